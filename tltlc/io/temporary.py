"""Make temporary files beside their final paths, and remove those that killed processes left.

A process that writes into a folder creates a lock file ``.tltlc-PID-TOKEN.lock`` there, and keeps
it locked as long as it has temporary files ``.tltlc-PID-TOKEN-NUMBER.ENDING`` there. The system
releases the lock when the process ends, even if it is killed. So if another process can lock the
file, the first process has ended, and its files may be removed. A temporary folder
(:func:`temporary_folder`) has a name of this form and a lock file, too.

The signal handlers of :mod:`tltlc.interfaces.cli.interrupts` wait until a function of this module
has ended. Otherwise an interrupt could leave a lock file behind, or stop a removal half-way.
"""

from __future__ import annotations

import os
import re
import stat
from collections.abc import Iterable, Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import IO, Final

from tltlc.diagnostics.diagnostic import Diagnostic, TltlError
from tltlc.io.locking import try_lock

_NAME: Final = re.compile(r"(\.tltlc-[0-9]{1,20}-[0-9a-f]{16})(?:(\.lock)|-[0-9]+(?:\.[^.]+)?)")
_MOST_LOCKS: Final = 200
"""The most lock files of other processes that one call of :func:`remove_abandoned` checks."""
_ATTEMPTS: Final = 100
"""The most attempts to create a lock file.

An attempt fails only if another process removes the new file.
"""


class Temporaries:
    """The temporary files of a task, in one or several folders.

    The task writes files at the paths that :meth:`path` returns, and renames them to their final
    paths. :meth:`close` removes the temporary files that were not renamed.
    """

    def __init__(self) -> None:
        self._locks: dict[Path, tuple[str, IO[bytes] | None]] = {}
        """For each folder, the prefix of the names of temporary files there, and the open lock file."""
        self._paths: list[Path] = []
        self._backups: list[tuple[Path, Path | None]] = []
        """The paths to restore, each with the path of its backup, or None if there was no file."""

    def path(self, target: Path, ending: str = ".tmp") -> Path:
        """Return a path for a new temporary file in the folder of ``target``.

        The first call for a folder creates the lock file, and removes files that killed processes
        left.

        Raises:
            OSError: the folder is not writable.
        """
        folder = target.parent
        if folder not in self._locks:
            remove_abandoned(folder)
            self._locks[folder] = _lock_file(folder)
        prefix, _ = self._locks[folder]
        self._paths.append(folder / f"{prefix}-{len(self._paths)}{ending}")
        return self._paths[-1]

    def back_up(self, target: Path) -> None:
        """Back up the file at ``target``, so that :meth:`restore` can put it back later.

        If there is no file at ``target`` now, :meth:`restore` removes the file that is there later.

        Raises:
            OSError: the system refuses to read the file or to write the backup.
        """
        backup = self.path(target)
        try:
            backup.hardlink_to(target)
        except FileNotFoundError:
            self._backups.append((target, None))
            return
        except OSError:
            # Some file systems have no hard links, and some files do not allow them.
            import shutil

            shutil.copy2(target, backup)
        self._backups.append((target, backup))

    def restore(self) -> list[Path]:
        """Put back all files that were backed up; return the paths at which the system refuses this."""
        backups, self._backups = self._backups, []
        return [target for target, backup in reversed(backups) if not _restore_file(target, backup)]

    def close(self) -> None:
        """Remove the temporary files that are left, then the lock files.

        The lock files come last, in case the process is killed in between: other processes remove
        temporary files only if their lock file is there.
        """
        for path in self._paths:
            _remove(path)
        for folder, (prefix, lock) in self._locks.items():
            if lock is not None:
                _remove_lock(folder / f"{prefix}.lock", lock)
        self._paths.clear()
        self._locks.clear()


@contextmanager
def temporaries() -> Iterator[Temporaries]:
    """Yield a new :class:`Temporaries`, and close it at the end of the ``with`` block.

    If the block raises an exception, first put back the files that were backed up.
    """
    owner = Temporaries()
    try:
        yield owner
    except BaseException:
        owner.restore()
        raise
    finally:
        owner.close()


@contextmanager
def new_folders(folders: Iterable[Path]) -> Iterator[None]:
    """Create missing folders and their missing parents at the start of the ``with`` block.

    If the block raises an exception, or a folder cannot be created, remove the new folders that are empty.

    Raises:
        OSError, ValueError: the system refuses to create a folder.
    """
    created: list[Path] = []
    try:
        for folder in folders:
            _make_folder(folder, created)
        yield
    except BaseException:
        for folder in reversed(created):
            with suppress(OSError):
                folder.rmdir()
        raise


def _make_folder(folder: Path, created: list[Path]) -> None:
    """Create a folder and its missing parents; append the new folders to ``created``."""
    missing = []
    while not folder.exists() and folder != folder.parent:
        missing.append(folder)
        folder = folder.parent
    if not folder.is_dir():
        # Raise the exception that says what is wrong.
        folder.mkdir()
    for new_folder in reversed(missing):
        try:
            new_folder.mkdir()
        except FileExistsError:
            if not new_folder.is_dir():
                raise
        else:
            created.append(new_folder)


