"""The client in Python: it passes the conversation, also with Python 3.8, and records traces that tltlc reads."""

from __future__ import annotations

import os
import re
import shutil
import subprocess
import sys
from math import inf, nan
from pathlib import Path

import numpy as np
import pytest

from tests.runtime.wire import conversation, examples, recorded_tapes
from tests.runtime.wire.listening import check_listening
from tests.runtime.wire.test_faults import GAMES
from tests.waiting import HANG_S
from tltl_runtime import read_tape
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


def test_a_game_that_listens_as_the_page_says_is_played_again_and_again(tmp_path: Path) -> None:
    loop = examples.code_of_page("python", "listen").replace("5000", "int(sys.argv[2])")
    script = tmp_path / "game.py"
    head = f"import sys\nsys.path.insert(0, {str(GAMES)!r})\nfrom counter import Counter\ngame = Counter()\n"
    script.write_text(head + loop, encoding="utf-8")
    check_listening([sys.executable, str(script)])


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


def test_the_example_of_the_page_is_judged_as_the_play_of_an_agent(tmp_path: Path) -> None:
    """The player begins at home, which is no part of the trace, so that it does not break `avoid`."""
    variables = {**os.environ, "PYTHONPATH": str(Path(tltl_client.__file__).parent)}
    words = [sys.executable, "-c", examples.code_of_page("python")]
    subprocess.run(words, cwd=tmp_path, env=variables, timeout=HANG_S, check=True)
    examples.check_traces_of_page(tmp_path / "traces")
    spec = tmp_path / "leave.tltl"
    spec.write_text(
        "clock 10 Hz\nsignal position: number in [0, 10]\nsignal at_goal: bool\n"
        "spec leave {\n  avoid position < 1\n  reach at_goal\n  limit 10 s\n}\n",
        encoding="utf-8",
    )
    words = [sys.executable, "-m", "tltlc", "monitor", str(spec), str(tmp_path / "traces")]
    result = subprocess.run(words, capture_output=True, text=True, timeout=HANG_S, check=False)
    assert result.returncode == 0, result.stdout + result.stderr


@pytest.mark.parametrize(
    "client", sorted(Path(tltl_client.__file__).parent.glob("*[Cc]lient*.*")), ids=lambda path: path.name
)
def test_each_client_says_that_a_sample_follows_a_tick(client: Path) -> None:
    (line,) = (line for line in client.read_text(encoding="utf-8").splitlines() if "after each tick" in line)
    assert re.search(r"ample\(.*(//|--|#) after each tick$", line)


def test_a_recorder_overwrites_no_trace(tmp_path: Path) -> None:
    (tmp_path / "trace-0001.csv").write_text("kept", encoding="utf-8")
    recorder = tltl_client.Recorder(tmp_path, ["x"])
    recorder.sample({"x": 1})
    recorder.end()
    assert (tmp_path / "trace-0001.csv").read_text(encoding="utf-8") == "kept"
    assert (tmp_path / "trace-0002.csv").read_text(encoding="utf-8") == "x\n1.0\n"


@pytest.mark.parametrize("value", [nan, inf, -inf])
def test_a_recorder_refuses_numbers_that_are_not_finite(tmp_path: Path, value: float) -> None:
    recorder = tltl_client.Recorder(tmp_path, ["x"], clock_hz=10)
    path = recorder.begin("crypt", "v1", seed=7)
    with pytest.raises(ValueError, match="the signal x is"):
        recorder.sample({"x": value}, 0)
    with pytest.raises(KeyError):
        recorder.sample({"y": 1}, 0)
    assert not [*tmp_path.iterdir()]
    recorder.sample({"x": 1}, 0)
    recorder.end()
    assert path.read_text(encoding="utf-8") == "time,x\n0.0,1.0\n"
    header = read_tape(tmp_path / "trace-0001.tape.jsonl").header
    assert (header.scene, header.variant, header.seed) == ("crypt", "v1", 7)


