"""Monitors on a clock that varies agree with the definition, which looks at the times of the whole trace."""

from __future__ import annotations

import json
import pickle
from collections.abc import Sequence
from random import Random

import pytest
from hypothesis import given

from tests.fuzzing import SEEDS, times
from tests.memory.timed_definition import EndlessDefinition, TimedDefinition
from tests.memory.timed_runs import TimedCase, check_timed_run, check_timed_seed, timed_case
from tests.memory.timed_texts import FORMS, TimedTexts, TimedTrace, timed_trace
from tltlc.automaton.memory import given_atoms
from tltlc.monitor.monitor import Monitor, Step
from tltlc.pipeline import decode_artefact, encode_artefact
from tltlc.resolve import chains


def case_of(clauses: str) -> TimedCase:
    case = timed_case(clauses)
    assert case is not None, clauses
    return case


def trace_of(p: str, q: str, lengths_s: Sequence[float]) -> TimedTrace:
    """Return a trace: ``1`` where p or q is true, ``.`` where it is false."""
    samples = [{"p": float(a == "1"), "q": float(b == "1"), "r": 0.0} for a, b in zip(p, q, strict=True)]
    return TimedTrace(samples, list(lengths_s))


def run(case: TimedCase, trace: TimedTrace) -> list[Step]:
    monitor = Monitor(case.fspa)
    return [monitor.step(sample, length_s) for sample, length_s in zip(*trace, strict=True)]


def marks(truth: Sequence[bool]) -> str:
    return "".join(".1"[value] for value in truth)


@pytest.mark.parametrize(
    ("clauses", "p", "q", "lengths_s", "accepted"),
    [
        # `within` includes the end of its time, and `for` does not.
        ("require eventually within 1 s p", "..1.", "....", (9, 0.5, 0.5, 9), "..11"),
        ("require eventually within 1 s p", "..1.", "....", (0, 0.5, 0.75, 0), "...."),
        ("require always for 1 s p", "11..", "....", (9, 0.5, 0.5, 0), "1111"),
        ("require always for 1 s p", "11.1", "....", (9, 0.5, 0.25, 0), "11.."),
        ("require always for 1 s p require always for 2 s q", "11..", "111.", (9, 0.5, 0.5, 1), "1111"),
        ("require always for 1 s p require always for 2 s q", "11..", "111.", (9, 0.5, 0.5, 0.75), "111."),
        ("keep p implies eventually within 1 s q", "1...", "..1.", (0, 0.5, 0.5, 0), "..11"),
        ("keep p implies eventually within 1 s q", "1...", "..1.", (0, 0.5, 0.75, 0), "...."),
        ("keep within 1 s of p, q", "11..", "...1", (0, 0.25, 0.5, 0.25), "...1"),
        ("keep within 1 s of p, q", "11..", "...1", (0, 0.25, 0.5, 0.5), "...."),
        ("keep p implies always for 1 s q", "1...", "11..", (0, 0.5, 0.5, 0), "1111"),
        ("keep p implies always for 1 s q", "1...", "11..", (0, 0.5, 0.25, 9), "11.."),
        ("keep p implies next always for 1 s q", "1....", ".11..", (0, 9, 0.5, 0.5, 0), ".1111"),
        ("keep p implies weak_next always for 1 s q", "1....", ".1...", (0, 9, 0.5, 0.5, 0), "11..."),
        ("keep p implies next eventually within 1 s q", "1....", "1..1.", (0, 9, 0.5, 0.5, 0), "...11"),
        ("keep p implies not eventually within 1 s q", "1...", "...1", (0, 0.5, 0.5, 0), "111."),
        ("keep p implies not eventually within 1 s q", "1...", "...1", (0, 0.5, 0.5, 0.125), "1111"),
        ("reach p then within 1 s q", "1...", "1..1", (0, 0.5, 0.5, 0), "...1"),
        ("reach p then within 1 s q", "1...", "1..1", (0, 0.5, 0.5, 0.125), "...."),
        ("reach p then within 1 s q then within 1 s p", "1..1", "..1.", (0, 0.5, 0.5, 1), "...1"),
        ("reach p then within 1 s q then within 1 s p", "1..1", "..1.", (0, 0.5, 0.75, 0), "...."),
        ("reach p and eventually within 1 s q", "1...", "..1.", (0, 0.5, 0.5, 0), "..11"),
        ("reach always for 1 s p", ".11.", "....", (0, 0, 0.5, 0.5), ".111"),
        ("reach always for 1 s p", ".11.", "....", (0, 0, 0.5, 0.25), ".11."),
        ("reach once within 1 s p and q", "1...", "...1", (0, 0.5, 0.5, 0), "...1"),
        ("reach once within 1 s p and q", "1...", "...1", (0, 0.5, 0.5, 0.125), "...."),
        ("reach historically for 1 s p and q", ".11", "..1", (0, 0, 1), "..1"),
        ("reach historically for 1 s p and q", ".11", "..1", (0, 0, 0.75), "..."),
        ("reach historically for 1 s p and q", "11", ".1", (0, 0), ".1"),
        ("keep time_since(p) <= 1 s", "1...", "....", (0, 0.5, 0.5, 0.125), "111."),
        ("reach time_holding(p) >= 1 s", ".111", "....", (0, 9, 0.5, 0.5), "...1"),
        # A long step jumps over several deadlines at once.
        ("keep within 1 s of p, q keep within 2 s of q, p", "1..", "..1", (0, 1e6, 0), "..."),
        ("require eventually within 1 s p", "..1", "...", (0, 0, 0), "..1"),
        # Doubles are added: three steps of 0.1 s take a little more than 0.3 s.
        ("require eventually within 0.3 s p", "...1", "....", (0, 0.1, 0.1, 0.1), "...."),
        ("require always for 0.3 s p", "111.", "....", (0, 0.1, 0.1, 0.1), "1111"),
        # The time from a sample does not depend on what was before it.
        ("reach p then within 0.1 s q", "..1.", "...1", (0, 1e6, 0.3, 0.1), "...1"),
    ],
)  # fmt: skip
def test_the_definition_and_the_monitor_accept_where_the_text_says(
    clauses: str, p: str, q: str, lengths_s: Sequence[float], accepted: str
) -> None:
    case, trace = case_of(clauses), trace_of(p, q, lengths_s)
    definition = TimedDefinition(case.module, *trace, {})
    ends = range(1, len(p) + 1)
    assert marks([all(definition.clause_holds(clause, end) for clause in case.clauses) for end in ends]) == accepted
    assert marks([step.accepting for step in run(case, trace)]) == accepted


