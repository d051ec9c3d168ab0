"""The line for a person who waits for a game to start."""

from __future__ import annotations

import sys
from pathlib import Path

import pytest

from tltl_runtime.cli.support.slow_starts import slow_start_text, slow_starts_shown
from tltl_runtime.wire.env import WireEnv
from tltl_runtime.wire.start_watch import SlowStart
from tltl_runtime.wire.wire_game import WireGame

SLOW = """
import sys, time
print("loading level 3", file=sys.stderr, flush=True)
time.sleep(3600)
"""


def test_the_line_says_what_the_game_wrote_last() -> None:
    start = SlowStart("hall", 5.03, 30.0, "SCRIPT ERROR: _ready: Invalid call. At: res://hall.gd:33.")
    assert slow_start_text(start) == (
        "`hall` has been starting for 5 of at most 30 s; it wrote last: "
        "SCRIPT ERROR: _ready: Invalid call. At: res://hall.gd:33."
    )
    silent = SlowStart("hall", 5.03, 30.0, "")
    assert slow_start_text(silent).endswith("at most 30 s; it has written nothing to standard error")


@pytest.mark.parametrize("is_terminal", [True, False])
def test_a_person_at_a_terminal_sees_it(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str], *, is_terminal: bool
) -> None:
    monkeypatch.setattr("tltl_runtime.wire.start_watch.LONG_S", 0.0)
    monkeypatch.setattr(sys.stderr, "isatty", lambda: is_terminal)
    # The game never says hello, so the deadline always passes.
    game = WireGame("hall", tmp_path, (sys.executable, "-c", SLOW), start_s=0.5)
    with slow_starts_shown(), pytest.raises(Exception, match="did not say hello within"):
        WireEnv(game)
    assert ("`hall` has been starting for" in capsys.readouterr().err) == is_terminal
