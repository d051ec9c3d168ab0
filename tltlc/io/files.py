"""Find and read source files. If a file is not a readable text, a diagnostic says why."""

from __future__ import annotations

import os
import stat
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from contextvars import ContextVar
from typing import TYPE_CHECKING, Final

from tltlc.core.record import EMPTY
from tltlc.core.source import SourceFile, SourceKind, Span
from tltlc.diagnostics.diagnostic import Diagnostic, Label, TltlError
from tltlc.io.access_log import log_lookup, log_read
from tltlc.io.confinement import may_read, outside_diagnostic
from tltlc.io.limits import ARTEFACT, SOURCE

if TYPE_CHECKING:
    from pathlib import Path

MAX_SOURCE_BYTES: Final = SOURCE.size
MAX_ARTEFACT_BYTES: Final = ARTEFACT.size

_BYTE_ORDER_MARK: Final = b"\xef\xbb\xbf"

_unsaved_texts: Final[ContextVar[Mapping[str, str]]] = ContextVar("unsaved", default=EMPTY)
"""The unsaved texts of an editor, by absolute path."""


@contextmanager
def unsaved_texts(texts: Mapping[str, str]) -> Iterator[None]:
    """Inside the ``with`` block, use the unsaved texts of an editor instead of the files on disk.

    ``texts`` maps the absolute path of each file to its text. The files need not exist.
    """
    token = _unsaved_texts.set(texts)
    try:
        yield
    finally:
        _unsaved_texts.reset(token)


def _unsaved_text(path: str | os.PathLike[str]) -> str | None:
    texts = _unsaved_texts.get()
    return texts.get(os.path.abspath(path)) if texts else None  # noqa: PTH100


def exists(path: str | os.PathLike[str]) -> bool:
    """Whether something exists at a path.

    The result is False if the system rejects the name or denies access, or if
    :func:`~tltlc.io.confinement.confine_reads` forbids access.
    """
    if not may_read(path):
        return False
    log_lookup(path)
    # pathlib's method raises an exception, before Python 3.14, if the system rejects the name or denies access.
    return os.path.exists(path)  # noqa: PTH110


def is_file(path: str | os.PathLike[str]) -> bool:
    """Whether there is a regular file at a path, or an unsaved text of an editor for it.

    Devices and pipes do not count. The result is False if
    :func:`~tltlc.io.confinement.confine_reads` forbids access.
    """
    if not may_read(path):
        return False
    log_lookup(path)
    return os.path.isfile(path) or _unsaved_text(path) is not None  # noqa: PTH113


def may_be_file(path: str | os.PathLike[str]) -> bool:
    """Whether a command may try to read a path: it is a regular file, or nothing is there.

    The result is False for a pipe, a device, a socket or a folder. Links are followed. If nothing
    is there, as for a broken link, reading the path reports the problem.
    """
    try:
        return stat.S_ISREG(os.stat(path).st_mode)  # noqa: PTH116
    except (OSError, ValueError):
        return True


def is_dir(path: str | os.PathLike[str]) -> bool:
    """Whether a folder exists at a path.

    The result is False if :func:`~tltlc.io.confinement.confine_reads` forbids access.
    """
    if not may_read(path):
        return False
    log_lookup(path)
    return os.path.isdir(path)  # noqa: PTH112


def walk(
    folder: str | os.PathLike[str], onerror: Callable[[OSError], object] | None = None
) -> Iterator[tuple[str, list[str], list[str]]]:
    """Yield what :func:`os.walk` yields from the top down, for folders that are nested to any depth.

    Before Python 3.12, :func:`os.walk` recurses once per level and may end in a RecursionError.
    """
    pending = [os.fspath(folder)]
    while pending:
        current = pending.pop()
        folders: list[str] = []
        files: list[str] = []
        try:
            with os.scandir(current) as entries:
                for entry in entries:
                    (folders if _leads_to_folder(entry) else files).append(entry.name)
        except OSError as error:
            if onerror is not None:
                onerror(error)
            continue
        yield current, folders, files
        paths = (os.path.join(current, name) for name in reversed(folders))  # noqa: PTH118
        pending += [path for path in paths if not os.path.islink(path)]  # noqa: PTH114


def files_below(folder: Path, endings: tuple[str, ...] = (".tltl",)) -> list[Path]:
    """Return the files with one of these endings in a folder and its subfolders.

    The paths are relative to ``folder``, and sorted. Hidden files and folders are skipped. Pipes
    and devices are skipped, too, because reading one could block forever. Raises TltlError with
    TLT0001 for a folder that cannot be read.
    """
    from pathlib import Path

    paths: list[Path] = []
    for place, folders, files in walk(folder, onerror=_raise_unreadable):
        folders[:] = [name for name in folders if not name.startswith(".")]
        relative = Path(place).relative_to(folder)
        names = [name for name in files if name.endswith(endings) and not name.startswith(".")]
        paths += [relative / name for name in names if may_be_file(os.path.join(place, name))]  # noqa: PTH118
    return sorted(paths)


def _raise_unreadable(error: OSError) -> None:
    # A folder may be removed while we search.
    if not isinstance(error, FileNotFoundError):
        raise reading_error(str(error.filename), error)


def _leads_to_folder(entry: os.DirEntry[str]) -> bool:
    try:
        return entry.is_dir()
    except OSError:
        return False


