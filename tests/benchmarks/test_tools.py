"""What the tools beside the compiler cost, as RESULTS.md tells it."""

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
    ratio = {command: [each - 0.1, each, each + 0.1] for command, each in commands.items()}
    specs = {name: {"compile_ms": 120.0, "ratio": ratio} for name in PAPER_SPECS}
    return {**specs, "a keystroke": {**KEYSTROKE, "answer_ms": [answer_ms] * 3}}


def verdicts(found: dict[str, Record]) -> list[str]:
    return [verdict for _, _, verdict in tools.goals(found)]


def test_goals() -> None:
    assert verdicts(records()) == ["met", "met", "met"]
    assert verdicts(records(lint=3.1)) == ["**missed**", "met", "met"]
    assert verdicts(records(answer_ms=101.0)) == ["met", "met", "**missed**"]


def test_what_was_not_measured_is_not_told() -> None:
    assert (verdicts({}), tools.section({})) == ([], "")
    some = records()
    del some["navigation"], some["a keystroke"]
    assert verdicts(some) == []
    assert tools.section(some).count("\n| ") == 2 + 2
    assert "keystroke" not in tools.section(some)


def test_the_section() -> None:
    text = tools.section(records())
    assert "| navigation | 120 | 1.2 (1.1–1.3) | 0.9 (0.8–1.0) |" in text
    assert "506 lines" in text and "of the server for each: 40 ms" in text
