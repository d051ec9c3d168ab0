"""Signals end a command in order: Ctrl-C, SIGTERM and SIGHUP clean up, and are never taken for a fault of tltlc."""

from __future__ import annotations

import os
import signal
import sys
from _thread import interrupt_main
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from threading import Timer, main_thread
from time import monotonic
from types import FrameType
from typing import Final, NoReturn

from tltlc.interfaces.cli import exits
from tltlc.interfaces.cli.main import end_at_once

REQUESTS: Final = tuple(getattr(signal, name) for name in ("SIGTERM", "SIGHUP") if hasattr(signal, name))
"""The signals by which other programs, and a terminal that is closed, ask a process to end."""

_TEMPORARY: Final = "tltlc.io.temporary"
"""The module whose functions must not be interrupted."""

_AGAIN_S: Final = 0.05
"""From an interrupt that came in the middle of such code to the next attempt."""

_PATIENCE_S: Final = 1.0
"""From the first one to the end of the process, if by then nothing but imports has gone on."""

_came: Final[dict[int, float]] = {}
"""When the interrupts came that wait for the end of an import, by their signals."""


@contextmanager
def signals_end() -> Iterator[None]:
    """Within, the process is one command: SIGINT, SIGTERM and SIGHUP end it with 128 and the signal's number.

    They raise KeyboardInterrupt, so that what was done is kept and temporary files are removed on the way out.  A
    signal that is ignored, as SIGINT in the background of a shell or SIGHUP under ``nohup``, stays ignored.  A program
    that is started has the defaults for those that are not ignored.  A forked copy of this process has the defaults for
    SIGTERM and SIGHUP, but SIGINT still raises KeyboardInterrupt there.  After the command, SIGINT is ignored: its own
    end has begun.
    """
    try:
        _listen()
        yield
    except KeyboardInterrupt:
        sys.exit(exits.interrupted())
    finally:
        # Python's own end would turn it into a death by the signal, or into a crash of a library's threads.
        signal.signal(signal.SIGINT, signal.SIG_IGN)
        _stop_listening()


def _listen() -> None:
    if hasattr(os, "register_at_fork"):
        # Programs that are started get the defaults from the system.
        os.register_at_fork(after_in_child=_stop_listening)
    if signal.getsignal(signal.SIGINT) in (signal.default_int_handler, end_at_once):
        signal.signal(signal.SIGINT, interrupt)
    for number in REQUESTS:
        if signal.getsignal(number) == signal.SIG_DFL:
            signal.signal(number, interrupt)


def _stop_listening() -> None:
    for number in REQUESTS:
        if signal.getsignal(number) not in (signal.SIG_DFL, signal.SIG_IGN, None):
            signal.signal(number, signal.SIG_DFL)


def interrupt(number: int, frame: FrameType | None) -> None:
    """The handler of a signal: raises KeyboardInterrupt, as soon as no code runs that must not be interrupted.

    Half-imported modules turn the exception into errors of their own, or lose it; an import that takes long ends with
    the process.  Temporary files would stay if the code that makes and removes them were interrupted, by a second
    signal for instance.
    """
    if not _is_at_temporary_files(frame):
        if not _is_importing(frame):
            _came.pop(number, None)
            exits.heard.append(number)
            raise KeyboardInterrupt
        if monotonic() - _came.setdefault(number, monotonic()) > _PATIENCE_S:
            _end(128 + number)
    again = Timer(_AGAIN_S, _send_again, (number,))
    again.daemon = True
    again.start()


def _end(status: int) -> NoReturn:
    """End at once, with what was printed."""
    for stream in (sys.stdout, sys.stderr):
        # Whoever reads it may have gone.
        with suppress(OSError, ValueError):
            stream.flush()
    os._exit(status)


def _is_importing(frame: FrameType | None) -> bool:
    return any(each.f_code.co_filename.startswith("<frozen importlib") for each in _stack(frame))


def _is_at_temporary_files(frame: FrameType | None) -> bool:
    """Whether temporary files are made or removed now, or a ``with`` that may do so is about to begin or end."""
    is_at_with = frame is not None and frame.f_globals.get("__name__") == "contextlib"
    return is_at_with or any(each.f_globals.get("__name__") == _TEMPORARY for each in _stack(frame))


def _stack(frame: FrameType | None) -> Iterator[FrameType]:
    while frame is not None:
        yield frame
        frame = frame.f_back


def _send_again(number: int) -> None:
    ident = main_thread().ident
    if sys.platform == "win32" or ident is None:
        interrupt_main(signal.Signals(number))
    else:
        # Ends a wait for the system, too.
        signal.pthread_kill(ident, number)
