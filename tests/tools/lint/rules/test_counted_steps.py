"""TLT0418: several `next` in a row."""

from __future__ import annotations

import pytest

import tltlc
from tests.tools.lint.helpers import SIGNALS, block, codes, findings_in, labelled_texts_in_block
from tltlc.automaton.compare import are_equivalent


@pytest.mark.parametrize(
    ("clause", "expected"),
    [
        ("require X X a", ["X X"]),
        ("require X F a", []),
        ("require X a", []),
        ("require next after 2 steps a", []),
        ("require always for 4 steps next after 2 steps a", []),
        ("require X next after 2 steps a", []),
        ("require X X next after 2 steps a", ["X X"]),
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
        "require X X X X X (a until b)",
        "require N weak_next a",
        "require X X all x in (k, l): near(x)",
    ],
)
def test_the_suggested_steps_and_time_are_equivalent(clause: str, clock: str) -> None:
    before = f"clock {clock}\nentity k, l\nsignal near(e): bool\n{SIGNALS}"
    text = block(clause, before=before)
    help_ = advice(text)
    (original,) = tltlc.compile_text(text)
    for suggestion in help_.split("`")[1:4:2]:
        suggested = block(f"require {suggestion}", before=before)
        assert are_equivalent(original, tltlc.compile_text(suggested)[0])
        assert "TLT0418" not in codes(suggested)


@pytest.mark.parametrize("clause", ["keep a implies X X b", "keep a implies N N b"])
def test_on_a_clock_that_varies_the_suggested_time_compiles(clause: str) -> None:
    before = f"clock varies\n{SIGNALS}"
    suggestion = advice(block(clause, before=before)).split("`")[1]
    assert "TLT0418" not in codes(block(f"keep a implies {suggestion}", before=before))


def advice(text: str) -> str:
    """Return the help of the only finding of this rule in a text."""
    (help_,) = (finding.diagnostic.help or "" for finding in findings_in(text) if finding.diagnostic.code == "TLT0418")
    return help_
