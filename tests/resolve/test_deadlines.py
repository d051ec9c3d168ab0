"""Timers in place of bounded operators: the language and the verdicts are those of the unfolded formula."""

from __future__ import annotations

import json
import random
from collections.abc import Iterator, Sequence

import pytest

from tltlc.automaton.fspa import Fspa
from tltlc.core.record import replace
from tltlc.diagnostics.diagnostic import TltlError
from tltlc.monitor.monitor import Monitor, Step
from tltlc.pipeline import compile_text, decode_artefact, encode_artefact
from tltlc.resolve import specs

NAMES = ("a", "b", "c")
SIGNALS = "".join(f"signal {name}: bool\n" for name in NAMES)

RULES = {
    "a deadline from the start": "require eventually within {n} steps a",
    "a window from the start": "require F[{m},{n}] a",
    "a rule from the start": "require always for {n} steps a",
    "a rule for a window": "require G[{m},{n}] (a or b)",
    "next after steps": "require next after {n} steps a",
    "weak next after steps": "require weak_next after {n} steps a",
    "a sequence by a deadline": "require eventually within {n} steps (a and next eventually b)",
    "a Boolean combination": "require eventually within {n} steps a or always for {n} steps not b",
    "a negation": "require not (eventually within {n} steps a)",
    "a response": "keep a implies eventually within {n} steps b",
    "a response at a later step": "keep a implies next eventually within {n} steps b",
    "a response at a later step, at the end": "keep a implies weak_next eventually within {n} steps b",
    "a response to either": "keep (a or c) implies eventually within {n} steps b",
    "two responses to one": "keep a implies (eventually within {n} steps b and eventually within {m} steps c)",
    "a response with an exception": "keep a implies (c or eventually within {n} steps b)",
    "again and again": "keep eventually within {n} steps a",
    "a rule after an event": "keep a implies always for {n} steps b",
    "not twice within": "keep a implies next always for {n} steps not a",
    "not twice within, at the end": "keep a implies weak_next always for {n} steps not a",
    "an avoided lapse": "avoid a and always for {n} steps not b",
    "staying": "reach always for {n} steps a",
    "staying after a goal": "reach a then (always for {n} steps b)",
    "staying after two goals": "reach a then b then (always for {n} steps (a or c))",
    "staying from a goal on": "require eventually (a and eventually always for {n} steps b)",
    "a chain": "require eventually (a and next eventually within {n} steps b)",
    "a chain at the same step": "require eventually (a and eventually within {n} steps b)",
    "a chain of three": (
        "require eventually (a and next eventually within {n} steps (b and next eventually within {m} steps c))"
    ),
    "a chain with an open link": (
        "require eventually (a and next eventually (b and next eventually within {n} steps c))"
    ),
    "a chain with a late open link": (
        "require eventually (a and next eventually within {n} steps (b and next eventually c))"
    ),
    "a chain by a deadline": "require eventually within {n} steps (a and next eventually within {m} steps b)",
    "an avoided sequence": "avoid a then within {n} steps b",
    "an avoided answer": "keep a implies not eventually within {n} steps b",
    "an avoided sequence of three": "avoid a then within {n} steps b then within {m} steps c",
    "an avoided chain at the same step": (
        "avoid a and eventually within {n} steps (b and eventually within {m} steps c)"
    ),
    "an avoided answer with an answer": (
        "keep a implies not eventually within {n} steps (b and next eventually within {m} steps c)"
    ),
    "an avoided later answer": (
        "keep a implies not next eventually within {n} steps (b and eventually within {m} steps c)"
    ),
    "a forbidden chain": "require not eventually (a and next eventually within {n} steps b)",
}
"""For each form with a rule, a clause. In the text, ``n`` and ``m`` are bounds, ``m`` at most ``n``."""


def compiled(clauses: str, monkeypatch: pytest.MonkeyPatch, most_unfolded: int, clock: str = "") -> Fspa:
    monkeypatch.setattr(specs, "MOST_UNFOLDED", most_unfolded)
    (fspa,) = compile_text(f"{clock}{SIGNALS}spec s {{ {clauses} }}")
    return fspa


def steps(fspa: Fspa, trace: Sequence[Sequence[bool]]) -> Iterator[Step]:
    monitor = Monitor(fspa)
    for sample in trace:
        yield monitor.step(dict(zip(NAMES, sample, strict=True)))


