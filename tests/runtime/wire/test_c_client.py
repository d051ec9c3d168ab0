"""The client in C and C++: it passes the conversation, survives damaged lines, and records traces that tltlc reads."""

from __future__ import annotations

import json
import os
import random
import shutil
import subprocess
from collections.abc import Callable, Iterator
from functools import cache
from math import inf
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
from tltl_runtime.wire.answers import screenshot, snapshot_id
from tltl_runtime.wire.hello import DeclaredSignal, hello_from
from tltl_runtime.wire.outline import outline_from
from tltl_runtime.wire.values import array_from

CLIENTS = Path(clients.__file__).parent
COMPILERS = {"c99": ("gcc", "-std=c99", "-x", "c"), "c++11": ("g++", "-std=c++11", "-x", "c++")}
STRICT = ("-Wall", "-Wextra", "-Werror", "-pedantic", "-Wconversion", "-Wshadow", "-O1")
CHECKED = ("-g", "-fsanitize=address,undefined", "-fno-sanitize-recover=all")


def _usable() -> Iterator[Any]:
    for language, words in COMPILERS.items():
        reason = "" if shutil.which(words[0]) else f"{words[0]} is not installed"
        yield pytest.param(language, marks=[pytest.mark.skip(reason=reason)] if reason else [])


with_compilers = pytest.mark.parametrize("language", list(_usable()))


Build = Callable[..., str]


@pytest.fixture(scope="module")
def build(tmp_path_factory: pytest.TempPathFactory) -> Build:
    """Return a function that builds a program once, and returns its path.

    Its arguments are a language, a source, which is a file in the folder of the games or a path, and options.
    """
    folder = tmp_path_factory.mktemp("programs")

    @cache
    def built(language: str, source: str | Path, *options: str) -> str:
        program = str(folder / str(len([*folder.iterdir()])))
        words = [*COMPILERS[language], *STRICT, *options, f"-I{CLIENTS}", str(GAMES / source), "-o", program]
        result = subprocess.run(words, capture_output=True, text=True, timeout=HANG_S, check=False)
        assert result.returncode == 0, result.stderr
        return program

    return built


def run(*words: str, **variables: str) -> subprocess.CompletedProcess[str]:
    env = {name: value for name, value in os.environ.items() if not name.startswith("TLTL_")} | variables
    return subprocess.run(words, capture_output=True, text=True, env=env, timeout=HANG_S, check=False)


@with_compilers
def test_the_client_passes_the_conversation(language: str, build: Build, tmp_path: Path) -> None:
    program = build(language, "counter.c", *CHECKED)
    lines: list[str] = []
    assert conversation.check([program], lines.append), "\n".join(lines)
    assert len(lines) == len(conversation.EXCHANGES) + len(conversation.REFUSALS) + 10
    check_listening([program])
    result = run(program)
    assert result.returncode == 1
    assert result.stderr == "tltlc must start this game: the variable TLTL_PORT is not set\n"
    result = run(program, TLTL_PORT="1")
    assert result.returncode == 1 and result.stderr.startswith("cannot connect to tltlc at port 1: ")


@with_compilers
def test_the_examples_work(language: str, build: Build, tmp_path: Path) -> None:
    source, page = tmp_path / "example.c", tmp_path / "page.c"
    code = examples.code_of_comment(CLIENTS / "tltl_client.h", "//", "#define", "    return tltl_play")
    source.write_text(code + "}\n", encoding="utf-8")
    examples.check_example([build(language, source, "-Wno-unused-parameter")])
    examples.check_example([build(language, "own_loop.c")])
    page.write_text(examples.code_of_page("c"), encoding="utf-8")
    subprocess.run([build(language, page)], cwd=tmp_path, timeout=HANG_S, check=True)
    examples.check_traces_of_page(tmp_path / "traces")


