"""What registers remember, in words."""

from __future__ import annotations

import pytest

from tltlc import compile_text
from tltlc.automaton.register_phrases import register_phrases

NAMES = "signal a: bool\nsignal b: bool\nsignal c: bool\nsignal x: number in [0, 9]\n"
CLAUSES = [
    ("keep times(a) <= 2", {"how often a has begun"}),
    ("keep time_since(a or b) < 9 s", {"the time since (a or b)"}),
    ("keep time_since(begins a) < 9 s", {"whether a held at the step before", "the time since the start of a"}),
    ("reach time_holding(a) >= 9 s", {"how long a has held"}),
    ("keep a implies once b", {"whether b has held"}),
    ("keep a implies historically b", {"whether b has always held"}),
    ("keep a implies b since c", {"whether b has held since c"}),
    ("keep a implies previously b", {"whether b held at the step before"}),
    ("keep previous(x) <= x", {"the previous x"}),
    ("keep x < highest(x) + 1", {"the highest x so far"}),
    ("keep within 9 s of a, b", {"how long b has been due after a", "whether b is due after a"}),
    ("keep eventually within 9 s b", {"how long b has been due", "whether b is due"}),
    ("require eventually within 9 s b", {"how many steps there have been"}),
    ("keep a implies always for 9 s b", {"the time since a"}),
    (
        "reach a then within 9 s b then within 8 s c",
        {"the time since a", "the time since a at an earlier step", "the time since b in time"},
    ),
]
VARYING = [
    ("keep within 9 s of a, b", {"how long b has been due after a", "whether b is due after a"}),
    ("require eventually within 9 s b", {"the time since the first step"}),
    ("reach always for 9 s a", {"how long a had held at the step before"}),
    (
        "reach a then within 9 s b then within 8 s c",
        {"the time since a at an earlier step", "the time since b in time at an earlier step"},
    ),
]


@pytest.mark.parametrize(
    ("clock", "clause", "words"),
    [*(("clock 60 Hz", *row) for row in CLAUSES), *(("clock varies", *row) for row in VARYING)],
)
def test_registers_have_words(clock: str, clause: str, words: set[str]) -> None:
    (fspa,) = compile_text(f"{clock}\n{NAMES}spec s {{ {clause} }}")
    kinds = {register.name: register.kind for register in fspa.registers}
    phrases = register_phrases(fspa)
    assert set(phrases) == set(kinds)
    assert {phrase for name, phrase in phrases.items() if kinds[name] not in ("last", "first", "breach")} == words


def test_a_register_without_words_keeps_its_name() -> None:
    (fspa,) = compile_text(f"{NAMES}spec s {{ keep previously a }}")
    (kept,) = (register.name for register in fspa.registers if register.kind == "last")
    assert register_phrases(fspa)[kept] == kept
