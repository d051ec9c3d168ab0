"""Child processes that run the compiler; each answers one request of the playground.

The server ends a child that takes too long, or whose client has gone.
"""

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
from tltlc.interfaces.playground.protocol import TOO_LARGE, error_answer, size_error_answer
from tltlc.io.limits import ANSWER

LIMIT_S: Final = 10.0
"""Seconds that a child may take for an answer."""
MOST_AT_ONCE: Final = 4
"""The most requests that are answered at the same time."""
_CHECK_S: Final = 0.1
"""Seconds between two checks whether the client still waits."""

_REPORT_HELP: Final = "try again; if this happens again, report it with the text"
_KILLED_HELP: Final = "try again; the system does this if memory is short, and then a smaller spec may help"


class AbandonedError(Exception):
    """Raised if nobody waits for the answer to a request: the client has gone, or the server is closing."""


class Children:
    """Answers requests in child processes, at most :data:`MOST_AT_ONCE` at a time.

    A request may take at most ``limit_s`` seconds. A child needs time to load the compiler, so one
    child starts in advance and waits for the next request.
    """

    def __init__(self, limit_s: float = LIMIT_S) -> None:
        self._limit_s = limit_s
        self._slots = BoundedSemaphore(MOST_AT_ONCE)
        self._lock = Lock()
        self._ready: subprocess.Popen[bytes] | None = _start_child()
        self._running: set[subprocess.Popen[bytes]] = set()
        self._closed = False

    def answer(self, request: bytes, is_abandoned: Callable[[], bool] = lambda: False) -> str | None:
        """Return a child's answer to a request, as JSON; None if the bytes are not a valid request.

        The child calls :func:`tltlc.interfaces.playground.protocol.answer`. If it takes too long,
        fails or answers too much, return an answer with an error instead. ``is_abandoned()`` says
        whether the client no longer waits.

        Raises AbandonedError as soon as the client no longer waits, or if :meth:`close` is called,
        and OSError if no process can be started.
        """
        if not request:
            return None
        while not self._slots.acquire(timeout=_CHECK_S):
            _check(is_abandoned)
        try:
            child = self._take_child()
            try:
                response = _answer(child, request, self._limit_s, is_abandoned)
            finally:
                self._replace_child(child)
        except subprocess.TimeoutExpired:
            return error_answer(f"this takes longer than {self._limit_s:g} s, so it was stopped")
        finally:
            self._slots.release()
        if child.returncode == NO_REQUEST:
            return None
        if len(response) > ANSWER.size:
            return size_error_answer()
        if child.returncode or not response:
            # If `close` killed the child, the request is abandoned.
            _check(lambda: self._closed)
            return _failure_answer(child.returncode)
        return response.decode("utf-8")

    def close(self) -> None:
        """End all children; :meth:`answer` then raises AbandonedError for the requests that are being answered."""
        with self._lock:
            self._closed = True
            for child in self._running:
                child.kill()
            if self._ready is not None:
                _end(self._ready)
                self._ready = None

    def _take_child(self) -> subprocess.Popen[bytes]:
        with self._lock:
            if self._closed:
                raise AbandonedError
            ready, self._ready = self._ready, None
            if ready is not None and ready.poll() is not None:
                # The child ended while it waited for a request.
                _end(ready)
                ready = None
            child = ready or _start_child()
            self._running.add(child)
            return child

    def _replace_child(self, child: subprocess.Popen[bytes]) -> None:
        """End a child, and start another one that waits for the next request."""
        _end(child)
        with self._lock:
            self._running.discard(child)
            if not self._closed and self._ready is None:
                # If the system has no room for another process now, the next request tries again.
                with suppress(OSError):
                    self._ready = _start_child()


def _answer(child: subprocess.Popen[bytes], request: bytes, limit_s: float, is_abandoned: Callable[[], bool]) -> bytes:
    """Send a request to a child, and return the child's answer.

    If the answer is larger than :data:`tltlc.io.limits.ANSWER` allows, return only its start, one
    byte more than is allowed. Raises AbandonedError if the client no longer waits, and
    subprocess.TimeoutExpired after ``limit_s`` seconds.
    """
    end = monotonic() + limit_s
    responses: list[bytes] = []
    talk = Thread(target=lambda: responses.append(_exchange(child, request)))
    talk.start()
    try:
        while talk.is_alive():
            _check(is_abandoned)
            if (remaining_s := end - monotonic()) <= 0:
                raise subprocess.TimeoutExpired(child.args, limit_s)
            talk.join(min(_CHECK_S, remaining_s))
    finally:
        if talk.is_alive():
            child.kill()
            talk.join()
    return responses[0] if responses else b""


def _exchange(child: subprocess.Popen[bytes], request: bytes) -> bytes:
    """Send the whole request to a child, then read and return the answer, and wait for the child to end.

    A child reads everything before it writes, so neither waits for the other. At most one byte more
    than :data:`tltlc.io.limits.ANSWER` allows is read; after that, the child is killed.
    """
    assert child.stdin is not None
    assert child.stdout is not None
    # If the child has ended already, it reads nothing. Its exit status says why it ended.
    with suppress(OSError):
        child.stdin.write(request)
        child.stdin.close()
    response = child.stdout.read(ANSWER.size + 1)
    if len(response) > ANSWER.size:
        child.kill()
    child.wait()
    return response


def _failure_answer(status: int) -> str:
    """Return the answer with an error, as JSON, for a child that failed with exit status ``status``.

    A negative status is the number of the signal that ended the child.
    """
    if status == NO_MEMORY:
        return error_answer(TOO_LARGE)
    if status >= 0:
        return error_answer(f"the compiler's process ended with exit status {status}", _REPORT_HELP)
    title = f"the signal {_signal_name(-status)} ended the compiler's process"
    is_killed = -status == getattr(signal, "SIGKILL", None)
    return error_answer(title, _KILLED_HELP if is_killed else _REPORT_HELP)


def _signal_name(number: int) -> str:
    try:
        return signal.Signals(number).name
    except ValueError:
        return str(number)


def _check(is_abandoned: Callable[[], bool]) -> None:
    if is_abandoned():
        raise AbandonedError


def _start_child() -> subprocess.Popen[bytes]:
    # Use the same module search path as this process, so that modules never come from the folder of the specs.
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
