"""Monitors of specs about the trace so far agree with the definition, which looks at the whole trace each time."""

from __future__ import annotations

import pickle
from collections.abc import Sequence
from math import inf, nan
from random import Random

import pytest
from hypothesis import given

from tests.fuzzing import SEEDS, times
from tests.memory.definition import Definition, formula
from tests.memory.runs import check_seed, random_case, random_params, random_trace
from tests.memory.texts import CLOCKS, DECLARATIONS, Texts
from tltlc.automaton.fspa import Fspa
from tltlc.automaton.memory import given_atoms
from tltlc.core.source import SourceFile
from tltlc.diagnostics.diagnostic import TltlError
from tltlc.grammar.parser import parse
from tltlc.monitor.errors import MonitorError
from tltlc.monitor.monitor import Monitor
from tltlc.pipeline import CompileOptions, Session, compile_text, decode_artefact, encode_artefact

BOOLS = "clock 2 Hz signal p: bool signal q: bool "


def samples_of(p: str, q: str = "") -> list[dict[str, float]]:
    """Return a trace: ``1`` where p or q is true, ``.`` where it is false."""
    return [{"p": float(a == "1"), "q": float(b == "1")} for a, b in zip(p, q or p, strict=True)]


@pytest.mark.parametrize(
    ("text", "p", "q", "holds"),
    [
        ("once p", "..1..", ".....", "..111"),
        ("historically p", "11.11", ".....", "11..."),
        ("previously p", "1.1..", ".....", ".1.1."),
        ("previously not p", "1.1..", ".....", "..1.1"),
        ("begins p", "11.1.", ".....", "1..1."),
        ("ends p", "11.1.", ".....", "..1.1"),
        ("p since q", "11.11", "..1..", "..111"),
        ("p since q", "1111.", ".....", "....."),
        ("p since q", "1.111", "1....", "1...."),
        ("once within 0 steps p", ".1...", ".....", ".1..."),
        ("once within 2 steps p", ".1....", "......", ".111.."),
        ("once within 1.1 s p", ".1....", "......", ".1111."),
        ("historically for 1 steps p", ".1.11", ".....", ".1.11"),
        ("historically for 2 steps p", "1.111", ".....", "1..11"),
        ("historically for 1.1 s p", "111.1111", "........", "111...11"),
        ("times(p) >= 2", "1.11.", ".....", "..111"),
        ("times(p, 2) >= 2", "1.1.1", ".....", "..111"),
        ("times(p) == 0", "..1.1", ".....", "11..."),
        ("times(p) == 2", "1.1.1.1.", "........", "..11...."),
        ("times(p) != 2", "1.1.1.1.", "........", "11..1111"),
        ("times(p, 3) == 2", "1.1.1.1.", "........", "..11...."),
        ("times(p, 3) == times(q, 3)", "1.1.....", ".....1.1", ".......1"),
        ("time_since(p) <= 0.5 s", "..1...", "......", "..11.."),
        ("time_since(p) >= 1 s", "..1...", "......", "11..11"),
        ("time_holding(p) >= 1 s", "111.1111", "........", "..1...11"),
        ("time_holding(p) < 0.5 s", "11..1", ".....", "1.111"),
        ("times_since(p, q) >= 1", "1.1..1", "...1..", "111..1"),
        ("times_since(p, q) == 1", "..1.1", "..1..", "..11."),
        ("times_since(p, q, 2) >= 2", "1.1.1.", "1....1", "..111."),
        ("times_within(p, 1 s) >= 2", "1.1...11", "........", "..1....."),
        ("times_within(p, 2 steps, 1) >= 1", "1....1", "......", "111..1"),
        ("times_since(p, begins q) >= 2", "1.1.1.1", "...1111", "..1...1"),
        ("total_time(p) >= 1 s", "1.1.1.", "......", "....11"),
        ("total_time_since(p, q) >= 1 s", "11111.1", "...1...", "..1.111"),
        ("highest_since(p, q)", ".1..1", "..11.", ".1..1"),
        ("lowest_since(p, q)", "1.11.", "..1..", "1.11."),
        ("value_at(p, q)", ".1..1", ".1.1.", ".11.."),
        ("value_at(p, begins q)", "1.1.1", "..111", "11111"),
        ("previous(p)", "1.1..", ".....", "11.1."),
        ("initial(p)", "1.1..", ".....", "11111"),
        ("highest(p)", ".1.", "...", ".11"),
        ("lowest(p)", "1.1", "...", "1.."),
    ],
)
def test_the_definition_and_the_monitor_hold_where_the_language_says(text: str, p: str, q: str, holds: str) -> None:
    samples, source = samples_of(p, q), f"{BOOLS} spec s = G ({text})"
    definition = Definition(parse(SourceFile("<test>", source))[0], samples, {})
    meaning = formula(text)
    truth = [definition.holds(meaning, i) for i in range(len(samples))]
    assert "".join(".1"[value] for value in truth) == holds
    # At each sample, the automaton of `F (here and p)` accepts exactly if p holds here.
    (fspa,) = compile_text(f"{BOOLS} signal here: bool spec s = F (here and ({text}))")
    accepted = []
    for i in range(len(samples)):
        monitor = Monitor(fspa)
        steps = [monitor.step({**sample, "here": float(j == i)}) for j, sample in enumerate(samples)]
        accepted.append(steps[-1].accepting)
    assert accepted == truth


