"""Limit the processor time and the memory of a command.

The limits in :mod:`tltlc.io.limits` count bytes and steps, so they give the same result on every
machine. This module stops a command that takes too much time or memory although its input exceeds
none of those limits. Its own limits depend on the machine, so they are far above what any ordinary
file needs. They apply only to the commands of tltlc: a program that imports tltlc keeps its own
signal handlers and limits.
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
from tltlc.io.limits import ProcessLimit

_AGAIN_S = 1.0
"""Seconds of processor time between two signals after the time is used up.

One signal may not be enough: Python ignores an exception that a signal handler raises in a
destructor.
"""

_command_limits: list[ProcessLimit] = []
"""The limits of the command that this process runs, as a list of one entry.

The list is empty if the process runs no command.
"""

_active: list[bool] = []
"""Has an entry inside a ``with`` block of :func:`resource_limits`, and is empty elsewhere."""


class OutOfTimeError(BaseException):
    """Raised when the processor time is used up.

    It is a BaseException, so that no ``except Exception`` catches it.
    """


def permit(process: ProcessLimit) -> None:
    """Set how much memory and processor time :func:`resource_limits` allows this process.

    A value of 0 means that there is no limit.
    """
    _command_limits[:] = [process]


def permitted() -> ProcessLimit | None:
    """Return the limits that :func:`permit` has set; None if it was not called."""
    return _command_limits[0] if _command_limits else None


@contextmanager
def resource_limits() -> Iterator[None]:
    """Limit the processor time and the memory of the ``with`` block to what :func:`permit` has set.

    If the block uses more, OutOfTimeError or MemoryError is raised in it. The function does nothing
    if :func:`permit` was not called, outside the main thread, and inside another of its ``with``
    blocks.
    """
    if not _command_limits or _active or current_thread() is not main_thread():
        # Only the main thread receives signals, and an outer block has set the limits already.
        yield
        return
    _active.append(True)
    try:
        with _memory_limit(_command_limits[0].memory), _time_limit(_command_limits[0].work_s), _quiet_destructors():
            yield
    finally:
        _active.clear()


def limit(name: str, most: int) -> None:
    """Set a resource limit of this process to ``most``, or to the hard limit if that is lower.

    The process cannot raise the limit again. ``name`` is a name in the module :mod:`resource`, such
    as ``RLIMIT_AS``. Do nothing if the system does not support the limit.
    """
    # Windows has no `resource` module, and other systems refuse some limits.
    with suppress(ImportError, AttributeError, OSError, ValueError):
        import resource

        kind = getattr(resource, name)
        hard = resource.getrlimit(kind)[1]
        soft = most if hard == resource.RLIM_INFINITY else min(most, hard)
        resource.setrlimit(kind, (soft, soft))


@contextmanager
def _quiet_destructors() -> Iterator[None]:
    """Suppress Python's messages about destructors that ran out of memory or time.

    The command itself runs out of memory or time soon after, and reports this. This function
    replaces ``sys.unraisablehook``. If there is not enough memory left to call the hook, Python
    still prints a message.
    """
    previous = sys.unraisablehook

    def hook(unraisable: sys.UnraisableHookArgs) -> None:
        if not issubclass(unraisable.exc_type, (MemoryError, OutOfTimeError)):
            previous(unraisable)

    sys.unraisablehook = hook
    try:
        yield
    finally:
        sys.unraisablehook = previous


@contextmanager
def _time_limit(seconds: float) -> Iterator[None]:
    if not seconds or not hasattr(signal, "setitimer"):
        yield
        return
    previous = signal.signal(signal.SIGPROF, _raise_out_of_time)
    signal.setitimer(signal.ITIMER_PROF, seconds, _AGAIN_S)
    try:
        yield
    finally:
        signal.setitimer(signal.ITIMER_PROF, 0)
        signal.signal(signal.SIGPROF, previous)


def _raise_out_of_time(number: int, frame: FrameType | None) -> NoReturn:
    raise OutOfTimeError


@contextmanager
def _memory_limit(size: int) -> Iterator[None]:
    """Inside the ``with`` block, limit the memory of the process to ``size`` bytes; 0 means no limit.

    Mapped files, such as libraries, do not count.
    """
    try:
        import resource
    except ImportError:
        yield
        return
    previous, hard = resource.getrlimit(resource.RLIMIT_DATA)
    bounds = [limit for limit in (previous, size) if limit not in (resource.RLIM_INFINITY, 0)]
    if not size or not bounds:
        yield
        return
    # Some systems have the limit but refuse to set it.
    with suppress(OSError, ValueError):
        resource.setrlimit(resource.RLIMIT_DATA, (min(bounds), hard))
    try:
        yield
    finally:
        with suppress(OSError, ValueError):
            resource.setrlimit(resource.RLIMIT_DATA, (previous, hard))


def exhaustion_error(error: BaseException) -> TltlError | None:
    """Return the error TLT0007 for an OutOfTimeError, MemoryError or RecursionError.

    Return None for any other exception.
    """
    permitted = _command_limits[0] if _command_limits else ProcessLimit(memory=0, work_s=0)
    if isinstance(error, OutOfTimeError):
        seconds = "1 second" if permitted.work_s == 1 else f"{permitted.work_s} seconds"
        title = f"the command did not finish within {seconds} of processor time"
        help_ = "make its input smaller, or allow more: `tltlc --max-cpu SECONDS COMMAND …`"
    elif isinstance(error, MemoryError):
        title, help_ = "the command ran out of memory", "make its input smaller"
        if permitted.memory and sys.platform != "win32":
            title += f" (it may use {permitted.memory / 2**30:g} GiB)"
            help_ += ", or allow more: `tltlc --max-memory GIB COMMAND …`"
    elif isinstance(error, RecursionError):
        title, help_ = "the input is nested too deeply for this command", "reduce its nesting"
    else:
        return None
    return TltlError([Diagnostic("TLT0007", title, help=help_)])
