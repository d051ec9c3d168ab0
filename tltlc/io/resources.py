"""Bounds on the processor time and the memory of a command, for where no limit of :mod:`tltlc.io.limits` ends it first.

Limits that count bytes or steps give the same answer on every machine.  These depend on the machine, so they are far
above what any file needs that is not made to do harm.  Only a process that is one command has them: a program that
imports tltlc keeps its signals and its limits.
"""

from __future__ import annotations

import signal
import sys
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from threading import current_thread, main_thread
from types import FrameType
from typing import NoReturn

from tltlc.diagnostics.diagnostic import Diagnostic, TltlError
from tltlc.io.limits import Process

_AGAIN_S = 1.0
"""From one signal to the next: where Python drops what a handler raises, as in a destructor, the next one ends it."""

_permitted: list[Process] = []
"""What the command of this process may use; empty where the process is none."""

_holding: list[bool] = []
"""Not empty while bounds are held."""


class OutOfTimeError(BaseException):
    """The processor time is used up.  No ``except Exception`` on the way keeps the command from ending."""


def permit(process: Process) -> None:
    """Make this process one command, which may use so much; 0 stands for no bound."""
    _permitted[:] = [process]


@contextmanager
def bounded() -> Iterator[None]:
    """Within, the work ends with OutOfTimeError or MemoryError beyond what :func:`permit` has permitted.

    Bounds within bounds are one: the outer ones count.  Where nothing was permitted there are none.
    """
    if not _permitted or _holding or current_thread() is not main_thread():
        # Signals come to the main thread.
        yield
        return
    _holding.append(True)
    try:
        with _memory(_permitted[0].memory), _time(_permitted[0].work_s), _quiet_destructors():
            yield
    finally:
        _holding.clear()


def limit(name: str, most: int) -> None:
    """Limit this process for good, as ``RLIMIT_AS`` or another name of :mod:`resource` says, where the system can."""
    # Windows has no such module, and other systems refuse some limits.
    with suppress(ImportError, AttributeError, OSError, ValueError):
        import resource

        kind = getattr(resource, name)
        hard = resource.getrlimit(kind)[1]
        least = most if hard == resource.RLIM_INFINITY else min(most, hard)
        resource.setrlimit(kind, (least, least))


@contextmanager
def _quiet_destructors() -> Iterator[None]:
    """Keep Python from printing that a destructor ran out of memory or time: the command itself soon does, and says so.

    A generator that is thrown away is ended by such a destructor.  Where there is not even room to call the hook,
    Python prints one line.
    """
    before = sys.unraisablehook

    def hook(unraisable: sys.UnraisableHookArgs) -> None:
        if not issubclass(unraisable.exc_type, (MemoryError, OutOfTimeError)):
            before(unraisable)

    sys.unraisablehook = hook
    try:
        yield
    finally:
        sys.unraisablehook = before


@contextmanager
def _time(seconds: float) -> Iterator[None]:
    if not seconds or not hasattr(signal, "setitimer"):
        yield
        return
    before = signal.signal(signal.SIGPROF, _end)
    signal.setitimer(signal.ITIMER_PROF, seconds, _AGAIN_S)
    try:
        yield
    finally:
        signal.setitimer(signal.ITIMER_PROF, 0)
        signal.signal(signal.SIGPROF, before)


def _end(number: int, frame: FrameType | None) -> NoReturn:
    raise OutOfTimeError


@contextmanager
def _memory(size: int) -> Iterator[None]:
    """Bound what the process writes to; files that it maps, such as libraries, do not count."""
    try:
        import resource
    except ImportError:
        yield
        return
    before, hard = resource.getrlimit(resource.RLIMIT_DATA)
    lower = [limit for limit in (before, size) if limit not in (resource.RLIM_INFINITY, 0)]
    if not size or not lower:
        yield
        return
    # Some systems know the limit and refuse to set it.
    with suppress(OSError, ValueError):
        resource.setrlimit(resource.RLIMIT_DATA, (min(lower), hard))
    try:
        yield
    finally:
        with suppress(OSError, ValueError):
            resource.setrlimit(resource.RLIMIT_DATA, (before, hard))


def exhausted(error: BaseException) -> TltlError | None:
    """TLT0007 for OutOfTimeError, MemoryError and RecursionError; None for others."""
    permitted = _permitted[0] if _permitted else Process(memory=0, work_s=0)
    if isinstance(error, OutOfTimeError):
        title = f"the command was not done after {permitted.work_s} seconds of processor time"
        help_ = "make its input smaller, or permit more: `tltlc --max-cpu SECONDS COMMAND …`"
    elif isinstance(error, MemoryError):
        title, help_ = "the command ran out of memory", "make its input smaller"
        if permitted.memory and sys.platform != "win32":
            title += f" (it may use {permitted.memory / 2**30:g} GiB)"
            help_ += ", or permit more: `tltlc --max-memory GIB COMMAND …`"
    elif isinstance(error, RecursionError):
        title, help_ = "the input nests too deeply for this command", "flatten what nests in it"
    else:
        return None
    return TltlError([Diagnostic("TLT0007", title, help=help_)])
