"""The relation of two specs agrees with their formulas on all short traces."""

from __future__ import annotations

from itertools import product

import pytest
from hypothesis import given

from tests.automaton.infinite.runs import compiled
from tests.fuzzing import times
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
from tltlc.tools.diff.relation import ExclusiveGroup, Relation, compare
from tltlc.tools.witness.blocks import letter_values

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


def compile_one(text: str) -> Fspa:
    (fspa,) = compile_text(text)
    return fspa


def relation_of(only_a: bool, only_b: bool) -> Relation:
    if only_a:
        return "incomparable" if only_b else "stricter"
    return "looser" if only_b else "equivalent"


@times(50)
@given(SMALL, SMALL)
def test_finite_relations_match_the_formulas(first: Formula, second: Formula) -> None:
    a, b = finite(first), finite(second)
    comparison = compare(a, b)
    assert comparison.relation == relation_of(not is_included(a, b), not is_included(b, a))
    for trace, accepts, rejects in ((comparison.only_a, first, second), (comparison.only_b, second, first)):
        witnesses = [
            candidate
            for candidate in all_traces(("a", "b"), 3)
            if holds(accepts, candidate) and not holds(rejects, candidate)
        ]
        if trace is None:
            assert not witnesses
            continue
        assert not trace.cycle
        assert holds(accepts, trace.prefix) and not holds(rejects, trace.prefix)
        assert len(trace.prefix) <= min(map(len, witnesses), default=len(trace.prefix))


@times(30)
@given(SMALL, SMALL)
def test_exclusive_atoms_restrict_the_traces(first: Formula, second: Formula) -> None:
    never = always(not_(and_(atom("a"), atom("b"))))
    a, b = finite(first), finite(second)
    sides = (not is_included(finite(and_(formula, never)), other) for formula, other in ((first, b), (second, a)))
    comparison = compare(a, b, exclusive=[ExclusiveGroup(("a", "b", "elsewhere"), True, True)])
    assert comparison.relation == relation_of(*sides)
    for trace in (comparison.only_a, comparison.only_b):
        assert trace is None or {"a", "b"} not in trace.prefix


@times(30)
@given(SMALL, SMALL)
def test_infinite_relations_match_the_formulas(first: Formula, second: Formula) -> None:
    comparison = compare(compiled(first), compiled(second))
    for trace, accepts, rejects in ((comparison.only_a, first, second), (comparison.only_b, second, first)):
        if trace is not None:
            assert holds_on_lasso(accepts, trace.prefix, trace.cycle)
            assert not holds_on_lasso(rejects, trace.prefix, trace.cycle)
            continue
        for before, after in ((0, 1), (1, 1), (1, 2)):
            for samples in product(SAMPLES, repeat=before + after):
                prefix, cycle = samples[:before], samples[before:]
                assert not holds_on_lasso(accepts, prefix, cycle) or holds_on_lasso(rejects, prefix, cycle)


@times(40)
@given(SMALL, SMALL)
def test_swapping_the_specs_swaps_the_relation(first: Formula, second: Formula) -> None:
    a, b = finite(first), finite(second)
    forward, backward = compare(a, b), compare(b, a)
    assert backward.relation == SWAPPED[str(forward.relation)]
    lengths = [
        trace and len(trace.prefix) for trace in (forward.only_a, forward.only_b, backward.only_b, backward.only_a)
    ]
    assert lengths[:2] == lengths[2:]


@times(25)
@given(SMALL)
def test_a_spec_does_not_differ_from_itself(formula: Formula) -> None:
    assert diff(finite(formula), finite(formula)).is_same


def test_finite_and_infinite_specs_have_no_relation() -> None:
    comparison = compare(
        compile_one("signal a: bool spec p = F a"), compile_one("signal a: bool spec p { semantics infinite reach a }")
    )
    assert (comparison.relation, comparison.only_a, comparison.only_b) == (None, None, None)
    assert comparison.beginnings is not None and comparison.beginnings.relation == "equivalent"


@times(30)
@given(SMALL, SMALL)
def test_beginnings_of_finite_and_infinite_specs_are_compared(first: Formula, second: Formula) -> None:
    a, b = finite(first), compiled(second)
    beginnings = compare(a, b).beginnings
    assert beginnings is not None
    prefixes = [trace for length in (1, 2, 3) for trace in product(SAMPLES, repeat=length)]
    for trace, kept, broken in ((beginnings.only_a, a, b), (beginnings.only_b, b, a)):
        witnesses = [prefix for prefix in prefixes if not is_broken(kept, prefix) and is_broken(broken, prefix)]
        if trace is None:
            assert not witnesses
        else:
            assert not is_broken(kept, trace.prefix) and is_broken(broken, trace.prefix)
            assert len(trace.prefix) <= min(map(len, witnesses), default=len(trace.prefix))
    assert beginnings.relation == relation_of(beginnings.only_a is not None, beginnings.only_b is not None)


def is_broken(fspa: Fspa, letters: tuple[Letter, ...]) -> bool:
    state = 0
    for letter in letters:
        state = successor(fspa, state, letter)
    return fspa.states[state].verdict == "violated"


