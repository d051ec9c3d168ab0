"""Find and read source files. If a file is not a readable text, a diagnostic says why."""

from __future__ import annotations

import os
import stat
from collections.abc import Callable, Iterable, Iterator, Mapping
from contextlib import contextmanager, suppress
from contextvars import ContextVar
from typing import TYPE_CHECKING, BinaryIO, Final, Union

from tltlc.core.record import EMPTY
from tltlc.core.source import SourceFile, SourceKind, Span
from tltlc.diagnostics.diagnostic import Diagnostic, Label, TltlError
from tltlc.io.limits import ARTEFACT, SOURCE

if TYPE_CHECKING:
    from pathlib import Path

MAX_SOURCE_BYTES: Final = SOURCE.size
MAX_ARTEFACT_BYTES: Final = ARTEFACT.size

_BYTE_ORDER_MARK: Final = b"\xef\xbb\xbf"

Stamp = Union[tuple[int, ...], None]
"""The state of a path, to see later whether it has changed: the file's time of change, size and inode number.

For a folder, a device or a pipe, it is only the kind. It is None if nothing is at the path.
"""


class AccessLog(dict[str, Stamp]):
    """Maps each path that was looked up or read to its stamp (such as time and size) just before.

    ``read`` has the device and inode numbers of the regular files that were read.
    """

    def __init__(self) -> None:
        super().__init__()
        self.read: set[tuple[int, int]] = set()


_active_logs: Final[list[AccessLog]] = []
"""The active access logs, the innermost last."""

_unsaved_texts: Final[ContextVar[Mapping[str, str]]] = ContextVar("unsaved", default=EMPTY)
"""The unsaved texts of an editor, by absolute path."""

_folders: Final[ContextVar[frozenset[str] | None]] = ContextVar("folders", default=None)
"""The folders that may be read, each as written and with links resolved.

It is None if every file may be read.
"""


@contextmanager
def confine_reads(folders: Iterable[str | os.PathLike[str]]) -> Iterator[None]:
    """Allow reading only in these folders and their subfolders inside the ``with`` block.

    A link is allowed only if the file that it leads to is in one of the folders, too.
    """
    resolvers = (os.path.abspath, os.path.realpath)
    token = _folders.set(frozenset(os.path.normcase(resolve(folder)) for folder in folders for resolve in resolvers))
    try:
        yield
    finally:
        _folders.reset(token)


def may_read(path: str | os.PathLike[str]) -> bool:
    """Whether :func:`confine_reads` allows a path, both as written and with links resolved.

    Without :func:`confine_reads`, every path is allowed.
    """
    folders = _folders.get()
    if folders is None:
        return True
    try:
        # Check the path as written first, so that no path outside is even looked up.
        return _is_inside(os.path.abspath(path), folders) and _is_inside(os.path.realpath(path), folders)  # noqa: PTH100
    except (OSError, ValueError):
        return False


def _is_inside(path: str, folders: Iterable[str]) -> bool:
    key = os.path.normcase(path)
    return any(key == folder or key.startswith(os.path.join(folder, "")) for folder in folders)  # noqa: PTH118


def outside_diagnostic(name: str, labels: tuple[Label, ...] = ()) -> Diagnostic:
    """Return the error TLT0777 for a file or folder that :func:`confine_reads` forbids to read."""
    title = f"`{name}` is outside the folder of the playground, so it is not read"
    return Diagnostic(
        "TLT0777", title, labels, "move it into that folder, or start `tltlc serve` in a folder above both"
    )


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


@contextmanager
def access_log() -> Iterator[AccessLog]:
    """Yield a log of the paths that this module looks up or reads inside the ``with`` block.

    The log maps each path to its stamp just before the first access. Results that were computed
    inside the block stay valid as long as :func:`stamp` returns the same for each of these paths.
    """
    log = AccessLog()
    _active_logs.append(log)
    try:
        yield log
    finally:
        _active_logs.pop()


def log_lookup(path: str | os.PathLike[str]) -> None:
    """Record in all active access logs that this path is about to be looked up."""
    for log in _active_logs:
        name = os.fspath(path)
        if name not in log:
            log[name] = stamp(name)


def log_read(path: str | os.PathLike[str]) -> None:
    """Record in all active access logs that this file is about to be read."""
    log_lookup(path)
    _log_identity(path)


def log_stream_read(stream: BinaryIO) -> None:
    """Record in all active access logs that a stream is about to be read, if it comes from a file."""
    with suppress(OSError, ValueError):
        _log_identity(stream.fileno())


def was_read(path: str | os.PathLike[str]) -> bool:
    """Whether the file at a path was read, under any name, since the innermost :func:`access_log` began.

    Files are compared by their inode numbers. A command that watches files begins a new log in each
    round, because the system reuses inode numbers: after an editor has replaced a source file, an
    output may get the number of the old file.
    """
    # Devices and pipes do not count, because writing to them replaces nothing.
    return bool(_active_logs) and _identity(path) in _active_logs[-1].read


