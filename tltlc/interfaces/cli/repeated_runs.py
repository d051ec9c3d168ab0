"""Repeat the work of a command whenever a file that it depends on changes."""

from __future__ import annotations

import os
import time
from collections.abc import Callable, Iterable, Mapping
from typing import Final, NoReturn

from tltlc.diagnostics.diagnostic import Diagnostic, TltlError
from tltlc.interfaces.cli import exits
from tltlc.io.access_log import Stamp, access_log, stamp
from tltlc.io.resources import OutOfTimeError, resource_limits

PAUSE_S: Final = 0.2
"""Seconds between two checks of the files.

After a change, work starts only when a check finds no further change, so that files are complete.
"""

_MOST_LOOKS: Final = 10
"""The most checks that wait for an end of changes. Then work starts anyway: some programs never stop writing."""


def repeat(work: Callable[[tuple[str, ...]], None], list_files: Callable[[], Iterable[str]] = tuple) -> NoReturn:
    """Run ``work`` at once, and again after each change of a file, until an exception such as Ctrl-C.

    ``work`` receives the paths that changed, and an empty tuple the first time. Two kinds of files
    are watched: those that the last run read or tried to find with :mod:`tltlc.io.files`, and new
    files that ``list_files`` returns.
    """
    changed: tuple[str, ...] = ()
    while True:
        known = frozenset(list_files())
        with access_log() as before:
            _run_bounded(work, changed)
        changed = _changes(before, known, list_files)


def _run_bounded(work: Callable[[tuple[str, ...]], None], changed: tuple[str, ...]) -> None:
    """Run ``work`` within the limits of processor time and memory.

    If ``work`` exceeds a limit, report this and return, because the next change may fix it.
    """
    try:
        with resource_limits():
            work(changed)
    except (OutOfTimeError, MemoryError, RecursionError) as error:
        exits.report(error)


def _changes(
    before: Mapping[str, Stamp], known: frozenset[str], list_files: Callable[[], Iterable[str]]
) -> tuple[str, ...]:
    """Wait until files change, and then until they stop changing; return their paths.

    Some programs never stop writing, so the wait also ends after more than ``_MOST_LOOKS`` checks
    that find changes. ``before`` maps the paths that the last run read or looked up to their stamps
    (time of change, size). ``known`` contains the files that ``list_files`` returned before the last
    run.
    """
    changed: dict[str, Stamp] = {}
    new: tuple[str, ...] = ()
    due = 0.0
    looks = 0
    while True:
        time.sleep(PAUSE_S)
        look_start = time.monotonic()
        if look_start >= due:
            new = tuple(path for path in list_files() if path not in known and path not in before)
            # Spend at most a twentieth of the time on searching folders, which may be large.
            due = look_start + 20 * (time.monotonic() - look_start)
        previous, changed = (
            changed,
            {path: new_stamp for path, old_stamp in before.items() if (new_stamp := stamp(path)) != old_stamp},
        )
        changed.update({path: stamp(path) for path in new})
        looks += bool(changed)
        if changed and (changed == previous or looks > _MOST_LOOKS):
            # The same file may appear under several paths. Keep only the first one of each file.
            files = {_real_path(path): path for path in reversed(changed)}
            return tuple(path for path in changed if path in files.values())


def _real_path(path: str) -> str:
    """Return the path with all links resolved; raise TLT0001 if the current folder was deleted."""
    try:
        return os.path.realpath(path)
    except FileNotFoundError:
        title, help_ = "the current folder has been deleted", "start the command again in another folder"
        raise TltlError([Diagnostic("TLT0001", title, help=help_)]) from None
