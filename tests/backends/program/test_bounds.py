"""The proven ranges of numbers hold for every value that a monitor can meet."""

from __future__ import annotations

import math
from pathlib import Path

import pytest
from hypothesis import example, given
from hypothesis import strategies as st

from tests.backends.program.interpreter import NoValueError, Scope
from tests.backends.strategies import expressions
from tests.calls import calls
from tests.fuzzing import times
from tltlc import compile_file
from tltlc.automaton.finite.blowup import recursion_room
from tltlc.automaton.finite.build import build, spec_from_formula
from tltlc.core.record import replace
from tltlc.expression.tree import Condition, Const, Expression, Op, ParamValue, SignalValue, When
from tltlc.logic import formula as f
from tltlc.program.arithmetic import ExpressionTranslator, with_declaration
from tltlc.program.bounds import ValueRange, prove_ranges, range_between
from tltlc.program.build import program
from tltlc.program.tree import Statement
from tltlc.program.used_names import functions_called
from tltlc.resolve import spec

ROOT = Path(__file__).resolve().parents[3]
KNOWN = {"s1": range_between(0.0, None), "health": ValueRange(0.0, 1.0), "size": ValueRange(2.0, 1e4)}
S1, HEALTH, SIZE = SignalValue("distance(s1)"), SignalValue("health"), ParamValue("level_size")


def with_proved_ranges(
    expression: Expression,
) -> tuple[tuple[Statement, ...], tuple[Statement, ...], ValueRange | None]:
    """Return the plain statements, the statements simplified by the proven ranges, and the range of the value."""
    arithmetic = ExpressionTranslator({"distance(s1)": "s1", "health": "health"}, {"level_size": "size"}, "t")
    statements = arithmetic.assign("value", expression)
    simplified, range_ = prove_ranges("value", statements, KNOWN)
    return with_declaration("value", statements), with_declaration("value", simplified), range_


def quotient(x: Expression, y: Expression) -> Op:
    return Op("/", (x, y))


def less(x: Expression, y: Expression) -> Op:
    return Op("-", (x, y))


def run(statements: tuple[Statement, ...], s1: float, health: float, size: float) -> float | None:
    scope = Scope({"s1": s1, "health": health, "size": size})
    try:
        scope.run(statements)
    except NoValueError:
        return None
    return float(scope.values["value"])


distances = st.floats(0.0, 20.0) | st.floats(0.0, allow_infinity=False) | st.sampled_from([0.0, 1.0, 2.0, 5e-324])
shares = st.floats(0.0, 1.0) | st.sampled_from([0.0, 0.5, 1.0])
sizes = st.floats(2.0, 20.0) | st.sampled_from([2.0, 1e4])
way = When(
    (
        (Condition("<", (S1, Const(1.0))), less(Const(1.0), S1)),
        (Condition("<", (S1, SIZE)), quotient(less(SIZE, S1), less(SIZE, Const(1.0)))),
    ),
    Const(-1.0),
)


@times(150)
@given(expressions() | st.builds(quotient, expressions(), expressions()), distances, shares, sizes)
@example(way, math.nextafter(2.0, 0.0), 0.0, 2.0)
@example(way, 1.0, 0.0, 3.0)
def test_values_are_the_same_and_in_their_range(expression: Expression, s1: float, health: float, size: float) -> None:
    statements, simplified, range_ = with_proved_ranges(expression)
    # A division by zero that is wrongly proven safe would fail the test.
    value, expected = run(simplified, s1, health, size), run(statements, s1, health, size)
    assert value == expected or (
        value is not None and expected is not None and math.isnan(value) and math.isnan(expected)
    )
    if range_ is not None and value is not None:
        assert range_.low <= value <= range_.high


@pytest.mark.parametrize(
    ("expression", "range_"),
    [
        (S1, range_between(0.0, None)),
        (less(Op("*", (Const(2.0), HEALTH)), Const(1.0)), ValueRange(-1.0, 1.0)),
        (quotient(S1, less(SIZE, Const(1.0))), range_between(0.0, None)),
        (quotient(Const(1.0), HEALTH), None),
        (Op("clamp", (quotient(S1, HEALTH), Const(-1.0), Const(1.0))), None),
        (Op("clamp", (Op("*", (S1, S1)), Const(-1.0), Const(1.0))), ValueRange(0.0, 1.0)),
        (way, ValueRange(-1.0, 1.0)),
        (Op("^", (less(HEALTH, Const(1.0)), Const(2.0))), ValueRange(0.0, 1.0)),
        (less(Op("*", (S1, S1)), Op("*", (S1, S1))), None),
        (Op("*", (Op("*", (S1, S1)), HEALTH)), None),
        (Op("tanh", (S1,)), ValueRange(-2.0, 2.0)),
        (Op("abs", (less(HEALTH, Const(0.25)),)), ValueRange(0.0, 0.75)),
        (Op("exp", (HEALTH,)), None),
    ],
)
def test_expressions_have_the_ranges_computed_by_hand(expression: Expression, range_: ValueRange | None) -> None:
    assert with_proved_ranges(expression)[2] == range_


