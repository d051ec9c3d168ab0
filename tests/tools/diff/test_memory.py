"""Comparisons of specs with registers: each difference is a trace of both monitors, and each equivalence is exact."""

from __future__ import annotations

import random
import re
from random import Random
from unittest.mock import patch

import pytest

from tests.resolve.test_deadlines import RULES, SIGNALS
from tests.unfolded import unfolded
from tltlc import compile_text
from tltlc.automaton.fspa import Fspa
from tltlc.monitor import Monitor
from tltlc.monitor.samples import Samples
from tltlc.resolve import specs
from tltlc.tools.diff import relation as relation_module
from tltlc.tools.diff.breaking import compare_versions
from tltlc.tools.diff.broken_rules import conflicts
from tltlc.tools.diff.diff_json import document
from tltlc.tools.diff.pairs import FileDiff, diff
from tltlc.tools.diff.relation import compare
from tltlc.tools.diff.text import text
from tltlc.tools.witness.blocks import given_values

NAMES = "clock 10 Hz\nsignal seen: bool\nsignal hidden: bool\nsignal hp in [0, 10]\n"


def _fspa(clause: str, names: str = NAMES) -> Fspa:
    (fspa,) = compile_text(f"{names}spec s {{ {clause} }}")
    return fspa


@pytest.mark.parametrize(
    ("a", "b", "relation"),
    [
        ("keep times(seen) <= 3", "keep times(seen) < 4", "equivalent"),
        ("keep times(seen) <= 3", "keep times(seen) <= 2", "stricter"),
        ("keep times(seen) <= 3", "keep times(hidden) <= 3", "incomparable"),
        ("keep seen implies hidden", "keep seen implies hidden and once hidden", "equivalent"),
        ("reach once seen", "reach seen", "equivalent"),
        ("reach begins seen", "reach seen", "equivalent"),
        ("keep hidden implies once within 1 s seen", "keep hidden implies once within 2 s seen", "looser"),
        ("keep hidden implies once within 1 s seen", "keep hidden implies time_since(seen) <= 1 s", "equivalent"),
        ("keep hp >= previous(hp)", "keep hp + 1 >= previous(hp)", "looser"),
        ("semantics infinite  keep times(seen) <= 3", "semantics infinite  keep times(seen) <= 2", "stricter"),
        ("keep hp >= previous(hp)  keep hidden", "keep hp >= previous(hp)  keep hidden or seen", "looser"),
        (
            "keep seen implies eventually within 60 s hidden",
            "keep seen implies eventually within 50 s hidden",
            "stricter",
        ),
        ("semantics infinite  keep once seen", "semantics infinite  require always once seen", "equivalent"),
    ],
)
def test_relations_are_those_of_traces_that_a_game_can_produce(a: str, b: str, relation: str) -> None:
    one, other = _fspa(a), _fspa(b)
    comparison = diff(one, other, feasible_only=True).comparison
    assert comparison.relation == relation
    for trace, accepting, rejecting in ((comparison.only_a, one, other), (comparison.only_b, other, one)):
        if trace is not None and one.semantics == "finite":
            assert _accepts(accepting, trace.prefix)
            assert not _accepts(rejecting, trace.prefix)


def _accepts(fspa: Fspa, letters: tuple[frozenset[str], ...]) -> bool:
    monitor = Monitor(fspa)
    return [monitor.step_atoms(given_values(fspa, letter)).accepting for letter in letters][-1]


def test_an_atom_that_follows_from_different_atoms_is_another_atom() -> None:
    predicate = "signal d in [0, 9]\npredicate near in [-1, 1] = when d < {}: 1 otherwise: -1\n"
    one, other = (_fspa("keep times(near) <= 1", predicate.format(limit)) for limit in (3, 5))
    comparison = diff(one, other, feasible_only=True).comparison
    assert comparison.split_names == ("near",)
    assert comparison.relation == "incomparable"
    # `breaking` compares by names, and reports the change of the predicate by itself.
    pair = compare_versions(one, other, 50_000)
    assert pair.comparison.relation == "equivalent"
    assert [(difference.kind, difference.name) for difference in pair.differences] == [("atom", "near")]


def test_renamed_signals_and_predicates_do_not_change_what_is_remembered() -> None:
    names = "signal d in [0, 9]\npredicate near in [-1, 1] = when d < 3: 1 otherwise: -1\n"
    clauses = "keep times(near) <= 1  keep lowest(d) > 2"
    one = _fspa(clauses, names)
    other = _fspa(clauses.replace("near", "close"), names.replace("near", "close"))
    assert compare_versions(one, other, 50_000).comparison.relation == "equivalent"
    other = _fspa(clauses.replace("(d)", "(range)"), names.replace(" d ", " range "))
    pair = compare_versions(one, other, 50_000)
    assert [(difference.kind, difference.name) for difference in pair.differences] == [("signal", "d")]