def random_trace(generator: random.Random, length: int) -> list[tuple[bool, ...]]:
    """Return a trace in which atoms hold seldom, often or in runs, so that bounds are met and missed."""
    chances = [generator.choice((0.03, 0.1, 0.3, 0.7, 0.95)) for _ in NAMES]
    keep = generator.choice((0.0, 0.5, 0.8))
    sample = tuple(generator.random() < chance for chance in chances)
    trace = [sample]
    while len(trace) < length:
        drawn = tuple(generator.random() < chance for chance in chances)
        sample = tuple(old if generator.random() < keep else new for old, new in zip(sample, drawn, strict=True))
        trace.append(sample)
    return trace


@pytest.mark.parametrize("form", RULES)
def test_timers_agree_with_unfolding_on_every_prefix(form: str, monkeypatch: pytest.MonkeyPatch) -> None:
    generator = random.Random(form)
    for n in (1, 2, 3, 5, 9, 20):
        m = generator.randint(1, n)
        clause = RULES[form].format(n=n, m=m)
        unfolded, timed = compiled(clause, monkeypatch, 10**9), compiled(clause, monkeypatch, 0)
        assert not unfolded.registers
        assert timed.registers or n == 1, clause
        assert decode_artefact(json.loads(json.dumps(encode_artefact(timed))), "timed") == timed
        for _ in range(60):
            trace = random_trace(generator, 3 * n + 8)
            for number, (expected, step) in enumerate(zip(steps(unfolded, trace), steps(timed, trace), strict=True)):
                where = (clause, trace[: number + 1])
                assert step.accepting == expected.accepting, where
                assert step.verdict == expected.verdict, where


def random_formula(generator: random.Random, depth: int) -> str:
    """Return the text of a random formula in brackets, in which most temporal operators have bounds."""
    if depth == 0 or generator.random() < 0.15:
        return generator.choice(NAMES)
    low = generator.randint(0, 2)
    high = low + generator.randint(0, 4)
    inner = random_formula(generator, depth - 1)
    unary = (
        "not",
        "next",
        "weak_next",
        "eventually",
        "always",
        f"eventually within {high} steps",
        f"F[{low},{high}]",
        f"always for {high + 1} steps",
        f"G[{low},{high}]",
    )
    binary = ("and", "or", "implies", "iff", "until", "release", "and next eventually within 3 steps")
    if generator.random() < 0.6:
        return f"({generator.choice(unary)} {inner})"
    return f"({inner} {generator.choice(binary)} {random_formula(generator, depth - 1)})"


def agree_on_random_formulas(seed: int, count: int, monkeypatch: pytest.MonkeyPatch) -> int:
    """Compare timers and unfolding on random formulas, and return how many of the formulas had timers."""
    generator = random.Random(seed)
    timed_count = 0
    for _ in range(count):
        clauses = " ".join(
            f"{generator.choice(('require', 'keep', 'reach', 'avoid'))} ({random_formula(generator, 3)})"
            for _ in range(generator.randint(1, 2))
        )
        try:
            unfolded, timed = compiled(clauses, monkeypatch, 10**9), compiled(clauses, monkeypatch, 0)
        except TltlError as error:
            assert {problem.code for problem in error.diagnostics} <= {"TLT0501"}, clauses
            continue
        timed_count += bool(timed.registers)
        for _ in range(12):
            trace = random_trace(generator, 14)
            for number, (expected, step) in enumerate(zip(steps(unfolded, trace), steps(timed, trace), strict=True)):
                where = (clauses, trace[: number + 1])
                assert step.accepting == expected.accepting, where
                # A verdict may come late, but it is never wrong.
                undecided = "holding" if step.accepting else "pending"
                assert step.verdict in (expected.verdict, undecided), where
    return timed_count


def test_timers_agree_with_unfolding_on_random_formulas(monkeypatch: pytest.MonkeyPatch) -> None:
    assert agree_on_random_formulas(1, 150, monkeypatch) > 25


@pytest.mark.slow
def test_timers_agree_with_unfolding_on_many_random_formulas(monkeypatch: pytest.MonkeyPatch) -> None:
    assert agree_on_random_formulas(2, 2000, monkeypatch) > 400