def test_a_condition_narrows_the_range_of_what_it_compares() -> None:
    bearing = Op("abs", (less(HEALTH, Const(0.5)),))
    for condition, narrows in (
        (Condition("<", (bearing, Const(0.25))), True),
        (Condition("not", (Condition(">=", (bearing, Const(0.25))),)), True),
        (Condition("and", (Condition(">", (S1, Const(3.0))), Condition("<=", (bearing, Const(0.25))))), True),
        (Condition("or", (Condition(">", (S1, Const(3.0))), Condition("<=", (bearing, Const(0.25))))), False),
        (Condition(">", (bearing, Const(0.25))), False),
    ):
        _, _, range_ = with_proved_ranges(When(((condition, Op("*", (Const(4.0), bearing))),), Const(0.0)))
        assert range_ is not None
        assert range_.low == 0.0
        assert (range_.high <= 1.0) == narrows


def test_a_divisor_is_safe_only_where_the_condition_holds() -> None:
    for condition in (Condition(">", (HEALTH, Const(0.0))), Condition(">=", (HEALTH, Const(1e-9)))):
        _, simplified, _ = with_proved_ranges(When(((condition, quotient(S1, HEALTH)),), Const(0.0)))
        assert "divide" not in functions_called(simplified)
        _, simplified, _ = with_proved_ranges(When(((condition, Const(0.0)),), quotient(S1, HEALTH)))
        assert "divide" in functions_called(simplified)


def test_predicates_of_the_examples_are_proven_safe() -> None:
    for name in ("navigation", "cover_and_hide", "branching"):
        for fspa in compile_file(ROOT / f"examples/{name}.tltl"):
            result = program(fspa, [])
            assert all(result.always_in_range)
            assert not any(functions_called(value) & {"divide"} for value in result.values)


@pytest.mark.parametrize("part", [Op("/", (Const(1.0), SignalValue("x"))), Op("exp", (SignalValue("x"),))])
def test_a_condition_that_may_have_no_value_is_not_safe(part: Expression) -> None:
    """The sample is an error, whatever the branches are."""
    value = When(((Condition(">", (part, Const(2.0))), Const(0.5)),), Const(-0.5))
    fspa = build(spec_from_formula(f.eventually(f.atom("p"))))
    signals = (spec.Signal("x", "number", None, None),)
    assert program(replace(fspa, signals=signals, atoms=(spec.Atom("p", value),)), ()).always_in_range == (False,)


def test_an_atom_is_computed_only_in_the_state_that_needs_it() -> None:
    formula = f.eventually(f.and_(f.atom("a"), f.next_(f.eventually(f.and_(f.atom("b"), f.atom("c"))))))
    fspa = build(spec_from_formula(formula))
    only_in = dict(zip((atom.name for atom in fspa.atoms), program(fspa, []).only_in, strict=True))
    assert only_in == {"a": 0, "b": 1, "c": 1}
    # Atoms that may report an error or a notice are computed in every state.
    atoms = tuple(replace(atom, expression=Op("*", (Const(2.0), atom.expression))) for atom in fspa.atoms)
    result = program(replace(fspa, atoms=atoms), [])
    assert result.always_in_range == (False,) * 3
    assert result.only_in == (None,) * 3
    # Atoms that exclude each other are compared at each step.
    numbers = {atom.name: place for place, atom in enumerate(fspa.atoms)}
    for group, remaining in (("bc", {"a": 0}), ("b", {"a": 0, "b": 1, "c": 1})):
        result = program(replace(fspa, exclusive=(tuple(sorted(numbers[name] for name in group)),)), [])
        assert {name: result.only_in[numbers[name]] for name in "abc"} == {**dict.fromkeys("abc"), **remaining}


def test_a_bool_is_read_only_in_the_state_that_needs_it() -> None:
    """If only the atoms of one state are computed from a bool, no other state reads it."""
    a, b = f.atom("a"), f.atom("b")
    then, together = f.eventually(f.and_(a, f.next_(f.eventually(b)))), f.eventually(f.and_(a, b))
    for formula, of_a, of_b, read_in in (
        (then, "x", "y", (0, 1, -1)),
        (then, "x", "x", (None, -1, -1)),
        (together, "x", "x", (0, -1, -1)),
    ):
        fspa = build(spec_from_formula(formula))
        signals = tuple(spec.Signal(name, "bool", None, None) for name in "xyz")
        atoms = (spec.Atom("a", SignalValue(of_a)), spec.Atom("b", SignalValue(of_b)))
        result = program(replace(fspa, signals=signals, atoms=atoms), [])
        assert result.read_in == read_in
        assert result.reads_sample
        for place in (None, 0, 1):
            expected = [name for name, only in zip("xyz", read_in, strict=True) if only == place]
            assert result.bools_read_in(place) == expected
    unread = replace(fspa, signals=signals, atoms=(spec.Atom("a", Const(0.5)), spec.Atom("b", Const(0.5))))
    assert not program(unread, []).reads_sample


def test_an_atom_that_no_state_reads_is_not_computed() -> None:
    fspa = build(spec_from_formula(f.eventually(f.atom("a"))))
    unread = replace(fspa, atoms=(*fspa.atoms, spec.Atom("more", Const(0.5))))
    result = program(unread, [])
    assert result.only_in == (0, -1)
    assert result.values[1] == ()


@pytest.mark.parametrize("depth", [30, 300])
def test_work_is_linear_in_the_depth_of_a_predicate(depth: int) -> None:
    expression: Expression = S1
    for step in range(depth):
        case = Condition("<", (S1, Const(float(step))))
        expression = Op("+", (When(((case, expression),), Const(0.0)), HEALTH))

    def bounded() -> None:
        with recursion_room():
            _, _, range_ = with_proved_ranges(expression)
        assert range_ is not None

    # Measured: 520.
    assert calls(bounded) < 2000 * depth
