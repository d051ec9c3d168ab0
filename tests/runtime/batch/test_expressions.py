"""Expressions over columns give the values of the scalar evaluator, and fail where it raises an error."""

from __future__ import annotations

import ast
import math
import re
from typing import Any

import pytest
import torch
from hypothesis import given, settings
from hypothesis import strategies as st

from tests.fixtures import near
from tests.monitor.strategies import PARAMS, SIGNALS, expressions, numbers
from tltl_runtime.spec.batch import BatchMonitor
from tltl_runtime.spec.batch.expressions import TensorExpressions
from tltlc.automaton.finite.build import build, spec_from_formula
from tltlc.core.record import replace
from tltlc.expression.evaluate import evaluate
from tltlc.expression.tree import ArithmeticOp, Condition, Const, Expression, Op, SignalValue, When
from tltlc.logic import formula as f
from tltlc.monitor import MonitorError
from tltlc.resolve import spec

FAILURES = (ZeroDivisionError, OverflowError, ValueError)
CPU = torch.device("cpu")
REPLACED: dict[str, ArithmeticOp] = {"exp": "abs", "tanh": "neg", "sqrt": "abs", "^": "/"}
x, y = SignalValue("x"), SignalValue("y")


def program(expression: Expression, params: dict[str, float] | None = None) -> TensorExpressions:
    return TensorExpressions([expression], SIGNALS if params else ("x", "y"), params or {}, CPU, torch.float64)


def exact(node: Any) -> Any:
    """Replace the operations that torch rounds differently.

    A comparison can depend on a single bit.
    """
    if isinstance(node, When):
        cases = tuple((exact(condition), exact(value)) for condition, value in node.cases)
        return When(cases, exact(node.otherwise))
    if not isinstance(node, (Op, Condition)):
        return node
    parts = tuple(map(exact, node.args))
    if isinstance(node, Condition):
        return Condition(node.op, parts)
    is_product = node.op == "^" and isinstance(parts[1], Const) and parts[1].value in (2.0, 3.0)
    return Op(node.op if is_product else REPLACED.get(node.op, node.op), parts)


@settings(max_examples=200, deadline=None)
@given(expressions(), st.lists(st.tuples(numbers, numbers), min_size=1, max_size=4), st.tuples(numbers, numbers))
def test_columns_give_the_values_of_single_samples(
    expression: Expression, samples: list[tuple[float, float]], given_params: tuple[float, float]
) -> None:
    expression = exact(expression)
    params = dict(zip(PARAMS, given_params, strict=True))
    (values,), (failures,) = program(expression, params).run(torch.tensor(samples, dtype=torch.float64).t())
    for index, sample in enumerate(samples):
        failed = failures is not None and bool(failures[index])
        try:
            expected = evaluate(expression, dict(zip(SIGNALS, sample, strict=True)), params)
        except FAILURES:
            assert failed
            continue
        assert not failed
        value = float(values[index])
        assert value == expected or (math.isnan(value) and math.isnan(expected))


@pytest.mark.parametrize(
    "expression",
    [
        Op("exp", (x,)),
        Op("tanh", (x,)),
        Op("sqrt", (x,)),
        Op("^", (x, Const(0.5))),
        Op("^", (x, Const(-1.0))),
        Op("^", (x, Const(4.0))),
        Op("^", (Const(2.5), x)),
        Op("^", (x, y)),
        Op("tanh", (Op("exp", (Op("sqrt", (Op("abs", (x,)),)),)),)),
    ],
)
def test_operations_that_torch_rounds_differently_are_close(expression: Expression) -> None:
    xs = (0.0, 0.1, 1.0, -2.0, 3.7, 710.0, 4577665636348541.0, 1e300)
    samples = [(a, b) for a in xs for b in (0.0, 0.5, -1.0, 7.5)]
    (values,), (failures,) = program(expression).run(torch.tensor(samples, dtype=torch.float64).t())
    for index, (a, b) in enumerate(samples):
        try:
            expected = evaluate(expression, {"x": a, "y": b}, {})
        except FAILURES:
            assert failures is not None
            assert failures[index]
            continue
        assert failures is None or not failures[index]
        assert float(values[index]) == pytest.approx(expected, rel=1e-12, abs=0.0)


def test_shared_subexpressions_are_computed_once() -> None:
    shared = Op("sqrt", (Op("abs", (x,)),))
    both = TensorExpressions([Op("+", (shared, y)), Op("-", (shared, y))], ("x", "y"), {}, CPU, torch.float64)
    assert both.source.count("sqrt(") == 1


@settings(max_examples=100, deadline=None)
@given(expressions())
def test_each_tensor_is_released_after_its_last_use(expression: Expression) -> None:
    (function,) = ast.parse(program(expression, dict.fromkeys(PARAMS, 1.0)).source).body
    assert isinstance(function, ast.FunctionDef)
    last_use: dict[str, int] = {}
    released: dict[str, int] = {}
    uses = 0
    for statement in function.body:
        names = {node.id for node in ast.walk(statement) if isinstance(node, ast.Name) and re.match(r"t\d", node.id)}
        if isinstance(statement, ast.Delete):
            released.update(dict.fromkeys(names, uses))
            continue
        uses += 1
        last_use.update(dict.fromkeys(names, uses))
    assert released == {name: use for name, use in last_use.items() if use < uses}


def test_a_case_that_is_not_taken_cannot_fail() -> None:
    guarded = When(((Condition(">", (x, Const(0.0))), Op("/", (Const(1.0), x))),), Const(-1.0))
    (values,), (failures,) = program(guarded).run(torch.tensor([[0.0, 4.0], [0.0, 0.0]], dtype=torch.float64))
    assert values.tolist() == [-1.0, 0.25]
    assert failures is not None
    assert not failures.any()


def test_closeness_equals_the_scalar_evaluator_at_its_borders() -> None:
    distances = [0.0, 0.5, 1.0, 5.0, 5.5, 10.0, 11.0]
    near_x = TensorExpressions([near("x")], ("x",), {"level_size": 10.0}, CPU, torch.float64)
    (values,), _ = near_x.run(torch.tensor([distances], dtype=torch.float64))
    assert values.tolist() == [evaluate(near("x"), {"x": d}, {"level_size": 10.0}) for d in distances]


@pytest.mark.parametrize(
    ("expression", "text"),
    [
        (Op("/", (Const(1.0), x)), "divides by zero"),
        (Op("sqrt", (Op("-", (x, Const(0.5))),)), "takes a root or power that does not exist"),
        (Op("exp", (Op("-", (Const(1000.0), Op("*", (x, Const(2000.0))))),)), "is too large to compute"),
        (Op("*", (Const(1e300), Op("-", (Op("*", (x, Const(1e300))), Const(1e300))))), "is too large to compute"),
        (Op("/", (Const(1.0), Const(0.0))), "divides by zero"),
    ],
)
def test_an_atom_without_a_value_is_named_with_its_environments(expression: Expression, text: str) -> None:
    fspa = build(spec_from_formula(f.eventually(f.atom("p"))))
    fspa = replace(fspa, signals=(spec.Signal("x", "number", None, None),), atoms=(spec.Atom("p", expression),))
    batch = BatchMonitor(fspa, 3)
    with pytest.raises(MonitorError) as caught:
        batch.step({"x": torch.tensor([1.0, 0.0, 1.0])})
    (diagnostic,) = caught.value.diagnostics
    assert diagnostic.code == "TLT0613"
    assert diagnostic.title.endswith(f": the atom `p` {text}")
    assert diagnostic.title.startswith("environment")
    assert batch.steps.tolist() == [0.0] * 3
