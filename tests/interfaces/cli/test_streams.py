"""Commands with closed standard streams: no crash, no message in a file, no result lost silently."""

from __future__ import annotations

import os
import shutil
import signal
import subprocess
import sys
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from importlib.util import find_spec
from pathlib import Path
from typing import Final

import pytest

from tests.interfaces.cli.conftest import ROOT
from tests.waiting import HANG_S
from tltlc.interfaces.cli.command_line import BUILT_IN, RUNTIME_COMMANDS, cli
from tltlc.interfaces.cli.main import main

pytestmark = pytest.mark.skipif(sys.platform == "win32", reason="needs descriptors that a shell closes")

OFTEN: Final = ("<&- >&-", "<&- >&- 2>&-")
SELDOM: Final = (">&-", "<&-", "2>&-", ">&- 2>&-")
"""Redirections that close streams, in shell syntax. The second row takes longer and rarely finds more."""
SPEC: Final = (
    'signal seen: bool\nspec hide = G !seen\ntest "caught" for hide {\n    step seen\n    expect violated\n}\n'
)
HOA: Final = 'HOA: v1\nStates: 1\nStart: 0\nAP: 1 "seen"\nAcceptance: 0 t\n--BODY--\nState: 0\n[t] 0\n--END--\n'
RECORDING: Final = "demo/cover_and_hide-v0-0.episode.npz"
NOWHERE: Final = ("nowhere.toml",)
"""A level or suite that does not exist, for commands that would take long or open a window."""

QUICK: Final[dict[str, list[tuple[str, ...]]]] = {
    "": [("--help",), ("--version",), ("bogus",), ()],
    "breaking": [("hide.tltl", "--against", "before")],
    "check": [("hide.tltl",), ("--format", "json", "hide.tltl"), ("-",), ("--help",)],
    "compile": [("hide.tltl", "-o", "out", "-t", "json,dot,python,hoa")],
    "completion": [("bash",)],
    "conformance": [("-o", "before")],
    "diff": [("hide.tltl", "hide.tltl")],
    "explain": [("hide.tltl",), ("TLT0001",)],
    "fmt": [("hide.tltl",), ("--diff", "wide.tltl"), ("-",)],
    "import": [("again.hoa", "--predicates", "hide.tltl", "-o", "out")],
    "lint": [("hide.tltl",)],
    "list": [("codes",), ("targets", "--json")],
    "lsp": [()],
    "mcp": [()],
    "mine": [("trace.csv", "--against", "bad.csv"), ("trace.csv", "--against", "bad.csv", "-o", "mined.tltl"), ("-",)],
    "monitor": [("hide.tltl", "trace.csv"), ("hide.tltl", "trace.csv", "--json"), ("hide.tltl", "-")],
    "new": [("game",)],
    "render": [("hide.tltl", "-t", "dot"), ("hide.tltl", "-o", "hide.dot")],
    "serve": [("--static", "site", "--pyodide", "nowhere")],
    "test": [("hide.tltl",)],
    "witness": [("hide.tltl",), ("hide.tltl", "-o", "out")],
}
"""Arguments of each command, for small inputs."""

OF_GAMES: Final[dict[str, list[tuple[str, ...]]]] = {
    "baseline": [NOWHERE],
    "demonstrate": [NOWHERE],
    "evaluate": [("--level", *NOWHERE)],
    "inspect": [("nowhere", "-o", "out.txt")],
    "play": [NOWHERE],
    "record": [NOWHERE],
    "regress": [NOWHERE],
    "replay": [(RECORDING,), (RECORDING, "-o", "trace_of_episode.csv")],
    "table1": [("-o", "hide.tltl/table")],
    "train": [("--resume", "demo", "--out", "out")],
}

IMPORTING: Final[dict[str, list[tuple[str, ...]]]] = {
    "conformance": [("-o", "hide.tltl/out")],
    "inspect": [("cover_and_hide",)],
    "train": [("--level", "cover_and_hide", "--print-config")],
}
"""Commands that compute or import for seconds before they print or fail."""

SLOW: Final[dict[str, list[tuple[str, ...]]]] = {
    "conformance": [("-o", "out")],
    "demonstrate": [("cover_and_hide", "-o", "out")],
    "evaluate": [("--level", "cover_and_hide", "--episodes", "1")],
    "record": [("cover_and_hide", "--episodes", "1", "-o", "out")],
}