@with_compilers
def test_the_code_is_in_one_file_of_a_game_with_several(language: str, build: Build, tmp_path: Path) -> None:
    (tmp_path / "code.c").write_text('#define TLTL_CLIENT_IMPLEMENTATION\n#include "tltl_client.h"\n', encoding="utf-8")
    source = tmp_path / "user.c"
    source.write_text(
        '#include "tltl_client.h"\n#include "tltl_client.h"\n'
        'int main(void) { tltl_recorder recorder; return tltl_recorder_init(&recorder, ".", NULL, 0, 0) - 1; }\n',
        encoding="utf-8",
    )
    assert run(build(language, source, str(tmp_path / "code.c"))).returncode == 0


@with_compilers
def test_damaged_lines_are_read_as_python_reads_them(language: str, build: Build, tmp_path: Path) -> None:
    program = build(language, "read_lines.c", *CHECKED)
    lines = [*request_lines.lines(27, 4000)]
    path = tmp_path / "lines"
    path.write_bytes(b"\n".join(lines) + b"\n" + b'{"step": {"action": 1}}')
    result = run(program, str(path))
    assert result.returncode == 0, result.stderr
    rows = result.stdout.splitlines()
    assert len(rows) == len(lines) + 1 and rows[-1] == "0\t"  # The last line has no end.
    accepted = 0
    for line, row in zip(lines, rows, strict=False):
        wanted = _wanted(line)
        assert row.startswith("1") == (wanted is not None), (line, row)
        if wanted is not None:
            accepted += 1
            _compare(row, wanted, line)
    assert accepted > 1000


def _wanted(line: bytes) -> dict[str, Any] | None:
    """Return the object that the client must read; None if it must refuse the line."""
    try:
        value = request_lines.parsed(line, first_of_equals=True)
    except ValueError:
        return None
    is_request = isinstance(value, dict) and "error" not in value and request_lines.depth(value) <= 64
    return value if is_request else None


def _compare(row: str, message: dict[str, Any], line: bytes) -> None:
    _, name, scene, variant, has_seed, seed, repeat, id_, numbers, is_right = row.split("\t")
    kinds = ("reset", "step", "snapshot", "restore", "release", "screenshot", "outline", "close")
    kind = next((word for word in kinds if word in message), None)
    body = message.get(kind) if kind else None
    body = body if isinstance(body, dict) else {}
    assert _text(name) == _plain(kind or next(iter(message), "")), line
    assert _text(scene) == _plain(body.get("scene") or "" if isinstance(body.get("scene"), str) else ""), line
    assert _text(variant) == _plain(body["variant"] if isinstance(body.get("variant"), str) else "v0"), line
    wanted = _whole(body.get("seed"))
    has = wanted is not None and wanted >= 0
    assert (has_seed, seed) == (str(int(has)), str(wanted if has else 0)), line
    assert repeat == str(min(max(_whole(body.get("repeat")) or 1, 1), 2**31 - 1)), line
    wanted = _whole(body.get("id"))
    assert id_ == str(-1 if wanted is None else wanted), line
    assert [float(number) for number in numbers.split()] == [*_numbers(body.get("action"))][:64], line
    assert is_right == "1", line


def _text(digits: str) -> str:
    return bytes.fromhex(digits).decode()


def _plain(text: str) -> str:
    """Return a text in which zero bytes and halves of surrogate pairs are replaced."""
    return "".join("\ufffd" if letter == "\0" or "\ud800" <= letter <= "\udfff" else letter for letter in text)


def _whole(value: Any) -> int | None:
    is_number = isinstance(value, (int, float)) and not isinstance(value, bool)
    return int(value) if is_number and abs(value) <= 2**53 and value == int(value) else None


def _numbers(value: Any) -> Iterator[float]:
    if isinstance(value, list):
        for item in value:
            yield from _numbers(item)
    elif isinstance(value, (int, float)) and not isinstance(value, bool):
        yield float(value)


