"""Exit statuses, and the last word on every exception."""

from __future__ import annotations

import errno
import os
import re
import sys
from collections.abc import Iterable
from contextlib import suppress
from typing import Final

import click

from tltlc.diagnostics.diagnostic import Diagnostic, TltlError
from tltlc.io.resources import OutOfTimeError, exhausted

CLEAN: Final = 0
FINDINGS: Final = 1
USAGE: Final = 2
UNREADABLE: Final = 3
MISSING_COMPONENT: Final = 4
BUG: Final = 70
INTERRUPTED: Final = 130
CLOSED_PIPE: Final = 141

_STATUS_OF_CODE: Final = {
    "TLT0001": UNREADABLE,
    "TLT0005": UNREADABLE,
    "TLT0009": UNREADABLE,
    "TLT0700": USAGE,
    "TLT0710": USAGE,
    "TLT0720": USAGE,
    "TLT0721": USAGE,
    "TLT0722": USAGE,
    "TLT0730": MISSING_COMPONENT,
    "TLT0751": UNREADABLE,
    "TLT0764": UNREADABLE,
    "TLT0768": UNREADABLE,
    "TLT0776": USAGE,
    "TLT0800": USAGE,
    "TLT0815": USAGE,
}
"""The codes whose exit status is not that of an error in a source text."""

_COMPONENTS: Final = {"graphviz", "pygraphviz", "sympy", "networkx", "rich", "tomli"}
"""Modules that come with tltlc, and that an installation by parts may lack."""


heard: Final[list[int]] = []
"""The numbers of the signals that have ended the work of this process, the first one first."""

_NO_OUTPUT: Final = {errno.ENOSPC, errno.EDQUOT, errno.EFBIG, errno.EIO, errno.EBADF}
"""What standard output may say to a write; files that a command names have their own messages."""

_NO_LOOK: Final = {errno.ENAMETOOLONG, errno.EACCES, errno.EPERM, errno.ELOOP}
"""What the system may say of a path at which it is only asked whether something is there."""

_NO_ROOM: Final = {
    errno.EMFILE: "this process may open no more files",
    errno.ENFILE: "the system can open no more files",
    errno.EAGAIN: "the system can start no more processes",
    errno.ENOMEM: "there is not enough memory",
}
"""What the system lacks, by what it says to whoever asks for a file or a process."""

_NO_NUMBER: Final = re.compile(r"'([^']*)' is not a valid (float|integer)(?: range)?")


class StopQuietlyError(Exception):
    """Ends the command with a status and no message: nobody is there to read one."""

    def __init__(self, status: int) -> None:
        super().__init__(status)
        self.status = status


def status_of(diagnostics: Iterable[Diagnostic]) -> int:
    """The exit status for what was found: the greatest of its errors', whatever their order; 0 where there is none."""
    errors = (diagnostic.code for diagnostic in diagnostics if diagnostic.severity == "error")
    return max((_STATUS_OF_CODE.get(code, FINDINGS) for code in errors), default=CLEAN)


def interrupted() -> int:
    """The exit status of a command that a signal has ended: 128 and the signal's number, by default that of Ctrl-C."""
    return 128 + heard[0] if heard else INTERRUPTED


def missing_component(wanted_by: str, module: str, requirement: str) -> TltlError:
    """The error for a part that is not installed; extras of tltlc itself are installed from its clone."""
    title = f"{wanted_by} needs `{module}`, which is not installed"
    own = requirement.startswith("tltlc[")
    way_out = f"in the clone of tltlc: pip install -c constraints.txt '{requirement.replace('tltlc', '.')}'"
    return TltlError([Diagnostic("TLT0730", title, help=way_out if own else f"pip install '{requirement}'")])


