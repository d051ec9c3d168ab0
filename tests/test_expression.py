from __future__ import annotations

from tltlc.expression.tree import Condition, Const, Expression, Op, Param, Signal, When, nodes


def test_nodes_come_in_order_of_appearance() -> None:
    a, b, c, d = Signal("a"), Param("b"), Const(1.0), Signal("d")
    test = Condition("<", (a, b))
    expression = Op("+", (When(((test, c),), d), a))
    assert list(nodes(expression)) == [expression, expression.args[0], test, a, b, c, d, a]


def test_depth_is_no_limit() -> None:
    expression: Expression = Signal("a")
    for _ in range(100_000):
        expression = Op("neg", (expression,))
    assert sum(1 for _ in nodes(expression)) == 100_001
