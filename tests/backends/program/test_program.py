from __future__ import annotations

import math
from collections.abc import Iterable
from typing import Literal
from unittest.mock import patch

from hypothesis import given
from hypothesis import strategies as st

from tests.automaton.letters import letters
from tests.backends.program.interpreter import NoValueError, Scope, failure_names, step
from tests.backends.strategies import automata, expressions, infinite_automata
from tests.fuzzing import times
from tltlc.automaton.finite.blowup import recursion_room
from tltlc.automaton.finite.build import build, spec_from_formula
from tltlc.automaton.fspa import Fspa
from tltlc.core.record import replace
from tltlc.expression.evaluate import evaluate
from tltlc.expression.tree import Condition, Const, Expression, Op, SignalValue, When
from tltlc.logic import formula as f
from tltlc.monitor import Monitor
from tltlc.program import arithmetic
from tltlc.program.arithmetic import ExpressionTranslator, with_declaration
from tltlc.program.build import program
from tltlc.program.printer import Printer
from tltlc.program.states import ROBUSTNESS
from tltlc.program.tree import Assign, Declare, If, ProgramVariable, Statement
from tltlc.program.used_names import parts, variables_read
from tltlc.resolve import spec

SIGNALS = {"distance(s1)": "s1", "health": "health"}
PARAMS = {"level_size": "size"}


def computed(expression: Expression, s1: float, health: float, size: float) -> float | str:
    scope = Scope({"s1": s1, "health": health, "size": size})
    try:
        scope.run(with_declaration("value", ExpressionTranslator(SIGNALS, PARAMS, "t").assign("value", expression)))
    except NoValueError as error:
        return str(error)
    return scope.values["value"]


def expected(expression: Expression, s1: float, health: float, size: float) -> float | str:
    try:
        return evaluate(expression, {"distance(s1)": s1, "health": health}, {"level_size": size})
    except (ZeroDivisionError, OverflowError, ValueError) as error:
        return type(error).__name__


def same(x: float | str, y: float | str) -> bool:
    if isinstance(x, float) and isinstance(y, float):
        return (math.isnan(x) and math.isnan(y)) or (x == y and math.copysign(1, x) == math.copysign(1, y))
    # If several parts have no value, the order of the statements decides which error comes first.
    return isinstance(x, str) == isinstance(y, str)


values = st.floats(-4, 4) | st.sampled_from([0.0, -0.0, 1.0, -1.0, 1e300])


@times(80)
@given(expressions(), values, values, values)
def test_expressions_have_the_value_of_the_evaluator(
    expression: Expression, s1: float, health: float, size: float
) -> None:
    assert same(computed(expression, s1, health, size), expected(expression, s1, health, size))


@times(80)
@given(expressions(), values, values, values)
def test_cases_that_are_computed_before_others_do_not_change_the_value(
    expression: Expression, s1: float, health: float, size: float
) -> None:
    with patch.object(arithmetic, "_MOST_BRANCHES", 1):
        assert same(computed(expression, s1, health, size), expected(expression, s1, health, size))


def deep_cases(count: int) -> Expression:
    """Return ``when`` expressions inside ``count * count`` cases, nested as deep as expressions are split."""
    x = SignalValue("health")

    def below(value: float) -> Condition:
        return Condition("<", (x, Const(value)))

    def cases(first: float, last: float, values: list[Expression]) -> Expression:
        borders = [first + (last - first) * (index + 1) / count for index in range(count)]
        return When(tuple(zip(map(below, borders), values, strict=True)), Const(-1.0))

    inside = [[Const(float(i * count + j)) for j in range(count)] for i in range(count)]
    leaves = [[When(((below(0.5), Const(0.25)),), When(((below(9.0), leaf),), x)) for leaf in row] for row in inside]
    expression = cases(0.0, 1.0, [cases(i / count, (i + 1) / count, list(row)) for i, row in enumerate(leaves)])
    for depth in range(arithmetic._MOST_BRANCHES - 2):
        expression = When(((Condition(">", (x, Const(-1.0 - depth))), expression),), Const(2.0))
    return expression


def test_the_code_of_deep_cases_grows_with_their_number() -> None:
    sizes = []
    for count in (5, 20):
        expression = deep_cases(count)
        for health in (-2.0, -0.1, 0.0, 0.3, 0.55, 0.74, 0.99, 1.0, 3.0):
            assert same(computed(expression, 0.0, health, 1.0), expected(expression, 0.0, health, 1.0))
        statements = ExpressionTranslator(SIGNALS, PARAMS, "t").assign("value", expression)
        sizes.append(len("".join(Printer().lines(statements))))
    # The second expression has 16 times as many cases.
    assert sizes[1] < 16 * sizes[0]


