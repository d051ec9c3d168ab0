from __future__ import annotations

from tltlc.expression.tree import Condition, Const, Expression, Op, ParamValue, SignalValue, When, nodes


def test_nodes_come_in_order_of_appearance() -> None:
    a, b, c, d = SignalValue("a"), ParamValue("b"), Const(1.0), SignalValue("d")
    condition = Condition("<", (a, b))
    expression = Op("+", (When(((condition, c),), d), a))
    assert list(nodes(expression)) == [expression, expression.args[0], condition, a, b, c, d, a]


def test_expressions_of_any_depth_can_be_walked() -> None:
    expression: Expression = SignalValue("a")
    for _ in range(100_000):
        expression = Op("neg", (expression,))
    assert sum(1 for _ in nodes(expression)) == 100_001
