"""The client in GDScript for Godot 3: it passes the conversation, keeps the values of numbers, and records traces."""

from __future__ import annotations

import json
import os
import shutil
import socket
import struct
import subprocess
import sys
import time
from math import isfinite
from pathlib import Path
from random import Random

import pytest

from tests.runtime.wire import conversation, recorded_tapes
from tests.runtime.wire.test_faults import GAMES
from tests.waiting import HANG_S
from tltl_runtime.wire.clients import tltl_client
from tltl_runtime.wire.env import WireEnv
from tltl_runtime.wire.errors import WireError
from tltl_runtime.wire.wire_game import WireGame

ENGINE = "godot3-server"
PAUSE_S = 0.05
CLIENT = Path(tltl_client.__file__).with_name("tltl_client_godot3.gd")
EXCHANGES = len(conversation.EXCHANGES) + len(conversation.REFUSALS) + 10

pytestmark = pytest.mark.skipif(shutil.which(ENGINE) is None, reason=f"needs the program {ENGINE}")


@pytest.fixture(name="project")
def _project(tmp_path: Path) -> Path:
    """Copy the game and the client into a project, as a studio does."""
    project = tmp_path / "project"
    shutil.copytree(GAMES / "godot3", project)
    shutil.copy(CLIENT, project)
    return project


def command(project: Path, *words: str) -> list[str]:
    return [ENGINE, "--path", str(project), "--fixed-fps", "10", "--disable-render-loop", *words]


def run_script(project: Path, text: str) -> subprocess.CompletedProcess[str]:
    """Run the body of a function in the engine, with the client as ``Tltl``."""
    body = "".join(f"\t{line}\n" for line in text.splitlines())
    script = f'extends SceneTree\nconst Tltl = preload("res://{CLIENT.name}")\nfunc _init():\n{body}\tquit()\n'
    (project / "script.gd").write_text(script, encoding="utf-8")
    words = [ENGINE, "--path", str(project), "-s", "script.gd"]
    return subprocess.run(words, capture_output=True, text=True, timeout=HANG_S, check=True)


@pytest.mark.parametrize("words", [(), ("play",)], ids=["the engine's loop", "the client's loop"])
def test_the_client_passes_the_conversation(project: Path, words: tuple[str, ...]) -> None:
    lines: list[str] = []
    assert conversation.check(command(project, *words), lines.append), "\n".join(lines)
    assert len(lines) == EXCHANGES


