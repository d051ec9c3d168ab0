"""Temporary files beside the files that they are to become; those of killed processes are removed later.

A process that writes into a folder creates a lock file there, ``.tltlc-PID-TOKEN.lock``, and holds a lock on it for as
long as it has temporary files ``.tltlc-PID-TOKEN-NUMBER.ENDING`` there. The system releases the lock when the process
ends, even if it is killed. So whoever gets the lock knows that the owner is gone, and may remove its files.
A temporary folder, :func:`temporary_folder`, has such a name and such a lock, too.

No signal that :mod:`tltlc.interfaces.cli.interrupts` handles interrupts a function of this module: it could leave a
lock file that
nobody knows of, or stop the removal half-way.
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
"""Lock files of others that one write looks at; what is left waits for the next one."""
_ATTEMPTS: Final = 100
"""To get a lock file before another process that cleans up removes it; each failure takes such a process."""


class Temporaries:
    """Temporary files in several folders, until :meth:`close` removes those that still have their temporary names."""

    def __init__(self) -> None:
        self._owned: dict[Path, tuple[str, IO[bytes] | None]] = {}
        """By folder: how names of temporary files begin there, and the lock file."""
        self._made: list[Path] = []
        self._kept: list[tuple[Path, Path | None]] = []
        """Places, each with another name of the file that was there, None where there was none."""

    def path(self, place: Path, ending: str = ".tmp") -> Path:
        """A path for a new temporary file in the folder of ``place``.

        Raises:
            OSError: nothing can be written into that folder.
        """
        folder = place.parent
        if folder not in self._owned:
            remove_abandoned(folder)
            self._owned[folder] = _lock_file(folder)
        beginning, _ = self._owned[folder]
        self._made.append(folder / f"{beginning}-{len(self._made)}{ending}")
        return self._made[-1]

    def keep(self, place: Path) -> None:
        """Keep the file at a place, or that there is none, so that :meth:`restore` can undo its replacement.

        Raises:
            OSError: the system refuses.
        """
        kept = self.path(place)
        try:
            kept.hardlink_to(place)
        except FileNotFoundError:
            self._kept.append((place, None))
            return
        except OSError:
            # Some file systems have no hard links, and some files may have none.
            import shutil

            shutil.copy2(place, kept)
        self._kept.append((place, kept))

    def restore(self) -> list[Path]:
        """Put the files back that were kept, the last one first; the places where the system refuses that."""
        kept, self._kept = self._kept, []
        return [place for place, older in reversed(kept) if not _is_restored(place, older)]

    def close(self) -> None:
        """Remove what is left, the lock files last: files without a lock file would stay for ever."""
        for path in self._made:
            _remove(path)
        for folder, (beginning, lock) in self._owned.items():
            if lock is not None:
                _remove_lock(folder / f"{beginning}.lock", lock)
        self._made.clear()
        self._owned.clear()


@contextmanager
def temporaries() -> Iterator[Temporaries]:
    """Within, there are temporary files; at the end, those that were not renamed are removed.

    If the body fails, files that were kept are put back first.
    """
    made = Temporaries()
    try:
        yield made
    except BaseException:
        made.restore()
        raise
    finally:
        made.close()


@contextmanager
def new_folders(folders: Iterable[Path]) -> Iterator[None]:
    """Make folders and those above them where they are missing; if the body fails, remove them where they are empty.

    Raises:
        OSError, ValueError: the system refuses to make one.
    """
    made: list[Path] = []
    try:
        for folder in folders:
            _make_folder(folder, made)
        yield
    except BaseException:
        for folder in reversed(made):
            with suppress(OSError):
                folder.rmdir()
        raise


def _make_folder(folder: Path, made: list[Path]) -> None:
    """Make a folder and those above it; those that were missing join ``made``."""
    missing = []
    while not folder.exists():
        missing.append(folder)
        folder = folder.parent
    if not folder.is_dir():
        # Raises what fits.
        folder.mkdir()
    for place in reversed(missing):
        try:
            place.mkdir()
        except FileExistsError:
            if not place.is_dir():
                raise
        else:
            made.append(place)


@contextmanager
def temporary_folder() -> Iterator[Path]:
    """Within, there is a folder that only this user can read; at the end, it is removed with all that is in it.

    If the process is killed, the next one that makes such a folder removes it. Error: TLT0005, there is no room for it.
    """
    # Loaded late: both take long.
    import tempfile

    with temporaries() as made:
        try:
            folder = made.path(Path(os.path.realpath(tempfile.gettempdir()), "folder"), "")
            folder.mkdir(mode=0o700)
        except OSError as error:
            raise _no_folder(error) from None
        yield folder


def _no_folder(error: OSError) -> TltlError:
    title = f"cannot make a temporary folder: {(error.strerror or str(error)).lower()}"
    help_ = "make room, or set TMPDIR to a folder that you may write into"
    return TltlError([Diagnostic("TLT0005", title, help=help_)])


def remove_abandoned(folder: Path) -> None:
    """Remove the temporary files and folders in a folder whose owners are gone; what cannot be removed stays.

    Only regular files with names of our own are touched, and folders of this user; no link is followed.
    """
    with suppress(OSError):
        names = list(filter(None, (_NAME.fullmatch(entry.name) for entry in os.scandir(folder))))
        temporary: dict[str, list[str]] = {}
        for name in names:
            if not name[2]:
                temporary.setdefault(name[1], []).append(name[0])
        for lock in [name for name in names if name[2]][:_MOST_LOCKS]:
            with suppress(OSError):
                _remove_of(folder, lock[1], temporary.get(lock[1], []))


def _remove_of(folder: Path, beginning: str, names: list[str]) -> None:
    lock = folder / f"{beginning}.lock"
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
    """Remove a temporary file, or a temporary folder of this user; what cannot be removed stays."""
    with suppress(OSError):
        if _is_file(path):
            path.unlink(missing_ok=True)
        elif _is_own_folder(path):
            import shutil

            shutil.rmtree(path, ignore_errors=True)


def _is_own_folder(path: Path) -> bool:
    # Folders are made without an ending.
    found = path.lstat()
    return stat.S_ISDIR(found.st_mode) and not path.suffix and (os.name == "nt" or found.st_uid == os.getuid())


def _is_restored(place: Path, older: Path | None) -> bool:
    try:
        if older is None:
            place.unlink(missing_ok=True)
        else:
            older.replace(place)
    except OSError:
        return False
    return True


def _open_lock(path: Path) -> IO[bytes] | None:
    """The lock file of another process, opened; None if it is a link, a pipe, or anything else but a file."""
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
    """How names of temporary files are to begin in a folder, and the lock file, None where there are no locks."""
    for _ in range(_ATTEMPTS):
        beginning = f".tltlc-{os.getpid()}-{os.urandom(8).hex()}"
        path = folder / f"{beginning}.lock"
        file = path.open("xb")
        try:
            locked = try_lock(file)
        except OSError:
            _remove_lock(path, file)
            return beginning, None
        # Until it is locked, another process may take it for one of an owner that is gone.
        if locked and _is_there(path, file):
            return beginning, file
        file.close()
    return beginning, None


def _is_there(path: Path, file: IO[bytes]) -> bool:
    try:
        return os.path.samestat(path.lstat(), os.fstat(file.fileno()))
    except FileNotFoundError:
        return False


def _remove_lock(path: Path, file: IO[bytes]) -> None:
    """Remove a lock file that this process holds.  Windows removes only files that are closed."""
    if os.name == "nt":
        file.close()
    with suppress(OSError):
        path.unlink(missing_ok=True)
    file.close()
