"""TLT0418: several `next` in a row."""

from __future__ import annotations

import pytest

import tltlc
from tests.tools.lint.helpers import SIGNALS, block, findings_in, labelled_texts_in_block
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
def test_repeated_nexts_are_reported(clause: str, expected: list[str]) -> None:
    assert [
        labelled_text.rstrip()
        for labelled_text in labelled_texts_in_block("TLT0418", clause, before="clock 10 Hz\n" + SIGNALS)
    ] == expected


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
def test_the_suggested_time_in_seconds_is_equivalent(clause: str, clock: str) -> None:
    before = f"clock {clock}\nentity k, l\nsignal near(e): bool\n{SIGNALS}"
    text = block(clause, before=before)
    (help_,) = (finding.diagnostic.help or "" for finding in findings_in(text) if finding.diagnostic.code == "TLT0418")
    suggestion = help_.split("`")[1]
    original, suggested = (
        tltlc.compile_text(source)[0] for source in (text, block(f"require {suggestion}", before=before))
    )
    assert are_equivalent(original, suggested)