def test_a_script_that_godot_cannot_read_is_the_first_line_of_the_error(
    project: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    script = project / "counter.gd"
    script.write_text(script.read_text(encoding="utf-8").replace("func _ready()", "func _ready("), encoding="utf-8")
    monkeypatch.setattr("tltl_runtime.wire.start_watch.GRACE_S", 0.0)
    with pytest.raises(WireError, match="did not say hello within 5 s after an error in a script") as caught:
        WireEnv(WireGame("counter", project, process=tuple(command(project)), start_s=HANG_S))
    help_ = caught.value.diagnostics[0].help or ""
    assert help_.startswith("the game's standard error ends:\nSCRIPT ERROR: GDScript::reload: Parse Error: ")
    assert "   At: res://counter.gd:" in help_ and ".cpp" not in help_


def test_the_game_in_the_comment_can_be_played(project: Path) -> None:
    lines = CLIENT.read_text(encoding="utf-8").splitlines()
    first = lines.index("#     extends Spatial")
    last = lines.index("#     # Optional methods:")
    script = "\n".join(line.removeprefix("#").removeprefix("     ") for line in lines[first:last])
    (project / "ice.gd").write_text(script, encoding="utf-8")
    (project / "ice.tscn").write_text(
        '[gd_scene load_steps=2 format=2]\n[ext_resource path="res://ice.gd" type="Script" id=1]\n'
        '[node name="Ice" type="Spatial"]\nscript = ExtResource( 1 )\n'
        '[node name="Player" type="KinematicBody" parent="."]\n',
        encoding="utf-8",
    )
    words = [*command(project), "ice.tscn"]
    words[words.index("10")] = "60"
    env = WireEnv(WireGame("ice", project, process=tuple(words)))
    env.reset(seed=2)
    ended, steps = False, 0
    while not ended:
        observation, _, ended, _, _ = env.step(2)
        steps += 1
        assert observation.tolist() == pytest.approx([2 + steps / 3, 20], abs=1e-3)
    assert steps == 25
    assert env.get_wrapper_attr("tltl_cause")() == "goal"
    env.close()


def test_without_tltlc_the_game_says_why_it_ends(project: Path) -> None:
    environment = {key: value for key, value in os.environ.items() if not key.startswith("TLTL_")}
    result = subprocess.run(
        command(project), capture_output=True, text=True, env=environment, timeout=HANG_S, check=False
    )
    assert result.returncode == 1
    assert "tltlc must start this game: the variable TLTL_PORT is not set" in result.stderr


def test_tltlc_connects_to_a_game_that_listens_one_time_after_another(
    project: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    with socket.create_server(("127.0.0.1", 0)) as server:
        port = server.getsockname()[1]
    monkeypatch.setenv("TLTL_TOKEN", "open sesame")
    with subprocess.Popen(command(project, "listen", str(port)), stdout=subprocess.DEVNULL) as game:
        try:
            for seed in (1, 2):
                env = _connected(port)
                env.reset(seed=seed)
                observation, *_ = env.step(2)
                assert observation.tolist() == [2 + seed]
                env.close()
            monkeypatch.setenv("TLTL_TOKEN", "guessed")
            with pytest.raises(WireError, match="the token is wrong"):
                _connected(port)
        finally:
            game.kill()


def _connected(port: int) -> WireEnv:
    """Connect to the game, which listens soon after it was started or its last tltlc has ended."""
    for _ in range(int(HANG_S / PAUSE_S)):
        try:
            return WireEnv(WireGame("counter", Path(), connect=f"127.0.0.1:{port}"))
        except WireError as error:
            if "no game listens" not in str(error):
                raise
            time.sleep(PAUSE_S)
    raise AssertionError("the game does not listen")


def numbers() -> list[float]:
    """Return numbers of all sizes, those of single precision, decimals, and limits."""
    random = Random(1)
    any_bits = [struct.unpack("d", random.randbytes(8))[0] for _ in range(500)]
    sizes = [random.uniform(-1, 1) * 10.0 ** random.randint(-9, 18) for _ in range(2_000)]
    single = [struct.unpack("f", struct.pack("f", random.uniform(-100, 100) ** 3))[0] for _ in range(1_000)]
    decimals = [place / 10**digits for digits in range(1, 12) for place in range(1, 60)]
    limits = [0.0, 0.1 + 0.2, 0.5, 0.49999999999999994, 5e-324, sys.float_info.max, 1e15, 1e16 - 2, 1e22, 1e23, 1e-6]
    return [*any_bits, *sizes, *single, *decimals, *limits, *(-number for number in limits)]


def test_numbers_keep_their_values(project: Path) -> None:
    values = numbers()
    (project / "numbers").write_bytes(struct.pack(f"<{len(values)}d", *values))
    run_script(
        project,
        """\
var source = File.new()
source.open("res://numbers", File.READ)
var target = File.new()
target.open("res://texts", File.WRITE)
while source.get_position() < source.get_len():
	target.store_line(Tltl.Digits.text(source.get_double()))
target.close()""",
    )
    read = [json.loads(line) for line in (project / "texts").read_text(encoding="utf-8").splitlines()]
    assert read == [value if isfinite(value) else None for value in values]


def change_game(project: Path, old: str, new: str) -> WireGame:
    """Change the code of the game, and return the game."""
    path = project / "counter.gd"
    text = path.read_text(encoding="utf-8")
    assert old in text
    path.write_text(text.replace(old, new), encoding="utf-8")
    return WireGame("counter", folder=project, process=tuple(command(project)))


@pytest.mark.parametrize("value", ["INF", "NAN"])
def test_a_number_that_is_not_finite_is_reported_by_name(project: Path, value: str) -> None:
    env = WireEnv(change_game(project, '"moves": moves,', f'"moves": {value} if moves > 1 else moves,'))
    env.reset(seed=1)
    env.step(1)
    with pytest.raises(WireError, match=r"TLT0793.*the signal moves is .*, and numbers must be finite"):
        env.step(1)
    env.close()


def test_arrays_of_floats_and_vectors_are_sent(project: Path) -> None:
    new = '[position], at_goal or trapped, cause, {"player": [position, 0]}'
    changed = 'PoolRealArray([position / 3.0]), at_goal, cause, {"player": Vector3(1, 2, 3), "mark": Vector2(4, 5)}'
    env = WireEnv(change_game(project, new, changed))
    observation, _ = env.reset(seed=1)
    assert observation.tolist() == [struct.unpack("f", struct.pack("f", 2 / 3))[0]]
    assert env.tltl_positions() == {"player": (1.0, -3.0, 2.0), "mark": (4.0, -5.0)}
    env.close()


def test_an_outline_has_the_axes_of_tltlc(project: Path) -> None:
    box = '"bounds": AABB(Vector3(1, 2, 3), Vector3(10, 20, 30))'
    env = WireEnv(change_game(project, '"bounds": Rect2(-1, -3, 12, 5)', box))
    env.reset(seed=1)
    assert env.tltl_outline()["bounds"] == [[1, -33, 2], [11, -3, 22]]
    env.close()


def test_a_text_may_have_any_characters(project: Path) -> None:
    env = WireEnv(change_game(project, '"goal" if at_goal', '"\\"\\\\ é €" if at_goal'))
    env.reset(seed=3)
    env.step(2)
    assert env.get_wrapper_attr("tltl_cause")() == '"\\ é €'
    env.close()


def test_a_recorded_trace_is_judged(project: Path, tmp_path: Path) -> None:
    folder = tmp_path / "traces"
    run_script(
        project,
        f"""\
var recorder = Tltl.Recorder.new("{folder}", ["near(a, b)", "seen"], 60)
for last in [true, false]:
	recorder.begin()
	for step in range(4):
		recorder.sample({{"near(a, b)": step / 3.0, "seen": last and step == 3, "unused": 1.0}})
recorder.end()""",
    )
    lines = (folder / "trace-0002.csv").read_text(encoding="utf-8").splitlines()
    assert lines[0] == 'time,"near(a, b)",seen'
    rows = [line.split(",") for line in lines[1:]]
    assert [(float(time), float(near), seen) for time, near, seen in rows] == [
        (step / 60, step / 3, "false") for step in range(4)
    ]
    spec = tmp_path / "see.tltl"
    spec.write_text(
        "clock 60 Hz\nsignal near(a, b): number in [0, 1]\nsignal seen: bool\nspec see = F seen\n", encoding="utf-8"
    )
    words = [sys.executable, "-m", "tltlc", "monitor", str(spec), str(folder)]
    result = subprocess.run(words, capture_output=True, text=True, timeout=HANG_S, check=False)
    assert "1 of 2 accepted" in result.stdout, result.stderr


def test_a_recorder_overwrites_nothing_and_refuses_what_is_no_sample(project: Path, tmp_path: Path) -> None:
    folder = tmp_path / "traces"
    folder.mkdir()
    (folder / "trace-0001.csv").write_text("kept", encoding="utf-8")
    result = run_script(
        project,
        f"""\
var recorder = Tltl.Recorder.new("{folder}", ["x"])
recorder.begin()
print(recorder.sample({{"x": NAN}}), recorder.problem)
print(recorder.sample({{"y": 1}}), recorder.problem)
print(File.new().file_exists(recorder.begin()), " before the first sample")
print(recorder.sample({{"x": 1}}))""",
    )
    assert "False" + "the signal x is nan, and numbers must be finite" in result.stdout
    assert "False" + "the signal x is missing" in result.stdout
    assert "False before the first sample" in result.stdout
    assert (folder / "trace-0001.csv").read_text(encoding="utf-8") == "kept"
    assert (folder / "trace-0002.csv").read_text(encoding="utf-8") == "x\n1\n"


def test_a_recorder_writes_the_tape_of_a_play(project: Path, tmp_path: Path) -> None:
    folder = tmp_path / "traces"
    folder.mkdir()
    (folder / "trace-0001.tape.jsonl").write_text("kept", encoding="utf-8")
    result = run_script(project, recorded_tapes.GDSCRIPT.replace("FOLDER", str(folder)))
    assert "Falsegive the action of each sample of an episode, or of none" in result.stdout
    tape = recorded_tapes.check_tape(folder / "trace-0002.tape.jsonl", tmp_path)
    assert tape.header.versions["godot"].startswith("3.")
    assert (folder / "trace-0001.tape.jsonl").read_text(encoding="utf-8") == "kept"
    assert not (folder / "trace-0003.tape.jsonl").exists()
    recorded_tapes.check_tape_without_a_variant(folder / "trace-0004.tape.jsonl")
