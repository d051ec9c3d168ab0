"""The process of a game: started, watched, and ended with all its child processes."""

from __future__ import annotations

import os
import shutil
import signal
import subprocess
import sys
import weakref
from collections.abc import Mapping, Sequence
from contextlib import suppress
from pathlib import Path
from typing import Final

from tltl_runtime.wire.error_lines import telling_lines
from tltl_runtime.wire.errors import NOT_STARTED, wire_error
from tltl_runtime.wire.stderr_tail import StderrTail
from tltlc.api import fileio

_SUPERVISOR: Final = Path(__file__).with_name("supervisor.py")
_TO_END_S: Final = 5.0
"""Seconds in which a killed process ends."""


class GameProcess:
    """A running game, started in ``folder`` by a command with these ``words``.

    ``variables`` are added to the game's environment variables. On Unix, the game never outlives this
    process, even if this process is killed: a small process between the two, the supervisor, then ends
    the game and its child processes (:mod:`~tltl_runtime.wire.supervisor`). On Windows, there is no
    supervisor, and only the game itself is ended.

    Raises:
        WireError: TLT0790, the program does not exist, or cannot be started.
    """

    def __init__(self, words: Sequence[str], folder: Path, variables: Mapping[str, str]) -> None:
        _check_program(words[0], folder)
        command = [*words] if os.name == "nt" else [sys.executable, "-I", "-S", str(_SUPERVISOR), *words]
        try:
            with fileio.block_interrupts():
                self._process = subprocess.Popen(
                    command,
                    cwd=folder,
                    env={**os.environ, **variables},
                    stdin=subprocess.PIPE,
                    stdout=subprocess.DEVNULL,
                    stderr=subprocess.PIPE,
                    bufsize=0,
                    start_new_session=True,
                )
        except (OSError, ValueError) as error:
            reason = error.strerror if isinstance(error, OSError) and error.strerror else str(error)
            title = f"cannot start `{words[0]}`: {reason}"
            raise wire_error(NOT_STARTED, title, "check the command of the game") from None
        assert self._process.stderr is not None
        self._tail = StderrTail(self._process.stderr)
        self._end = weakref.finalize(self, _end, self._process)

    @property
    def pid(self) -> int:
        """The id of the supervisor; on Windows, that of the game."""
        return self._process.pid

    def has_ended(self) -> bool:
        """Whether the game has ended by itself, or was ended."""
        return self._process.poll() is not None

    def wait(self, patience: float) -> bool:
        """Wait until the game ends by itself, at most ``patience`` seconds; return whether it did."""
        with suppress(subprocess.TimeoutExpired):
            self._process.wait(patience)
        return self._process.returncode is not None

    def end_text(self) -> str:
        """Return how the game ended by itself, such as "ended with exit status 3"."""
        status = self._process.returncode
        if status is not None and status < 0:
            return f"was killed by {_signal_name(-status)}"
        return f"ended with exit status {status}"

    def end(self) -> None:
        """End the game and all its child processes."""
        self._end()

    def lines_so_far(self) -> list[str]:
        """Return the last lines that the game has written to standard error so far."""
        return self._tail.lines_so_far()

    def last_lines(self) -> list[str]:
        """Return the lines of the end of the game's standard error that help to mend it; the game must have ended."""
        return telling_lines(self._tail.lines(), fileio.limits.WIRE_STDERR.values or 0)


def _end(process: subprocess.Popen[bytes]) -> None:
    """Close the supervisor's standard input, so that it kills the game and ends; wait until it has ended.

    On Windows, kill the game itself.
    """
    assert process.stdin is not None
    with suppress(OSError):
        process.stdin.close()
    if os.name == "nt":
        process.kill()
    try:
        process.wait(_TO_END_S)
    except subprocess.TimeoutExpired:
        process.kill()
        process.wait()


def _check_program(program: str, folder: Path) -> None:
    """Raise WireError, TLT0790, if there is no such program; a path is relative to ``folder``."""
    is_path = os.sep in program or (os.altsep is not None and os.altsep in program)
    # `folder / program` alone may have no separator, and would be searched in PATH.
    path = shutil.which((folder / program).absolute()) if is_path else shutil.which(program)
    if path is None:
        title = f"there is no program `{program}` that can be run"
        help_ = "paths are relative to the folder of the game file" if is_path else "install it, or give its path"
        raise wire_error(NOT_STARTED, title, help_)


def _signal_name(number: int) -> str:
    with suppress(ValueError):
        return signal.Signals(number).name
    return f"signal {number}"
