"""Exit statuses, and the messages for exceptions that end a command."""

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
from tltlc.io.resources import OutOfTimeError, exhaustion_error

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
    "TLT0731": USAGE,
    "TLT0751": UNREADABLE,
    "TLT0764": UNREADABLE,
    "TLT0768": UNREADABLE,
    "TLT0776": USAGE,
    "TLT0800": USAGE,
    "TLT0815": USAGE,
}
"""Exit statuses of diagnostic codes; errors with other codes have the status FINDINGS."""

_COMPONENTS: Final = {"graphviz", "pygraphviz", "sympy", "networkx", "rich", "tomli"}
"""Packages that tltlc depends on but that a partial installation may lack."""


received_signals: Final[list[int]] = []
"""Numbers of the signals that ended the work of this process, in order of arrival."""

_OUTPUT_ERRORS: Final = {errno.ENOSPC, errno.EDQUOT, errno.EFBIG, errno.EIO, errno.EBADF}
"""Errors of the system that writing to standard output may raise.

Errors in writing files are reported where they occur.
"""

_PATH_ERRORS: Final = {errno.ENAMETOOLONG, errno.EACCES, errno.EPERM, errno.ELOOP}
"""Errors that the system may raise when a program only checks whether a path exists."""

_RESOURCE_MESSAGES: Final = {
    errno.EMFILE: "this process cannot open more files",
    errno.ENFILE: "the system cannot open more files",
    errno.EAGAIN: "the system cannot start more processes",
    errno.ENOMEM: "there is not enough memory",
}
"""The message for each error that the system raises if a resource is used up."""

_INVALID_NUMBER: Final = re.compile(r"'([^']*)' is not a valid (float|integer)(?: range)?")


class StopQuietlyError(Exception):
    """Raised to end the command with an exit status and without a message."""

    def __init__(self, status: int) -> None:
        super().__init__(status)
        self.status = status


def status_of(diagnostics: Iterable[Diagnostic]) -> int:
    """Return the greatest exit status of the errors among the diagnostics; 0 without errors."""
    errors = (diagnostic.code for diagnostic in diagnostics if diagnostic.severity == "error")
    return max((_STATUS_OF_CODE.get(code, FINDINGS) for code in errors), default=CLEAN)


def interrupted_status() -> int:
    """Return the exit status after a signal: 128 plus the number of the first received signal.

    If no signal was recorded, return 130, the status after Ctrl-C.
    """
    return 128 + received_signals[0] if received_signals else INTERRUPTED


def missing_component(wanted_by: str, module: str, requirement: str) -> TltlError:
    """Return error TLT0730 for a Python module that is not installed.

    ``wanted_by`` names the command or feature that needs the module. ``requirement`` is the argument
    for ``pip install`` in the help. For an extra of tltlc, such as ``tltlc[game]``, the help says how
    to install it from a clone.
    """
    title = f"{wanted_by} needs `{module}`, which is not installed"
    is_extra = requirement.startswith("tltlc[")
    extra_help = f"in the clone of tltlc: pip install -c constraints.txt '{requirement.replace('tltlc', '.')}'"
    return TltlError([Diagnostic("TLT0730", title, help=extra_help if is_extra else f"pip install '{requirement}'")])


