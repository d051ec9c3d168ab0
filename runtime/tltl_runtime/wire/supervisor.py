"""A program that runs a game, and ends it with all its child processes as soon as tltlc ends.

It is started as ``python -I -S supervisor.py WORDS…``, imports only the standard library, and
works on Unix. Its standard input is a pipe whose other end belongs to tltlc. The pipe is closed when
tltlc closes it or is killed. Then, or when the game has ended, the supervisor kills all processes of the
game that still run. Its exit status is that of the game.
"""

from __future__ import annotations

import os
import select
import signal
import sys
from contextlib import suppress
from pathlib import Path

_SET_PARENT_DEATH_SIGNAL = 1
_SET_CHILD_SUBREAPER = 36
_NOT_FOUND = 127


def main(words: list[str]) -> int:
    """Run the game with the command ``words`` until it ends, or until standard input is closed.

    Then kill all of its processes that still run. Return the game's status, as :func:`os.waitpid` gives
    it; -1 if the game did not end by itself.
    """
    _prctl(_SET_CHILD_SUBREAPER, 1)
    reads, writes = os.pipe()
    os.set_blocking(writes, False)
    signal.set_wakeup_fd(writes)
    signal.signal(signal.SIGCHLD, lambda *_: None)
    for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
        signal.signal(number, signal.SIG_IGN)
    supervisor = os.getpid()
    game = os.fork()
    if game == 0:
        _become(words, supervisor)
    with suppress(OSError):
        os.setpgid(game, game)
    status = _wait(game, reads)
    _kill(game)
    return status


def _become(words: list[str], supervisor: int) -> None:
    """Run the game in place of this process, a new child; exit with status 127 if the game cannot be started."""
    with suppress(OSError):
        os.setpgid(0, 0)
    signal.set_wakeup_fd(-1)
    for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP, signal.SIGCHLD, signal.SIGPIPE):
        signal.signal(number, signal.SIG_DFL)
    signal.pthread_sigmask(signal.SIG_SETMASK, [])
    os.dup2(os.open(os.devnull, os.O_RDONLY), 0)
    _prctl(_SET_PARENT_DEATH_SIGNAL, signal.SIGKILL)
    try:
        if os.getppid() == supervisor:
            os.execvp(words[0], words)
    except OSError as error:
        os.write(2, f"{words[0]}: {error.strerror}\n".encode(errors="replace"))
    os._exit(_NOT_FOUND)


def _wait(game: int, woken: int) -> int:
    """Wait until the game has ended, and return its status; return -1 if standard input is closed before.

    ``woken`` is the pipe that gets a byte when a child process has ended.
    """
    while True:
        ready, _, _ = select.select([0, woken], [], [])
        if woken in ready:
            os.read(woken, 1024)
            for child, status in _ended():
                if child == game:
                    return status
        if 0 in ready:
            return -1


def _ended() -> list[tuple[int, int]]:
    """Return the ids of the child processes that have ended since the last call, each with its status."""
    ended = []
    with suppress(ChildProcessError):
        while (pair := os.waitpid(-1, os.WNOHANG))[0]:
            ended.append(pair)
    return ended


def _kill(game: int) -> None:
    """Kill the process group of the game, then its descendants that left the group."""
    with suppress(OSError):
        os.killpg(game, signal.SIGKILL)
    while True:
        # A process whose parent has ended becomes a child of this process.
        for child in _children():
            with suppress(OSError):
                os.kill(child, signal.SIGKILL)
        try:
            os.waitpid(-1, 0)
        except ChildProcessError:
            return


def _children() -> list[int]:
    """Return the ids of the child processes of this process; none on systems other than Linux."""
    try:
        children = Path(f"/proc/self/task/{os.getpid()}/children").read_text(encoding="ascii")
        return [int(child) for child in children.split()]
    except OSError:
        return []


def _prctl(option: int, value: int) -> None:
    """Set an attribute of this process; without effect on systems other than Linux."""
    if sys.platform != "linux":
        return
    import ctypes

    with suppress(OSError, AttributeError):
        ctypes.CDLL(None).prctl(option, value, 0, 0, 0)


def _end(status: int) -> None:
    """End this process as the game ended: with the same exit status, or by the same signal.

    ``status`` is the result of :func:`main`. If the game did not end by itself, exit with status 0.
    """
    if status != -1 and os.WIFSIGNALED(status):
        import resource

        resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
        number = os.WTERMSIG(status)
        with suppress(OSError):
            signal.signal(number, signal.SIG_DFL)
        signal.pthread_sigmask(signal.SIG_SETMASK, [])
        os.kill(os.getpid(), number)
    os._exit(os.WEXITSTATUS(status) if status != -1 and os.WIFEXITED(status) else 0)


if __name__ == "__main__":
    _end(main(sys.argv[1:]))
