"""Doing a command's work again whenever a file changes that it depends on."""

from __future__ import annotations

import os
import time
from collections.abc import Callable, Iterable, Mapping
from typing import Final, NoReturn

from tltlc.diagnostics.diagnostic import Diagnostic, TltlError
from tltlc.interfaces.cli import exits
from tltlc.io.files import Stamp, noted, stamp
from tltlc.io.resources import OutOfTimeError, bounded

PAUSE_S: Final = 0.2
"""Between two looks at the files.  Editors replace files in steps: a change counts once a second look finds no more."""

_MOST_LOOKS: Final = 10
"""So many looks after the first change it counts anyway: some programs write to a file all the time."""


def repeat(work: Callable[[tuple[str, ...]], None], listed: Callable[[], Iterable[str]] = tuple) -> NoReturn:
    """Work at once, and again after each change, until something is raised, as Ctrl-C does.

    ``work`` is given the paths that have changed, the first time none.  The files are those that :mod:`tltlc.io.files`
    looked for or read the last time, whether they are there or not, and those that ``listed`` says by now.
    """
    changed: tuple[str, ...] = ()
    while True:
        known = frozenset(listed())
        with noted() as before:
            _done(work, changed)
        changed = _changes(before, known, listed)


def _done(work: Callable[[tuple[str, ...]], None], changed: tuple[str, ...]) -> None:
    """Work; what took too long or too much is reported, and may be mended by the next change."""
    try:
        with bounded():
            work(changed)
    except (OutOfTimeError, MemoryError, RecursionError) as error:
        exits.report(error)


def _changes(
    before: Mapping[str, Stamp], known: frozenset[str], listed: Callable[[], Iterable[str]]
) -> tuple[str, ...]:
    """Wait until files are no longer as they were, and then until they stay as they are, or for some more looks."""
    found: dict[str, Stamp] = {}
    new: tuple[str, ...] = ()
    due = 0.0
    looks = 0
    while True:
        time.sleep(PAUSE_S)
        begun = time.monotonic()
        if begun >= due:
            new = tuple(path for path in listed() if path not in known and path not in before)
            # A large folder is searched less often: for a twentieth of the time at most.
            due = begun + 20 * (time.monotonic() - begun)
        last, found = found, {path: now for path, was in before.items() if (now := stamp(path)) != was}
        found.update({path: stamp(path) for path in new})
        looks += bool(found)
        if found and (found == last or looks > _MOST_LOOKS):
            # A file may have been looked at under several paths: the first is the one that messages use.
            files = {_place(path): path for path in reversed(found)}
            return tuple(path for path in found if path in files.values())


def _place(path: str) -> str:
    """Where a path leads, by one name; error TLT0001 where the current folder has gone."""
    try:
        return os.path.realpath(path)
    except FileNotFoundError:
        title, way_out = "the current folder has been deleted", "start the command again in another one"
        raise TltlError([Diagnostic("TLT0001", title, help=way_out)]) from None