def test_the_text_says_what_was_not_decided() -> None:
    infinite = "semantics infinite  keep hp >= previous(hp)"
    pair = diff(_fspa(infinite), _fspa(f"{infinite}  keep hp <= highest(hp)"))
    assert pair.comparison.relation == "undecided"
    report = text(FileDiff("a", "b", (pair,)))
    assert "it was not decided whether B accepts the same traces as A" in report
    assert "Traces were searched, with a bounded number of steps" in " ".join(report.split())
    assert not pair.is_same


def test_a_shorter_deadline_is_compared_exactly_with_a_shortest_trace() -> None:
    names = "clock 60 Hz\nsignal alarm: bool\nsignal hidden: bool\n"
    old, new = (_fspa(f"keep alarm implies eventually within {time} hidden", names) for time in ("5 s", "4 s"))
    pair = diff(old, new, feasible_only=True)
    comparison = pair.comparison
    assert (comparison.relation, comparison.method, comparison.impossible) == ("stricter", "unfolded", ())
    assert comparison.only_a is not None
    nothing = frozenset[str]()
    assert comparison.only_a.prefix == (frozenset({"alarm"}), *[nothing] * 240, frozenset({"hidden"}))
    report = text(FileDiff("a", "b", (pair,)))
    assert "This is exact: what the specs remember was unfolded to 302 states in A and 242 in B." in report
    assert "    step 1: alarm\n    steps 2 to 241 (4 s): nothing holds\n    step 242: hidden\n" in report
    assert document(FileDiff("a", "b", (pair,)))["specs"][0]["method"] == "unfolded"


TWO_TIMERS = "keep within {} of alarm, hidden  reach door  keep within {} of seen, hidden"
TWO_NAMES = "clock 60 Hz\n" + "".join(f"signal {name}: bool\n" for name in ("alarm", "hidden", "seen", "door"))


@pytest.mark.parametrize(
    ("a", "b", "relation"),
    [
        (("5 s", "5 s"), ("4 s", "5 s"), "stricter"),
        (("5 s", "4 s"), ("5 s", "5 s"), "looser"),
        (("5 s", "4 s"), ("4 s", "5 s"), "incomparable"),
    ],
)
def test_timers_of_different_clauses_are_unfolded_apart(a: tuple[str, str], b: tuple[str, str], relation: str) -> None:
    # The values of both timers together are 90,000, too many to unfold.
    old, new = (_fspa(TWO_TIMERS.format(*times), TWO_NAMES) for times in (a, b))
    pair = diff(old, new, feasible_only=True)
    comparison = pair.comparison
    assert comparison.relation == relation
    assert comparison.method == "clauses"
    for trace, accepting, rejecting in ((comparison.only_a, old, new), (comparison.only_b, new, old)):
        if trace is not None:
            assert _accepts(accepting, trace.prefix)
            assert not _accepts(rejecting, trace.prefix)
    assert "This is exact: groups of clauses were compared with each other." in text(FileDiff("a", "b", (pair,)))


THREE_TIMERS = """
    keep x > 30 implies always for {} steps e
    keep {} implies always for 300 steps d
    keep f implies eventually within 300 steps g
"""
THREE_NAMES = "clock 60 Hz\nsignal x: number in [0, 100]\n" + "".join(f"signal {name}: bool\n" for name in "defg")


@pytest.mark.parametrize(
    ("second", "rest", "relation", "method"),
    [
        # Since `x > 20` never holds, `x > 30` does not.
        ("x > 20", "avoid d", "equivalent", "clauses"),
        ("x < 20", "avoid d", "stricter", "clauses"),
        # At a sample with `x > 30`, both times begin, and each group knows only one.
        ("x > 20", "avoid g", "undecided", "search"),
    ],
)
def test_atoms_of_different_groups_may_depend_on_the_same_signals(
    second: str, rest: str, relation: str, method: str
) -> None:
    old, new = (_fspa(THREE_TIMERS.format(steps, second) + rest, THREE_NAMES) for steps in (250, 300))
    comparison = diff(old, new, feasible_only=True).comparison
    assert (comparison.relation, comparison.method, comparison.only_b) == (relation, method, None)
    if relation == "stricter":
        assert comparison.only_a is not None
        assert "x > 30" in comparison.only_a.prefix[0]


def test_groups_of_clauses_relate_as_their_states_do() -> None:
    methods = [check_groups(Random(seed)) for seed in range(40)]
    assert methods.count("clauses") > 10


def check_groups(random: Random) -> str:
    """Compare two specs of two clauses with timers, and as states; return how those with timers were compared."""
    first, second = (RULES[random.choice(list(RULES))] for _ in range(2))
    # The second clause is about other atoms, or partly so.
    renamed = dict(zip("abc", random.choice((("d", "e", "c"), ("d", "e", "f"))), strict=True))
    second = re.sub(r"\b[abc]\b", lambda match: renamed[match[0]], second)
    names = SIGNALS + "".join(f"signal {name}: bool\n" for name in "def")
    clauses = [
        f"{first.format(n=n, m=1)}  {second.format(n=m, m=1)}"
        for n, m in ((2, 3), random.choice(((2, 3), (3, 3), (2, 2), (3, 2))))
    ]
    with patch.object(specs, "MOST_UNFOLDED", 0), patch.object(relation_module, "_QUICK", 10**9):
        timers = diff(*(_fspa(clause, names) for clause in clauses)).comparison
    with unfolded():
        states = diff(*(_fspa(clause, names) for clause in clauses)).comparison
    assert timers.relation == states.relation, clauses
    return timers.method