def _written(program: str, numbers: list[float], folder: Path, *words: str, **variables: str) -> list[str]:
    """Return the numbers as the client writes them, after it has read them."""
    path = folder / "numbers"
    path.write_text("".join(f'{{"step": {{"action": {number!r}}}}}\n' for number in numbers), encoding="utf-8")
    result = run(program, str(path), *words, **variables)
    assert result.returncode == 0, result.stderr
    return [row.split("\t")[8] for row in result.stdout.splitlines()]


@with_compilers
def test_numbers_keep_their_values(language: str, build: Build, tmp_path: Path) -> None:
    program = build(language, "read_lines.c", *CHECKED)
    chance = random.Random(2)
    numbers = [*(request_lines.a_float(chance) for _ in range(5000)), 2**53 - 1, 0, -1]
    texts = _written(program, numbers, tmp_path)
    assert [repr(float(text)) for text in texts] == [repr(float(number)) for number in numbers]
    assert texts[-3:] == ["9007199254740991", "0", "-1"]


@with_compilers
def test_numbers_are_read_and_written_alike_where_the_locale_has_a_comma(
    language: str, build: Build, tmp_path: Path
) -> None:
    if not make_german_locale(tmp_path):
        pytest.skip("localedef cannot make the locale de_DE.UTF-8")
    program = build(language, "read_lines.c", *CHECKED)
    numbers = [0.5, -1.25e-300, 1 / 3, 3]
    texts = _written(program, numbers, tmp_path, "de_DE.UTF-8", LOCPATH=str(tmp_path))
    assert texts == ["0.5", "-1.25e-300", "0.3333333333333333", "3"]


@with_compilers
def test_long_lines_and_numbers_are_refused(language: str, build: Build, tmp_path: Path) -> None:
    program = build(language, "read_lines.c", *CHECKED, "-DTLTL_LONGEST_REQUEST=((size_t)1000)")
    path = tmp_path / "lines"
    path.write_bytes(
        b'{"step": {"action": 0.' + b"0" * 600 + b"}}\n" + b"x" * 1001 + b"\n" + b" " * 100000 + b"\n"
        b'{"close": {}' + b" " * 987 + b"}\n"
    )
    rows = [row.split("\t")[:2] for row in run(program, str(path)).stdout.splitlines()]
    too_long = ["0", "tltlc sent a line of more than 1000 bytes"]
    assert rows == [["0", "tltlc sent a number that is too long"], too_long, too_long, ["1", b"close".hex()]]


@with_compilers
def test_answers_of_all_kinds_arrive(language: str, build: Build) -> None:
    result = run(build(language, "answers.c", *CHECKED))
    assert result.returncode == 0, result.stderr
    *messages, odd, large, huge = result.stdout.splitlines()
    hello, state, plain, snapshot, picture, outline, bounds, refusal = map(json.loads, messages)
    assert hello["hello"]["token"] == 'a"b\\c\x01ä'
    declared = hello_from(hello)
    assert declared.signals['near(a, "b")'] == DeclaredSignal("number", -inf, 1)
    assert declared.signals["free"] == DeclaredSignal("number", -inf, inf)
    assert declared.actions.shape == (2, 3) and declared.name == "game"
    assert state["state"]["signals"] == {'near(a, "b")': 0.1, "seen": True}
    assert array_from(state["state"]["observation"], "observation").tolist() == [[1], [-2], [0]]
    assert state["state"]["positions"] == {"player": [1, -2.5, 1e-9], "guard": [0, 3]}
    assert (state["state"]["ended"], state["state"]["cause"]) == (True, "line\nend")
    assert plain["state"] == {
        "signals": {'near(a, "b")': -1e300, "seen": False},
        "observation": {"map": [1, 2], "speed": 0.5},
        "ended": False,
        "cause": None,
    }
    assert snapshot_id(snapshot) == 2**53 + 1
    assert screenshot(picture).tolist() == [[[255, 0, 0], [0, 255, 0], [0, 0, 255]]]
    read = outline_from(outline)
    assert read["image"].pop("pixels").tolist() == [[[255, 0, 0], [0, 255, 0], [0, 0, 255]]]
    assert read == {
        "bounds": [[0, 0], [9, 6]],
        "boxes": {'wall "1"': [[[0, 0, -1], [8, 1, 2.5]], [[8, 0, -1], [9, 6, 2.5]]], "fence": []},
        "polygons": {"lake": [[1, 1], [3, 1], [2, 2]]},
        "regions": {"hall": [[0, 0], [9, 6]], "roof": [[0, 0, -1], [8, 1, 2.5]]},
        "image": {"extent": [0, 0, 9, 6]},
    }
    assert bounds == {"outline": {"boxes": {}, "polygons": {}, "regions": {}, "bounds": [[0, 0, -1], [8, 1, 2.5]]}}, (
        "what the outline before contained is forgotten"
    )
    assert refusal["error"]["message"] == "ä" * 255
    assert odd == "the signal seen is nan, and numbers must be finite"
    assert large == "the picture is too large to be sent, or has no channels" == huge


