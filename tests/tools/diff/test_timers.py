"""Comparisons of specs with many timers: clauses for each entity, sequences with times, and a clock that varies."""

from __future__ import annotations

from random import Random
from unittest.mock import patch

import pytest

from tests.resolve.test_deadlines import RULES, SIGNALS
from tests.tools.witness.test_guided_search import NAMES, TOWER
from tltlc import compile_text
from tltlc.automaton.compare import Trace
from tltlc.automaton.fspa import Fspa
from tltlc.diagnostics.diagnostic import TltlError
from tltlc.monitor import Monitor
from tltlc.monitor.samples import STEP_LENGTH, Samples
from tltlc.resolve import specs
from tltlc.tools.diff.difference_search import DifferenceSearch
from tltlc.tools.diff.pairs import FileDiff, diff
from tltlc.tools.diff.relation import OF_A, OF_B
from tltlc.tools.diff.text import text
from tltlc.tools.diff.timer_order import timer_conflicts
from tltlc.tools.witness.blocks import given_values
from tltlc.tools.witness.memory_search import MemorySearch
from tltlc.tools.witness.step_lengths import length_of

GUARDS = "keep all g in guards: within {0} of begins alarm, answers(g)"
COMBO = "reach begins jump then within {0} (begins attack) then within {0} (begins dash)"
VARIES = NAMES.replace("clock 60 Hz", "clock varies")


def spec_of(clauses: str, names: str = NAMES) -> Fspa:
    (fspa,) = compile_text(f"{names}spec s {{ {clauses} }}")
    return fspa


def accepts(fspa: Fspa, trace: Trace) -> bool:
    monitor = Monitor(fspa)
    return [
        monitor.step_atoms(given_values(fspa, letter), length_of(letter, fspa)).accepting for letter in trace.prefix
    ][-1]


@pytest.mark.parametrize("names", [NAMES, VARIES], ids=["fixed", "varies"])
@pytest.mark.parametrize(
    ("form", "times", "relation"),
    [
        (GUARDS, ("5 s", "4 s"), "stricter"),
        (GUARDS, ("4 s", "5 s"), "looser"),
        (COMBO, ("0.5 s", "0.4 s"), "stricter"),
        (f"{GUARDS}  {COMBO}", ("5 s", "4 s"), "stricter"),
        ("avoid any p in guards: (begins falls(p)) then within {} (begins falls(p))", ("5 s", "4 s"), "looser"),
    ],
)
def test_other_times_of_the_same_clauses_are_compared_exactly(
    form: str, times: tuple[str, str], relation: str, names: str
) -> None:
    old, new = (spec_of(form.format(time), names) for time in times)
    pair = diff(old, new, feasible_only=True)
    comparison = pair.comparison
    assert comparison.relation == relation
    trace, one, other = (comparison.only_a, old, new) if relation == "stricter" else (comparison.only_b, new, old)
    assert trace is not None
    assert accepts(one, trace)
    assert not accepts(other, trace)
    report = text(FileDiff("a", "b", (pair,)))
    assert "This is exact" in report
    assert "late(" not in report.split("as a test of")[0]


def test_a_rule_of_a_large_spec_is_compared_in_few_steps(monkeypatch: pytest.MonkeyPatch) -> None:
    old, new = spec_of(TOWER), spec_of(TOWER.replace("within 5 s of", "within 4 s of"))
    steps, take = 0, MemorySearch.step

    def counted(*arguments):  # type: ignore[no-untyped-def]
        nonlocal steps
        steps += 1
        return take(*arguments)

    monkeypatch.setattr(MemorySearch, "step", counted)
    comparison = diff(old, new, feasible_only=True).comparison
    assert (comparison.relation, comparison.only_b) == ("stricter", None)
    # Most steps are those of one of the specs.
    assert steps < 10_000


