"""What became of a spec: against the meaning of formulas on all short traces, and as atoms are one or not."""

from __future__ import annotations

from itertools import product

import pytest
from hypothesis import given, settings

from tests.automaton.infinite.runs import compiled
from tests.logic.strategies import formulas
from tltlc import compile_text
from tltlc.automaton.compare import Letter, Trace, is_included
from tltlc.automaton.finite.build import build, spec_from_formula
from tltlc.automaton.fspa import Fspa
from tltlc.automaton.infinite.lasso import holds_on_lasso
from tltlc.logic.formula import Formula, always, and_, atom, not_
from tltlc.logic.oracle import all_traces, holds
from tltlc.logic.text.printer import ascii_text
from tltlc.monitor.guards import holds as guard_holds
from tltlc.tools.diff.differences import differences
from tltlc.tools.diff.pairs import diff
from tltlc.tools.diff.relation import Group, Relation, compare
from tltlc.tools.witness.blocks import values

SMALL = formulas(atoms=("a", "b"), max_leaves=4)
SAMPLES = [frozenset(names) for names in ((), ("a",), ("b",), ("a", "b"))]
SWAPPED = {"equivalent": "equivalent", "stricter": "looser", "looser": "stricter", "incomparable": "incomparable"}
NEAR = """
signal distance(x: entity): length in [0 m, inf]
param size: length in [4 m, 99 m] = 20 m
entity chest
predicate near(x: entity, close: length = 1 m) in [-1, 1] =
    when distance(x) < close: 1 - distance(x) / close
    otherwise: -min(1, (distance(x) - close) / (size - close))
spec find = F near(chest)
"""


def finite(formula: Formula) -> Fspa:
    return build(spec_from_formula(formula))


def one(text: str) -> Fspa:
    (fspa,) = compile_text(text)
    return fspa


def relation_of(only_a: bool, only_b: bool) -> Relation:
    if only_a:
        return "incomparable" if only_b else "stricter"
    return "looser" if only_b else "equivalent"


@settings(max_examples=150, deadline=None)
@given(SMALL, SMALL)
def test_over_finite_traces_as_the_formulas_say(first: Formula, second: Formula) -> None:
    a, b = finite(first), finite(second)
    found = compare(a, b)
    assert found.relation == relation_of(not is_included(a, b), not is_included(b, a))
    for trace, accepts, rejects in ((found.only_a, first, second), (found.only_b, second, first)):
        short = [each for each in all_traces(("a", "b"), 3) if holds(accepts, each) and not holds(rejects, each)]
        if trace is None:
            assert not short
            continue
        assert not trace.cycle
        assert holds(accepts, trace.prefix) and not holds(rejects, trace.prefix)
        assert len(trace.prefix) <= min(map(len, short), default=len(trace.prefix))


@settings(max_examples=80, deadline=None)
@given(SMALL, SMALL)
def test_on_traces_on_which_a_and_b_never_hold_together(first: Formula, second: Formula) -> None:
    never = always(not_(and_(atom("a"), atom("b"))))
    a, b = finite(first), finite(second)
    sides = (not is_included(finite(and_(one, never)), other) for one, other in ((first, b), (second, a)))
    found = compare(a, b, exclusive=[Group(("a", "b", "elsewhere"), True, True)])
    assert found.relation == relation_of(*sides)
    for trace in (found.only_a, found.only_b):
        assert trace is None or {"a", "b"} not in trace.prefix


@settings(max_examples=80, deadline=None)
@given(SMALL, SMALL)
def test_over_infinite_traces_as_the_formulas_say(first: Formula, second: Formula) -> None:
    found = compare(compiled(first), compiled(second))
    for trace, accepts, rejects in ((found.only_a, first, second), (found.only_b, second, first)):
        if trace is not None:
            assert holds_on_lasso(accepts, trace.prefix, trace.cycle)
            assert not holds_on_lasso(rejects, trace.prefix, trace.cycle)
            continue
        for before, after in ((0, 1), (1, 1), (1, 2)):
            for samples in product(SAMPLES, repeat=before + after):
                prefix, cycle = samples[:before], samples[before:]
                assert not holds_on_lasso(accepts, prefix, cycle) or holds_on_lasso(rejects, prefix, cycle)


@settings(max_examples=100, deadline=None)
@given(SMALL, SMALL)
def test_swapping_turns_it_round(first: Formula, second: Formula) -> None:
    a, b = finite(first), finite(second)
    found, back = compare(a, b), compare(b, a)
    assert back.relation == SWAPPED[str(found.relation)]
    lengths = [trace and len(trace.prefix) for trace in (found.only_a, found.only_b, back.only_b, back.only_a)]
    assert lengths[:2] == lengths[2:]


@settings(max_examples=50, deadline=None)
@given(SMALL)
def test_a_spec_does_not_differ_from_itself(formula: Formula) -> None:
    assert diff(finite(formula), finite(formula)).is_same


def test_traces_of_two_kinds_do_not_relate() -> None:
    found = compare(one("signal a: bool spec p = F a"), one("signal a: bool spec p { semantics infinite reach a }"))
    assert (found.relation, found.only_a, found.only_b) == (None, None, None)
    assert found.beginnings is not None and found.beginnings.relation == "equivalent"