@with_compilers
def test_memory_that_ends_is_an_error(language: str, build: Build) -> None:
    program = build(language, "answers.c", *CHECKED)
    for allocations in range(18):
        result = run(program, str(allocations))
        assert (result.returncode, result.stderr) == (0, ""), allocations


@with_compilers
def test_a_recorded_trace_is_judged(language: str, build: Build, tmp_path: Path) -> None:
    program = build(language, "record.c", *CHECKED)
    folder = tmp_path / "new" / "traces"
    assert run(program, str(folder)).stdout == f"{folder / 'trace-0002.csv'}\n"
    assert run(program, str(folder)).stdout == f"{folder / 'trace-0004.csv'}\n"
    for number in (1, 3):
        check_traces(folder, tmp_path, number)
    assert run(program, str(folder), "0.1").returncode == 0
    assert (folder / "trace-0005.csv").read_text(encoding="utf-8") == '"near(a, b)",seen\n0.1,true\n'
    for value in ("nan", "inf", "-inf"):
        result = run(program, str(folder), value)
        assert result.returncode == 1
        assert result.stderr == f"the signal near(a, b) is {value}, and numbers must be finite\n"
        assert not (folder / "trace-0006.csv").exists()
    result = run(program, str(tmp_path / program / "none"))
    assert result.returncode == 1 and result.stderr.startswith("cannot write ")


@with_compilers
def test_a_recorder_writes_the_tape_of_a_play(language: str, build: Build, tmp_path: Path) -> None:
    (tmp_path / "trace-0001.tape.jsonl").write_text("kept", encoding="utf-8")
    result = run(build(language, "record.c", *CHECKED), str(tmp_path), "tape")
    assert result.returncode == 0, result.stderr
    assert result.stdout.splitlines() == [
        "give the action of each sample of an episode, or of none",
        str(tmp_path / "trace-0005.csv"),
    ]
    recorded_tapes.check_tape(tmp_path / "trace-0002.tape.jsonl", tmp_path)
    assert (tmp_path / "trace-0001.tape.jsonl").read_text(encoding="utf-8") == "kept"
    assert not (tmp_path / "trace-0003.tape.jsonl").exists()
    recorded_tapes.check_tape_without_a_variant(tmp_path / "trace-0004.tape.jsonl")
    assert not (tmp_path / "trace-0005.csv").exists()


@with_compilers
def test_digests_are_right_where_the_compiler_does_not_keep_signs_of_zero(
    language: str, build: Build, tmp_path: Path
) -> None:
    result = run(build(language, "record.c", "-fno-signed-zeros"), str(tmp_path), "tape")
    assert result.returncode == 0, result.stderr
    recorded_tapes.check_tape(tmp_path / "trace-0001.tape.jsonl", tmp_path)
