"""TLT0418: several `next` in a row."""

from __future__ import annotations

import pytest

import tltlc
from tests.tools.lint.helpers import SIGNALS, block, found, of
from tltlc.automaton.compare import are_equivalent


@pytest.mark.parametrize(
    ("clause", "expected"),
    [
        ("require X X a", ["X X"]),
        ("require X F a", []),
        ("require X a", []),
        ("require next after 2 steps a", ["next after 2 steps"]),
        ("require next after 1 step a", []),
        ("require next after 2 s a", []),
        ("require N (N a)", ["N (N"]),
        ("require X (a and X b)", []),
        ("reach a then b then c", []),
    ],
)
def test_nexts_that_count(clause: str, expected: list[str]) -> None:
    assert [each.rstrip() for each in of("TLT0418", clause, before="clock 10 Hz\n" + SIGNALS)] == expected


@pytest.mark.parametrize(
    "clock", ["10 Hz", "20 Hz", "3 Hz", "60 Hz", "0.15 s", "7 Hz", "1000000 Hz", "400 s", "1.23456789 s"]
)
@pytest.mark.parametrize(
    "clause",
    [
        "require next next next a",
        "require weak_next weak_next weak_next a",
        "require X X (a or b)",
        "require N (N (N (N (N (N (N a))))))",
        "require next after 5 steps (a until b)",
        "require weak_next after 2 steps a",
        "require X X all x in (k, l): near(x)",
    ],
)
def test_the_time_in_seconds_asks_for_the_same(clause: str, clock: str) -> None:
    before = f"clock {clock}\nentity k, l\nsignal near(e): bool\n{SIGNALS}"
    text = block(clause, before=before)
    (help_,) = (each.diagnostic.help or "" for each in found(text) if each.diagnostic.code == "TLT0418")
    offered = help_.split("`")[1]
    ours, theirs = (tltlc.compile_text(each)[0] for each in (text, block(f"require {offered}", before=before)))
    assert are_equivalent(ours, theirs)