def test_an_atom_with_another_expression_is_another_atom() -> None:
    a, b = compile_one(NEAR), compile_one(NEAR.replace("1 - distance(x) / close", "(1 - distance(x) / close)^2"))
    comparison = compare(a, b)
    assert (comparison.relation, comparison.split_names) == ("incomparable", ("near(chest)",))
    assert comparison.only_a == Trace((frozenset({"near(chest) of A"}),))
    assert comparison.only_b == Trace((frozenset({"near(chest) of B"}),))
    assert compare(a, b, by_name=True).relation == "equivalent"


@pytest.mark.parametrize(
    ("old", "new", "is_split", "differ"),
    [
        ("= 20 m", "= 30 m", False, ["near(chest)", "size"]),  # a different scale
        ("close: length = 1 m", "close: length = 2 m", True, ["near(chest)"]),
        ("[0 m, inf]", "[0 m, 5 km]", False, ["distance(chest)"]),  # equal on the samples that both ranges allow
        ("[0 m, inf]", "[3 m, inf]", False, ["distance(chest)"]),
        ("entity chest", "entity chest, gate", False, []),
    ],
)
def test_params_and_ranges_split_an_atom_if_its_truth_changes(
    old: str, new: str, is_split: bool, differ: list[str]
) -> None:
    a, b = compile_one(NEAR), compile_one(NEAR.replace(old, new))
    comparison = compare(a, b)
    assert bool(comparison.split_names) == is_split
    assert (comparison.relation == "incomparable") == is_split
    assert [difference.name for difference in differences(a, b)] == differ


def test_disjoint_ranges_split_an_atom() -> None:
    text = "signal x: number in [{}]  predicate high in [-1, 1] = clamp(x - 10, -1, 1)  spec up = F high"
    assert compare(compile_one(text.format("0, 9")), compile_one(text.format("11, 20"))).split_names == ("high",)


THRESHOLDS = {"a": "x > 0.75", "b": "x > 0.25", "c": "x < 0.5"}
FEASIBLE = [
    frozenset(THRESHOLDS[name] for name, holds in zip(THRESHOLDS, (x > 0.75, x > 0.25, x < 0.5), strict=True) if holds)
    for x in (0.0, 0.3, 0.6, 0.8)
]
"""The letters over these atoms that values of the one signal can produce: four of eight."""


@times(30)
@given(formulas(atoms=tuple(THRESHOLDS), max_leaves=4), formulas(atoms=tuple(THRESHOLDS), max_leaves=4))
def test_only_letters_that_samples_can_produce_count(first: Formula, second: Formula) -> None:
    lets = "".join(f"let {name} = {atom}\n" for name, atom in THRESHOLDS.items())
    a, b = (compile_one(f"signal x in [0, 1]\n{lets}spec s = {ascii_text(formula)}") for formula in (first, second))
    comparison = compare(a, b, feasible_only=True)
    sides = [has_feasible_counterexample(a, b), has_feasible_counterexample(b, a)]
    assert comparison.relation == relation_of(*sides)
    for trace in (comparison.only_a, comparison.only_b):
        known = {atom.name for atom in (*a.atoms, *b.atoms)}
        assert trace is None or set(trace.prefix) <= {letter & known for letter in FEASIBLE}


def has_feasible_counterexample(a: Fspa, b: Fspa) -> bool:
    """Whether ``a`` accepts a trace of feasible letters that ``b`` rejects."""
    queue = [(0, 0)]
    for pair in queue:
        for letter in FEASIBLE:
            target = successor(a, pair[0], letter), successor(b, pair[1], letter)
            if a.states[target[0]].accepting and not b.states[target[1]].accepting:
                return True
            if target not in queue:
                queue.append(target)
    return False


def successor(fspa: Fspa, state: int, letter: Letter) -> int:
    truth = letter_values(fspa, letter)
    return next(edge.target for edge in fspa.edges_from(state) if guard_holds(edge.guard, truth))


def test_a_higher_threshold_is_stricter() -> None:
    param = "signal fuel in [0, 100]  param low in [0, 50] = {}  spec s = G fuel > low"
    comparison = compare(compile_one(param.format(20)), compile_one(param.format(30)), feasible_only=True)
    assert comparison.relation == "stricter"
    assert comparison.impossible == ((("fuel > low of B", True), ("fuel > low of A", False)),)
    # If the signal's range differs in B, nothing is known about the samples.
    other = param.replace("signal fuel in [0, 100]", "signal fuel in [200, 300]").replace("[0, 50]", "[200, 299]")
    assert not compare(compile_one(param.format(20)), compile_one(other.format(250)), feasible_only=True).impossible


def test_forty_thresholds_are_compared_within_the_work_limit() -> None:
    def keeps(least: float) -> Fspa:
        numbers = range(40)
        signals = "".join(f"signal x{number} in [0, 1]\n" for number in numbers)
        return compile_one(f"{signals}spec s {{ {' '.join(f'keep x{number} > {least}' for number in numbers)} }}")

    comparison = compare(keeps(0.1), keeps(0.2), feasible_only=True, work=200_000)
    assert comparison.relation == "stricter"
    assert len(comparison.impossible) == 40
