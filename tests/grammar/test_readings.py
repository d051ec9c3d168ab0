"""A help for a phrase with several readings gives each of them as a clause that compiles, and offers no edit.

The readings are written by hand, over all short traces and without the compiler. A second has one step.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping, Sequence
from itertools import product

import pytest

from tests.grammar.suggestions import Meaning, Trace, a, b, error_of
from tltlc import compile_text
from tltlc.core.source import SourceFile
from tltlc.monitor import Monitor
from tltlc.tools.lint.scopes import apply_edits

NAMES = """
clock 1 Hz
signal a: bool
signal b: bool
signal c: bool
signal phase: int in [0, 3]
signal mode: (idle, alert, chase)
"""
VARIES = NAMES.replace("clock 1 Hz", "clock varies")
LONGEST = {1: 6, 2: 4, 3: 4}
"""The greatest length of the traces, by the number of signals."""
KEYWORDS = ("keep", "reach", "avoid", "require")


def c(trace: Trace) -> list[bool]:
    return [sample[2] for sample in trace]


def both(left: Sequence[bool], right: Sequence[bool]) -> list[bool]:
    return [x and y for x, y in zip(left, right, strict=True)]


def lately(holds: Sequence[bool]) -> list[bool]:
    """Return at which steps a truth holds, or has held at one of the two steps before."""
    return [any(holds[max(0, i - 2) : i + 1]) for i in range(len(holds))]


def implies(left: Sequence[bool], right: Sequence[bool]) -> bool:
    return all(y or not x for x, y in zip(left, right, strict=True))


def answers(event: Sequence[bool], answer: Sequence[bool]) -> bool:
    """Whether the answer comes at each event, or at one of the two steps after it."""
    return all(any(answer[i : i + 3]) for i, now in enumerate(event) if now)


def follows(event: Sequence[bool], answer: Sequence[bool]) -> bool:
    """Whether the answer comes at one of the two steps after some event."""
    return any(any(answer[i + 1 : i + 3]) for i, now in enumerate(event) if now)


def lasts(holds: Sequence[bool], steps: int) -> bool:
    return any(all(holds[i : i + steps]) for i in range(len(holds) - steps + 1))


def is_absent(t: Trace) -> bool:
    """Whether b holds neither at an a, nor at one of the two steps after it."""
    return not any(any(b(t)[i : i + 3]) for i, now in enumerate(a(t)) if now)


def stops(t: Trace) -> bool:
    """Whether b does not hold at each a, or at one of the two steps after it."""
    return answers(a(t), [not now for now in b(t)])


def quoted(clause: str, names: str = NAMES) -> list[str]:
    """Return what a help quotes; assert that it offers no edit."""
    _, error = error_of(clause, names)
    assert error.fixes == ()
    return re.findall("`([^`]*)`", error.help or "")


def check(clause: str, meaning: Meaning) -> None:
    """Assert that a spec with the clause accepts exactly the traces of a meaning."""
    (fspa,) = compile_text(f"{NAMES}spec s {{ {clause} }}")
    signals = {signal.name for signal in fspa.signals}
    varied = ["a" in signals, bool(signals & {"b", "mode", "phase"}), "c" in signals]
    letters = [letter for letter in product((False, True), repeat=3) if all(map(bool.__le__, letter, varied))]
    for trace in product(letters, repeat=LONGEST[sum(varied)]):
        monitor = Monitor(fspa)
        for stop, (now_a, now_b, now_c) in enumerate(trace, start=1):
            values = {"a": now_a, "b": now_b, "c": now_c, "phase": 2 * now_b, "mode": "alert" if now_b else "idle"}
            step = monitor.step({name: value for name, value in values.items() if name in signals})
            assert step.accepting == meaning(trace[:stop]), (clause, trace[:stop])


READINGS: Mapping[str, tuple[Meaning, ...]] = {
    "keep a for the last 2 s": (lambda t: all(a(t)), lambda t: len(t) > 2 and all(a(t)[-3:])),
    "keep (a for the last 2 s)": (lambda t: all(a(t)), lambda t: len(t) > 2 and all(a(t)[-3:])),
    "require a for the last 2 steps": (lambda t: all(a(t)), lambda t: all(a(t)[-2:])),
    "keep c implies a within 2 s of b": (
        lambda t: answers(both(c(t), b(t)), a(t)),
        lambda t: implies(c(t), both(a(t), lately(b(t)))),
    ),
    "keep (not b) within 2 s of a": (is_absent, stops),
    "keep ((not b)) within 2 s of a": (is_absent, stops),
    "keep mode is not alert within 2 s of a": (is_absent, stops),
    "keep (mode is not alert) within 2 s of a": (is_absent, stops),
    "keep phase != 2 within 2 s of a": (is_absent, stops),
    "require phase != 2 within 2 s after a": (is_absent, stops),
    "keep after a, mode is not alert within 2 s": (is_absent, stops),
    "keep if a, (not b) within 2 s": (is_absent, stops),
    "keep within 2 s after a, (not b)": (is_absent, stops),
    "after a, not b within 2 s": (is_absent, stops),
    "keep whenever a, not b within 2 s": (is_absent, stops),
    "keep if a then not b within 2 s": (is_absent, stops),
    "when a, mode is not alert within 2 s": (is_absent, stops),
    "keep a for 2 s": (lambda t: lasts(a(t), 3), lambda t: all(a(t)[:2])),
    "keep for 2 s a": (lambda t: lasts(a(t), 3), lambda t: all(a(t)[:2])),
    "keep not a for 2 s": (
        lambda t: lasts([not now for now in a(t)], 3),
        lambda t: not any(a(t)[:2]),
    ),
    "keep a and b for 2 s": (lambda t: lasts(both(a(t), b(t)), 3), lambda t: all(both(a(t), b(t))[:2])),
    "keep a for 3 steps": (lambda t: lasts(a(t), 3), lambda t: all(a(t)[:3])),
    "reach a then b within 2 s": (
        lambda t: any(now and any(a(t)[:i]) for i, now in enumerate(b(t)[:3])),
        lambda t: follows([now and not (i and a(t)[i - 1]) for i, now in enumerate(a(t))], b(t)),
        lambda t: follows(a(t), b(t)),
    ),
    "reach a before b": (
        lambda t: any(now and not any(b(t)[: i + 1]) for i, now in enumerate(a(t))),
        lambda t: any(a(t)) and not any(b(t)[: a(t).index(True)]),
        lambda t: not any(b(t)[: a(t).index(True)]) if any(a(t)) else not any(b(t)),
        lambda t: any(now and any(b(t)[i + 1 :]) for i, now in enumerate(a(t))),
    ),
    "reach at most 1 phase": (lambda t: not any(b(t)), lambda t: not all(b(t))),
    "reach phase no more than 1": (lambda t: not any(b(t)), lambda t: not all(b(t))),
    "after a reach b": (
        lambda t: all(any(b(t)[i:]) for i, now in enumerate(a(t)) if now),
        lambda t: any(now and any(b(t)[i + 1 :]) for i, now in enumerate(a(t))),
    ),
    "avoid a for 3 s": (lambda t: not any(a(t)[:3]), lambda t: not lasts(a(t), 4)),
    "never a for 3 s": (lambda t: not any(a(t)[:3]), lambda t: not lasts(a(t), 4)),
    "avoid a for 3 steps": (lambda t: not any(a(t)[:3]), lambda t: not lasts(a(t), 3)),
    "never a for 3 steps": (lambda t: not any(a(t)[:3]), lambda t: not lasts(a(t), 3)),
    "avoid a for 1 step": (lambda t: not any(a(t)[:1]), lambda t: not any(a(t))),
    "avoid for 2 s a": (lambda t: not any(a(t)[:2]), lambda t: not lasts(a(t), 3)),
    "avoid a and b for 2 s": (
        lambda t: not any(both(a(t), b(t))[:2]),
        lambda t: not lasts(both(a(t), b(t)), 3),
    ),
    "keep a then b within 2 s": (lambda t: answers(a(t), b(t)), lambda t: follows(a(t), b(t))),
    "never a and b": (
        lambda t: not any(both(a(t), b(t))),
        lambda t: not any(a(t)) and not any(b(t)),
    ),
}


@pytest.mark.parametrize(("clause", "readings"), READINGS.items(), ids=READINGS)
def test_each_reading_has_the_meaning_that_the_help_says(clause: str, readings: tuple[Meaning, ...]) -> None:
    clauses = [text for text in quoted(clause) if text.startswith(KEYWORDS)]
    assert len(clauses) == len(readings)
    for text, meaning in zip(clauses, readings, strict=True):
        check(text, meaning)


@pytest.mark.parametrize("clause", [clause for clause in READINGS if "step" not in clause])
def test_each_reading_compiles_where_the_clock_varies(clause: str) -> None:
    clauses = [text for text in quoted(clause, VARIES) if text.startswith(KEYWORDS)]
    assert len(clauses) == len(READINGS[clause])
    for text in clauses:
        assert compile_text(f"{VARIES}spec s {{ {text} }}")


@pytest.mark.parametrize(
    "clause",
    [
        "keep a implies not b within 2 s",
        "keep a implies (not b) within 2 s",
        "keep a implies mode is not alert within 2 s",
        "keep a implies phase != 2 within 2 s",
    ],
)
def test_a_negation_within_a_time_in_a_rule_gets_both_readings(clause: str) -> None:
    never, sometimes = quoted(clause)
    check(never, is_absent)
    check(sometimes, stops)


MEANINGS: Mapping[str, Meaning] = {
    "keep a within 2 s of b implies c": lambda t: implies(both(a(t), lately(b(t))), c(t)),
    "keep c iff a within 2 s of b": lambda t: c(t) == both(a(t), lately(b(t))),
    "keep a within 2 s of b iff c": lambda t: c(t) == both(a(t), lately(b(t))),
    "keep b implies a for the last 2 s": lambda t: all(
        all(a(t)[max(0, i - 1) : i + 1]) for i, now in enumerate(b(t)) if now
    ),
    "keep a for the last 2 s implies b": lambda t: all(
        b(t)[i] for i in range(len(t)) if all(a(t)[max(0, i - 1) : i + 1])
    ),
    "avoid a for the last 2 s": lambda t: not lasts(a(t), 3),
    "reach a for the last 2 s": lambda t: lasts(a(t), 3),
    "avoid a then b within 2 s": lambda t: not follows(a(t), b(t)),
    "require a then b within 2 s": lambda t: follows(a(t), b(t)),
    "never a or b": lambda t: not any(a(t)) and not any(b(t)),
    "require eventually after 2 s a": lambda t: any(a(t)[2:]),
    "require always after 2 s a": lambda t: all(a(t)[2:]),
}


@pytest.mark.parametrize(("clause", "meaning"), MEANINGS.items(), ids=MEANINGS)
def test_a_help_has_the_meaning_of_the_sentence(clause: str, meaning: Meaning) -> None:
    text, error = error_of(clause, NAMES)
    if error.fixes:
        fixed = apply_edits(SourceFile("a.tltl", text), error.fixes[0].edits).text
        check(fixed.removeprefix(f"{NAMES}spec s {{").removesuffix("}"), meaning)
        return
    suggested = re.findall("`([^`]*)`", error.help or "")[0].replace(" p", " a")
    check(suggested if suggested.startswith(KEYWORDS) else f"require {suggested}", meaning)


@pytest.mark.parametrize(
    ("clause", "meaning"),
    [("require eventually after 2 s a", any), ("require always after 2 s a", all)],
)
def test_a_later_begin_counts_from_the_first_step_where_the_clock_varies(
    clause: str, meaning: Callable[[list[bool]], bool]
) -> None:
    (suggestion,) = quoted(clause, VARIES)
    text = re.sub(r"\bp\b", "a", suggestion)
    (fspa,) = compile_text(f"{VARIES}spec s {{ require {text} }}")
    for values, lengths in product(product((False, True), repeat=4), product((0.5, 1.0, 2.0), repeat=3)):
        monitor, time = Monitor(fspa), 0.0
        later: list[bool] = []
        for value, dt in zip(values, (0.0, *lengths), strict=True):
            time += dt
            if time >= 2:
                later.append(value)
            assert monitor.step({"a": value}, dt).accepting == meaning(later), (values, lengths)


@pytest.mark.parametrize(
    "clause",
    [
        "keep not c implies a or b within 2 s of b",
        "keep a within 2 s of b implies c implies a",
        "keep a implies not b within 2 s of c",
    ],
)
def test_an_answer_in_an_unclear_rule_gets_a_general_help(clause: str) -> None:
    assert quoted(clause)[:2] == ["b and once within 2 s a", "b within 2 s of a"]


@pytest.mark.parametrize("clause", ["keep after a, b and not c within 2 s", "keep after a, c implies b within 2 s"])
def test_after_is_no_predicate(clause: str) -> None:
    _, error = error_of(clause, NAMES)
    assert error.fixes == ()
    assert error.title == "`after` cannot stand here"
    assert "after(a)" not in (error.help or "")


@pytest.mark.parametrize("clause", ["avoid a then not b within 2 s", "avoid a and c then b within 2 s"])
def test_an_unclear_sequence_with_a_time_gets_no_edit(clause: str) -> None:
    assert quoted(clause) == ["a then within 2 s b", "a then b within 2 s"]
