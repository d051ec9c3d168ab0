"""The client in Python: it passes the conversation, also with Python 3.8, and records traces that tltlc reads."""

from __future__ import annotations

import re
import shutil
import subprocess
import sys
from math import inf, nan
from pathlib import Path

import pytest

from tests.runtime.wire import conversation
from tests.runtime.wire.test_faults import GAMES
from tests.waiting import HANG_S
from tltl_runtime.wire.clients import tltl_client

COUNTER = str(GAMES / "counter.py")
OLDEST = shutil.which("python3.8")


def test_the_client_passes_the_conversation() -> None:
    lines: list[str] = []
    assert conversation.check([sys.executable, COUNTER], lines.append), "\n".join(lines)
    assert len(lines) == len(conversation.EXCHANGES) + len(conversation.REFUSALS) + 10


def test_the_client_needs_no_newer_python() -> None:
    works = OLDEST and subprocess.run([OLDEST, "-c", ""], capture_output=True, check=False).returncode == 0
    if not works:
        pytest.skip("needs Python 3.8")
    lines: list[str] = []
    assert conversation.check([str(OLDEST), COUNTER], lines.append), "\n".join(lines)


def test_the_conversation_notices_what_is_wrong(tmp_path: Path) -> None:
    text = (GAMES / "counter.py").read_text(encoding="utf-8")
    game = tmp_path / "counter.py"
    client = Path(tltl_client.__file__).parent
    text = re.sub(r"sys\.path\.insert.*", f"sys.path.insert(0, {str(client)!r})", text)
    changes = {
        "self.moves += 1": "self.moves += 2",
        '"goal" if at_goal': '"win" if at_goal',
        '"at_goal": at_goal': '"at_goal": int(at_goal)',
        '"clock_hz": 10': '"clock_hz": 60',
        "[1, 11, 3]": "[11, 1, 3]",
    }
    for old, new in changes.items():
        assert old in text
        game.write_text(text.replace(old, new), encoding="utf-8")
        lines: list[str] = []
        assert not conversation.check([sys.executable, str(game)], lines.append)
        assert any(line.startswith("WRONG") for line in lines)


def test_without_tltlc_the_game_says_why_it_ends() -> None:
    result = subprocess.run(
        [sys.executable, COUNTER], capture_output=True, text=True, env={}, timeout=HANG_S, check=False
    )
    assert result.returncode == 1
    assert result.stderr == "tltlc must start this game: the variable TLTL_PORT is not set\n"


def test_a_recorded_trace_is_judged(tmp_path: Path) -> None:
    folder = tmp_path / "traces"
    recorder = tltl_client.Recorder(folder, ["near(a, b)", "seen"], clock_hz=60)
    for last in (True, False):
        path = recorder.begin()
        for step in range(4):
            recorder.sample({"near(a, b)": step / 3, "seen": last and step == 3, "unused": 1.0})
    recorder.end()
    assert path == folder / "trace-0002.csv"
    assert path.read_text(encoding="utf-8").splitlines()[:3] == [
        'time,"near(a, b)",seen',
        "0.0,0.0,false",
        "0.016666666666666666,0.3333333333333333,false",
    ]
    spec = tmp_path / "see.tltl"
    spec.write_text(
        "clock 60 Hz\nsignal near(a, b): number in [0, 1]\nsignal seen: bool\nspec see = F seen\n", encoding="utf-8"
    )
    words = [sys.executable, "-m", "tltlc", "monitor", str(spec), str(folder)]
    result = subprocess.run(words, capture_output=True, text=True, timeout=HANG_S, check=False)
    assert "1 of 2 accepted" in result.stdout, result.stderr


def test_a_recorder_overwrites_no_trace(tmp_path: Path) -> None:
    (tmp_path / "trace-0001.csv").write_text("kept", encoding="utf-8")
    recorder = tltl_client.Recorder(tmp_path, ["x"])
    recorder.sample({"x": 1})
    recorder.end()
    assert (tmp_path / "trace-0001.csv").read_text(encoding="utf-8") == "kept"
    assert (tmp_path / "trace-0002.csv").read_text(encoding="utf-8") == "x\n1.0\n"


@pytest.mark.parametrize("value", [nan, inf, -inf])
def test_a_recorder_refuses_numbers_that_are_not_finite(tmp_path: Path, value: float) -> None:
    with pytest.raises(ValueError, match="the signal x is"):
        tltl_client.Recorder(tmp_path, ["x"]).sample({"x": value})