@pytest.mark.parametrize(
    ("text", "values", "expected"),
    [
        ("times(p) > 1", "1.1.1.1", [0, 0, 0.5, 0.5, 1, 1, 1]),
        ("times(p) == 1", "..1.1.1", [-1 / 3, -1 / 3, 1, 1, -1 / 3, -1 / 3, -1]),
        ("time_since(p) > 1 s", "1.....", [-1, -0.5, 0, 0.5, 1, 1]),
        ("time_since(p) > 1 s", "..", [1, 1]),
        ("time_holding(p) > 1 s", "111111.", [-1, -0.5, 0, 0.5, 1, 1, -1]),
        ("times_since(p, not p) > 0", "1.11", [1, 0, 1, 1]),
        ("total_time(p) > 1 s", "11..111", [-1, -0.5, -0.5, -0.5, 0, 0.5, 1]),
        ("once within 1 steps p", "1...", [1, 1 / 3, -1 / 3, -1]),
        ("historically for 1 steps p", "11.1", [1, 1, -1, 1]),
        ("once not p", "1.", [-1, 1]),
    ],
)
def test_counts_times_and_windows_are_scaled(text: str, values: str, expected: Sequence[float]) -> None:
    (fspa,) = compile_text(f"{BOOLS} spec s = G ({text})")
    monitor = Monitor(fspa)
    found = []
    for sample in samples_of(values):
        monitor.step(sample)
        found.append(monitor.values[0])
    assert found == pytest.approx(expected)


@pytest.mark.parametrize("clock", ["0.15 s", "0.03 s", "0.07 s", "150 ms", "20 Hz", "0.9 s"])
def test_a_time_of_whole_steps_is_reached_after_that_many_steps(clock: str) -> None:
    number, unit = clock.split()
    for steps in range(1, 60):
        seconds = {"s": steps * float(number), "ms": steps * float(number) / 1000, "Hz": steps / float(number)}[unit]
        (fspa,) = compile_text(f"clock {clock} signal p: bool spec s = F time_holding(p) >= {seconds:.9g} s")
        monitor = Monitor(fspa)
        verdicts = [monitor.step({"p": True}).verdict for _ in range(steps + 2)]
        assert verdicts.index("satisfied") == steps


@times(300)
@given(SEEDS)
def test_monitors_agree_with_the_definition(seed: int) -> None:
    check_seed(seed)


@pytest.mark.slow
def test_monitors_agree_with_the_definition_on_a_hundred_thousand_runs() -> None:
    # About one random spec in seven is in error.
    assert sum(check_seed(seed, traces=8) for seed in range(15_000)) >= 100_000


@times(150)
@given(SEEDS)
def test_an_artefact_and_a_pickle_give_the_same_automaton_and_runs(seed: int) -> None:
    case = random_case(seed)
    if case is None:
        return
    random = Random(seed)
    samples, params = random_trace(random), random_params(random, case.fspa)
    document = encode_artefact(case.fspa)
    for copy in (decode_artefact(document, "copy"), pickle.loads(pickle.dumps(case.fspa))):
        assert copy == case.fspa
        assert [atom.opposite for atom in copy.atoms] == [atom.opposite for atom in case.fspa.atoms]
        first, second = Monitor(case.fspa, params), Monitor(copy, params)
        for sample in samples:
            assert first.step(sample) == second.step(sample)
            assert (first.values, first.registers) == (second.values, second.registers)


@times(150)
@given(SEEDS)
def test_the_values_of_the_given_atoms_give_the_same_steps_as_the_signals(seed: int) -> None:
    case = random_case(seed)
    if case is None:
        return
    random = Random(seed)
    params = random_params(random, case.fspa)
    by_signals, by_atoms = Monitor(case.fspa, params), Monitor(case.fspa, params)
    given_ = given_atoms(case.fspa)
    for sample in random_trace(random):
        step = by_signals.step(sample)
        assert by_atoms.step_atoms([by_signals.values[index] for index in given_]) == step
        assert by_atoms.values == by_signals.values