def read_source(
    path: str | os.PathLike[str],
    name: str | None = None,
    *,
    max_bytes: int = MAX_SOURCE_BYTES,
    kind: SourceKind = "file",
) -> SourceFile:
    """Return the text of a file, with its name.

    ``name`` is the name of the file in messages, by default its path. ``kind`` is the kind of the
    result. If it is ``standard library``, the result also has the path of the file, as its
    location.

    Errors (:class:`TltlError`): TLT0001 if the system cannot read the file, TLT0002 if it is not
    UTF-8, TLT0003 if it is binary, TLT0004 if it is larger than ``max_bytes``, TLT0777 if
    :func:`~tltlc.io.confinement.confine_reads` forbids to read it.
    """
    display_name = name if name is not None else os.fspath(path)
    location = os.fspath(path) if kind == "standard library" else None
    data = read_bytes(path, display_name, max_bytes)
    return decode(data, display_name, max_bytes=max_bytes, kind=kind, location=location)


def read_bytes(path: str | os.PathLike[str], name: str, max_bytes: int) -> bytes:
    """Return at most ``max_bytes`` + 1 bytes of a file.

    If the result has the extra byte, the file is too large. ``name`` is the name of the file in
    messages.

    Errors (:class:`TltlError`): TLT0001 if the system cannot read the file, TLT0777 if
    :func:`~tltlc.io.confinement.confine_reads` forbids it.
    """
    if not may_read(path):
        raise TltlError([outside_diagnostic(name)])
    log_read(path)
    text = _unsaved_text(path)
    if text is not None:
        return text.encode(errors="replace")[: max_bytes + 1]
    try:
        with open(path, "rb") as file:  # noqa: PTH123 (pathlib costs the start of a command 5 ms)
            return file.read(max_bytes + 1)
    except (OSError, ValueError) as error:
        raise reading_error(name, error) from None


def decode(
    data: bytes,
    name: str,
    *,
    max_bytes: int = MAX_SOURCE_BYTES,
    kind: SourceKind = "file",
    location: str | None = None,
) -> SourceFile:
    """Decode the bytes of a file, which must be UTF-8, with or without a byte order mark.

    ``name`` is the name of the file in messages. ``kind`` and ``location`` are stored in the
    result.

    Errors (:class:`TltlError`): TLT0002 if the data is not UTF-8, TLT0003 if it is binary, TLT0004
    if it is larger than ``max_bytes``.
    """
    if len(data) > max_bytes:
        title = f"`{name}` is larger than {max_bytes >> 20} MiB"
        is_source = max_bytes == MAX_SOURCE_BYTES
        advice = "split it: a file may `import` others" if is_source else "name a smaller file"
        raise TltlError([Diagnostic("TLT0004", title, help=advice)])
    if data.startswith((b"\xff\xfe", b"\xfe\xff")):
        raise TltlError([Diagnostic("TLT0002", f"`{name}` is UTF-16 text", help="save it as UTF-8")])
    if b"\0" in data:
        raise TltlError([Diagnostic("TLT0003", f"`{name}` is a binary file", help="name a text file")])
    try:
        return SourceFile(name, data.removeprefix(_BYTE_ORDER_MARK).decode(), kind, location)
    except UnicodeDecodeError as error:
        source = SourceFile(name, error.object.decode(errors="replace"), kind, location)
        raise _not_utf8(error.object, source, error.start) from None


def reading_error(name: str, error: OSError | ValueError) -> TltlError:
    """Return the error TLT0001 for a file that the system cannot read; ``name`` is its name in the message."""
    suggestion: str | None = "check its name and its permissions"
    if isinstance(error, FileNotFoundError):
        suggestion = _missing_file_help(name) or "check its spelling, and the folder that you are in"
    elif isinstance(error, IsADirectoryError):
        suggestion = "name a file in it"
    return TltlError([Diagnostic("TLT0001", f"cannot read `{name}`: {reason(error)}", help=suggestion)])


def reason(error: OSError | ValueError) -> str:
    """Say in words why the system refused to open, create or write a file: ``permission denied``."""
    if isinstance(error, FileNotFoundError):
        return "there is no such file"
    if isinstance(error, IsADirectoryError):
        return "it is a folder"
    if isinstance(error, FileExistsError):
        return "it is a file, not a folder"
    if isinstance(error, NotADirectoryError):
        return "a part of its path is a file, not a folder"
    if isinstance(error, PermissionError):
        return "permission denied"
    if isinstance(error, OSError) and error.strerror:
        return error.strerror[0].lower() + error.strerror[1:]
    return "the system does not allow its name"


def _missing_file_help(name: str) -> str | None:
    """Return advice for a missing file, such as a similar name in its folder; None if nothing is similar."""
    from difflib import get_close_matches

    folder, file = os.path.split(name)
    try:
        close_matches = get_close_matches(file, os.listdir(folder or "."), n=1, cutoff=0.85)  # noqa: PTH208
    except OSError:
        return f"there is no folder `{folder}` either"
    if close_matches and close_matches[0] == file:
        return "it is a link, and its target does not exist"
    return f"did you mean `{os.path.join(folder, close_matches[0])}`?" if close_matches else None  # noqa: PTH118


def _not_utf8(data: bytes, source: SourceFile, start: int) -> TltlError:
    """Return the error TLT0002 for text that is not UTF-8, with a label at the first invalid byte.

    ``start`` is the offset of this byte in ``data``. ``source`` has the text of ``data``, with
    U+FFFD in place of invalid bytes.
    """
    offset = len(data[:start].decode())
    label = Label(source, Span(offset, offset + 1), f"the byte 0x{data[start]:02X} is not valid UTF-8")
    return TltlError([Diagnostic("TLT0002", f"`{source.name}` is not UTF-8 text", (label,), help="save it as UTF-8")])