def test_specs_that_differ_in_both_directions_show_two_traces() -> None:
    old = spec_of(f"{GUARDS.format('5 s')}  {COMBO.format('0.4 s')}")
    new = spec_of(f"{GUARDS.format('4 s')}  {COMBO.format('0.5 s')}")
    comparison = diff(old, new, feasible_only=True).comparison
    assert comparison.relation == "incomparable"
    for trace, one, other in ((comparison.only_a, old, new), (comparison.only_b, new, old)):
        assert trace is not None
        assert accepts(one, trace)
        assert not accepts(other, trace)


def test_a_search_finds_no_trace_that_only_a_stricter_spec_accepts() -> None:
    automata = spec_of(COMBO.format("5 steps")), spec_of(COMBO.format("4 steps"))
    search = DifferenceSearch(automata, automata, (), by_name=False)
    assert search.trace(1) is None
    trace = search.trace(0)
    assert trace is not None
    assert accepts(automata[0], trace)
    assert not accepts(automata[1], trace)


@pytest.mark.parametrize("clock", ["clock 10 Hz\n", "clock varies\n"])
@pytest.mark.parametrize("form", RULES)
def test_timers_that_imply_each_other_do_so_at_each_sample(form: str, clock: str) -> None:
    unit = "steps" if clock == "clock 10 Hz\n" else "s"
    rules = [RULES[form].format(n=n, m=m).replace("steps", unit) for n, m in ((3, 2), (5, 2), (5, 4))]
    if "[" in rules[0] and unit == "s":
        pytest.skip("these bounds are in steps")
    with patch.object(specs, "MOST_UNFOLDED", 0):
        try:
            automata = [spec_of(rule, clock + SIGNALS) for rule in rules]
        except TltlError as error:
            assert {diagnostic.code for diagnostic in error.diagnostics} <= {"TLT0323", "TLT0342"}
            pytest.skip("this form needs a fixed clock")
    random = Random(form)
    for one in automata:
        for other in automata:
            conflicts = list(timer_conflicts((one, other), (), (OF_A, OF_B)))
            # Each longer time implies a shorter one, or the reverse.
            assert conflicts or one is other or not _times(one) or _times(one) == _times(other), form
            for _ in range(10):
                chance = random.random()
                trace = [_sample(random, chance, one) for _ in range(30)]
                both = zip(_values(one, trace), _values(other, trace), strict=True)
                for here, there in both:
                    values = {**here, **there}
                    assert not any(all(values[name] == holds for name, holds in pair) for pair in conflicts)


def test_predicates_that_read_a_time_imply_nothing() -> None:
    # Both are divided by 8 s, but the first holds after 2 s and the second after 3 s.
    automata = [
        spec_of("reach calm", f"{NAMES}predicate calm in [-1, 1] = (time_since(jump, 10 s) - {time}) / 8 s\n")
        for time in ("2 s", "3 s")
    ]
    assert not list(timer_conflicts((automata[0], automata[1]), ("calm",), (OF_A, OF_B)))


def _times(fspa: Fspa) -> set[str]:
    bases = ("late", "passed", "recent", "lately", "held", "breach", "over", "lasted")
    return {atom.name for atom in fspa.atoms if atom.base in bases and "chain" not in atom.base}


def _sample(random: Random, chance: float, fspa: Fspa) -> dict[str, float]:
    sample: dict[str, float] = {name: float(random.random() < chance) for name in "abc"}
    return {**sample, STEP_LENGTH: random.choice((0.0, 0.5, 1.0, 2.0))} if fspa.clock_varies else sample


def _values(fspa: Fspa, trace: list[dict[str, float]]) -> list[dict[str, bool]]:
    named = [{signal.name: sample[signal.name] for signal in fspa.signals} for sample in trace]
    samples = [
        {**own, **({STEP_LENGTH: sample[STEP_LENGTH]} if fspa.clock_varies else {})}
        for own, sample in zip(named, trace, strict=True)
    ]
    return [
        {atom.name: value > 0.0 for atom, value in zip(fspa.atoms, values.atoms, strict=True)}
        for values in Samples(fspa, None, []).of_trace(samples)
    ]