def test_few_states_are_unfolded_and_many_get_timers() -> None:
    (small,) = compile_text(f"{SIGNALS}spec s {{ keep a implies eventually within 62 steps b }}")
    (large,) = compile_text(f"{SIGNALS}spec s {{ keep a implies eventually within 63 steps b }}")
    (both,) = compile_text(f"{SIGNALS}spec s {{ keep within 7 steps of a, b keep within 7 steps of b, c }}")
    assert not small.registers
    assert len(large.states) == 3
    assert [register.kind for register in both.registers].count("waiting") == 2


def test_a_bound_without_a_rule_is_unfolded() -> None:
    (fspa,) = compile_text(f"{SIGNALS}spec s {{ reach next always for 70 steps a }}")
    assert not fspa.registers
    assert len(fspa.states) > 70


def test_ten_long_deadlines_need_three_states() -> None:
    signals = "".join(f"signal p{index}: bool\nsignal q{index}: bool\n" for index in range(10))
    clauses = "".join(f"keep within 10 min of p{index}, q{index}\n" for index in range(10))
    (fspa,) = compile_text(f"clock 60 Hz\n{signals}spec s {{ {clauses} }}")
    assert len(fspa.states) == 3


def test_waiting_for_an_answer_costs_no_distance(monkeypatch: pytest.MonkeyPatch) -> None:
    clause = "keep a implies eventually within 5 steps b"
    unfolded, timed = compiled(clause, monkeypatch, 10**9), compiled(clause, monkeypatch, 0)
    trace = [(True, False, False)] + [(False, False, False)] * 5
    for fspa in (unfolded, timed):
        assert [fspa.states[step.state].distance for step in steps(fspa, trace)] == [1] * 5 + [None]


@pytest.mark.parametrize(
    ("form", "meaning"),
    [
        ("reach a then within 3 steps b", "require eventually (a and next F[0,2] b)"),
        ("reach a then within 3 steps b then c", "require eventually (a and next F[0,2] (b and next eventually c))"),
        ("reach a then b then within 3 steps c", "require eventually (a and next eventually (b and next F[0,2] c))"),
        ("keep within 3 steps of a, b", "keep a implies F[0,3] b"),
        ("require within 3 steps of a, b", "require a implies F[0,3] b"),
    ],
)
def test_spellings_of_deadlines_have_their_meaning(form: str, meaning: str) -> None:
    (written,), (meant,) = (compile_text(f"{SIGNALS}spec s {{ {clause} }}") for clause in (form, meaning))
    # Only the texts of the clauses differ.
    assert replace(written, clauses=()) == replace(meant, clauses=())


@pytest.mark.parametrize("clock", ["60 Hz", "varies"])
def test_timers_of_goals_at_the_same_step_have_names_of_their_own(clock: str) -> None:
    later = "a then within 50 s b then within 50 s c"
    same = "a and eventually within 50 s (b and eventually within 50 s c)"
    specs = f"spec x {{ reach {later} }} spec y {{ reach {same} }} spec z {{ reach {later} reach {same} }}"
    assert len(compile_text(f"clock {clock} {SIGNALS} {specs}")) == 3


def test_then_within_no_steps_is_an_error() -> None:
    with pytest.raises(TltlError) as caught:
        compile_text(f"{SIGNALS}spec s {{ reach a then within 0 steps b }}")
    assert [problem.code for problem in caught.value.diagnostics] == ["TLT0312"]


def test_several_rules_from_the_start_need_no_states(monkeypatch: pytest.MonkeyPatch) -> None:
    clause = "require always for 4 steps a require G[2,6] (b or c) require next G[0,3] not c"
    unfolded, timed = compiled(clause, monkeypatch, 10**100), compiled(clause, monkeypatch, 0)
    assert len(timed.states) <= 4
    generator = random.Random(5)
    for _ in range(300):
        trace = random_trace(generator, 10)
        for expected, step in zip(steps(unfolded, trace), steps(timed, trace), strict=True):
            assert step.accepting == expected.accepting
            assert step.verdict in (expected.verdict, "holding" if step.accepting else "pending")


def test_times_on_a_fast_clock_tell_steps_apart() -> None:
    clauses = "require F[0,3] a or G[0,90] b require F[0,4] c"
    (fspa,) = compile_text(f"clock 2000000 Hz\n{SIGNALS}spec s {{ {clauses} }}")
    assert {atom.name for atom in fspa.atoms} >= {"passed(3 steps)", "passed(2e-06 s)"}
