"""Text from files is printed without workflow commands and control characters."""

from __future__ import annotations

import pytest

from tests.runtime.regression.handmade import an_episode, case
from tltl_runtime.cli.support.plain_text import plain_text
from tltl_runtime.cli.support.regression_display import RegressionDisplay
from tltl_runtime.cli.support.regression_text import case_lines
from tltl_runtime.regression.report.case_report import CaseReport
from tltlc.core.record import replace

EVIL = "x\n::error::forged\r\n\x1b[31mred\x07"


@pytest.mark.parametrize(
    ("text", "shown"),
    [
        ("navigation:v1", "navigation:v1"),
        ("dies `in` the hall — 14 of 25", "dies `in` the hall — 14 of 25"),
        ("a::b", "a::b"),
        ("x\n::error::y", "x ::error::y"),
        ("a\r\nb\u2028c\xa0d", "a  b c d"),
        ("\x1b[31mred\x00\u202e", "\ufffd[31mred\ufffd\ufffd"),
        ("::warning::y", ": :warning::y"),
        (" \t::set-output name=a::b", "  : :set-output name=a::b"),
        (":::", ": ::"),
        ("a ##[error]b", "a ## [error]b"),
    ],
)
def test_commands_are_defused(text: str, shown: str) -> None:
    assert plain_text(text) == shown


def commands(text: str) -> list[str]:
    """The lines that GitHub Actions takes for commands, or that contain escape sequences."""
    return [line for line in text.splitlines() if line.lstrip().startswith("::") or "##[" in line or "\x1b" in line]


def test_each_name_and_each_reason_is_one_line() -> None:
    report = CaseReport(f"::error::{EVIL}", "room", "v0", "fail", (EVIL, f"::warning::{EVIL}", "##[error]forged"))
    lines = list(case_lines(report, 10, is_cached=False))
    assert len(lines) == 1 + len(report.reasons)
    verdict, *reasons = lines
    assert "\n".join(lines).count("forged") == 4
    assert commands("\n".join([verdict.replace("\x1b[31m\x1b[1mfail\x1b[0m", "fail"), *reasons])) == []


def test_progress_has_one_line_without_commands(capsys: pytest.CaptureFixture[str]) -> None:
    with RegressionDisplay() as display:
        display(replace(case(f"::error::{EVIL}"), episodes=1), 1, an_episode())
    output = capsys.readouterr().err
    assert "forged" in output and len(output.splitlines()) == 1 and commands(output) == []
