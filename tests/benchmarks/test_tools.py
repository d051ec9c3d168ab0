"""The cost of the tools besides the compiler, as in RESULTS.md."""

from __future__ import annotations

from benchmarks import tools
from benchmarks.specs import PAPER_SPECS
from benchmarks.store import Record

KEYSTROKE = {
    "lines": 506,
    "keystrokes": 25,
    "answer_ms": [50.0, 60.0, 70.0],
    "server_ms": 40.0,
    "parse_ms": [15.0, 16.0, 17.0],
}


def records(lint: float = 1.2, answer_ms: float = 60.0) -> dict[str, Record]:
    commands = {"lint": lint, "explain": 0.9, "fmt": 0.5, "diff": 1.0, "witness": 0.9}
    ratio = {
        command: [ratio_of_command - 0.1, ratio_of_command, ratio_of_command + 0.1]
        for command, ratio_of_command in commands.items()
    }
    specs = {name: {"compile_ms": 120.0, "ratio": ratio} for name in PAPER_SPECS}
    return {**specs, "a keystroke": {**KEYSTROKE, "answer_ms": [answer_ms] * 3}}


def verdicts(results: dict[str, Record]) -> list[str]:
    return [verdict for _, _, verdict in tools.goals(results)]


def test_goals_are_met_or_missed() -> None:
    assert verdicts(records()) == ["met", "met", "met"]
    assert verdicts(records(lint=3.1)) == ["**missed**", "met", "met"]
    assert verdicts(records(answer_ms=101.0)) == ["met", "met", "**missed**"]


def test_missing_measurements_are_not_reported() -> None:
    assert (verdicts({}), tools.section({})) == ([], "")
    partial = records()
    del partial["navigation"], partial["a keystroke"]
    assert verdicts(partial) == []
    assert tools.section(partial).count("\n| ") == 2 + 2
    assert "keystroke" not in tools.section(partial)


def test_the_section_has_ratios_and_the_keystroke() -> None:
    text = tools.section(records())
    assert "| navigation | 120 | 1.2 (1.1–1.3) | 0.9 (0.8–1.0) |" in text
    assert "506 lines" in text and "of the server for each: 40 ms" in text
