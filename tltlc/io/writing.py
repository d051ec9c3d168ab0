"""Writing files so that a failure leaves neither a part of one nor harm to an older one."""

from __future__ import annotations

import errno
import os
import stat
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from typing import Final

from tltlc.diagnostics.diagnostic import Diagnostic, TltlError
from tltlc.io.files import descriptor_of, reason, was_read
from tltlc.io.limits import SOURCE
from tltlc.io.temporary import new_folders, temporaries

_OPTION: Final = "name another place with -o"
_WRITABLE: Final = stat.S_IWUSR | stat.S_IWGRP | stat.S_IWOTH


def write_files(
    folder: Path,
    files: Mapping[str, str | bytes],
    advice: str = _OPTION,
    *,
    durable: bool = False,
    over_inputs: bool = False,
) -> tuple[Path, ...]:
    """Write all of the files into the folder, or none of them.  Folders are made where missing.

    Files that hold this already stay untouched, so that nothing is made again from them; the result is the paths of
    the others, in order.  Every file is first written under a temporary name beside its place, and only when all of
    them are there are they renamed.  If the system refuses a rename, the files that were renamed before it get their
    older content back, and folders that were made are removed.  Text is UTF-8 with line feeds.  Errors, with
    ``advice`` on where else to write: TLT0005; TLT0700 if a file would change that the command has read, unless
    ``over_inputs``.

    Each ``durable`` file is a whole one after a loss of power, too, and is not lost once this has returned, as long as
    its folder is not.

    A process that is killed may leave temporary files; the next one that writes into the same folder removes them.
    Between two renames, it leaves some files new and some as they were, and none of them half written.
    """
    try:
        with new_folders({(folder / name).parent: None for name in files}):
            placed = {folder / name: content for name, content in files.items()}
            return _write(placed, advice, durable=durable, over_inputs=over_inputs)
    except (OSError, ValueError) as error:
        raise _error(folder, error, advice) from None


def write_file(
    path: Path, content: str | bytes, advice: str = _OPTION, *, durable: bool = False, over_inputs: bool = False
) -> None:
    """Write one file into a folder that exists, in the same way; a device, a pipe, and the file that standard output or
    standard error goes to are written to directly.
    """
    _write({path: content}, advice, durable=durable, over_inputs=over_inputs)


def check_not_read(path: Path, advice: str = _OPTION) -> None:
    """Raise TLT0700 if the command has read the file at this path: no output takes the place of an input."""
    if was_read(path):
        raise TltlError([Diagnostic("TLT0700", f"`{path}` would be written over: it is an input", help=advice)])


def rewrite(path: Path, content: str) -> None:
    """Write a source file anew, in the same way.

    Raises:
        TltlError: the file stays as it is: TLT0005, it is marked as read-only; TLT0004, it would be too large to read.
    """
    if len(content.encode(errors="replace")) > SOURCE.size:
        title = f"`{path}` would be larger than {SOURCE.size >> 20} MiB"
        raise TltlError([Diagnostic("TLT0004", title, help="it stays as it is; split it: a file may `import` others")])
    mode = _mode(path)
    # To be renamed over, a file need not be writable.
    if mode is not None and not (mode & _WRITABLE and os.access(path, os.W_OK)):
        help_ = "check its owner and its attributes" if mode & _WRITABLE else "make it writable"
        raise TltlError([Diagnostic("TLT0005", f"cannot write `{path}`: it is read-only", help=help_)])
    write_file(path, content, "make it and its folder writable", over_inputs=True)


def remove_file(path: Path, advice: str) -> None:
    """Remove a file, unless it is not there; raises TltlError, TLT0005, with ``advice`` on what else can be done."""
    try:
        path.unlink(missing_ok=True)
    except OSError as error:
        raise TltlError([Diagnostic("TLT0005", f"cannot remove `{path}`: {reason(error)}", help=advice)]) from None


@contextmanager
def replaced(path: Path, advice: str = _OPTION) -> Iterator[Path]:
    """A temporary path beside ``path``, of the same ending, for a program that writes by itself.

    What is there at the end becomes ``path``; where anything is raised, Ctrl-C too, it is removed.  Error: TLT0005.
    """
    with temporaries() as made:
        try:
            place = Path(os.path.realpath(path))
            temporary = made.path(place, place.suffix)
            # The place may refuse: better to know before an hour of work.
            temporary.touch()
            yield temporary
            temporary.replace(place)
        except (OSError, ValueError) as error:
            raise _error(path, error, advice) from None


def _write(files: Mapping[Path, str | bytes], advice: str, *, durable: bool, over_inputs: bool) -> tuple[Path, ...]:
    waiting: list[tuple[Path, Path]] = []
    written: list[Path] = []
    shown = Path()
    with temporaries() as made:
        try:
            for shown, content in files.items():
                data = content.encode() if isinstance(content, str) else content
                mode = _mode(shown)
                descriptor = descriptor_of(shown)
                # Nobody knows whether what is there would outlast a loss of power.
                if not durable and descriptor is None and mode is not None and _holds(shown, mode, data):
                    continue
                if not over_inputs:
                    check_not_read(shown, advice)
                written.append(shown)
                if descriptor is not None:
                    # What others write there, before and after this command, stays.
                    with os.fdopen(descriptor, "wb", closefd=False) as file:
                        file.write(data)
                    continue
                if mode is not None and not stat.S_ISREG(mode):
                    # A device or a pipe keeps its place, which a link of `/dev/fd` alone may name; a folder refuses.
                    with shown.open("wb") as file:
                        file.write(data)
                    continue
                place = Path(os.path.realpath(shown))
                temporary = made.path(place)
                _fill(temporary, data, mode, durable)
                waiting.append((temporary, place))
            for temporary, shown in waiting:
                # A single file needs no way back: no rename comes after it.
                if len(waiting) > 1:
                    made.keep(shown)
                temporary.replace(shown)
            for shown in {place.parent for _, place in waiting} if durable else ():
                _sync_folder(shown)
        except (OSError, ValueError) as error:
            raise _error(shown, error, advice) from None
    return tuple(written)


def _fill(temporary: Path, data: bytes, mode: int | None, durable: bool) -> None:
    """Write a temporary file, with the permissions of the one that it is to replace."""
    with temporary.open("wb") as file:
        file.write(data)
        if durable:
            file.flush()
            os.fsync(file.fileno())
    if mode is not None:
        temporary.chmod(stat.S_IMODE(mode))


def _holds(path: Path, mode: int, data: bytes) -> bool:
    """Whether this is a file with that content."""
    try:
        return stat.S_ISREG(mode) and path.stat().st_size == len(data) and path.read_bytes() == data
    except OSError:
        return False


def _sync_folder(folder: Path) -> None:
    """Have the system write down that files were renamed, where it knows how to."""
    if os.name == "nt":
        return
    descriptor = os.open(folder, os.O_RDONLY)
    try:
        os.fsync(descriptor)
    finally:
        os.close(descriptor)


def _mode(path: Path) -> int | None:
    try:
        return path.stat().st_mode
    except FileNotFoundError:
        return None


def _error(path: Path, error: OSError | ValueError, advice: str) -> TltlError:
    # A file that we are to make is never missing itself.
    why = "there is no such folder" if isinstance(error, FileNotFoundError) else reason(error)
    title = f"cannot write `{path}`: {why}"
    if isinstance(error, OSError) and error.errno == errno.EMFILE:
        advice = "let this process open more files: `ulimit -n 1024`"
    return TltlError([Diagnostic("TLT0005", title, help=advice)])
