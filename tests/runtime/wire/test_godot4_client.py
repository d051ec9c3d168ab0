"""The client in GDScript for Godot 4.

Godot 4 is not here. The client is parsed by gdparse; and Godot 3 stands in for Godot 4: it runs the client and its
game with the names that it has for the same things, so the logic is run, and that the names are right is not.
"""

from __future__ import annotations

import json
import os
import re
import shutil
import struct
import subprocess
import sys
from math import ulp
from pathlib import Path
from random import Random

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.runtime.wire import conversation, recorded_tapes
from tests.runtime.wire.test_env import connected, free_port
from tests.runtime.wire.test_faults import GAMES
from tests.waiting import HANG_S
from tltl_runtime.wire.clients import tltl_client
from tltl_runtime.wire.env import WireEnv
from tltl_runtime.wire.errors import WireError
from tltl_runtime.wire.wire_game import WireGame

CLIENT = Path(tltl_client.__file__).with_name("tltl_client_godot4.gd")
GAME = GAMES / "godot4"
GDPARSE = os.environ.get("GDPARSE") or shutil.which("gdparse")
ENGINE = "godot3-server"

parses = pytest.mark.skipif(not GDPARSE, reason="there is no gdparse (gdtoolkit) here: no script for Godot 4 is parsed")
runs = pytest.mark.skipif(not shutil.which(ENGINE), reason=f"there is no {ENGINE} here, the stand-in for Godot 4")

OLD_NAMES: tuple[tuple[str, str], ...] = (
    (r": Variant\b| -> Variant\b", ""),
    (r"\[(?:int|String)\] =", " ="),
    (r"Array\[int\]", "Array"),
    (r"RefCounted", "Reference"),
    (r"PackedByteArray", "PoolByteArray"),
    (r"PackedStringArray", "PoolStringArray"),
    (r"PackedFloat32Array", "PoolRealArray"),
    (r"TYPE_PACKED_FLOAT32_ARRAY", "TYPE_REAL_ARRAY"),
    (r"\t\tTYPE_PACKED_FLOAT64_ARRAY:\n.*\n", ""),
    (r"value\.to_byte_array\(\)", "var2bytes(value).subarray(8, 4 * value.size() + 7)"),
    (r"TYPE_FLOAT", "TYPE_REAL"),
    (r"TYPE_STRING, TYPE_STRING_NAME", "TYPE_STRING"),
    (r"TCPServer", "TCP_Server"),
    (r"JSON\.parse_string", "parse_json"),
    (r"\t*_connection\.poll\(\)\n", ""),
    (r"_received\.clear\(\)", "_received = PoolByteArray()"),
    (r"_received\.(find|slice)\(", r"_\1(_received, "),
    (r"not is_finite\((\w+)\)", r"(is_nan(\1) or is_inf(\1))"),
    (r"absf\(|absi\(", "abs("),
    (r"floorf\(", "floor("),
    (r"clampi\(", "clamp("),
    (r"String\.num\(value, 17\)", '"%.16f" % value'),
    (r"String\.num\(value, 30\)", "odd(value)"),
    (r'","\.join\((\w+)\)', r'\1.join(",")'),
    (r"substr\(place \+ 1\)", "substr(place + 1, escaped.length())"),
    (r"unicode_at", "ord_at"),
    (r"is_empty", "empty"),
    (r"to_utf8_buffer", "to_utf8"),
    (r"\t*@warning_ignore.*\n", ""),
    (r"_(file|tape): FileAccess = null", r"_\1 = null"),
    (r"\(file: FileAccess, ", "(file, "),
    (r"JSON\.stringify", "to_json"),
    (r"about\.merge\(_played\)", "for key in _played: about[key] = _played[key]"),
    (r"FileAccess\.file_exists", "File.new().file_exists"),
    (r"FileAccess\.open\((.*), FileAccess.WRITE\)", r"_opened(\1)"),
    (r"DirAccess\.make_dir_recursive_absolute", "Directory.new().make_dir_recursive"),
    (r"path_join", "plus_file"),
    (r"\t*file\.flush\(\)\n", ""),
    (r"get_cmdline_user_args", "get_cmdline_args"),
)
"""Patterns in scripts for Godot 4, and what stands for them in Godot 3."""