def test_operands_are_computed_only_where_they_are_needed() -> None:
    x = SignalValue("health")
    quotient = Op("/", (Const(1.0), x))
    inside = When(((Condition(">", (quotient, Const(2.0))), Const(1.0)),), Const(0.0))
    ops: tuple[Literal["and", "or"], ...] = ("and", "or")
    for op in ops:
        health = 0.0
        first = Condition(">" if op == "and" else "<=", (x, Const(0.0)))
        test = Condition(op, (first, Condition(">", (inside, Const(0.5))), Condition("<", (x, Const(9.0)))))
        for nested in (When(((test, inside),), Const(0.25)), Op("+", (When(((test, Const(3.0)),), Const(4.0)), x))):
            assert same(computed(nested, 0.0, health, 1.0), expected(nested, 0.0, health, 1.0))
            assert same(computed(nested, 0.0, 0.25, 1.0), expected(nested, 0.0, 0.25, 1.0))


def _depth(statement: Statement) -> int:
    """Return the maximal nesting depth of brackets in the text of a statement."""
    text, depth, deepest = Printer().lines([statement])[0], 0, 0
    for character in text:
        depth += {"(": 1, ")": -1}.get(character, 0)
        deepest = max(deepest, depth)
    return deepest


def test_deep_expressions_are_split() -> None:
    deep: Expression = SignalValue("health")
    for _ in range(200):
        deep = Op("+", (Const(1.0), Op("abs", (deep,))))
    with recursion_room():
        assert computed(deep, 0.0, 0.5, 1.0) == 200.5
        depth = max(map(_depth, ExpressionTranslator(SIGNALS, PARAMS, "t").assign("value", deep)))
    assert 10 < depth < 40


@times(25)
@given(automata() | infinite_automata(), st.data())
def test_steps_agree_with_the_monitor(fspa: Fspa, data: st.DataObject) -> None:
    limit = data.draw(st.none() | st.integers(1, 5))
    fspa = replace(fspa, limit_steps=limit, judge=data.draw(st.sampled_from(("goal", "limit"))))
    compiled = program(fspa, ())
    monitor = Monitor(fspa)
    state, best, done = 0, 0.0, False
    for number in range(1, 8):
        letter = data.draw(st.sampled_from(letters(fspa)))
        sample = [(1 if holds else -1) * data.draw(st.sampled_from([1.0, 0.5, 0.25])) for holds in letter]
        sample = [0.0 if value == -0.25 else value for value in sample]
        outcome = step(compiled, state, number, best, done, dict(zip(compiled.atoms, sample, strict=True)))
        row = monitor.step_atoms(sample)
        limiting = None if outcome["limiting"] < 0 else fspa.atoms[int(outcome["limiting"])].name
        state, best, done = int(outcome["target"]), float(outcome["best"]), bool(outcome["done"])
        assert (state, best, done) == (row.state, row.progress, row.done)
        assert (outcome["reward"], outcome["robustness"], limiting) == (row.reward, row.robustness, row.limiting)
        if row.failed_step in (None, number):
            assert failure_names(compiled, outcome) == (row.failed_clause, row.failed_atom)


@given(st.lists(st.floats(-1, 1) | st.sampled_from([0.0, -0.0, 0.5]), min_size=4, max_size=4))
def test_robustness_is_written_with_as_few_literals_as_possible(sample: list[float]) -> None:
    """The guard of the loop has four primes of two literals, or two clauses of two."""
    a, b, c, d = map(f.atom, "abcd")
    fspa = build(spec_from_formula(f.eventually(f.or_(f.and_(a, b), f.and_(c, d)))))
    compiled = program(fspa, ())
    (branch,) = compiled.cases[0].statements
    assert isinstance(branch, If)
    for body in (branch.cases[0][1], branch.otherwise):
        (robustness,) = (line.value for line in body if isinstance(line, Assign) and line.name == ROBUSTNESS)
        assert sum(isinstance(part, ProgramVariable) for part in parts([robustness])) == 4
    outcome = step(compiled, 0, 1, 0.0, False, dict(zip(compiled.atoms, sample, strict=True)))
    assert outcome["robustness"] == Monitor(fspa).step_atoms(sample).robustness


def test_temporaries_avoid_the_names_of_a_specification() -> None:
    names = ("t", "t_1", "t 2", "t2_1", "t_")
    square = Op("^", (Op("+", (SignalValue("t"), Const(1.0))), Const(2.0)))
    fspa = replace(
        build(spec_from_formula(f.atom("a"))),
        signals=tuple(spec.Signal(name, "number", None, None) for name in names),
        atoms=(spec.Atom("a", square),),
    )
    compiled = program(fspa, ())
    declared = [statement.name for statement in compiled.values[0] if isinstance(statement, Declare)]
    assert declared == ["t3_1"]
    assert len({*compiled.signals, *compiled.atoms, *declared}) == 7


@times(25)
@given(automata() | infinite_automata(), st.sampled_from(("goal", "limit")))
def test_every_declared_variable_is_read(fspa: Fspa, judge: spec.JudgeMode) -> None:
    for case in program(replace(fspa, judge=judge), ()).cases:
        assert _declared(case.statements) <= variables_read(case.statements)


def _declared(statements: Iterable[Statement]) -> set[str]:
    names: set[str] = set()
    for statement in statements:
        if isinstance(statement, Declare):
            names.add(statement.name)
        elif isinstance(statement, If):
            names |= _declared(statement.otherwise).union(*(_declared(body) for _, body in statement.cases))
    return names
