"""Source files are looked for and read: every way in which one can fail to be a text becomes a diagnostic."""

from __future__ import annotations

import os
import stat
from collections.abc import Callable, Iterable, Iterator, Mapping
from contextlib import contextmanager, suppress
from contextvars import ContextVar
from typing import BinaryIO, Final, Union

from tltlc.core.record import EMPTY
from tltlc.core.source import SourceFile, Span
from tltlc.diagnostics.diagnostic import Diagnostic, Label, TltlError
from tltlc.io.limits import ARTEFACT, SOURCE

MAX_SOURCE_BYTES: Final = SOURCE.size
MAX_ARTEFACT_BYTES: Final = ARTEFACT.size

_BYTE_ORDER_MARK: Final = b"\xef\xbb\xbf"

Stamp = Union[tuple[int, ...], None]
"""What tells one state of a file from another; of a folder or a device only that it is there, and None of nothing."""


class Notes(dict[str, Stamp]):
    """The paths that were looked for or read, with their states before that.

    ``read`` identifies the regular files that were read, by their device and their number there.
    """

    def __init__(self) -> None:
        super().__init__()
        self.read: set[tuple[int, int]] = set()


_noted: Final[list[Notes]] = []
"""Who asks for notes of what is looked at."""

_unsaved: Final[ContextVar[Mapping[str, str]]] = ContextVar("unsaved", default=EMPTY)
"""The texts that an editor has not saved, by absolute paths."""

_folders: Final[ContextVar[frozenset[str] | None]] = ContextVar("folders", default=None)
"""The folders that may be read, each as it is written and with its links followed; None where every file may be."""


@contextmanager
def confined(folders: Iterable[str | os.PathLike[str]]) -> Iterator[None]:
    """Within, only these folders and what is below them can be read; :func:`may_read` says how links count."""
    ways = (os.path.abspath, os.path.realpath)
    token = _folders.set(frozenset(os.path.normcase(way(folder)) for folder in folders for way in ways))
    try:
        yield
    finally:
        _folders.reset(token)


def may_read(path: str | os.PathLike[str]) -> bool:
    """Whether a path is inside the folders of :func:`confined`: as it is written, and after links are followed."""
    folders = _folders.get()
    if folders is None:
        return True
    try:
        # The written path comes first, so that nothing outside is even looked at.
        return _is_inside(os.path.abspath(path), folders) and _is_inside(os.path.realpath(path), folders)  # noqa: PTH100
    except (OSError, ValueError):
        return False


def _is_inside(path: str, folders: Iterable[str]) -> bool:
    own = os.path.normcase(path)
    return any(own == folder or own.startswith(os.path.join(folder, "")) for folder in folders)  # noqa: PTH118


def outside(name: str, labels: tuple[Label, ...] = ()) -> Diagnostic:
    """TLT0777: a file or folder is outside of those that may be read."""
    title = f"`{name}` is outside the folder of the playground, so it is not read"
    return Diagnostic(
        "TLT0777", title, labels, "move it into that folder, or start `tltlc serve` in a folder above both"
    )


@contextmanager
def unsaved(texts: Mapping[str, str]) -> Iterator[None]:
    """Within, these texts are read in place of the files at their absolute paths, be there such a file or not."""
    token = _unsaved.set(texts)
    try:
        yield
    finally:
        _unsaved.reset(token)


def _unsaved_text(path: str | os.PathLike[str]) -> str | None:
    texts = _unsaved.get()
    return texts.get(os.path.abspath(path)) if texts else None  # noqa: PTH100


@contextmanager
def noted() -> Iterator[Notes]:
    """Within, every path that is looked for or read here is noted with its state before that, if it is there or not.

    They are what a result depends on: as long as :func:`stamp` says the same of each, it would come out the same.
    """
    notes = Notes()
    _noted.append(notes)
    try:
        yield notes
    finally:
        _noted.pop()


def note(path: str | os.PathLike[str]) -> None:
    """Tell those who asked by :func:`noted` that this path is about to be looked at."""
    for notes in _noted:
        name = os.fspath(path)
        if name not in notes:
            notes[name] = stamp(name)


def note_read(path: str | os.PathLike[str]) -> None:
    """Tell those who asked by :func:`noted` that this file is about to be read."""
    note(path)
    _note_identity(path)