def report(error: Exception | OutOfTimeError) -> int:
    """Print the message, if any, for the exception that ended a command, and return the exit status."""
    if limit_error := exhaustion_error(error):
        # The traceback would keep the memory of the interrupted work alive.
        error.__traceback__ = error.__context__ = error.__cause__ = None
        error = limit_error
    if isinstance(error, BrokenPipeError):
        error = StopQuietlyError(CLOSED_PIPE)
    if isinstance(error, StopQuietlyError):
        if error.status == CLOSED_PIPE:
            _discard_output()
        return error.status
    if isinstance(error, click.exceptions.Exit):
        return error.exit_code
    if isinstance(error, click.Abort):
        return interrupted_status()
    if isinstance(error, click.ClickException):
        error = TltlError([_usage_diagnostic(error)])
    if isinstance(error, ModuleNotFoundError) and (component := (error.name or "").partition(".")[0]) in _COMPONENTS:
        error = missing_component("this command", component, component)
    if isinstance(error, OSError) and error.filename is None and error.errno in _OUTPUT_ERRORS:
        _discard_output()
        error = _output_error(error)
    if not isinstance(error, TltlError) and (missing := _missing_resource(error)) is not None:
        help_ = "`ulimit -a` shows your limits: raise the one that is too small, or close other programs"
        error = TltlError([Diagnostic("TLT0768", missing, help=help_)])
    if isinstance(error, OSError) and error.filename is not None and error.errno in _PATH_ERRORS:
        error = _path_error(error)
    if isinstance(error, TltlError):
        from tltlc.interfaces.cli.report import show

        # Standard error may be full as well.
        with suppress(OSError):
            show(error.diagnostics, "text", sys.stderr)
        return status_of(error.diagnostics)
    return interrupted_status() if is_interrupted(error) else _bug(error)


def is_interrupted(error: BaseException | None) -> bool:
    """Whether an exception is a KeyboardInterrupt, or has one among its causes."""
    while error is not None:
        if isinstance(error, KeyboardInterrupt):
            return True
        error = error.__cause__ or error.__context__
    return False


def _missing_resource(error: BaseException | None) -> str | None:
    """Return a message if an exception or one of its causes says that the system lacks a resource.

    The resources are memory, open files and processes. Return None for all other exceptions.
    """
    while error is not None:
        if isinstance(error, MemoryError):
            return _RESOURCE_MESSAGES[errno.ENOMEM]
        if isinstance(error, OSError) and error.errno in _RESOURCE_MESSAGES:
            return _RESOURCE_MESSAGES[error.errno]
        error = error.__cause__ or error.__context__
    return None


def _usage_diagnostic(error: click.ClickException) -> Diagnostic:
    """Convert a usage error of click to a diagnostic."""
    # click prints one choice per line.
    message = " ".join(error.format_message().rstrip(".").split())
    context = error.ctx if isinstance(error, click.UsageError) else None
    command = context.command_path if context else "tltlc"
    message = _INVALID_NUMBER.sub(lambda match: _number_message(match[1], match[2]), message)
    if message[1:2].islower():
        message = message[0].lower() + message[1:]
    return Diagnostic("TLT0700", message, help=f"`{command} --help` shows how to use it")


def _number_message(text: str, kind: str) -> str:
    """Reword click's message about an invalid number; suggest a decimal point for a comma."""
    message = f"`{text}` is not a {'whole ' if kind == 'integer' else ''}number"
    with_point = text.replace(",", ".", 1)
    return f"{message}; write {with_point}" if kind == "float" and re.fullmatch(r"-?\d+\.\d+", with_point) else message


def flush() -> None:
    """Flush standard output, and drop the text that cannot be written.

    Without this call, Python would flush at exit, where an error changes the exit status.
    """
    try:
        sys.stdout.flush()
    except (OSError, ValueError):
        _discard_output()


def _output_error(error: OSError) -> TltlError:
    from tltlc.io.files import reason

    closed = error.errno == errno.EBADF
    title = f"cannot write to standard output: {'it is closed' if closed else reason(error)}"
    help_ = (
        "send the output to a file, or to /dev/null"
        if closed
        else "free some space, or send the output to another place"
    )
    return TltlError([Diagnostic("TLT0005", title, help=help_)])


def _path_error(error: OSError) -> TltlError:
    from tltlc.io.files import reason

    title = f"cannot access `{os.fsdecode(error.filename)}`: {reason(error)}"
    return TltlError([Diagnostic("TLT0001", title, help="check its name and its permissions")])


def _discard_output() -> None:
    """Redirect standard output to the null device, so that Python's flush at exit does not fail."""
    # Standard output may have no file descriptor.
    with suppress(OSError, ValueError):
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())


def _bug(error: BaseException) -> int:
    """Report an unforeseen exception as a bug of tltlc, and return the exit status.

    The message contains a short reference: a hash of the exception's type and of its place in the
    code. The traceback appears only if the environment variable TLTLC_DEBUG is 1.
    """
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