@pytest.mark.parametrize("form", FORMS)
def test_each_form_agrees_with_the_definition(form: str) -> None:
    random = Random(form)
    for number in range(8):
        texts = TimedTexts(random)
        clauses = texts.form(form, plain=number < 4)
        # All forms have a timer, but not all formulas that may stand in them.
        case = case_of(clauses) if number < 4 else timed_case(clauses)
        for _ in range(4):
            if case is None:
                break
            check_timed_run(case, timed_trace(random, random.randint(1, 12)), random)


@pytest.mark.parametrize("form", [form for form in FORMS if "chain" in form])
def test_chains_as_atoms_agree_with_the_definition(form: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(chains, "MOST_GOALS", 1)
    random = Random(form)
    for number in range(8):
        texts = TimedTexts(random)
        case = timed_case(texts.form(form, plain=number < 4))
        for _ in range(0 if case is None else 12):
            check_timed_run(case, timed_trace(random, random.randint(1, 12)), random)


def test_long_chains_agree_with_the_definition(monkeypatch: pytest.MonkeyPatch) -> None:
    random, met = Random("chains"), 0
    for number in range(40):
        # Long ones have two states, and short ones, with an atom for some of them, have states for their attempts.
        monkeypatch.setattr(chains, "MOST_GOALS", 4 if number % 2 else 1)
        texts = TimedTexts(random)
        case = case_of(f"{random.choice(('reach', 'avoid', 'require'))} {texts.chain(random.randint(2, 8))}")
        for _ in range(12):
            trace = timed_trace(random, random.randint(8, 30))
            check_timed_run(case, trace, random)
            met += run(case, trace)[-1].verdict in ("satisfied", "violated")
    assert met > 60


@times(150)
@given(SEEDS)
def test_monitors_agree_with_the_definition(seed: int) -> None:
    check_timed_seed(seed)


@pytest.mark.slow
def test_monitors_agree_with_the_definition_on_a_hundred_thousand_runs() -> None:
    # About one random spec in five has no timer.
    assert sum(check_timed_seed(seed, traces=20) for seed in range(6_500)) >= 100_000


@times(60)
@given(SEEDS)
def test_steps_of_one_length_are_like_a_fixed_clock(seed: int) -> None:
    random = Random(seed)
    clauses = TimedTexts(random, eighths=True).clauses()
    varying, fixed = timed_case(clauses), timed_case(clauses, "8 Hz")
    if varying is None or fixed is None:
        return
    samples = timed_trace(random, 12).samples
    fixed_clock = Monitor(fixed.fspa)
    for step, sample in zip(run(varying, TimedTrace(samples, [0.125] * len(samples))), samples, strict=True):
        expected = fixed_clock.step(sample)
        assert step.accepting == expected.accepting, (clauses, samples)
        # Either verdict may come later than the other, but the two do not contradict each other.
        assert {step.verdict, expected.verdict} != {"satisfied", "violated"}, (clauses, samples)


@times(60)
@given(SEEDS)
def test_an_artefact_a_pickle_and_the_values_of_atoms_give_the_same_runs(seed: int) -> None:
    random = Random(seed)
    case = timed_case(TimedTexts(random).clauses())
    if case is None:
        return
    document = json.loads(json.dumps(encode_artefact(case.fspa)))
    assert document["version"] == 2
    copies = (decode_artefact(document, "copy"), pickle.loads(pickle.dumps(case.fspa)))
    assert copies == (case.fspa, case.fspa)
    trace = timed_trace(random, 8)
    by_signals, by_atoms, by_copy = Monitor(case.fspa), Monitor(case.fspa), Monitor(copies[0])
    by_signals.step(trace.samples[0], trace.lengths_s[-1])
    by_signals.reset()
    for sample, length_s in zip(*trace, strict=True):
        step = by_signals.step(sample, length_s)
        assert by_copy.step(sample, length_s) == step
        assert by_atoms.step_atoms([by_signals.values[index] for index in given_atoms(case.fspa)], length_s) == step
        assert by_atoms.values == by_signals.values == by_copy.values
        assert by_atoms.registers == by_signals.registers == by_copy.registers


@pytest.mark.parametrize("time", ["1e-320", "1e-9", "0.001", "0.1", "0.3", "1e9"])
def test_times_are_exact_however_short_or_long(time: str) -> None:
    clauses = "keep within {s} s of p, q keep historically for {s} s not q or r reach q then within {s} s r or p"
    case, random, time_s = case_of(clauses.format(s=time)), Random(7), float(time)
    for _ in range(40):
        samples = timed_trace(random, 8).samples
        lengths_s = [random.choice((0.0, time_s, time_s / 2, time_s * 3, 1e308)) for _ in samples]
        check_timed_run(case, TimedTrace(samples, lengths_s), random)


def test_two_times_that_differ_by_little_are_two_timers() -> None:
    case = case_of("keep within 1000000.001 s of p, q keep once within 1000000.001 s p or once within 1000000.002 s p")
    assert len({atom.name for atom in case.fspa.atoms}) == len(case.fspa.atoms)
    steps = run(case, trace_of("11.", "11.", (0, 0, 1000000.0015)))
    assert [step.verdict for step in steps] == ["holding", "holding", "holding"]
    assert run(case, trace_of("11.", "11.", (0, 0, 1000000.0025)))[-1].verdict == "violated"


@times(60)
@given(SEEDS)
def test_exclusive_atoms_keep_their_deadlines(seed: int) -> None:
    random = Random(seed)
    case = timed_case(TimedTexts(random).clauses(), "varies exclusive p, q")
    if case is not None:
        check_timed_run(case, timed_trace(random, 8, exclusive=True), random, exclusive=True)


@times(60)
@given(SEEDS)
def test_verdicts_over_infinite_traces_are_never_wrong(seed: int) -> None:
    random = Random(seed)
    case = timed_case(f"semantics infinite {TimedTexts(random).clauses()}")
    if case is None:
        return
    clauses = [clause for clause in case.clauses if clause.kind != "semantics"]
    trace = timed_trace(random, 6)
    steps = run(case, trace)
    final = next((i for i, step in enumerate(steps) if step.verdict in ("satisfied", "violated")), None)
    for _ in range(4):
        if final is None:
            break
        more = timed_trace(random, random.randint(1, 6))
        samples = [*trace.samples[: final + 1], *more.samples]
        lengths_s = [*trace.lengths_s[: final + 1], *more.lengths_s]
        # All windows of the random specs are shorter than this.
        definition = EndlessDefinition(case.module, samples + samples[-1:] * 6, lengths_s + [25.0] * 6, {})
        met = all(definition.clause_holds(clause, len(samples) + 6) for clause in clauses)
        assert steps[final].verdict == ("satisfied" if met else "violated")
