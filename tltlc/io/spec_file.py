"""Read the files that a command's arguments name: ``SPEC.tltl``, ``SPEC.tltl:NAME``, an artefact, or ``-``.

An artefact is a compiled spec, as JSON. ``-`` is standard input.
"""

from __future__ import annotations

import os
import re
import sys
from errno import EBADF
from typing import TYPE_CHECKING, Final

from tltlc.core.source import SourceFile, SourceKind
from tltlc.diagnostics.diagnostic import Diagnostic, TltlError
from tltlc.io.access_log import log_read, log_stream_read
from tltlc.io.files import MAX_ARTEFACT_BYTES, MAX_SOURCE_BYTES, decode, read_bytes, reading_error

if TYPE_CHECKING:
    from typing import BinaryIO

STDIN: Final = "-"
"""The path that means standard input."""

ARTEFACT_ENDING: Final = ".json"

STDIN_NAME: Final = "<stdin>"
"""The name of standard input in messages. In ``PATH:NAME``, it may also be the path."""

_PLAIN_NAME: Final = re.compile(r"[A-Za-z_][A-Za-z0-9_]*\Z")


def split(argument: str) -> tuple[str, str | None]:
    """Split an argument into path and name: ``"a.tltl:win"`` -> ``("a.tltl", "win")``.

    The name is None if the argument is only a path, or if the whole argument is the path of an
    existing file. On Windows, a single letter before the colon is a drive, not a path. The path
    ``<stdin>`` becomes ``-``.
    """
    path, colon, name = argument.rpartition(":")
    if not colon or not path or not is_plain_name(name) or os.path.exists(argument):  # noqa: PTH110
        return argument, None
    if len(path) == 1 and path.isalpha() and os.name == "nt":
        return argument, None
    return STDIN if path == STDIN_NAME else path, name


def is_plain_name(text: str) -> bool:
    """Whether a text can be the NAME of ``PATH:NAME``: ASCII letters, digits and _, no digit first."""
    return bool(_PLAIN_NAME.match(text))


def read(path: str) -> tuple[SourceFile, bool]:
    """Return the text of a file or of standard input, and whether it is an artefact.

    An artefact is a compiled spec, as JSON. A text counts as an artefact if it begins with a brace,
    which no source text does, or if its path ends with ``.json``. Errors (:class:`TltlError`):
    TLT0001 if the system cannot read the file, TLT0002 if it is not UTF-8, TLT0003 if it is binary,
    TLT0004 if it is too large.
    """
    name = STDIN_NAME if path == STDIN else path
    try:
        if path == STDIN:
            stream = standard_input()
            log_stream_read(stream)
            return _read_stream(stream, STDIN_NAME, "text")
        log_read(path)
        with open(path, "rb") as file:  # noqa: PTH123 (pathlib costs the start of a command 5 ms)
            return _read_stream(file, path, "file")
    except (OSError, ValueError) as error:
        raise input_error(name, error) from None


def read_text(path: str, max_bytes: int) -> SourceFile:
    """Return the text of a file, or of standard input for the path ``-``.

    Errors are those of :func:`tltlc.io.files.read_source`.
    """
    data, name = read_data(path, max_bytes)
    return decode(data, name, max_bytes=max_bytes, kind=input_kind(path))


def input_kind(path: str) -> SourceKind:
    """Return the kind of source that a path names: ``text`` for standard input (``-``), else ``file``."""
    return "text" if path == STDIN else "file"


def read_data(path: str, max_bytes: int) -> tuple[bytes, str]:
    """Return at most ``max_bytes`` + 1 bytes of a file or of standard input, and its name in messages.

    If the result has the extra byte, the input is too large. Errors are those of
    :func:`tltlc.io.files.read_bytes`.
    """
    if path == STDIN:
        try:
            stream = standard_input()
            log_stream_read(stream)
            return stream.read(max_bytes + 1), STDIN_NAME
        except OSError as error:
            raise input_error(STDIN_NAME, error) from None
    return read_bytes(path, path, max_bytes), path


def standard_input() -> BinaryIO:
    """Return standard input as a stream of bytes; raise TltlError, TLT0001, if it is closed."""
    # A process can start without standard input.
    if sys.stdin is None:
        raise input_error(STDIN_NAME, OSError(EBADF, "it is closed"))
    return sys.stdin.buffer


def input_error(name: str, error: OSError | ValueError) -> TltlError:
    """Return the error TLT0001 for a file or standard input that cannot be read."""
    if name == STDIN_NAME and isinstance(error, OSError) and error.errno == EBADF:
        help_ = "send input to it, as in `tltlc check - < level.tltl`, or name a file"
        return TltlError([Diagnostic("TLT0001", "cannot read standard input: it is closed", help=help_)])
    return reading_error(name, error)


def _read_stream(stream: BinaryIO, name: str, kind: SourceKind) -> tuple[SourceFile, bool]:
    data = stream.read(MAX_SOURCE_BYTES + 1)
    if not name.endswith(ARTEFACT_ENDING) and not data.removeprefix(b"\xef\xbb\xbf").lstrip().startswith(b"{"):
        return decode(data, name, kind=kind), False
    data += stream.read(MAX_ARTEFACT_BYTES + 1 - len(data))
    return decode(data, name, max_bytes=MAX_ARTEFACT_BYTES, kind=kind), True