OLD_FUNCTIONS = """

static func _find(bytes: PoolByteArray, value: int, from: int) -> int:
	for place in range(from, bytes.size()):
		if bytes[place] == value:
			return place
	return -1


static func _slice(bytes: PoolByteArray, from: int, to: int = -1) -> PoolByteArray:
	to = bytes.size() if to < 0 else to
	return bytes.subarray(from, to - 1) if to > from else PoolByteArray()


"""
"""What arrays of bytes in Godot 3 cannot do."""

OLD_OPEN = """
	static func _opened(path: String) -> File:
		var file = File.new()
		return file if file.open(path, File.WRITE) == OK else null

"""


def for_godot_3(script: str) -> str:
    """Return a script for Godot 4 with the names of Godot 3."""
    for pattern, name in OLD_NAMES:
        script = re.sub(pattern, name, script)
    script = script.replace("# --- text ---", OLD_FUNCTIONS + "# --- text ---")
    return script.replace("\tfunc _path(", OLD_OPEN + "\tfunc _path(")


@pytest.fixture
def project(tmp_path: Path) -> Path:
    """Return a project of Godot 3 with the game and the client."""
    folder = tmp_path / "project"
    shutil.copytree(GAMES / "godot4", folder)
    for script in (CLIENT, GAME / "counter.gd"):
        (folder / script.name).write_text(for_godot_3(script.read_text(encoding="utf-8")), encoding="utf-8")
    (folder / "counter.tscn").write_text(
        '[gd_scene load_steps=2 format=2]\n[ext_resource path="res://counter.gd" type="Script" id=1]\n'
        '[node name="Counter" type="Node"]\nscript = ExtResource( 1 )\n',
        encoding="utf-8",
    )
    settings = (folder / "project.godot").read_text(encoding="utf-8").replace("config_version=5", "config_version=4")
    (folder / "project.godot").write_text(settings + '\n[locale]\n\ntest="en"\n', encoding="utf-8")
    return folder


def command(project: Path, *words: str) -> list[str]:
    """Return the command that starts the game."""
    return [ENGINE, "--path", str(project), "--fixed-fps", "10", "--disable-render-loop", *words]


def run_script(project: Path, body: str) -> str:
    """Run the body of a function, with the client as ``Tltl``, and return its output."""
    lines = "".join(f"\t{line}\n" for line in body.splitlines())
    script = f'extends SceneTree\nconst Tltl = preload("res://{CLIENT.name}")\nfunc _init():\n{lines}\tquit()\n'
    (project / "script.gd").write_text(script, encoding="utf-8")
    words = [ENGINE, "--path", str(project), "-s", "script.gd"]
    result = subprocess.run(words, capture_output=True, text=True, timeout=HANG_S, check=True)
    assert "SCRIPT ERROR" not in result.stdout + result.stderr, result.stdout + result.stderr
    return result.stdout


def example() -> str:
    """Return the game in the head comment of the client."""
    head = CLIENT.read_text(encoding="utf-8").partition("\nextends")[0]
    block = head[head.index("#     extends Node3D") : head.index("# `seed_` is null")]
    return re.sub(r"^#(?: {5})?", "", block, flags=re.MULTILINE).replace("    ", "\t")


@parses
def test_the_client_and_its_game_are_parsed(tmp_path: Path) -> None:
    (tmp_path / "example.gd").write_text(example(), encoding="utf-8")
    scripts = [str(CLIENT), str(GAME / "counter.gd"), str(tmp_path / "example.gd")]
    result = subprocess.run([str(GDPARSE), *scripts], capture_output=True, text=True, timeout=HANG_S, check=False)
    assert result.returncode == 0, result.stdout + result.stderr


def test_the_client_uses_nothing_newer_than_godot_4_1() -> None:
    script = CLIENT.read_text(encoding="utf-8")
    assert not re.search(r"\bfor \w+:", script), "types of loop variables are of Godot 4.2"
    assert not re.search(r"Dictionary\[|@abstract|\.\.\.", script), "these are newer, too"


