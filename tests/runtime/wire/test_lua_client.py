"""The client in Lua: it passes the conversation, keeps the values of numbers, and records traces that tltlc reads."""

from __future__ import annotations

import json
import os
import random
import shutil
import subprocess
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

from tests.runtime.wire import conversation, examples, recorded_tapes, request_lines
from tests.runtime.wire.german_locale import make_german_locale
from tests.runtime.wire.listening import check_listening
from tests.runtime.wire.recorded_traces import check_traces
from tests.runtime.wire.test_faults import GAMES
from tests.waiting import HANG_S
from tltl_runtime.wire import clients

CLIENTS = Path(clients.__file__).parent
INTERPRETERS = ("lua5.1", "lua5.2", "lua5.3", "lua5.4", "luajit")
COUNTER, RECORD, READ_LINES = (str(GAMES / name) for name in ("counter.lua", "record.lua", "read_lines.lua"))


def _missing(interpreter: str, library: str) -> str:
    """Return why an interpreter, or its library, cannot be used here; empty if it can."""
    if shutil.which(interpreter) is None:
        return f"{interpreter} is not installed"
    words = [interpreter, "-e", f'require "{library}"']
    is_there = subprocess.run(words, capture_output=True, timeout=HANG_S, check=False).returncode == 0
    return "" if is_there else f"{interpreter} has no LuaSocket (on Debian: apt-get install lua-socket)"


def _usable(library: str) -> Iterator[Any]:
    for interpreter in INTERPRETERS:
        reason = _missing(interpreter, library)
        yield pytest.param(interpreter, marks=[pytest.mark.skip(reason=reason)] if reason else [])


with_sockets = pytest.mark.parametrize("lua", list(_usable("socket")))
with_lua = pytest.mark.parametrize("lua", list(_usable("string")))


def run(*words: str, **variables: str) -> subprocess.CompletedProcess[str]:
    env = {name: value for name, value in os.environ.items() if not name.startswith("TLTL_")} | variables
    return subprocess.run(words, capture_output=True, text=True, env=env, timeout=HANG_S, check=False)


@with_sockets
def test_the_client_passes_the_conversation(lua: str) -> None:
    lines: list[str] = []
    assert conversation.check([lua, COUNTER], lines.append), "\n".join(lines)
    assert len(lines) == len(conversation.EXCHANGES) + len(conversation.REFUSALS) + 10


@with_sockets
def test_the_examples_work(lua: str, tmp_path: Path) -> None:
    game, page = tmp_path / "game.lua", tmp_path / "page.lua"
    path = f'package.path = "{CLIENTS}/?.lua;" .. package.path\n'
    code = examples.code_of_comment(CLIENTS / "tltl_client.lua", "--", "local tltl_client", "tltl_client.play(game)")
    game.write_text(path + code, encoding="utf-8")
    examples.check_example([lua, str(game)])
    page.write_text(path + examples.code_of_page("lua"), encoding="utf-8")
    (tmp_path / "traces").mkdir()
    subprocess.run([lua, str(page)], cwd=tmp_path, timeout=HANG_S, check=True)
    examples.check_traces_of_page(tmp_path / "traces")


@with_sockets
def test_a_game_that_listens_refuses_a_wrong_token_and_is_played_twice(lua: str) -> None:
    check_listening([lua, COUNTER])


@with_sockets
def test_without_tltlc_the_game_says_why_it_ends(lua: str) -> None:
    result = run(lua, COUNTER)
    assert result.returncode == 1
    assert result.stderr == "tltlc must start this game: the variable TLTL_PORT is not set\n"


@with_sockets
def test_an_error_in_the_game_names_its_place(lua: str, tmp_path: Path) -> None:
    game = tmp_path / "game.lua"
    game.write_text(
        f'package.path = "{CLIENTS}/?.lua;" .. package.path\n'
        'require("tltl_client").play({hello = {signals = {}, actions = {type = "discrete", n = 1}},\n'
        "  reset = function() return nil + 1 end})\n",
        encoding="utf-8",
    )
    with conversation.Game([lua, str(game)]) as playing:
        playing.receive()
        playing.send({"reset": {}})
        assert playing.status() == 1
        assert "game.lua:3:" in playing.stderr() and "attempt to perform arithmetic" in playing.stderr()


@with_lua
def test_damaged_lines_are_read_as_python_reads_them(lua: str, tmp_path: Path) -> None:
    lines = [*request_lines.lines(26, 10000)]
    path = tmp_path / "lines"
    path.write_bytes(b"\n".join(lines) + b"\n")
    output = subprocess.run([lua, READ_LINES, str(path)], capture_output=True, timeout=HANG_S, check=True).stdout
    results = output.split(b"\n")[:-1]
    assert len(results) == len(lines)
    accepted = 0
    for line, result in zip(lines, results, strict=True):
        try:
            wanted = request_lines.parsed(line)
        except UnicodeDecodeError:
            continue  # The client passes bytes on that are not UTF-8.
        except ValueError:
            assert result == b"0", line
            continue
        if request_lines.depth(wanted) <= 100:
            accepted += 1
            assert result[:1] == b"1", line
            assert _as_lua(json.loads(result[1:])) == _as_lua(wanted), line
    assert accepted > 1000