def descriptor_of(path: str | os.PathLike[str]) -> int | None:
    """Return 1 if standard output of this process goes to the file at a path, 2 if standard error does.

    Return None if neither does.
    """
    identity = _identity(path)
    return next(
        (descriptor for descriptor in (1, 2) if identity is not None and _identity(descriptor) == identity), None
    )


def _log_identity(file: str | os.PathLike[str] | int) -> None:
    identity = _identity(file) if _active_logs else None
    if identity is not None:
        for log in _active_logs:
            log.read.add(identity)


def _identity(file: str | os.PathLike[str] | int) -> tuple[int, int] | None:
    """Return the device and inode number of a regular file, and None for anything else."""
    try:
        status = os.stat(file)  # noqa: PTH116
    except (OSError, ValueError):
        return None
    return (status.st_dev, status.st_ino) if stat.S_ISREG(status.st_mode) else None


def stamp(path: str) -> Stamp:
    """Return the current stamp of a path: the file's time of change, size and inode number.

    Another stamp later means that the file has changed. For a folder, a device or a pipe, the stamp
    is only the kind; if nothing is at the path, it is None.
    """
    try:
        status = os.stat(path)  # noqa: PTH116
    except (OSError, ValueError):
        return None
    if not stat.S_ISREG(status.st_mode):
        return (stat.S_IFMT(status.st_mode),)
    return (status.st_mtime_ns, status.st_size, status.st_ino)


def exists(path: str | os.PathLike[str]) -> bool:
    """Whether something exists at a path.

    Returns False if the system rejects the name or denies access, or if :func:`confine_reads`
    forbids access.
    """
    if not may_read(path):
        return False
    log_lookup(path)
    # pathlib's method raises an exception, before Python 3.14, if the system rejects the name or denies access.
    return os.path.exists(path)  # noqa: PTH110


def is_file(path: str | os.PathLike[str]) -> bool:
    """Whether a regular file exists at a path, or an unsaved text; devices and pipes do not count."""
    if not may_read(path):
        return False
    log_lookup(path)
    return os.path.isfile(path) or _unsaved_text(path) is not None  # noqa: PTH113


def may_be_file(path: str | os.PathLike[str]) -> bool:
    """Whether a path is not a pipe, device, socket or folder, so that a command may try to read it.

    Links are followed. The result is True if nothing is there, as for a broken link, so that
    reading it reports the problem.
    """
    try:
        return stat.S_ISREG(os.stat(path).st_mode)  # noqa: PTH116
    except (OSError, ValueError):
        return True


def is_dir(path: str | os.PathLike[str]) -> bool:
    """Whether a folder exists at a path."""
    if not may_read(path):
        return False
    log_lookup(path)
    return os.path.isdir(path)  # noqa: PTH112


def walk(
    folder: str | os.PathLike[str], onerror: Callable[[OSError], object] | None = None
) -> Iterator[tuple[str, list[str], list[str]]]:
    """Yield what :func:`os.walk` yields from the top down, for folders of any depth.

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
    """Return the files with these endings in and below a folder, relative to it and sorted.

    Hidden files are skipped. Pipes and devices are skipped too, because reading one could block
    forever. Raises TltlError with TLT0001 for a folder that cannot be read.
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
    """Return the text of a file.

    ``name`` is the name of the file in messages, by default its path. A file of the standard library
    has its own ``kind``, and its path as its location.

    Errors (:class:`TltlError`): TLT0001 if the system cannot read the file, TLT0002 if it is not
    UTF-8, TLT0003 if it is binary, TLT0004 if it is larger than ``max_bytes``, TLT0777 if
    :func:`confine_reads` forbids to read it.
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
    :func:`confine_reads` forbids it.
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

    ``name`` is the name of the file in messages; ``kind`` and ``location`` are those of the source
    that is returned.

    Errors (:class:`TltlError`): TLT0002 not UTF-8, TLT0003 binary, TLT0004 larger than
    ``max_bytes``.
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
    """Return the reason, in words, for which the system refused to open, create or write a file."""
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
    """Return advice for a missing file, such as a similar name in its folder; None if there is no advice."""
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
    """Return the error for text that is not UTF-8, with a label at the first invalid byte.

    The text of ``source`` has U+FFFD in place of the invalid bytes. ``start`` is the offset of the
    first one in ``data``.
    """
    offset = len(data[:start].decode())
    label = Label(source, Span(offset, offset + 1), f"the byte 0x{data[start]:02X} is not valid UTF-8")
    return TltlError([Diagnostic("TLT0002", f"`{source.name}` is not UTF-8 text", (label,), help="save it as UTF-8")])
