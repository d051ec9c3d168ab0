"""Specs that are in another file now, or are called otherwise and mean the same."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from typing import TYPE_CHECKING, Final

from tltlc.automaton.infinite.work import DEFAULT_WORK
from tltlc.core.record import record, replace
from tltlc.diagnostics.diagnostic import TltlError
from tltlc.tools.diff.breaking import Change, Move, Version, compared

if TYPE_CHECKING:
    from tltlc.automaton.fspa import Fspa

_SOURCE: Final = ".tltl"
"""An artefact that is elsewhere is not found where its host looks for it: only specs in sources move."""
_MOST_RENAMED: Final = 6
"""With so many new specs, at most, one that is gone is compared."""


@record
class _Side:
    """A spec in the file of a change; ``number`` is that of the change."""

    number: int
    fspa: Fspa


def followed(changes: Sequence[Change], work: int = DEFAULT_WORK) -> tuple[Change, ...]:
    """The changes, in which specs that moved from file to file, or were renamed, are told apart from others.

    One that is gone moved to where one of its name is new; else it was renamed to a new one that accepts the same
    traces, of the same file rather than of another.
    """
    gone = [each for number, change in enumerate(changes) for each in _only(change.old, change.new, number, change)]
    added = [each for number, change in enumerate(changes) for each in _only(change.new, change.old, number, change)]
    found: list[tuple[_Side, _Side]] = []
    for is_same in (_has_its_name, lambda old, new: _means_the_same(old, new, work)):
        for old in list(gone):
            new = next((each for each in _candidates(old, added) if is_same(old, each)), None)
            if new is not None:
                found.append((old, new))
                gone.remove(old)
                added.remove(new)
    return tuple(_with(change, number, found, changes) for number, change in enumerate(changes))


def _only(these: Version, those: Version, number: int, change: Change) -> Iterator[_Side]:
    """The specs of one version of a source that the other one does not have."""
    names = {fspa.name for fspa in those.automata}
    if change.path.endswith(_SOURCE):
        yield from (_Side(number, fspa) for fspa in these.automata if fspa.name not in names)


def _candidates(old: _Side, added: Iterable[_Side]) -> list[_Side]:
    """The new specs that an old one may be by now, the likeliest first."""
    return sorted(added, key=lambda each: (each.fspa.name != old.fspa.name, each.number != old.number))[:_MOST_RENAMED]


def _has_its_name(old: _Side, new: _Side) -> bool:
    return old.fspa.name == new.fspa.name


def _means_the_same(old: _Side, new: _Side, work: int) -> bool:
    try:
        return compared(old.fspa, new.fspa, work).comparison.relation == "equivalent"
    except TltlError:
        return False


def _with(change: Change, number: int, found: Sequence[tuple[_Side, _Side]], changes: Sequence[Change]) -> Change:
    """A change without the specs that moved away or came, which are listed as moves where they came."""
    away = [old.fspa for old, _ in found if old.number == number]
    came = [(old, new) for old, new in found if new.number == number]
    moves = (
        Move(old.fspa, new.fspa, changes[old.number].old.places[old.fspa.name], change.new.places[new.fspa.name])
        for old, new in came
    )
    return replace(
        change,
        old=_without(change.old, away),
        new=_without(change.new, [new.fspa for _, new in came]),
        moves=tuple(moves),
    )


def _without(version: Version, automata: Sequence[Fspa]) -> Version:
    return replace(version, automata=tuple(fspa for fspa in version.automata if fspa not in automata))
