"""Write files so that a failure neither leaves a file half written nor damages an existing file."""

from __future__ import annotations

import errno
import os
import stat
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from typing import Final

from tltlc.diagnostics.diagnostic import Diagnostic, TltlError
from tltlc.io.access_log import descriptor_of, was_read
from tltlc.io.files import reason
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
    """Write all files into a folder, or none of them; return the paths of the files that were written.

    ``files`` maps paths relative to ``folder`` to contents. Missing folders are created. Without
    ``durable``, a file that already has the same content is not written, so that build tools do not
    rebuild what depends on it.

    Each file is first written under a temporary name beside its final path. The temporary files are
    renamed only when all of them are complete. If the system refuses a rename, the files that were
    already renamed get their old content back, and new folders are removed. Text is written as
    UTF-8 with line feeds.

    A device, a pipe, and the file to which standard output or standard error is redirected are not
    replaced: the content is written into them at once, and cannot be taken back.

    With ``durable``, the files are on the disk when this function returns, and complete even after
    a loss of power. The entry of a new folder may still be lost.

    If the process is killed, some files may be new and some old, but none is half written.
    Temporary files may remain; the next process that writes into the same folder removes them.

    Raises:
        TltlError: TLT0005 if the system refuses; TLT0700 if a file that the command has read would
            change, unless ``over_inputs`` is true. The help of both errors is ``advice``, which
            says where else to write. If too many files are open, the help is to allow more.
    """
    try:
        with new_folders({(folder / name).parent: None for name in files}):
            contents = {folder / name: content for name, content in files.items()}
            return _write(contents, advice, durable=durable, over_inputs=over_inputs)
    except (OSError, ValueError) as error:
        raise _writing_error(folder, error, advice) from None


def write_file(
    path: Path, content: str | bytes, advice: str = _OPTION, *, durable: bool = False, over_inputs: bool = False
) -> None:
    """Write one file into a folder that exists.

    ``content``, the options and the errors are those of :func:`write_files`.
    """
    _write({path: content}, advice, durable=durable, over_inputs=over_inputs)


def check_not_read(path: Path, advice: str = _OPTION) -> None:
    """Raise TltlError, TLT0700, if the command has read the file at this path.

    This keeps an output from replacing an input. ``advice`` is the help of the error.
    """
    if was_read(path):
        raise TltlError([Diagnostic("TLT0700", f"`{path}` would be overwritten, but it is an input", help=advice)])


def rewrite(path: Path, content: str) -> None:
    """Replace the content of a source file; if this fails, the file keeps its old content.

    Raises:
        TltlError: TLT0005 if the file is read-only, or the system refuses to write; TLT0004 if the
            new content would be too large to read.
    """
    if len(content.encode(errors="replace")) > SOURCE.size:
        title = f"`{path}` would be larger than {SOURCE.size >> 20} MiB, so it was not changed"
        raise TltlError([Diagnostic("TLT0004", title, help="split it: a file may `import` others")])
    mode = _mode(path)
    # Writing renames a temporary file, which would replace even a read-only file: check this first.
    if mode is not None and not (mode & _WRITABLE and os.access(path, os.W_OK)):
        help_ = "check its owner and its attributes" if mode & _WRITABLE else "make it writable"
        raise TltlError([Diagnostic("TLT0005", f"cannot write `{path}`: it is read-only", help=help_)])
    write_file(path, content, "make it and its folder writable", over_inputs=True)


def remove_file(path: Path, advice: str) -> None:
    """Remove a file if it exists; raise TltlError, TLT0005, with ``advice`` if the system refuses."""
    try:
        path.unlink(missing_ok=True)
    except OSError as error:
        raise TltlError([Diagnostic("TLT0005", f"cannot remove `{path}`: {reason(error)}", help=advice)]) from None


@contextmanager
def replace_file(path: Path, advice: str = _OPTION) -> Iterator[Path]:
    """Yield a temporary path beside ``path``, at which the ``with`` block must write a file.

    The temporary path has the same extension as ``path``. At the end of the block, the temporary
    file is renamed to ``path``. If the block raises an exception, even by Ctrl-C, the temporary
    file is removed, and ``path`` stays as it was.

    Raises:
        TltlError: TLT0005 the system refuses to write, with ``advice`` as its help.
    """
    with temporaries() as temporary_files:
        try:
            target = Path(os.path.realpath(path))
            temporary = temporary_files.path(target, target.suffix)
            # Fail now if the folder refuses, not after an hour of work.
            temporary.touch()
            yield temporary
            temporary.replace(target)
        except (OSError, ValueError) as error:
            raise _writing_error(path, error, advice) from None


def _write(files: Mapping[Path, str | bytes], advice: str, *, durable: bool, over_inputs: bool) -> tuple[Path, ...]:
    renames: list[tuple[Path, Path]] = []
    changed: list[Path] = []
    path = Path()
    with temporaries() as temporary_files:
        try:
            for path, content in files.items():
                data = content.encode() if isinstance(content, str) else content
                mode = _mode(path)
                descriptor = descriptor_of(path)
                # With `durable`, write an equal file too, because the existing one may not be on the disk yet.
                if not durable and descriptor is None and mode is not None and _has_content(path, mode, data):
                    continue
                if not over_inputs:
                    check_not_read(path, advice)
                changed.append(path)
                if descriptor is not None:
                    # Write into the open file, to keep what other processes write there before and after this command.
                    with os.fdopen(descriptor, "wb", closefd=False) as file:
                        file.write(data)
                    continue
                if mode is not None and not stat.S_ISREG(mode):
                    # Do not replace a device or a pipe by a file. If the path is a folder, this fails, as it should.
                    with path.open("wb") as file:
                        file.write(data)
                    continue
                target = Path(os.path.realpath(path))
                temporary = temporary_files.path(target)
                _write_temporary(temporary, data, mode, durable)
                renames.append((temporary, target))
            for temporary, path in renames:
                # A single file needs no backup: no later rename can fail.
                if len(renames) > 1:
                    temporary_files.back_up(path)
                temporary.replace(path)
            for path in {target.parent for _, target in renames} if durable else ():
                _sync_folder(path)
        except (OSError, ValueError) as error:
            raise _writing_error(path, error, advice) from None
    return tuple(changed)


def _write_temporary(temporary: Path, data: bytes, mode: int | None, durable: bool) -> None:
    """Write a temporary file with the permissions of the file that it will replace.

    ``mode`` is the mode of that file; None if there is no such file. With ``durable``, the content
    is on the disk when the function returns.
    """
    with temporary.open("wb") as file:
        file.write(data)
        if durable:
            file.flush()
            os.fsync(file.fileno())
    if mode is not None:
        temporary.chmod(stat.S_IMODE(mode))


def _has_content(path: Path, mode: int, data: bytes) -> bool:
    """Whether a path, whose mode is ``mode``, is a regular file with the content ``data``."""
    try:
        return stat.S_ISREG(mode) and path.stat().st_size == len(data) and path.read_bytes() == data
    except OSError:
        return False


def _sync_folder(folder: Path) -> None:
    """Make sure that the renamed files in a folder are on the disk; do nothing on Windows."""
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


def _writing_error(path: Path, error: OSError | ValueError, advice: str) -> TltlError:
    # To write a file, it need not exist. So if something does not exist, it is the folder.
    why = "there is no such folder" if isinstance(error, FileNotFoundError) else reason(error)
    title = f"cannot write `{path}`: {why}"
    if isinstance(error, OSError) and error.errno == errno.EMFILE:
        advice = "let this process open more files: `ulimit -n 1024`"
    return TltlError([Diagnostic("TLT0005", title, help=advice)])
