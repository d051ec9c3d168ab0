"""Record which files a computation looks up and reads, to see later whether its result is still valid."""

from __future__ import annotations

import os
import stat
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from typing import BinaryIO, Final, Union

Stamp = Union[tuple[int, ...], None]
"""The state of a file, to see later whether it has changed: its time of change, size and inode number.

For a folder, a device or a pipe, the stamp has only the kind. It is None if nothing is at the path.
"""


class AccessLog(dict[str, Stamp]):
    """Maps each path that was looked up or read to its stamp just before the first access.

    The stamp is the state of the file (:func:`stamp`): time of change, size and inode number.
    ``read`` has the device and inode numbers of the regular files that were read.
    """

    def __init__(self) -> None:
        super().__init__()
        self.read: set[tuple[int, int]] = set()


_active_logs: Final[list[AccessLog]] = []
"""The active access logs, the innermost last."""


@contextmanager
def access_log() -> Iterator[AccessLog]:
    """Yield a log of the paths that are looked up or read inside the ``with`` block.

    The log maps each path to its stamp (time of change, size and inode number) just before the
    first access. A result that was computed inside the block stays valid as long as :func:`stamp`
    returns the same for each of these paths.
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
    """Record in all active access logs that a stream is about to be read.

    Do nothing if the stream is not from a regular file.
    """
    with suppress(OSError, ValueError):
        _log_identity(stream.fileno())


def was_read(path: str | os.PathLike[str]) -> bool:
    """Whether the file at a path was read, under any name, since the innermost :func:`access_log` began.

    The result is False outside an :func:`access_log`. Files are compared by their inode numbers. A
    command that watches files begins a new log in each round, because the system reuses inode
    numbers: after an editor has replaced a source file, an output may get the number of the old
    file.
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


def stamp(path: str) -> Stamp:
    """Return the current stamp of a path: the file's time of change, size and inode number.

    If a later stamp differs, the file has changed. For a folder, a device or a pipe, the stamp has
    only the kind. It is None if nothing is at the path.
    """
    try:
        status = os.stat(path)  # noqa: PTH116
    except (OSError, ValueError):
        return None
    if not stat.S_ISREG(status.st_mode):
        return (stat.S_IFMT(status.st_mode),)
    return (status.st_mtime_ns, status.st_size, status.st_ino)


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
