"""TLT0437: bounds without effect."""

from __future__ import annotations

from itertools import product

import pytest

from tests.tools.lint.helpers import findings_in
from tltlc.automaton.compare import are_equivalent
from tltlc.monitor import Monitor
from tltlc.pipeline import compile_text

SIGNALS = "clock 10 Hz\nsignal a: bool\nsignal b: bool\n"
CASES = {
    "reach eventually within 2 s a": "reach a",
    "reach a then (eventually within 2 s b)": "reach a then b",
    "keep always for 2 s a": "keep a",
    "require eventually F[0,3] a": "require eventually a",
    "require G (always for 3 steps a)": "require always a",
    "require b and (eventually (eventually within 3 steps a))": "require b and eventually a",
    "require eventually within 2 s (a then b)": "reach a then b",
    "require eventually within 2 s (a then within 1 s b)": "reach a then within 1 s b",
    "keep b implies F[0,3] (a then b)": "keep b implies (a then b)",
}
"""Maps clauses with a bound that has no effect to the same clauses without it."""


def helps(clause: str) -> list[str | None]:
    text = f"{SIGNALS}spec s {{\n    limit 300 steps\n    {clause}\n}}\n"
    diagnostics = (finding.diagnostic for finding in findings_in(text))
    return [diagnostic.help for diagnostic in diagnostics if diagnostic.code == "TLT0437"]


@pytest.mark.parametrize(("clause", "without"), CASES.items(), ids=CASES)
def test_a_bound_without_effect_is_reported(clause: str, without: str) -> None:
    assert len(helps(clause)) == 1
    (one,), (other,) = (compile_text(f"{SIGNALS}spec s {{ {text} }}") for text in (clause, without))
    assert are_equivalent(one, other)


@pytest.mark.parametrize(
    "clause",
    [
        "require eventually within 2 s a",
        "reach a then within 2 s b",
        "keep a implies eventually within 2 s b",
        "keep eventually within 2 s a",
        "reach always for 2 s a",
        "reach F[2,5] a",
        "reach (eventually within 2 s a) then b",
        "reach a and (eventually within 2 s b)",
        "require not eventually within 2 s a",
        "require F[1,5] (a then b)",
        "require eventually (a then within 2 s b)",
        "reach (a and time_holding(true) <= 2 s) then within 1 s b",
    ],
)
def test_a_bound_with_an_effect_is_not_reported(clause: str) -> None:
    assert helps(clause) == []


def test_the_advice_names_the_right_form() -> None:
    assert helps("require eventually within 2 s (a then b)") == [
        "without a time, leave the bound out; for a time from `a` on, write `reach a then within 2 s b`; "
        "for a time from the first step of play, write `(a and time_holding(true) <= 2 s)` for `a`"
    ]
    assert helps("require eventually within 2 s (a then b then a)") == [
        "without a time, leave the bound out; for a time from the first step of play, "
        "write `(a and time_holding(true) <= 2 s)` for `a`"
    ]
    assert helps("require F[0,7] (a then b)") == [
        "without a time, leave the bound out; for a time from `a` on, write `reach a then within 7 steps b`"
    ]
    assert helps("reach eventually within 2 s a") == ["write `require eventually within 2 s a`"]
    assert helps("reach a then (eventually within 2 s b)") == ["write `a then within 2 s b`"]
    assert helps("reach a then (F[0,7] (a or b))") == ["write `a then within 7 steps (a or b)`"]
    assert helps("reach a then (eventually within 2 s b) then (eventually within 3 s a)") == [
        "write `then within 2 s b then within 3 s a`"
    ]
    assert helps("reach (eventually within 2 s b) then (eventually within 3 s a)") == [
        "write `(eventually within 2 s b) then within 3 s a`"
    ]
    assert helps("reach (always a) then (eventually within 3 s a)") == ["write `(always a) then within 3 s a`"]


def test_the_advice_for_a_sequence_is_a_deadline_of_its_first_goal() -> None:
    (fspa,) = compile_text(f"{SIGNALS}spec s {{ reach (a and time_holding(true) <= 0.3 s) then within 0.2 s b }}")
    letters = list(product((False, True), repeat=2))
    for trace in product(letters, repeat=6):
        monitor = Monitor(fspa)
        accepting = [monitor.step({"a": now_a, "b": now_b}).accepting for now_a, now_b in trace][-1]
        assert accepting == any(
            now_a and any(now_b for _, now_b in trace[at + 1 : at + 3]) for at, (now_a, _) in enumerate(trace[:4])
        )


def test_a_sequence_after_an_event_may_have_a_time_from_that_event() -> None:
    assert helps("keep begins a implies eventually within 2 s (b then a then b)") == [
        "for all of it within 2 s of `begins a`, write `eventually within 2 s (b and not begins a and previously (not "
        "begins a since (a and not begins a and previously (not begins a since b))))`, where each `begins a` asks "
        "for all of it anew, also if one before it is not answered yet; without a time, leave the bound out"
    ]
    assert helps("keep a implies (eventually within 2 s (b then a))") == [
        "without a time, leave the bound out; for a time from `b` on, write `eventually (b then within 2 s a)`"
    ]


def test_the_first_seconds_alone_or_every_step_may_be_meant() -> None:
    assert helps("keep always for 2 s not a") == [
        "for the first steps alone, write `require always for 2 s not a`; for every step, write `keep not a`"
    ]
