"""Children that answer requests, each one of them, and are ended where that takes too long or nobody waits any more."""

from __future__ import annotations

import signal
import subprocess
import sys
from collections.abc import Callable
from contextlib import suppress
from threading import BoundedSemaphore, Lock, Thread
from time import monotonic
from typing import Final

from tltlc.interfaces.playground.child import NO_MEMORY, NO_REQUEST
from tltlc.interfaces.playground.protocol import TOO_LARGE, gave_up, gave_up_on_size
from tltlc.io.limits import ANSWER

LIMIT_S: Final = 10.0
MOST_AT_ONCE: Final = 4
_LOOK_S: Final = 0.1
"""Between two looks at whether somebody still waits."""

_REPORT: Final = "try again; if it ends again, report it with the text"
_KILLED: Final = "try again; the system does this if memory is short, and then a smaller spec may help"


class AbandonedError(Exception):
    """Nobody waits for the answer any more."""


class Children:
    """Answers requests, at most :data:`MOST_AT_ONCE` at a time; one child is always loaded already."""

    def __init__(self, limit_s: float = LIMIT_S) -> None:
        self._limit_s = limit_s
        self._room = BoundedSemaphore(MOST_AT_ONCE)
        self._lock = Lock()
        self._ready: subprocess.Popen[bytes] | None = _started()
        self._running: set[subprocess.Popen[bytes]] = set()
        self._closed = False

    def answer(self, request: bytes, is_abandoned: Callable[[], bool] = lambda: False) -> str | None:
        """The answer of :func:`tltlc.interfaces.playground.protocol.answer`, or None for what is no request.

        Raises AbandonedError as soon as nobody waits any more, and OSError where no process can be started.
        """
        if not request:
            return None
        while not self._room.acquire(timeout=_LOOK_S):
            _check(is_abandoned)
        try:
            child = self._taken()
            try:
                said = _answer(child, request, self._limit_s, is_abandoned)
            finally:
                self._put_back(child)
        except subprocess.TimeoutExpired:
            return gave_up(f"this takes longer than {self._limit_s:g} s, and was given up")
        finally:
            self._room.release()
        if child.returncode == NO_REQUEST:
            return None
        if len(said) > ANSWER.size:
            return gave_up_on_size()
        if child.returncode or not said:
            # Whoever closes this kills the children that work.
            _check(lambda: self._closed)
            return _failed(child.returncode)
        return said.decode("utf-8")

    def close(self) -> None:
        """End the child that waits, and those that work: their requests are abandoned."""
        with self._lock:
            self._closed = True
            for child in self._running:
                child.kill()
            if self._ready is not None:
                _end(self._ready)
                self._ready = None

    def _taken(self) -> subprocess.Popen[bytes]:
        with self._lock:
            if self._closed:
                raise AbandonedError
            ready, self._ready = self._ready, None
            if ready is not None and ready.poll() is not None:
                # It ended while it waited.
                _end(ready)
                ready = None
            child = ready or _started()
            self._running.add(child)
            return child

    def _put_back(self, child: subprocess.Popen[bytes]) -> None:
        """End a child, and have another one ready."""
        _end(child)
        with self._lock:
            self._running.discard(child)
            if not self._closed and self._ready is None:
                # Where the system has no room for another process now, the next request tries again.
                with suppress(OSError):
                    self._ready = _started()


def _answer(child: subprocess.Popen[bytes], request: bytes, limit_s: float, is_abandoned: Callable[[], bool]) -> bytes:
    """What a child answers, at most one byte more than an answer may have.

    Raises AbandonedError, and TimeoutExpired after ``limit_s`` seconds.
    """
    end = monotonic() + limit_s
    answered: list[bytes] = []
    talk = Thread(target=lambda: answered.append(_exchange(child, request)))
    talk.start()
    try:
        while talk.is_alive():
            _check(is_abandoned)
            if (left := end - monotonic()) <= 0:
                raise subprocess.TimeoutExpired(child.args, limit_s)
            talk.join(min(_LOOK_S, left))
    finally:
        if talk.is_alive():
            child.kill()
            talk.join()
    return answered[0] if answered else b""


def _exchange(child: subprocess.Popen[bytes], request: bytes) -> bytes:
    """Send all of a request, then read the answer: a child reads everything before it writes."""
    assert child.stdin is not None
    assert child.stdout is not None
    # A child that has ended reads nothing; its exit status says why.
    with suppress(OSError):
        child.stdin.write(request)
        child.stdin.close()
    answered = child.stdout.read(ANSWER.size + 1)
    if len(answered) > ANSWER.size:
        child.kill()
    child.wait()
    return answered


def _failed(status: int) -> str:
    """The answer where a child ended without one: what it ended with, and no cause that is not known."""
    if status == NO_MEMORY:
        return gave_up(TOO_LARGE)
    if status >= 0:
        return gave_up(f"the compiler's process ended with exit status {status}", _REPORT)
    title = f"the signal {_signal_name(-status)} ended the compiler's process"
    is_killed = -status == getattr(signal, "SIGKILL", None)
    return gave_up(title, _KILLED if is_killed else _REPORT)


def _signal_name(number: int) -> str:
    try:
        return signal.Signals(number).name
    except ValueError:
        return str(number)


def _check(is_abandoned: Callable[[], bool]) -> None:
    if is_abandoned():
        raise AbandonedError


def _started() -> subprocess.Popen[bytes]:
    # It finds modules where this process does, and never in a folder that specs happen to lie in.
    program = f"import sys; sys.path[:] = {sys.path!r}; from tltlc.interfaces.playground.child import main; main()"
    return subprocess.Popen(
        [sys.executable, "-c", program],
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        stderr=subprocess.DEVNULL,
    )


def _end(child: subprocess.Popen[bytes]) -> None:
    child.kill()
    for stream in (child.stdin, child.stdout):
        if stream is not None:
            stream.close()
    child.wait()