@contextmanager
def temporary_folder() -> Iterator[Path]:
    """Yield a new folder that only this user can read, and remove it with its contents at the end.

    If the process is killed, the next call of this function by any process removes the folder.

    Raises:
        TltlError: TLT0005 the folder cannot be created.
    """
    # Imported here because `tempfile` takes long to load.
    import tempfile

    with temporaries() as owner:
        try:
            folder = owner.path(Path(os.path.realpath(tempfile.gettempdir()), "folder"), "")
            folder.mkdir(mode=0o700)
        except OSError as error:
            raise _no_folder_error(error) from None
        yield folder


def _no_folder_error(error: OSError) -> TltlError:
    title = f"cannot create a temporary folder: {(error.strerror or str(error)).lower()}"
    help_ = "free some space, or set TMPDIR to a folder that you can write to"
    return TltlError([Diagnostic("TLT0005", title, help=help_)])


def remove_abandoned(folder: Path) -> None:
    """Remove the temporary files and folders in ``folder`` whose processes have ended.

    Remove only regular files and folders of this user, and only those whose names this module has
    made. Follow no links. Ignore what cannot be removed.
    """
    with suppress(OSError):
        matches = list(filter(None, (_NAME.fullmatch(entry.name) for entry in os.scandir(folder))))
        names_by_prefix: dict[str, list[str]] = {}
        for match in matches:
            if not match[2]:
                names_by_prefix.setdefault(match[1], []).append(match[0])
        for lock in [match for match in matches if match[2]][:_MOST_LOCKS]:
            with suppress(OSError):
                _remove_if_abandoned(folder, lock[1], names_by_prefix.get(lock[1], []))


def _remove_if_abandoned(folder: Path, prefix: str, names: list[str]) -> None:
    lock = folder / f"{prefix}.lock"
    file = _open_lock(lock)
    if file is None:
        return
    if not try_lock(file):
        file.close()
        return
    try:
        for name in names:
            _remove(folder / name)
    except BaseException:
        file.close()
        raise
    _remove_lock(lock, file)


def _remove(path: Path) -> None:
    """Remove a temporary file, or a temporary folder of this user; do nothing if the system refuses."""
    with suppress(OSError):
        if _is_file(path):
            path.unlink(missing_ok=True)
        elif _is_own_folder(path):
            import shutil

            shutil.rmtree(path, ignore_errors=True)


def _is_own_folder(path: Path) -> bool:
    # Temporary folders have no extension.
    status = path.lstat()
    return stat.S_ISDIR(status.st_mode) and not path.suffix and (os.name == "nt" or status.st_uid == os.getuid())


def _restore_file(target: Path, backup: Path | None) -> bool:
    """Move a backup back to ``target``; without a backup, remove the file at ``target``.

    Returns False if the system refuses.
    """
    try:
        if backup is None:
            target.unlink(missing_ok=True)
        else:
            backup.replace(target)
    except OSError:
        return False
    return True


def _open_lock(path: Path) -> IO[bytes] | None:
    """Open the lock file of another process; return None if it is a link, a pipe, or another special file."""
    if not _is_file(path):
        return None
    flags = os.O_RDWR | getattr(os, "O_NOFOLLOW", 0) | getattr(os, "O_NONBLOCK", 0)
    file = os.fdopen(os.open(path, flags), "r+b")
    if stat.S_ISREG(os.fstat(file.fileno()).st_mode):
        return file
    file.close()
    return None


def _is_file(path: Path) -> bool:
    return stat.S_ISREG(path.lstat().st_mode)


def _lock_file(folder: Path) -> tuple[str, IO[bytes] | None]:
    """Create and lock a lock file in a folder.

    Return the prefix for the names of temporary files in the folder, and the open lock file. If
    locks do not work there, return None instead of the file.
    """
    for _ in range(_ATTEMPTS):
        prefix = f".tltlc-{os.getpid()}-{os.urandom(8).hex()}"
        path = folder / f"{prefix}.lock"
        file = path.open("xb")
        try:
            locked = try_lock(file)
        except OSError:
            _remove_lock(path, file)
            return prefix, None
        # Another process may have removed the file before it was locked, because it seemed to be abandoned.
        if locked and _is_still_at(path, file):
            return prefix, file
        file.close()
    return prefix, None


def _is_still_at(path: Path, file: IO[bytes]) -> bool:
    """Whether a path still leads to the open file ``file``, which may have been removed or replaced."""
    try:
        return os.path.samestat(path.lstat(), os.fstat(file.fileno()))
    except FileNotFoundError:
        return False


def _remove_lock(path: Path, file: IO[bytes]) -> None:
    """Close and remove a lock file that this process has open. Windows removes only closed files."""
    if os.name == "nt":
        file.close()
    with suppress(OSError):
        path.unlink(missing_ok=True)
    file.close()
