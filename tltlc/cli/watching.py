"""Doing a command's work again whenever a file changes that it depends on."""

from __future__ import annotations

import os
import time
from collections.abc import Callable, Mapping
from typing import Final, NoReturn

from tltlc.files import Stamp, noted, stamp

PAUSE_S: Final = 0.2
"""Between two looks at the files.  Editors replace files in steps: a change counts once a second look finds no more."""


def repeat(work: Callable[[tuple[str, ...]], None]) -> NoReturn:
    """Work at once, and again after each change, until something is raised, as Ctrl-C does.

    ``work`` is given the paths that have changed, the first time none.  The files are those that :mod:`tltlc.files`
    looked for or read the last time, whether they are there or not.
    """
    changed: tuple[str, ...] = ()
    while True:
        with noted() as before:
            work(changed)
        changed = _changes(before)


def _changes(before: Mapping[str, Stamp]) -> tuple[str, ...]:
    """Wait until files are no longer as they were, and then until they stay as they are."""
    found: dict[str, Stamp] = {}
    while True:
        time.sleep(PAUSE_S)
        last, found = found, {path: now for path, was in before.items() if (now := stamp(path)) != was}
        if found and found == last:
            # A file may have been looked at under several paths: the first is the one that messages use.
            files = {os.path.realpath(path): path for path in reversed(found)}
            return tuple(path for path in found if path in files.values())