def _as_lua(value: Any) -> Any:
    """Return a value without what Lua cannot keep: null in objects, and half a surrogate pair."""
    if isinstance(value, dict):
        return {_as_lua(key): _as_lua(item) for key, item in value.items() if item is not None}
    if isinstance(value, list):
        return [_as_lua(item) for item in value]
    if isinstance(value, str):
        return "".join("\ufffd" if "\ud800" <= letter <= "\udfff" else letter for letter in value)
    return float(value) if isinstance(value, int) and not isinstance(value, bool) else value


@with_lua
def test_numbers_keep_their_values(lua: str, tmp_path: Path) -> None:
    chance = random.Random(1)
    numbers = [*(request_lines.a_float(chance) for _ in range(5000)), 2**53 - 1, 0, -1]
    path = tmp_path / "lines"
    path.write_text("\n".join(map(repr, numbers)) + "\n", encoding="utf-8")
    texts = [line[1:] for line in run(lua, READ_LINES, str(path)).stdout.splitlines()]
    assert [repr(float(text)) for text in texts] == [repr(float(number)) for number in numbers]
    assert texts[-3:] == ["9007199254740991", "0", "-1"]
    assert max(map(len, texts)) <= len("-2.2250738585072014e-308")


@with_lua
def test_numbers_are_read_and_written_alike_where_the_locale_has_a_comma(lua: str, tmp_path: Path) -> None:
    if not make_german_locale(tmp_path):
        pytest.skip("localedef cannot make the locale de_DE.UTF-8")
    path = tmp_path / "lines"
    path.write_text("0.5\n-1.25e-300\n0.3333333333333333\n3\n", encoding="utf-8")
    result = run(lua, READ_LINES, str(path), "de_DE.UTF-8", LOCPATH=str(tmp_path))
    assert result.stdout == "10.5\n1-1.25e-300\n10.3333333333333333\n13\n", result.stderr


@with_lua
def test_lists_without_values_and_deep_ones(lua: str, tmp_path: Path) -> None:
    path = tmp_path / "lines"
    path.write_text(
        '{"a":[],"b":{}}\n[null]\n' + "[" * 101 + "]" * 101 + "\n" + "[" * 99 + "]" * 99 + "\n", encoding="utf-8"
    )
    first, second, third, fourth = run(lua, READ_LINES, str(path)).stdout.splitlines()
    assert json.loads(first[1:]) == {"a": [], "b": {}}
    assert (second, third, fourth) == ("1[null]", "0", "1" + "[" * 99 + "]" * 99)


@with_lua
def test_a_recorded_trace_is_judged(lua: str, tmp_path: Path) -> None:
    folder = tmp_path / "traces"
    folder.mkdir()
    (folder / "trace-0001.csv").write_text("kept", encoding="utf-8")
    assert run(lua, RECORD, str(folder)).stdout == f"{folder / 'trace-0003.csv'}\n"
    assert (folder / "trace-0001.csv").read_text(encoding="utf-8") == "kept"
    check_traces(folder, tmp_path, 2)


@with_lua
def test_a_recorder_writes_the_tape_of_a_play(lua: str, tmp_path: Path) -> None:
    (tmp_path / "trace-0001.tape.jsonl").write_text("kept", encoding="utf-8")
    result = run(lua, RECORD, str(tmp_path), "tape")
    assert result.stdout == "give the action of each sample of an episode, or of none\n", result.stderr
    tape = recorded_tapes.check_tape(tmp_path / "trace-0002.tape.jsonl", tmp_path)
    assert tape.header.versions["lua"].startswith("Lua 5.")
    assert (tmp_path / "trace-0001.tape.jsonl").read_text(encoding="utf-8") == "kept"
    assert not (tmp_path / "trace-0003.tape.jsonl").exists()
    recorded_tapes.check_tape_without_a_variant(tmp_path / "trace-0004.tape.jsonl")


@with_lua
@pytest.mark.parametrize("value", ["nan", "inf", "-inf"])
def test_a_recorder_refuses_numbers_that_are_not_finite(lua: str, tmp_path: Path, value: str) -> None:
    result = run(lua, RECORD, str(tmp_path), value)
    assert result.returncode == 1
    assert f"the signal near(a, b) is {value}, and numbers must be finite" in result.stderr
    assert not [*tmp_path.iterdir()]


@with_lua
def test_a_recorder_names_a_folder_that_is_missing(lua: str, tmp_path: Path) -> None:
    result = run(lua, RECORD, str(tmp_path / "none"))
    assert result.returncode == 1 and "is the folder there?" in result.stderr


with_love = pytest.mark.skipif(shutil.which("love") is None, reason="love is not installed")
LOVE_GAME = str(GAMES / "love")


@with_love
def test_a_game_in_love_passes_the_conversation() -> None:
    lines: list[str] = []
    assert conversation.check(["love", LOVE_GAME], lines.append), "\n".join(lines)


@with_love
def test_in_love_traces_are_in_the_folder_of_what_players_save(tmp_path: Path) -> None:
    folder = tmp_path / "love" / "tltl-counter" / "plays" / "traces"
    for number in (2, 4):
        result = run("love", LOVE_GAME, "record.lua", "plays/traces", XDG_DATA_HOME=str(tmp_path))
        assert result.stdout == f"{folder / f'trace-{number:04d}.csv'}\n", result.stderr
        check_traces(folder, tmp_path, number - 1)
    result = run("love", LOVE_GAME, "record.lua", "plays/tapes", "tape", XDG_DATA_HOME=str(tmp_path))
    assert result.returncode == 0, result.stderr
    recorded_tapes.check_tape(folder.with_name("tapes") / "trace-0001.tape.jsonl", tmp_path)
