"""The progress of a suite, on a terminal and elsewhere."""

from __future__ import annotations

import io
import re
import sys

import pytest

from tests.runtime.regression.handmade import an_episode, case
from tltl_runtime.cli.support.regression_display import RegressionDisplay
from tltlc.core.record import replace


class Terminal(io.StringIO):
    def isatty(self) -> bool:
        return True


def test_without_a_terminal_progress_is_printed_in_lines(capsys: pytest.CaptureFixture[str]) -> None:
    with RegressionDisplay("at most") as display:
        for name, episodes in (("one", 60), ("other", 30)):
            for count in range(1, episodes + 1):
                display(replace(case(name), episodes=episodes), count, an_episode(count - 1, count % 2 == 0))
            display.clear()
    assert capsys.readouterr().err.splitlines() == [
        "one: 25 of at most 60 episodes, 12 met the spec",
        "one: 50 of at most 60 episodes, 25 met the spec",
        "one: 60 of at most 60 episodes, 30 met the spec",
        "other: 25 of at most 30 episodes, 12 met the spec",
        "other: 30 of at most 30 episodes, 15 met the spec",
    ]


def test_films_are_announced_before_they_are_drawn(
    capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    with RegressionDisplay() as display:
        for name, total in (("one", 3), ("other", 1)):
            for count in range(total):
                display.show_films(name, count, total)
    assert capsys.readouterr().err.splitlines() == [
        "one: drawing 3 films for the page",
        "other: drawing 1 film for the page",
    ]
    monkeypatch.setenv("TERM", "xterm")
    monkeypatch.setattr(sys, "stderr", Terminal())
    with RegressionDisplay() as display:
        display.show_films("one", 1, 3)
    assert "one: drawing films for the page, 1 of 3" in re.sub(r"\s+", " ", sys.stderr.getvalue())  # type: ignore[attr-defined]


def test_on_a_terminal_a_progress_bar_is_shown_and_removed(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("TERM", "xterm")
    monkeypatch.setattr(sys, "stderr", Terminal())
    with RegressionDisplay("at most") as display:
        for count in (1, 2, 3):
            display(replace(case("[b]odd"), episodes=50), count, an_episode(count - 1, count != 2))
        display.clear()
        drawn = sys.stderr.getvalue()  # type: ignore[attr-defined]
    assert "[b]odd: 2 of 3 met" in re.sub(r"\x1b\[[0-9;?]*[A-Za-z]", "", drawn)
    assert drawn.rstrip().endswith("\x1b[2K") or "\x1b[1A\x1b[2K" in drawn