def note_stream(stream: BinaryIO) -> None:
    """Tell those who asked by :func:`noted` that a stream is about to be read, which may come from a file."""
    with suppress(OSError, ValueError):
        _note_identity(stream.fileno())


def was_read(path: str | os.PathLike[str]) -> bool:
    """Whether the file at a path, under this name or another, was read since the innermost :func:`noted` began.

    A command that watches begins one for each round.  The system may give a source's number to an output once an
    editor has replaced the source, so what earlier rounds read does not count.
    """
    # What is written to a device or a pipe replaces nothing.
    return bool(_noted) and _identity(path) in _noted[-1].read


def descriptor_of(path: str | os.PathLike[str]) -> int | None:
    """1 or 2 where standard output or standard error of this process goes to the file at a path, by any name of it."""
    there = _identity(path)
    return next((number for number in (1, 2) if there is not None and _identity(number) == there), None)


def _note_identity(file: str | os.PathLike[str] | int) -> None:
    identity = _identity(file) if _noted else None
    if identity is not None:
        for notes in _noted:
            notes.read.add(identity)


def _identity(file: str | os.PathLike[str] | int) -> tuple[int, int] | None:
    """The device of a regular file, and its number there; None for anything else."""
    try:
        found = os.stat(file)  # noqa: PTH116
    except (OSError, ValueError):
        return None
    return (found.st_dev, found.st_ino) if stat.S_ISREG(found.st_mode) else None


def stamp(path: str) -> Stamp:
    """The state of what is at a path now."""
    try:
        found = os.stat(path)  # noqa: PTH116
    except (OSError, ValueError):
        return None
    if not stat.S_ISREG(found.st_mode):
        return (stat.S_IFMT(found.st_mode),)
    return (found.st_mtime_ns, found.st_size, found.st_ino)


def exists(path: str | os.PathLike[str]) -> bool:
    """Whether something is there, as far as the system tells: where it allows no such name or look, nothing is."""
    if not may_read(path):
        return False
    note(path)
    # pathlib's raises there, before Python 3.14.
    return os.path.exists(path)  # noqa: PTH110


def is_file(path: str | os.PathLike[str]) -> bool:
    """Whether a file is there, as :func:`exists` has it; devices and pipes are none."""
    if not may_read(path):
        return False
    note(path)
    return os.path.isfile(path) or _unsaved_text(path) is not None  # noqa: PTH113


def may_be_file(path: str | os.PathLike[str]) -> bool:
    """Whether a command that walks a folder may read this entry: not if it is a pipe, device, socket or folder.

    Links are followed. A link that leads nowhere passes, so that whoever reads it reports it.
    """
    try:
        return stat.S_ISREG(os.stat(path).st_mode)  # noqa: PTH116
    except (OSError, ValueError):
        return True


def is_dir(path: str | os.PathLike[str]) -> bool:
    """Whether a folder is there, as :func:`exists` has it."""
    if not may_read(path):
        return False
    note(path)
    return os.path.isdir(path)  # noqa: PTH112


def walk(
    folder: str | os.PathLike[str], onerror: Callable[[OSError], object] | None = None
) -> Iterator[tuple[str, list[str], list[str]]]:
    """Yield what :func:`os.walk` yields from the top down, for folders of any depth.

    Before Python 3.12 that one calls itself for each level, and ends in a RecursionError.
    """
    waiting = [os.fspath(folder)]
    while waiting:
        place = waiting.pop()
        folders: list[str] = []
        files: list[str] = []
        try:
            with os.scandir(place) as entries:
                for entry in entries:
                    (folders if _leads_to_folder(entry) else files).append(entry.name)
        except OSError as error:
            if onerror is not None:
                onerror(error)
            continue
        yield place, folders, files
        paths = (os.path.join(place, name) for name in reversed(folders))  # noqa: PTH118
        waiting += [path for path in paths if not os.path.islink(path)]  # noqa: PTH114


def _leads_to_folder(entry: os.DirEntry[str]) -> bool:
    try:
        return entry.is_dir()
    except OSError:
        return False


def read_source(
    path: str | os.PathLike[str], name: str | None = None, *, max_bytes: int = MAX_SOURCE_BYTES
) -> SourceFile:
    """The text of a file; ``name`` is what messages call it, by default its path.

    Errors (:class:`TltlError`): those of :func:`read_bytes` and of :func:`decode`.
    """
    shown = name if name is not None else os.fspath(path)
    return decode(read_bytes(path, shown, max_bytes), shown, max_bytes=max_bytes)


