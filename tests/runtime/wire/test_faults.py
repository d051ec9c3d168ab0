"""Games that hang, end, or talk nonsense: one plain sentence, the last standard error, and no process left behind."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import tracemalloc
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import pytest
from gymnasium.error import ResetNeeded

from tests.docs.blocks import ROOT
from tests.waiting import HANG_S, children, until, until_gone
from tltl_runtime.wire.env import WireEnv
from tltl_runtime.wire.errors import WireError
from tltl_runtime.wire.start_watch import SlowStart, telling_slow_starts
from tltl_runtime.wire.wire_game import WireGame
from tltlc.api.fileio import limits

GAMES = Path(__file__).parent / "games"


def faulty(*words: str, start_s: float = HANG_S, step_s: float = HANG_S) -> WireGame:
    return WireGame("faulty", GAMES, (sys.executable, "faulty.py", *words), start_s=start_s, step_s=step_s)


@contextmanager
def little_memory() -> Iterator[None]:
    """Check that Python never holds much more than a few messages of the greatest size."""
    tracemalloc.start()
    try:
        yield
        _, peak = tracemalloc.get_traced_memory()
    finally:
        tracemalloc.stop()
    assert peak < 3 * limits.WIRE_MESSAGE.size


@contextmanager
def no_new_children() -> Iterator[None]:
    """Check that the process has no more children at the end than at the beginning."""
    before = children(os.getpid())
    yield
    assert children(os.getpid()) == before


def family(env: WireEnv) -> list[int]:
    """Return the ids of the supervisor and the game."""
    assert env.process_id is not None
    return [env.process_id, *children(env.process_id)]


def error_of(game: WireGame, *, at_step: bool = False) -> tuple[str, str, str]:
    """Play until the fault; return code, sentence and help, once all processes are gone."""
    env = WireEnv(game)
    pids = family(env)
    if at_step:
        env.reset()
    with pytest.raises(WireError) as caught:
        env.step(0) if at_step else env.reset()
    until_gone(pids)
    with pytest.raises(ResetNeeded):
        env.step(0)
    env.close()
    (diagnostic,) = caught.value.diagnostics
    return diagnostic.code, diagnostic.title, diagnostic.help or ""


LOST = [
    ("exit", "ended with exit status 3 instead of answering `reset`"),
    ("crash", "was killed by SIGSEGV instead of answering `reset`"),
    ("raise", "ended with exit status 1 instead of answering `reset`"),
]
MALFORMED = [
    ("garbage", "sent a line that is not JSON: `Godot Engine v3.2.3 - https://godotengine.org`"),
    ("binary", f"sent a line that is not UTF-8: `{3 * chr(0xFFFD)}`"),
    ("nan", "sent the number NaN, and numbers must be finite"),
    ("infinite", "sent a number that is not finite as `state.signals.health`"),
    ("wrong type", 'sent `state.signals.health` as "full", but it must be a number'),
    ("number for bool", "sent `state.signals.seen` as 1, but it must be true or false"),
    ("out of range", "sent 2.0 as the signal `health`, outside its declared range from 0 to 1"),
    ("other signal", "sent the signal `armour`, which it did not declare; there are: `health`, `seen`"),
    ("missing signal", "did not send the signal `seen`, which it declared"),
    ("other kind", "sent a message `snapshot` instead of `state`"),
]


@pytest.mark.parametrize(("fault", "sentence"), LOST)
def test_a_game_that_ends_is_reported(fault: str, sentence: str) -> None:
    code, title, help_ = error_of(faulty(fault))
    assert (code, title) == ("TLT0791", f"the game `faulty` {sentence}")
    assert help_.startswith(f"the game's standard error ends:\nnow: {fault}\n")
    if fault == "raise":
        assert "RuntimeError: no such node: Player/Camera" in help_


def test_a_game_that_ends_in_a_step_is_reported() -> None:
    assert error_of(faulty("step exit"), at_step=True) == (
        "TLT0791",
        "the game `faulty` ended with exit status 3 instead of answering `step`",
        "the game's standard error ends:\nnow: exit\ncorrect the game; let it write what it does to standard error",
    )


@pytest.mark.parametrize(("fault", "sentence"), MALFORMED)
def test_an_answer_that_breaks_the_protocol_is_reported(fault: str, sentence: str) -> None:
    assert error_of(faulty(fault)) == (
        "TLT0792",
        f"the game `faulty` {sentence}",
        f"the game's standard error ends:\nnow: {fault}\ncorrect the game; `docs/wire.md` describes the messages",
    )


def test_an_error_of_the_game_is_reported() -> None:
    code, title, _ = error_of(faulty("error"))
    assert (code, title) == ("TLT0793", "the game `faulty` reports: the scene `crypt` cannot be loaded")


@pytest.mark.parametrize("fault", ["hang", "drip", "stop"])
def test_a_game_that_does_not_answer_is_ended(fault: str) -> None:
    # The game never answers, so the short deadline always passes.
    code, title, help_ = error_of(faulty(fault, step_s=0.2))
    assert (code, title) == ("TLT0791", "the game `faulty` did not answer `reset` within 0.2 s, and was ended")
    assert help_.endswith("find out what it waits for, or allow more time with `step_s`")


def test_a_game_that_closes_its_connection_is_reported(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("tltl_runtime.wire.session._TO_CLOSE_S", 0.1)
    code, title, _ = error_of(faulty("close"))
    assert (code, title) == ("TLT0791", "the game `faulty` closed its connection instead of answering `reset`")


def test_two_answers_to_one_request_are_refused() -> None:
    env = WireEnv(faulty("two answers"))
    env.reset()
    with pytest.raises(WireError, match="sent more than one message as the answer to one request"):
        env.step(0)
    env.close()


def test_a_line_of_a_gigabyte_is_refused_before_it_is_held() -> None:
    with little_memory():
        code, title, _ = error_of(faulty("long line"))
    assert (code, title) == ("TLT0792", "the game `faulty` sent a line of more than 32 MiB")


def test_a_first_line_of_a_gigabyte_is_refused_before_it_is_held() -> None:
    sentence = r"TLT0792: the game `faulty` sent a first line of more than 1 MiB"
    with no_new_children(), little_memory(), pytest.raises(WireError, match=sentence):
        WireEnv(faulty("long hello"))


def test_standard_error_without_end_is_read_and_not_held() -> None:
    # The pipe holds 64 KiB: the game ends only if somebody reads it.
    with little_memory():
        code, title, help_ = error_of(faulty("flood"))
    assert (code, title) == ("TLT0791", "the game `faulty` ended with exit status 4 instead of answering `reset`")
    assert len(help_) < 2 * limits.WIRE_STDERR.size


STARTS = [
    ("old version", "TLT0792", "speaks version 0 of the protocol, and this tltlc speaks version 1"),
    ("wrong token", "TLT0792", "sent a wrong token; it must send the value of the variable TLTL_TOKEN"),
    (
        "wrong actions",
        "TLT0792",
        "declares `hello.actions` as a space of the unknown type `discret`; did you mean `discrete`?",
    ),
    ("exit first", "TLT0790", "ended with exit status 1 before it said hello"),
]


@pytest.mark.parametrize(("fault", "code", "sentence"), STARTS)
def test_a_game_that_does_not_start_is_reported(
    fault: str, code: str, sentence: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("tltl_runtime.wire.session._TO_CLOSE_S", HANG_S)
    with no_new_children(), pytest.raises(WireError) as caught:
        WireEnv(faulty(fault))
    (diagnostic,) = caught.value.diagnostics
    assert (diagnostic.code, diagnostic.title) == (code, f"the game `faulty` {sentence}")
    last_line = "cannot open display :0" if fault == "exit first" else f"tltlc refuses this game, because it {sentence}"
    assert f"the game's standard error ends:\n{last_line}\n" in (diagnostic.help or "")


def test_garbage_in_place_of_hello_is_reported() -> None:
    sentence = r"TLT0792: the game `faulty` sent a line that is not JSON: `Loading\.\.\.`"
    with no_new_children(), pytest.raises(WireError, match=sentence):
        WireEnv(faulty("garbage first"))


@pytest.mark.parametrize("fault", ["no hello", "drip hello"])
def test_a_game_that_never_says_hello_is_ended(fault: str) -> None:
    with no_new_children(), pytest.raises(WireError) as caught:
        WireEnv(faulty(fault, start_s=2))
    (diagnostic,) = caught.value.diagnostics
    assert diagnostic.title == "the game `faulty` did not say hello within 2 s, and was ended"


def test_a_game_whose_script_cannot_be_read_is_ended_early(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("tltl_runtime.wire.start_watch.GRACE_S", 0.0)
    with no_new_children(), pytest.raises(WireError) as caught:
        WireEnv(faulty("script error"))
    (diagnostic,) = caught.value.diagnostics
    title = "the game `faulty` did not say hello within 5 s after an error in a script, and was ended"
    assert (diagnostic.code, diagnostic.title) == ("TLT0790", title)
    assert diagnostic.help == (
        "the game's standard error ends:\n"
        "SCRIPT ERROR: GDScript::reload: Parse Error: Expected an indented block.\n"
        "   At: res://main.gd:7.\n"
        "correct the script: the engine cannot read it, and goes on without it"
    )


def test_a_game_that_says_hello_after_an_error_in_a_script_is_played(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("tltl_runtime.wire.start_watch.GRACE_S", HANG_S)
    env = WireEnv(faulty("late hello"))
    monkeypatch.setattr("tltl_runtime.wire.start_watch.GRACE_S", 0.0)
    env.reset()
    env.step(0)
    env.close()


def test_who_waits_is_told_what_a_starting_game_wrote_last(monkeypatch: pytest.MonkeyPatch) -> None:
    class ToldError(Exception):
        pass

    def tell(start: SlowStart) -> None:
        lines.append(start.last_line)
        if start.last_line:
            assert (start.name, start.start_s) == ("faulty", HANG_S)
            raise ToldError

    lines: list[str] = []
    monkeypatch.setattr("tltl_runtime.wire.start_watch.LONG_S", 0.0)
    with no_new_children(), telling_slow_starts(tell), pytest.raises(ToldError):
        WireEnv(faulty("no hello"))
    # Before the game has written anything, the line is empty. No line is printed twice.
    assert lines in (["loading assets"], ["", "loading assets"])


@pytest.mark.parametrize(
    ("program", "help_"),
    [
        ("no-such-program", "install it, or give its path"),
        ("./no-such-program", "paths are relative to the folder of the game file"),
    ],
)
def test_a_program_that_does_not_exist_is_reported(program: str, help_: str) -> None:
    with pytest.raises(WireError) as caught:
        WireEnv(WireGame("faulty", GAMES, (program,)))
    (diagnostic,) = caught.value.diagnostics
    assert (diagnostic.code, diagnostic.title) == ("TLT0790", f"there is no program `{program}` that can be run")
    assert diagnostic.help == help_


def test_the_next_reset_starts_the_game_again() -> None:
    env = WireEnv(faulty("none"))
    env.reset()
    pids = family(env)
    os.kill(pids[0], signal.SIGKILL)
    until_gone(pids)
    with pytest.raises(WireError, match="was killed by SIGKILL instead of answering `step`"):
        env.step(0)
    env.reset()
    assert env.tltl_signals() == {"health": 1.0, "seen": False}
    pids = family(env)
    env.close()
    until_gone(pids)


def test_a_game_must_declare_the_same_at_each_start(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    env = WireEnv(faulty("changes", str(tmp_path / "started")))
    env.reset()
    pids = family(env)
    os.kill(pids[0], signal.SIGKILL)
    until_gone(pids)
    with pytest.raises(WireError):
        env.step(0)
    sentence = "declares other signals, spaces or capabilities than when it was first started"
    monkeypatch.setattr("tltl_runtime.wire.session._TO_CLOSE_S", HANG_S)
    with no_new_children(), pytest.raises(WireError, match=f"TLT0792: the game `faulty` {sentence}") as caught:
        env.reset()
    assert f"tltlc refuses this game, because it {sentence}" in (caught.value.diagnostics[0].help or "")
    env.close()


def test_a_second_connection_to_the_port_is_refused() -> None:
    code, title, help_ = error_of(faulty("second connection"))
    assert (code, title) == ("TLT0791", "the game `faulty` ended with exit status 5 instead of answering `reset`")
    assert "second connection: ConnectionRefusedError" in help_


def test_all_processes_of_a_game_end_with_the_environment(tmp_path: Path) -> None:
    file = tmp_path / "pids"
    env = WireEnv(faulty("children", str(file)))
    env.reset()
    pids = [*map(int, file.read_text().split()), *family(env)]
    assert len(set(pids)) == 4
    env._session._close_channel()  # The game notices the end of the connection, and stays.
    env.close()
    until_gone(pids)


PROGRAM = """
import sys
from tests.runtime.wire.test_faults import family, faulty
from tltl_runtime.wire.env import WireEnv
env = WireEnv(faulty(*sys.argv[1:]))
print(*family(env), flush=True)
env.reset()
print("reset", flush=True)
sys.stdin.read()
"""


def program(*words: str) -> subprocess.Popen[str]:
    path = [str(ROOT), str(ROOT / "runtime"), os.environ.get("PYTHONPATH", "")]
    variables = {**os.environ, "PYTHONPATH": os.pathsep.join(filter(None, path))}
    return subprocess.Popen(
        [sys.executable, "-c", PROGRAM, *words],
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        env=variables,
        cwd=ROOT,
    )


def line_of(process: subprocess.Popen[str]) -> str:
    assert process.stdout is not None
    return process.stdout.readline()


def test_no_process_of_a_game_is_left_if_tltlc_is_killed(tmp_path: Path) -> None:
    file = tmp_path / "pids"
    with program("children", str(file)) as process:
        pids = [*map(int, line_of(process).split())]
        assert line_of(process) == "reset\n"
        pids += map(int, file.read_text().split())
        process.kill()
    until_gone(pids)


def test_no_process_of_a_game_is_left_after_ctrl_c(tmp_path: Path) -> None:
    file = tmp_path / "hangs"
    with program("hang", str(file)) as process:
        pids = [*map(int, line_of(process).split())]
        until(lambda: file.exists() or process.poll() is not None, "the game to hang while the program waits for it")
        process.send_signal(signal.SIGINT)
        _, errors = process.communicate(timeout=HANG_S)
        assert "KeyboardInterrupt" in errors and process.returncode == -signal.SIGINT
    until_gone(pids)


def test_no_process_is_left_if_the_supervisor_is_killed() -> None:
    env = WireEnv(faulty("hang"))
    supervisor, game = family(env)
    os.kill(supervisor, signal.SIGKILL)
    until_gone([supervisor, game])
    env.close()


def test_a_game_is_ended_without_close() -> None:
    env = WireEnv(faulty("none"))
    pids = family(env)
    del env
    until_gone(pids)
