"""Handle Ctrl-C, SIGTERM and SIGHUP: clean up and end the command, and never report a bug."""

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
"""The signals that other programs and closing terminals send to end a process."""

_TEMPORARY: Final = "tltlc.io.temporary"
"""The module whose functions must not be interrupted, because files would be left behind."""

_RETRY_S: Final = 0.05
"""Seconds until the next attempt, if an interrupt comes while code runs that must not be interrupted."""

_PATIENCE_S: Final = 1.0
"""Seconds that an import may still take after an interrupt. After them, the process ends without cleaning up."""

_arrival_times: Final[dict[int, float]] = {}
"""Arrival times of interrupts that wait for an import to end, by signal number."""


@contextmanager
def end_on_signals() -> Iterator[None]:
    """Within the context, let SIGINT, SIGTERM and SIGHUP end the process with status 128 plus the signal's number.

    These signals raise KeyboardInterrupt, so finished work is kept and temporary files are removed.
    There are four special cases:

    - A signal that is already ignored stays ignored, such as SIGINT in a shell's background or
      SIGHUP under ``nohup``.
    - A program that this process starts has the default handlers, except for ignored signals.
    - A forked copy of this process has the default handlers of SIGTERM and SIGHUP, but SIGINT still
      raises KeyboardInterrupt there.
    - After the command, SIGINT is ignored, because the process is already ending.
    """
    try:
        _listen()
        yield
    except KeyboardInterrupt:
        sys.exit(exits.interrupted_status())
    finally:
        # During Python's shutdown a SIGINT would kill the process, or crash the threads of a library.
        signal.signal(signal.SIGINT, signal.SIG_IGN)
        _stop_listening()


def _listen() -> None:
    if hasattr(os, "register_at_fork"):
        # Programs that this process starts get the default handlers from exec. Forked copies need this.
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
    """Handle a signal: raise KeyboardInterrupt, now or as soon as the running code may be interrupted.

    Two kinds of code must not be interrupted. An import would turn the exception into another error
    or lose it; if the import takes too long, the process ends at once. Code that creates or removes
    temporary files would leave some behind.
    """
    if not _is_at_temporary_files(frame):
        if not _is_importing(frame):
            _arrival_times.pop(number, None)
            exits.received_signals.append(number)
            raise KeyboardInterrupt
        if monotonic() - _arrival_times.setdefault(number, monotonic()) > _PATIENCE_S:
            _end_process(128 + number)
    timer = Timer(_RETRY_S, _send_again, (number,))
    timer.daemon = True
    timer.start()


def _end_process(status: int) -> NoReturn:
    """Flush the standard streams and end the process at once."""
    for stream in (sys.stdout, sys.stderr):
        # The program that reads the stream may have ended.
        with suppress(OSError, ValueError):
            stream.flush()
    os._exit(status)


def _is_importing(frame: FrameType | None) -> bool:
    return any(caller.f_code.co_filename.startswith("<frozen importlib") for caller in _stack(frame))


def _is_at_temporary_files(frame: FrameType | None) -> bool:
    """Whether the interrupted code creates or removes temporary files, or enters or leaves a context manager."""
    is_at_with = frame is not None and frame.f_globals.get("__name__") == "contextlib"
    return is_at_with or any(caller.f_globals.get("__name__") == _TEMPORARY for caller in _stack(frame))


def _stack(frame: FrameType | None) -> Iterator[FrameType]:
    while frame is not None:
        yield frame
        frame = frame.f_back


def _send_again(number: int) -> None:
    ident = main_thread().ident
    if sys.platform == "win32" or ident is None:
        interrupt_main(signal.Signals(number))
    else:
        # This also ends a blocking system call.
        signal.pthread_kill(ident, number)
