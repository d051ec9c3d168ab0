"""Allow a computation to read files only in certain folders."""

from __future__ import annotations

import os
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from contextvars import ContextVar
from typing import Final

from tltlc.diagnostics.diagnostic import Diagnostic, Label

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


def outside_diagnostic(name: str, labels: tuple[Label, ...] = ()) -> Diagnostic:
    """Return the error TLT0777 for a file or folder that :func:`confine_reads` forbids to read.

    ``name`` is its name in the message, and ``labels`` are the places in a source that name it.
    """
    title = f"`{name}` is outside the folder of the playground, so it is not read"
    return Diagnostic(
        "TLT0777", title, labels, "move it into that folder, or start `tltlc serve` in a folder above both"
    )


def _is_inside(path: str, folders: Iterable[str]) -> bool:
    key = os.path.normcase(path)
    return any(key == folder or key.startswith(os.path.join(folder, "")) for folder in folders)  # noqa: PTH118