@times(100)
@given(SEEDS)
def test_a_failed_sample_changes_nothing_and_a_reset_forgets_all(seed: int) -> None:
    case = random_case(seed)
    if case is None or not case.fspa.signals:
        return
    random = Random(seed)
    samples = random_trace(random)
    steady, troubled = Monitor(case.fspa), Monitor(case.fspa)
    initial = troubled.registers
    for _ in range(2):
        for sample in samples:
            name = random.choice(case.fspa.signals).name
            bad = {**sample, name: random.choice((nan, inf, -inf))}
            if random.random() < 0.5:
                del bad[name]
            before = troubled.registers
            with pytest.raises(MonitorError):
                troubled.step(bad)
            assert troubled.registers == before
            assert troubled.step(sample) == steady.step(sample)
            assert troubled.registers == steady.registers
        troubled.reset()
        steady.reset()
        assert troubled.registers == initial


@times(60)
@given(SEEDS)
def test_an_automaton_does_not_depend_on_the_other_specs_of_its_file(seed: int) -> None:
    random = Random(seed)
    texts = Texts(random, 0)
    clock = (
        f"clock {CLOCKS[0]} {DECLARATIONS} {random.choice(('', 'exclusive once p, previously q', 'exclusive p, r'))}"
    )
    specs = [f"spec s{number} = {texts.spec(1)}" for number in range(4)]
    alone = [automata(f"{clock} {spec}") for spec in specs]
    kept = [spec for spec, built in zip(specs, alone, strict=True) if built]
    assert automata(" ".join([clock, *kept])) == tuple(fspa for built in alone for fspa in built)


def automata(text: str) -> tuple[Fspa, ...]:
    """Return the automata of a text; none if it is in error."""
    try:
        return Session(SourceFile("<test>", text), CompileOptions(state_budget=300), proofs=False).automata
    except TltlError:
        return ()


def test_a_sample_with_two_exclusive_atoms_changes_no_register() -> None:
    (fspa,) = compile_text(f"{BOOLS} exclusive p, q spec s = G (times(p) <= 2 and once q)")
    monitor = Monitor(fspa)
    monitor.step({"p": True, "q": False})
    before = monitor.registers
    with pytest.raises(MonitorError):
        monitor.step({"p": True, "q": True})
    assert monitor.registers == before


def test_a_number_so_long_ago_is_that_of_the_first_sample_until_there_is_one() -> None:
    for length in ("3 steps", "0.3 s", "0.21 s"):
        (fspa,) = compile_text(f"clock 10 Hz signal hp in [0, 9] spec s = G (hp >= previous(hp, {length}) - 2)")
        monitor = Monitor(fspa)
        verdicts = [monitor.step({"hp": hp}).verdict for hp in (9, 8, 8, 7, 6, 6, 5, 3)]
        assert verdicts == ["holding"] * 7 + ["violated"], length


def test_the_highest_value_within_a_time_forgets_earlier_ones() -> None:
    (fspa,) = compile_text("clock 10 Hz signal hp in [0, 9] spec s = G (hp >= highest_within(hp, 0.2 s) - 2)")
    monitor = Monitor(fspa)
    verdicts = [monitor.step({"hp": hp}).verdict for hp in (9, 8, 7, 6, 5, 4, 4, 4, 1)]
    assert verdicts == ["holding"] * 8 + ["violated"]
    monitor.reset()
    assert [monitor.step({"hp": hp}).verdict for hp in (5, 8, 5)] == ["holding", "holding", "violated"]


def test_the_time_within_a_time_is_no_more_than_that() -> None:
    (fspa,) = compile_text("clock 10 Hz signal p: bool spec s = G (total_time_within(p, 0.3 s) <= 0.2 s)")
    monitor = Monitor(fspa)
    assert [monitor.step({"p": p == "1"}).verdict for p in "11.11.111"] == ["holding"] * 8 + ["violated"]


def test_previous_values_and_previous_truth_of_one_name_are_kept_apart() -> None:
    (fspa,) = compile_text(f"{BOOLS} spec s = G (previous(p) implies previously p)")
    monitor = Monitor(fspa)
    assert [monitor.step(sample).verdict for sample in samples_of("..1.")] == ["holding"] * 4
    monitor.reset()
    assert [monitor.step(sample).verdict for sample in samples_of("1.")] == ["violated"] * 2