def test_an_episode_that_has_ended_says_nothing_about_the_next_one(tmp_path: Path) -> None:
    recorder = tltl_client.Recorder(tmp_path, ["x"])
    recorder.begin("crypt", "v1", seed=7)
    recorder.end()
    recorder.sample({"x": 1}, 0)
    recorder.end()
    header = read_tape(tmp_path / "trace-0001.tape.jsonl").header
    assert (header.scene, header.variant, header.seed) == (None, "v0", None)


def test_a_recorder_writes_the_tape_of_a_play(tmp_path: Path) -> None:
    folder = tmp_path / "traces"
    recorder = tltl_client.Recorder(folder, ["near(a, b)", "size", "seen"], clock_hz=60, game="walk")
    recorder.begin("crypt", "v1", seed=7)
    for step in range(1, recorded_tapes.STEPS + 1):
        mixed = {"near(a, b)": True} if step == 3 else {"seen": step - 129} if step > 128 else {}
        recorder.sample({**recorded_tapes.signals(step), **mixed}, recorded_tapes.action(step))
    recorder.begin()
    recorder.sample({"near(a, b)": 1, "size": 2, "seen": False})
    recorder.begin("crypt", None, seed=7)
    recorder.sample({"near(a, b)": 1, "size": 2, "seen": False}, 1)
    recorder.end()
    recorded_tapes.check_tape_without_a_variant(folder / "trace-0003.tape.jsonl")
    tape = recorded_tapes.check_tape(folder / "trace-0001.tape.jsonl", tmp_path)
    assert tape.header.versions["python"] == sys.version.split()[0]
    assert sorted(path.name for path in folder.iterdir()) == [
        "trace-0001.csv",
        "trace-0001.tape.jsonl",
        "trace-0002.csv",
        "trace-0003.csv",
        "trace-0003.tape.jsonl",
    ]


def test_a_tape_keeps_arrays_of_numpy(tmp_path: Path) -> None:
    recorder = tltl_client.Recorder(tmp_path, ["x"])
    recorder.begin(seed=np.int64(3))  # type: ignore[arg-type]
    recorder.sample({"x": np.float32(0.1)}, {"move": np.array([0.5, -1], np.float32), "jump": np.int64(1)})
    recorder.end()
    tape = read_tape(tmp_path / "trace-0001.tape.jsonl")
    assert tape.header.seed == 3
    (step,) = tape.steps
    assert step.action == {"move": [0.5, -1.0], "jump": 1} and step.signals == {"x": float(np.float32(0.1))}


def test_a_recorder_overwrites_no_tape(tmp_path: Path) -> None:
    (tmp_path / "trace-0001.tape.jsonl").write_text("kept", encoding="utf-8")
    recorder = tltl_client.Recorder(tmp_path, ["x"])
    recorder.sample({"x": 1}, 0)
    recorder.end()
    assert (tmp_path / "trace-0001.tape.jsonl").read_text(encoding="utf-8") == "kept"
    assert sorted(path.name for path in tmp_path.glob("trace-0002*")) == ["trace-0002.csv", "trace-0002.tape.jsonl"]


@pytest.mark.parametrize("actions", [(1, None), (None, 1)])
def test_each_sample_of_a_tape_needs_an_action(tmp_path: Path, actions: tuple[int | None, int | None]) -> None:
    recorder = tltl_client.Recorder(tmp_path, ["x"])
    recorder.sample({"x": 1}, actions[0])
    with pytest.raises(ValueError, match="give the action of each sample of an episode, or of none"):
        recorder.sample({"x": 2}, actions[1])
    with pytest.raises(ValueError, match="Out of range float values"):
        tltl_client.Recorder(tmp_path / "other", ["x"]).sample({"x": 1}, nan)
    assert not (tmp_path / "other").exists()
    recorder.end()
    assert (tmp_path / "trace-0001.csv").read_text(encoding="utf-8") == "x\n1.0\n"