def test_a_clause_that_always_holds_makes_no_difference() -> None:
    old = TWO_TIMERS.format("5 s", "5 s")
    comparison = diff(*(_fspa(text, TWO_NAMES) for text in (old, f"{old}  keep alarm implies once alarm"))).comparison
    assert (comparison.relation, comparison.method) == ("equivalent", "clauses")


def test_equal_specs_are_not_unfolded() -> None:
    old, new = (_fspa(TWO_TIMERS.format(time, time), TWO_NAMES) for time in ("10 min", "36000 steps"))
    comparison = diff(old, new, feasible_only=True).comparison
    assert (comparison.relation, comparison.method) == ("equivalent", "automata")


def test_more_values_than_the_work_allows_are_searched() -> None:
    old, new = (_fspa(f"keep seen implies eventually within {time} hidden") for time in ("100 s", "90 s"))
    pair = diff(old, new, feasible_only=True, work=50_000)
    assert (pair.comparison.relation, pair.comparison.method) == ("stricter", "search")
    assert "due(" not in text(FileDiff("a", "b", (pair,))).split("as a test")[0].split("after these")[0]


@pytest.mark.parametrize("form", RULES)
def test_bounds_relate_as_their_states_do(form: str) -> None:
    clauses = [RULES[form].format(n=n, m=2) for n in (4, 6)]
    with patch.object(specs, "MOST_UNFOLDED", 0):
        timers = diff(*(_fspa(clause, SIGNALS) for clause in clauses)).comparison
    with unfolded():
        states = diff(*(_fspa(clause, SIGNALS) for clause in clauses)).comparison
    assert (timers.relation, timers.method, states.method) == (states.relation, "unfolded", "automata")
    for one, other in ((timers.only_a, states.only_a), (timers.only_b, states.only_b)):
        assert (one and len(one.prefix)) == (other and len(other.prefix))


def test_an_atom_that_follows_from_others_in_one_version_only_is_not_compared_by_name() -> None:
    predicate = "signal seen: bool\npredicate calm in [-1, 1] = {}\n"
    one = _fspa("keep calm", predicate.format("when seen: -1 otherwise: 1"))
    other = _fspa("keep calm  keep times(seen) <= 1", predicate.format("when times(seen, 5) > 2: -1 otherwise: 1"))
    assert compare_versions(one, other, 50_000).comparison.relation == "undecided"


def rules_spec(*rules: str) -> Fspa:
    """Return a spec with a timer and these rules about single samples."""
    signals = "".join(f"signal {name}{number}: bool\n" for number in range(4) for name in "abc")
    timer = "keep a0 implies eventually within 90 steps b0"
    return compile_text(f"{signals}spec s {{ {timer} {' '.join(f'keep {rule}' for rule in rules)} }}")[0]


def test_rules_in_guards_and_rules_with_an_atom_are_compared_exactly() -> None:
    rules = [f"a{number} implies b{number} or c{number}" for number in range(4)]
    few, many = rules_spec(*rules[:2]), rules_spec(*rules)
    other_order = rules_spec(*(f"(c{number} or b{number}) or not a{number}" for number in range(4)))
    assert "breach" not in {register.kind for register in few.registers}
    assert "breach" in {register.kind for register in many.registers}
    constants = rules_spec(*(f"a{number} implies (b{number} and true) or c{number}" for number in range(4)))
    # The work does not allow to unfold the timer.
    assert compare(few, many, work=50_000).relation == "stricter"
    assert compare(many, few, work=50_000).relation == "looser"
    assert compare(many, other_order, work=50_000).relation == "equivalent"
    assert compare(many, constants, work=50_000).relation == "equivalent"


def test_conflicts_of_a_broken_rule_meet_no_sample() -> None:
    rules = ("a1 implies b1 or not c1", "a2 iff b2 and c2", "not (a3 and (b3 or c3))", "(a0 and b0) or c0")
    fspa, generator = rules_spec(*rules), random.Random(4)
    found = list(conflicts(fspa, (), ""))
    assert len({name for conflict in found for name, _ in conflict if name.startswith("breach")}) == 4
    samples = Samples(fspa, None, [])
    for _ in range(200):
        sample = {signal.name: generator.random() < 0.5 for signal in fspa.signals}
        (values,) = samples.of_trace([sample])
        holds = {atom.name: value > 0 for atom, value in zip(fspa.atoms, values.atoms, strict=True)}
        assert not any(all(holds[name] == truth for name, truth in conflict) for conflict in found)
        # The conflicts decide each of these atoms.
        for name in holds:
            if name.startswith("breach"):
                flipped = {**holds, name: not holds[name]}
                assert any(all(flipped[atom] == truth for atom, truth in conflict) for conflict in found)