@runs
@pytest.mark.parametrize("words", [(), ("play",)], ids=["the engine's loop", "the client's loop"])
def test_the_client_passes_the_conversation(project: Path, words: tuple[str, ...]) -> None:
    lines: list[str] = []
    assert conversation.check(command(project, *words), lines.append), "\n".join(lines)
    assert len(lines) == len(conversation.EXCHANGES) + len(conversation.REFUSALS) + 10


@runs
def test_without_tltlc_the_game_says_why_it_ends(project: Path) -> None:
    variables = {key: value for key, value in os.environ.items() if not key.startswith("TLTL_")}
    result = subprocess.run(
        command(project), capture_output=True, text=True, env=variables, timeout=HANG_S, check=False
    )
    assert result.returncode == 1
    assert "tltlc must start this game: the variable TLTL_PORT is not set" in result.stderr


@runs
def test_a_running_game_is_played_again_and_again(project: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("TLTL_TOKEN", "open sesame")
    port = free_port()
    with subprocess.Popen(command(project, "listen", str(port)), stdout=subprocess.DEVNULL) as game:
        try:
            for token in ("open sesame", "open barley", "open sesame"):
                monkeypatch.setenv("TLTL_TOKEN", token)
                if token == "open barley":
                    with pytest.raises(WireError, match="the token is wrong"):
                        connected(port)
                    continue
                env = connected(port)
                env.reset(seed=1)
                assert env.step(2)[0].tolist() == [3]
                env.close()
        finally:
            game.kill()


def changed(project: Path, old: str, new: str) -> WireEnv:
    """Change the code of the game, and start it."""
    path = project / "counter.gd"
    text = path.read_text(encoding="utf-8")
    assert old in text
    path.write_text(text.replace(old, new), encoding="utf-8")
    return WireEnv(WireGame("counter", project, tuple(command(project)), start_s=HANG_S, step_s=HANG_S))


@runs
@pytest.mark.parametrize("value", ["INF", "NAN"])
def test_a_number_that_is_not_finite_is_reported_by_name(project: Path, value: str) -> None:
    env = changed(project, '"moves": moves,', f'"moves": {value} if moves > 1 else moves,')
    env.reset(seed=1)
    env.step(1)
    with pytest.raises(WireError, match=r"TLT0793.*the signal moves is .*, and numbers must be finite"):
        env.step(1)
    env.close()


@runs
def test_arrays_of_floats_vectors_and_any_texts_are_sent(project: Path) -> None:
    path = project / "counter.gd"
    text = path.read_text(encoding="utf-8")
    path.write_text(text.replace('"goal" if at_goal', '"\\"\\\\ é €" if at_goal'), encoding="utf-8")
    new = '{"player": Vector3(1, 2, 3), "mark": Vector2(4, 5)}'
    env = changed(project, '{"player": [place, 0]}', new)
    env.reset(seed=3)
    env.step(2)
    assert env.tltl_positions() == {"player": (1.0, -3.0, 2.0), "mark": (4.0, -5.0)}
    assert env.tltl_cause() == '"\\ é €'
    env.close()
    env = changed(project, "[place],", "PoolRealArray([place / 3.0]),")
    assert env.reset(seed=1)[0].tolist() == [struct.unpack("f", struct.pack("f", 2 / 3))[0]]
    env.close()
    assert '"a\\u0009\\u0001é"' in run_script(project, 'print(Tltl._quoted("a" + char(9) + char(1) + "é"))')


@runs
def test_an_outline_has_the_axes_of_tltlc(project: Path) -> None:
    box = '"bounds": AABB(Vector3(1, 2, 3), Vector3(10, 20, 30))'
    env = changed(project, '"bounds": Rect2(-1, -3, 12, 5)', box)
    env.reset(seed=1)
    assert env.tltl_outline()["bounds"] == [[1, -33, 2], [11, -3, 22]]
    env.close()


@runs
def test_very_small_and_very_large_numbers_keep_their_values(project: Path) -> None:
    """Numbers between are written by Godot 4 itself; see the next test."""
    random = Random(1)
    values = [struct.unpack("<d", random.randbytes(8))[0] for _ in range(500)]
    values = [value for value in values if value == value and abs(value) < float("inf")]
    values += [
        5e-324,
        sys.float_info.max,
        sys.float_info.min,
        1e15,
        1e16 - 2,
        1e22,
        1e23,
        -1e-12,
        3e-17,
        0.0,
        -7.0,
        2.0**53,
    ]
    values = [value for value in values if not 1e-12 <= abs(value) < 1e15 or value == int(value)]
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
    assert [json.loads(line) for line in (project / "texts").read_text(encoding="utf-8").splitlines()] == values


@given(st.floats(1e-12, 1e15, exclude_max=True))
def test_as_many_decimals_as_godot_4_is_asked_for_are_enough(value: float) -> None:
    """``String.num`` is C's ``printf`` with at most 32 decimals, in all versions of Godot 4."""
    decimals = 17 if value >= 0.5 else 30
    assert float(f"{value:.{decimals}f}") == value and decimals <= 32 and ulp(value) > 10.0**-decimals


@runs
def test_a_recorded_trace_is_judged(project: Path, tmp_path: Path) -> None:
    folder = tmp_path / "traces"
    folder.mkdir()
    (folder / "trace-0001.csv").write_text("kept", encoding="utf-8")
    output = run_script(
        project,
        f"""\
var recorder = Tltl.Recorder.new("{folder}", ["near(a, b)", "seen"], 64)
for last in [true, false]:
	print(recorder.begin())
	for step in range(4):
		recorder.sample({{"near(a, b)": step / 4.0, "seen": last and step == 3, "unused": 1.0}})
print(recorder.sample({{"near(a, b)": NAN, "seen": true}}), recorder.problem)
print(recorder.sample({{"seen": true}}), recorder.problem)
recorder.begin()
recorder.sample({{"seen": true}})
recorder.end()""",
    )
    for text in (
        str(folder / "trace-0002.csv"),
        str(folder / "trace-0003.csv"),
        "Falsethe signal near(a, b) is nan, and numbers must be finite",
        "Falsethe signal near(a, b) is missing",
    ):
        assert text in output
    assert (folder / "trace-0001.csv").read_text(encoding="utf-8") == "kept"
    (folder / "trace-0001.csv").unlink()
    assert len([*folder.iterdir()]) == 2
    header, *rows = (folder / "trace-0003.csv").read_text(encoding="utf-8").splitlines()
    assert header == 'time,"near(a, b)",seen'
    assert [[float(cell) for cell in row.split(",")[:2]] for row in rows] == [
        [step / 64, step / 4] for step in range(4)
    ]
    spec = tmp_path / "see.tltl"
    spec.write_text(
        "clock 64 Hz\nsignal near(a, b): number in [0, 1]\nsignal seen: bool\nspec see = F seen\n", encoding="utf-8"
    )
    words = [sys.executable, "-m", "tltlc", "monitor", str(spec), str(folder)]
    result = subprocess.run(words, capture_output=True, text=True, timeout=HANG_S, check=False)
    assert "1 of 2 accepted" in result.stdout, result.stderr


@runs
def test_a_recorder_writes_the_tape_of_a_play(project: Path, tmp_path: Path) -> None:
    folder = tmp_path / "traces"
    folder.mkdir()
    (folder / "trace-0001.tape.jsonl").write_text("kept", encoding="utf-8")
    output = run_script(project, recorded_tapes.GDSCRIPT.replace("FOLDER", str(folder)))
    assert "Falsegive the action of each sample of an episode, or of none" in output
    recorded_tapes.check_tape(folder / "trace-0002.tape.jsonl", tmp_path)
    assert (folder / "trace-0001.tape.jsonl").read_text(encoding="utf-8") == "kept"
    assert not (folder / "trace-0003.tape.jsonl").exists()
    recorded_tapes.check_tape_without_a_variant(folder / "trace-0004.tape.jsonl")