@settings(max_examples=80, deadline=None)
@given(SMALL, SMALL)
def test_beginnings_of_traces_of_two_kinds_relate(first: Formula, second: Formula) -> None:
    a, b = finite(first), compiled(second)
    found = compare(a, b).beginnings
    assert found is not None
    short = [trace for length in (1, 2, 3) for trace in product(SAMPLES, repeat=length)]
    for trace, kept, broken in ((found.only_a, a, b), (found.only_b, b, a)):
        telling = [each for each in short if not is_broken(kept, each) and is_broken(broken, each)]
        if trace is None:
            assert not telling
        else:
            assert not is_broken(kept, trace.prefix) and is_broken(broken, trace.prefix)
            assert len(trace.prefix) <= min(map(len, telling), default=len(trace.prefix))
    assert found.relation == relation_of(found.only_a is not None, found.only_b is not None)


def is_broken(fspa: Fspa, letters: tuple[Letter, ...]) -> bool:
    state = 0
    for letter in letters:
        state = after(fspa, state, letter)
    return fspa.states[state].verdict == "violated"


def test_an_atom_with_another_expression_is_another_atom() -> None:
    a, b = one(NEAR), one(NEAR.replace("1 - distance(x) / close", "(1 - distance(x) / close)^2"))
    found = compare(a, b)
    assert (found.relation, found.split) == ("incomparable", ("near(chest)",))
    assert found.only_a == Trace((frozenset({"near(chest) of A"}),))
    assert found.only_b == Trace((frozenset({"near(chest) of B"}),))
    assert compare(a, b, by_name=True).relation == "equivalent"


@pytest.mark.parametrize(
    ("old", "new", "is_split", "differ"),
    [
        ("= 20 m", "= 30 m", False, ["near(chest)", "size"]),  # scaled otherwise
        ("close: length = 1 m", "close: length = 2 m", True, ["near(chest)"]),
        ("[0 m, inf]", "[0 m, 5 km]", False, ["distance(chest)"]),  # the same at all that both take
        ("[0 m, inf]", "[3 m, inf]", False, ["distance(chest)"]),
        ("entity chest", "entity chest, gate", False, []),
    ],
)
def test_params_and_ranges_make_another_atom_where_it_holds_elsewhere(
    old: str, new: str, is_split: bool, differ: list[str]
) -> None:
    a, b = one(NEAR), one(NEAR.replace(old, new))
    found = compare(a, b)
    assert bool(found.split) == is_split
    assert (found.relation == "incomparable") == is_split
    assert [each.name for each in differences(a, b)] == differ


def test_ranges_that_have_nothing_in_common_make_another_atom() -> None:
    text = "signal x: number in [{}]  predicate high in [-1, 1] = clamp(x - 10, -1, 1)  spec up = F high"
    assert compare(one(text.format("0, 9")), one(text.format("11, 20"))).split == ("high",)


THRESHOLDS = {"a": "x > 0.75", "b": "x > 0.25", "c": "x < 0.5"}
REAL = [
    frozenset(THRESHOLDS[name] for name, holds in zip(THRESHOLDS, (x > 0.75, x > 0.25, x < 0.5), strict=True) if holds)
    for x in (0.0, 0.3, 0.6, 0.8)
]
"""Of the eight letters over these atoms of one signal those that samples give."""


@settings(max_examples=80, deadline=None)
@given(formulas(atoms=tuple(THRESHOLDS), max_leaves=4), formulas(atoms=tuple(THRESHOLDS), max_leaves=4))
def test_real_traces_alone_count(first: Formula, second: Formula) -> None:
    lets = "".join(f"let {name} = {atom}\n" for name, atom in THRESHOLDS.items())
    a, b = (one(f"signal x in [0, 1]\n{lets}spec s = {ascii_text(each)}") for each in (first, second))
    found = compare(a, b, real=True)
    sides = [is_told_apart(a, b), is_told_apart(b, a)]
    assert found.relation == relation_of(*sides)
    for trace in (found.only_a, found.only_b):
        known = {atom.name for atom in (*a.atoms, *b.atoms)}
        assert trace is None or set(trace.prefix) <= {letter & known for letter in REAL}


def is_told_apart(a: Fspa, b: Fspa) -> bool:
    """Whether real letters lead to where the one accepts and the other does not."""
    queue = [(0, 0)]
    for both in queue:
        for letter in REAL:
            target = after(a, both[0], letter), after(b, both[1], letter)
            if a.states[target[0]].accepting and not b.states[target[1]].accepting:
                return True
            if target not in queue:
                queue.append(target)
    return False


def after(fspa: Fspa, state: int, letter: Letter) -> int:
    truth = values(fspa, letter)
    return next(edge.target for edge in fspa.edges_from(state) if guard_holds(edge.guard, truth))


def test_a_greater_threshold_is_stricter() -> None:
    param = "signal fuel in [0, 100]  param low in [0, 50] = {}  spec s = G fuel > low"
    found = compare(one(param.format(20)), one(param.format(30)), real=True)
    assert found.relation == "stricter"
    assert found.impossible == ((("fuel > low of B", True), ("fuel > low of A", False)),)
    # Where a signal is another thing in B, nothing is known of samples.
    other = param.replace("signal fuel in [0, 100]", "signal fuel in [200, 300]").replace("[0, 50]", "[200, 299]")
    assert not compare(one(param.format(20)), one(other.format(250)), real=True).impossible


def test_many_thresholds_are_as_one() -> None:
    def keeps(least: float) -> Fspa:
        numbers = range(40)
        signals = "".join(f"signal x{number} in [0, 1]\n" for number in numbers)
        return one(f"{signals}spec s {{ {' '.join(f'keep x{number} > {least}' for number in numbers)} }}")

    found = compare(keeps(0.1), keeps(0.2), real=True, work=200_000)
    assert found.relation == "stricter"
    assert len(found.impossible) == 40