def read_bytes(path: str | os.PathLike[str], name: str, max_bytes: int) -> bytes:
    """The bytes of a file, which messages call ``name``; of a larger one the first ``max_bytes`` and one more.

    Errors (:class:`TltlError`): TLT0001 where the system cannot read it, TLT0777 where :func:`confined` forbids it.
    """
    if not may_read(path):
        raise TltlError([outside(name)])
    note_read(path)
    text = _unsaved_text(path)
    if text is not None:
        return text.encode(errors="replace")[: max_bytes + 1]
    try:
        with open(path, "rb") as file:  # noqa: PTH123 (pathlib costs the start of a command 5 ms)
            return file.read(max_bytes + 1)
    except (OSError, ValueError) as error:
        raise reading_error(name, error) from None


def decode(data: bytes, name: str, *, max_bytes: int = MAX_SOURCE_BYTES) -> SourceFile:
    """The text that the bytes of a file hold: UTF-8, with or without a byte order mark.

    Errors (:class:`TltlError`): TLT0002 not UTF-8, TLT0003 binary, TLT0004 larger than ``max_bytes``.
    """
    if len(data) > max_bytes:
        title = f"`{name}` is larger than {max_bytes >> 20} MiB"
        split = max_bytes == MAX_SOURCE_BYTES
        advice = "split it: a file may `import` others" if split else "name a smaller file"
        raise TltlError([Diagnostic("TLT0004", title, help=advice)])
    if data.startswith((b"\xff\xfe", b"\xfe\xff")):
        raise TltlError([Diagnostic("TLT0002", f"`{name}` is UTF-16 text", help="save it as UTF-8")])
    if b"\0" in data:
        raise TltlError([Diagnostic("TLT0003", f"`{name}` is a binary file", help="name a text file")])
    try:
        return SourceFile(name, data.removeprefix(_BYTE_ORDER_MARK).decode())
    except UnicodeDecodeError as error:
        raise _not_utf8(error.object, name, error.start) from None


def reading_error(name: str, error: OSError | ValueError) -> TltlError:
    """TLT0001 for a file that the system does not give us."""
    way_out: str | None = "check its name and its permissions"
    if isinstance(error, FileNotFoundError):
        way_out = _neighbour(name) or "check its spelling, and the folder that you are in"
    elif isinstance(error, IsADirectoryError):
        way_out = "name a file in it"
    return TltlError([Diagnostic("TLT0001", f"cannot read `{name}`: {reason(error)}", help=way_out)])


def reason(error: OSError | ValueError) -> str:
    """Why the system refused, in plain words."""
    if isinstance(error, FileNotFoundError):
        return "there is no such file"
    if isinstance(error, IsADirectoryError):
        return "it is a folder"
    if isinstance(error, FileExistsError):
        return "it is a file, and no folder"
    if isinstance(error, NotADirectoryError):
        return "a part of its path is a file, and no folder"
    if isinstance(error, PermissionError):
        return "permission denied"
    if isinstance(error, OSError) and error.strerror:
        return error.strerror[0].lower() + error.strerror[1:]
    return "its name is not one that the system allows"


def _neighbour(name: str) -> str | None:
    """A file of the same folder with a name much like that one's."""
    from difflib import get_close_matches

    folder, file = os.path.split(name)
    try:
        close = get_close_matches(file, os.listdir(folder or "."), n=1, cutoff=0.85)  # noqa: PTH208
    except OSError:
        return f"there is no folder `{folder}` either"
    if close and close[0] == file:
        return "it is a link: what it leads to is gone"
    return f"did you mean `{os.path.join(folder, close[0])}`?" if close else None  # noqa: PTH118


def _not_utf8(data: bytes, name: str, start: int) -> TltlError:
    """The error for the first bad byte, shown in a text where every bad byte is replaced."""
    source = SourceFile(name, data.decode(errors="replace"))
    offset = len(data[:start].decode())
    label = Label(source, Span(offset, offset + 1), f"the byte 0x{data[start]:02X} is no UTF-8")
    return TltlError([Diagnostic("TLT0002", f"`{name}` is not UTF-8 text", (label,), help="save it as UTF-8")])
