"""Find specs that moved to another file, or were renamed without a change of meaning."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from typing import TYPE_CHECKING, Final

from tltlc.automaton.work import DEFAULT_WORK
from tltlc.core.record import record, replace
from tltlc.diagnostics.diagnostic import TltlError
from tltlc.tools.diff.breaking import FileChange, MovedSpec, Version, compare_versions

if TYPE_CHECKING:
    from tltlc.automaton.fspa import Fspa

_SOURCE: Final = ".tltl"
"""The ending of source files. Specs can move only between these: a game finds an artefact by its file name."""
_MOST_RENAMED: Final = 6
"""The most new specs that a removed spec is compared with."""


@record
class _SpecInChange:
    """A spec that is in only one of the two versions of a file: it was removed or added.

    ``number`` is the index of the file in the list of changed files.
    """

    number: int
    fspa: Fspa


def follow_moves(changes: Sequence[FileChange], work: int = DEFAULT_WORK) -> tuple[FileChange, ...]:
    """Find the specs that were moved or renamed, and return the changes with these specs in ``moves``.

    A removed spec counts as moved if another file has a new spec of the same name. Otherwise it
    counts as renamed if a new spec accepts the same traces; specs in the same file are tried first.
    At most ``work`` steps are spent on each comparison.
    """
    removed = [
        side
        for number, change in enumerate(changes)
        for side in _specs_in_one_version(change.old, change.new, number, change)
    ]
    added = [
        side
        for number, change in enumerate(changes)
        for side in _specs_in_one_version(change.new, change.old, number, change)
    ]
    matches: list[tuple[_SpecInChange, _SpecInChange]] = []
    for is_same in (_has_same_name, lambda old, new: _has_same_meaning(old, new, work)):
        for old in list(removed):
            new = next((candidate for candidate in _candidates(old, added) if is_same(old, candidate)), None)
            if new is not None:
                matches.append((old, new))
                removed.remove(old)
                added.remove(new)
    return tuple(_with_moves(change, number, matches, changes) for number, change in enumerate(changes))


def _specs_in_one_version(
    version: Version, other_version: Version, number: int, change: FileChange
) -> Iterator[_SpecInChange]:
    """Yield the specs of ``version`` that ``other_version`` of the same file does not have.

    Yield nothing for an artefact. ``number`` is the index of ``change``, the change of the file.
    """
    names = {fspa.name for fspa in other_version.automata}
    if change.path.endswith(_SOURCE):
        yield from (_SpecInChange(number, fspa) for fspa in version.automata if fspa.name not in names)


def _candidates(old: _SpecInChange, added: Iterable[_SpecInChange]) -> list[_SpecInChange]:
    """Return at most ``_MOST_RENAMED`` of the new specs ``added`` that ``old`` may have become.

    Those with the same name come first, then those in the same file.
    """
    return sorted(added, key=lambda side: (side.fspa.name != old.fspa.name, side.number != old.number))[:_MOST_RENAMED]


def _has_same_name(old: _SpecInChange, new: _SpecInChange) -> bool:
    return old.fspa.name == new.fspa.name


def _has_same_meaning(old: _SpecInChange, new: _SpecInChange, work: int) -> bool:
    try:
        return compare_versions(old.fspa, new.fspa, work).comparison.relation == "equivalent"
    except TltlError:
        return False


def _with_moves(
    change: FileChange,
    number: int,
    matches: Sequence[tuple[_SpecInChange, _SpecInChange]],
    changes: Sequence[FileChange],
) -> FileChange:
    """Return the change of one file in which moved and renamed specs are listed in ``moves``.

    ``matches`` has the old and the new form of each such spec, and ``number`` is the index of
    ``change`` in ``changes``. Old forms are removed from the old version of their file, and new forms
    from the new version, so that they no longer count as removed and added.
    """
    moved_away = [old.fspa for old, _ in matches if old.number == number]
    moved_here = [(old, new) for old, new in matches if new.number == number]
    moves = (
        MovedSpec(old.fspa, new.fspa, changes[old.number].old.places[old.fspa.name], change.new.places[new.fspa.name])
        for old, new in moved_here
    )
    return replace(
        change,
        old=_without(change.old, moved_away),
        new=_without(change.new, [new.fspa for _, new in moved_here]),
        moves=tuple(moves),
    )


def _without(version: Version, automata: Sequence[Fspa]) -> Version:
    return replace(version, automata=tuple(fspa for fspa in version.automata if fspa not in automata))