LASTING: Final = ("serve", "watch")
"""Commands that run until Ctrl-C."""


def _cases(table: dict[str, list[tuple[str, ...]]]) -> list[tuple[str, ...]]:
    return [(command, *arguments) if command else arguments for command, rows in table.items() for arguments in rows]


FIRST: Final = _cases({command: rows[:1] for command, rows in QUICK.items()})


def test_the_tables_list_every_command() -> None:
    known = cli.commands.keys() | set(BUILT_IN) | set(RUNTIME_COMMANDS)
    assert known == {*QUICK, *OF_GAMES, *LASTING} - {""}


@dataclass(frozen=True)
class Run:
    status: int
    out: bytes
    err: bytes
    files: dict[str, bytes]


Runner = Callable[[Path, tuple[str, ...], str], Run]


@pytest.fixture(name="inputs", scope="module")
def _inputs(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("streams") / "inputs"
    folder.mkdir()
    texts = {
        "hide.tltl": SPEC,
        "wide.tltl": SPEC.replace("signal seen: bool", "signal   seen :  bool"),
        "again.hoa": HOA,
        "trace.csv": "seen\n0\n0\n",
        "bad.csv": "seen\n0\n1\n",
    }
    for name, text in texts.items():
        (folder / name).write_text(text, encoding="utf-8")
    (folder / "before").mkdir()
    shutil.copy(folder / "hide.tltl", folder / "before")
    return folder


@pytest.fixture(name="recorded", scope="module")
def _inputs_with_recording(inputs: Path) -> Path:
    """The inputs, and a recording of an episode."""
    if find_spec("pybullet") is None or find_spec("safetensors") is None:
        pytest.skip("needs the extra game")
    demonstration = _run(inputs, ("demonstrate", "cover_and_hide", "-o", "demo"), "")
    assert demonstration.status == 0, demonstration.err
    return inputs


def _run(folder: Path, arguments: tuple[str, ...], closed: str) -> Run:
    """Run a command line in a folder, with streams closed by a redirection in shell syntax."""
    stdin = "" if "<" in closed else "</dev/null"
    completed = subprocess.run(
        ["bash", "-c", f'exec "$@" {stdin} {closed}', "bash", sys.executable, "-m", "tltlc", *arguments],
        cwd=folder,
        capture_output=True,
        timeout=600,
        env={**os.environ, "PYTHONPATH": str(ROOT), "TLTLC_CACHE_DIR": "", "SDL_VIDEODRIVER": "dummy"},
        check=False,
    )
    return Run(completed.returncode, completed.stdout, completed.stderr, _files(folder))


def _files(folder: Path) -> dict[str, bytes]:
    return {str(path.relative_to(folder)): path.read_bytes() for path in folder.rglob("*") if path.is_file()}


@pytest.fixture(name="run_here")
def _run_here(capfdbinary: pytest.CaptureFixture[bytes], monkeypatch: pytest.MonkeyPatch) -> Runner:
    """A function that runs a command line with open streams, in this process, which needs no start of Python."""

    def run(folder: Path, arguments: tuple[str, ...], _: str) -> Run:
        capfdbinary.readouterr()
        with monkeypatch.context() as patch, Path(os.devnull).open(encoding="utf-8") as nothing:
            patch.chdir(folder)
            patch.setenv("TLTLC_CACHE_DIR", "")
            patch.setattr(sys, "stdin", nothing)
            with pytest.raises(SystemExit) as exit_:
                main(list(arguments))
        assert isinstance(exit_.value.code, int)
        out, err = capfdbinary.readouterr()
        return Run(exit_.value.code, out, err, _files(folder))

    return run


def _check(
    inputs: Path,
    arguments: tuple[str, ...],
    folder: Path,
    streams: Sequence[str],
    *,
    same_bytes: bool = True,
    run_open: Runner = _run,
) -> None:
    """Compare a run with open streams to runs with closed streams."""

    def run_copy(closed: str, run: Runner = _run) -> Run:
        shutil.rmtree(folder, ignore_errors=True)
        shutil.copytree(inputs, folder)
        return run(folder, arguments, closed)

    open_run = run_copy("", run_open)
    assert open_run.status != 70 and b"Traceback" not in open_run.err
    reads = "-" in arguments
    for closed in streams:
        run = run_copy(closed)
        messages = run.err.decode()
        expected_status = open_run.status
        if "<" in closed and reads:
            expected_status = 3
            assert "2>" in closed or "cannot read standard input: it is closed" in messages
        elif ">&-" in closed.replace("2>&-", "") and open_run.out:
            expected_status = 3
            assert "2>" in closed or "cannot write to standard output: it is closed" in messages
        elif same_bytes and "2>" not in closed:
            assert run.err == open_run.err, closed
        assert run.status == expected_status, (closed, messages)
        assert run.files.keys() == open_run.files.keys(), closed
        assert not same_bytes or run.files == open_run.files, closed
        assert b"Traceback" not in run.err and b"bug in tltlc" not in run.err, closed
        if expected_status == open_run.status and run.out:
            assert not same_bytes or run.out == open_run.out, closed


@pytest.mark.parametrize("arguments", _cases(QUICK), ids=" ".join)
def test_closed_streams_lose_no_result(
    arguments: tuple[str, ...], inputs: Path, tmp_path: Path, run_here: Runner
) -> None:
    run_open = run_here
    if arguments in (("lsp",), ("mcp",)):
        pytest.importorskip({"lsp": "pygls", "mcp": "mcp"}[arguments[0]])
        # The server reads from the descriptor of standard input.
        run_open = _run
    # The first arguments of each command are run with standard error closed, too.
    streams = OFTEN if arguments in FIRST else OFTEN[:1]
    _check(inputs, arguments, tmp_path / "inputs", streams, run_open=run_open)


@pytest.mark.parametrize("arguments", _cases(OF_GAMES), ids=" ".join)
def test_closed_streams_of_game_commands_lose_no_result(
    arguments: tuple[str, ...], recorded: Path, tmp_path: Path
) -> None:
    _check(recorded, arguments, tmp_path / "inputs", OFTEN[-1:])


@pytest.mark.slow
@pytest.mark.parametrize("arguments", _cases(QUICK) + _cases(OF_GAMES) + _cases(IMPORTING), ids=" ".join)
def test_other_closed_streams_lose_no_result(arguments: tuple[str, ...], recorded: Path, tmp_path: Path) -> None:
    _check(recorded, arguments, tmp_path / "inputs", OFTEN + SELDOM)


@pytest.mark.slow
@pytest.mark.parametrize("arguments", _cases(SLOW), ids=" ".join)
def test_closed_streams_of_slow_commands_lose_no_result(
    arguments: tuple[str, ...], recorded: Path, tmp_path: Path
) -> None:
    # Recordings contain times, so their bytes differ.
    _check(recorded, arguments, tmp_path / "inputs", OFTEN + SELDOM, same_bytes=False)


@pytest.mark.parametrize("closed", [">&-", "<&-", "<&- >&-"])
@pytest.mark.parametrize("arguments", [("serve", "--port", "0"), ("watch", "hide.tltl")], ids=" ".join)
def test_lasting_commands_start_and_end_with_closed_streams(
    arguments: tuple[str, ...], closed: str, inputs: Path, tmp_path: Path
) -> None:
    shutil.copytree(inputs, tmp_path / "inputs")
    with subprocess.Popen(
        ["bash", "-c", f'exec "$@" {closed}', "bash", sys.executable, "-m", "tltlc", *arguments],
        cwd=tmp_path / "inputs",
        stdin=subprocess.DEVNULL,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        env={**os.environ, "PYTHONPATH": str(ROOT)},
        text=True,
    ) as running:
        try:
            assert running.stderr is not None
            assert any("press Ctrl-C to stop" in line for line in running.stderr)
            running.send_signal(signal.SIGINT)
            _, err = running.communicate(timeout=HANG_S)
        finally:
            running.kill()
    assert (running.returncode, err) == (130, "")


def test_full_standard_error_does_not_change_the_exit_status(inputs: Path) -> None:
    if not Path("/dev/full").exists():
        pytest.skip("needs a device without room")
    with Path("/dev/full").open("wb") as full:
        command = [sys.executable, "-m", "tltlc", "check", "nowhere.tltl"]
        completed = subprocess.run(
            command, stderr=full, cwd=inputs, env={**os.environ, "PYTHONPATH": str(ROOT)}, check=False
        )
    assert completed.returncode == 3