def report(error: Exception | OutOfTimeError) -> int:
    """Say on standard error what went wrong and return the exit status."""
    if spent := exhausted(error):
        # What was running keeps its memory for as long as the error says where it was.
        error.__traceback__ = error.__context__ = error.__cause__ = None
        error = spent
    if isinstance(error, BrokenPipeError):
        error = StopQuietlyError(CLOSED_PIPE)
    if isinstance(error, StopQuietlyError):
        if error.status == CLOSED_PIPE:
            _discard_output()
        return error.status
    if isinstance(error, click.exceptions.Exit):
        return error.exit_code
    if isinstance(error, click.Abort):
        return interrupted()
    if isinstance(error, click.ClickException):
        error = TltlError([_usage(error)])
    if isinstance(error, ModuleNotFoundError) and (component := (error.name or "").partition(".")[0]) in _COMPONENTS:
        error = missing_component("this command", component, component)
    if isinstance(error, OSError) and error.filename is None and error.errno in _NO_OUTPUT:
        _discard_output()
        error = _no_output(error)
    if not isinstance(error, TltlError) and (lacking := _lacking(error)) is not None:
        help_ = "`ulimit -a` shows your limits: raise the one that is too small, or close other programs"
        error = TltlError([Diagnostic("TLT0768", lacking, help=help_)])
    if isinstance(error, OSError) and error.filename is not None and error.errno in _NO_LOOK:
        error = _refused_path(error)
    if isinstance(error, TltlError):
        from tltlc.interfaces.cli.report import show

        # Standard error may be full, too.
        with suppress(OSError):
            show(error.diagnostics, "text", sys.stderr)
        return status_of(error.diagnostics)
    return interrupted() if is_interrupted(error) else _bug(error)


def is_interrupted(error: BaseException | None) -> bool:
    """Whether an exception is what a library has made of an interrupt."""
    while error is not None:
        if isinstance(error, KeyboardInterrupt):
            return True
        error = error.__cause__ or error.__context__
    return False


def _lacking(error: BaseException | None) -> str | None:
    """What the system lacks for this command; None if an exception, or one that led to it, is about something else."""
    while error is not None:
        if isinstance(error, MemoryError):
            return _NO_ROOM[errno.ENOMEM]
        if isinstance(error, OSError) and error.errno in _NO_ROOM:
            return _NO_ROOM[error.errno]
        error = error.__cause__ or error.__context__
    return None


def _usage(error: click.ClickException) -> Diagnostic:
    """A complaint about the command line, as a diagnostic."""
    # click lists choices one a line.
    message = " ".join(error.format_message().rstrip(".").split())
    context = error.ctx if isinstance(error, click.UsageError) else None
    command = context.command_path if context else "tltlc"
    message = _NO_NUMBER.sub(lambda found: _number_wanted(found[1], found[2]), message)
    if message[1:2].islower():
        message = message[0].lower() + message[1:]
    return Diagnostic("TLT0700", message, help=f"`{command} --help` shows how to use it")


def _number_wanted(text: str, kind: str) -> str:
    """What click says in the words of its types."""
    wanted = f"`{text}` is no {'whole ' if kind == 'integer' else ''}number"
    pointed = text.replace(",", ".", 1)
    return f"{wanted}; write {pointed}" if kind == "float" and re.fullmatch(r"-?\d+\.\d+", pointed) else wanted


def flush() -> None:
    """Flush standard output and drop what it does not take: at the end of Python that would change the exit status."""
    try:
        sys.stdout.flush()
    except (OSError, ValueError):
        _discard_output()


def _no_output(error: OSError) -> TltlError:
    from tltlc.io.files import reason

    closed = error.errno == errno.EBADF
    title = f"cannot write to standard output: {'it is closed' if closed else reason(error)}"
    help_ = "send it to a file, or to /dev/null" if closed else "make room, or send it to another place"
    return TltlError([Diagnostic("TLT0005", title, help=help_)])


def _refused_path(error: OSError) -> TltlError:
    from tltlc.io.files import reason

    title = f"cannot look at `{os.fsdecode(error.filename)}`: {reason(error)}"
    return TltlError([Diagnostic("TLT0001", title, help="check its name and its permissions")])


def _discard_output() -> None:
    """Let Python's own flush at exit go nowhere: whoever read our output has gone, or is full."""
    # Where standard output is no file of the system, nothing is flushed to one.
    with suppress(OSError, ValueError):
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())


def _bug(error: BaseException) -> int:
    """An exception that nobody foresaw: a short reference for the report, the traceback only when asked for."""
    import traceback
    import zlib

    from tltlc import __version__

    if os.environ.get("TLTLC_DEBUG") == "1":
        traceback.print_exception(error)
    place = traceback.extract_tb(error.__traceback__)[-1]
    where = f"{type(error).__name__} {os.path.basename(place.filename)}:{place.lineno}"  # noqa: PTH119
    print(
        f"error: a bug in tltlc stopped this command (reference {zlib.crc32(where.encode()):08x})\n"
        f"  Please report it with this reference, the version ({__version__}) and the files that caused it.\n"
        "  TLTLC_DEBUG=1 in the environment shows where it happened.",
        file=sys.stderr,
    )
    return BUG
