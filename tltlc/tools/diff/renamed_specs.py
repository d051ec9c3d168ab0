"""Find specs that moved to another file, or were renamed but mean the same."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from typing import TYPE_CHECKING, Final

from tltlc.automaton.work import DEFAULT_WORK
from tltlc.core.record import record, replace
from tltlc.diagnostics.diagnostic import TltlError
from tltlc.tools.diff.breaking import FileChange, MovedSpec, Version, compared

if TYPE_CHECKING:
    from tltlc.automaton.fspa import Fspa

_SOURCE: Final = ".tltl"
"""Only specs in source files can move: a host does not find an artefact that is elsewhere."""
_MOST_RENAMED: Final = 6
"""The most new specs that a removed spec is compared with."""


@record
class _Side:
    """A spec in the file of a change; ``number`` is the index of the change."""

    number: int
    fspa: Fspa


def followed(changes: Sequence[FileChange], work: int = DEFAULT_WORK) -> tuple[FileChange, ...]:
    """Return the changes with moved and renamed specs recorded as moves.

    A removed spec moved to a file where a spec of its name is new. Otherwise it was renamed to a
    new spec that accepts the same traces, preferably in the same file.
    """
    gone = [side for number, change in enumerate(changes) for side in _only(change.old, change.new, number, change)]
    added = [side for number, change in enumerate(changes) for side in _only(change.new, change.old, number, change)]
    matches: list[tuple[_Side, _Side]] = []
    for is_same in (_has_its_name, lambda old, new: _means_the_same(old, new, work)):
        for old in list(gone):
            new = next((candidate for candidate in _candidates(old, added) if is_same(old, candidate)), None)
            if new is not None:
                matches.append((old, new))
                gone.remove(old)
                added.remove(new)
    return tuple(_with(change, number, matches, changes) for number, change in enumerate(changes))


def _only(version: Version, other_version: Version, number: int, change: FileChange) -> Iterator[_Side]:
    """Yield the specs of one version of a source file that the other version does not have."""
    names = {fspa.name for fspa in other_version.automata}
    if change.path.endswith(_SOURCE):
        yield from (_Side(number, fspa) for fspa in version.automata if fspa.name not in names)


def _candidates(old: _Side, added: Iterable[_Side]) -> list[_Side]:
    """Return the new specs that an old one may have become, the most likely first."""
    return sorted(added, key=lambda side: (side.fspa.name != old.fspa.name, side.number != old.number))[:_MOST_RENAMED]


def _has_its_name(old: _Side, new: _Side) -> bool:
    return old.fspa.name == new.fspa.name


def _means_the_same(old: _Side, new: _Side, work: int) -> bool:
    try:
        return compared(old.fspa, new.fspa, work).comparison.relation == "equivalent"
    except TltlError:
        return False


def _with(
    change: FileChange, number: int, matches: Sequence[tuple[_Side, _Side]], changes: Sequence[FileChange]
) -> FileChange:
    """Return a change without the specs that moved; specs that moved here are listed as moves."""
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
