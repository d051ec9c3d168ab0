"""Find the changes between two versions of a file that a host or a recorded baseline notices.

A host is a game that supplies signals and runs a monitor. A baseline is any earlier recording that
a spec has judged. The findings are diagnostics: a change that breaks a host or a baseline is an
error, a change of numbers alone is a warning, and a change that both can ignore is a note.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import TYPE_CHECKING, Final

from tltlc.automaton.work import DEFAULT_WORK
from tltlc.core.record import EMPTY, record, replace
from tltlc.diagnostics.diagnostic import Diagnostic, Label
from tltlc.resolve.spec import Atom
from tltlc.tools.diff import findings as say
from tltlc.tools.diff.differences import Difference, renamed_params
from tltlc.tools.diff.pairs import SpecPair, diff
from tltlc.tools.diff.renaming import renamed_signals, with_names_of, with_signals

if TYPE_CHECKING:
    from tltlc.automaton.fspa import Fspa
    from tltlc.tools.diff.library import OfferedName
    from tltlc.tools.diff.rules import Rules

_OF_ALL: Final = ("clock", "signal", "param", "atom")
"""The kinds of differences that the specs of a file share."""


@record
class Version:
    """A file at one time: its automata, the places of its specs, and its offers if it has no specs.

    ``rules`` is set only for a file that exists and has no specs.
    """

    automata: tuple[Fspa, ...] = ()
    places: Mapping[str, Label] = EMPTY
    offers: Mapping[str, OfferedName] = EMPTY
    rules: Rules | None = None


@record
class MovedSpec:
    """A spec that moved to another file or has another name, with its old and new place."""

    old: Fspa
    new: Fspa
    was_at: Label
    is_at: Label


@record
class FileChange:
    """Two versions of the file at a path. If the file does not exist, its version is empty.

    ``moves`` are the specs that moved into the file. Specs that moved are in neither version.
    """

    path: str
    old: Version
    new: Version
    moves: tuple[MovedSpec, ...] = ()


def breaking(change: FileChange, work: int = DEFAULT_WORK) -> tuple[Diagnostic, ...]:
    """Return everything that changed: first the specs, in order, then what they use.

    Error (:class:`~tltlc.diagnostics.diagnostic.TltlError`): TLT0750 if a comparison takes more
    than ``work``.
    """
    old, new = change.old, change.new
    if not (old.automata or new.automata or change.moves):
        from tltlc.tools.diff.offers import changed_offers

        return (*changed_offers(old.offers, new.offers), *_changed_rules(old, new))
    return tuple(_specs(old, new, change.moves, work))


def _changed_rules(old: Version, new: Version) -> Iterator[Diagnostic]:
    if old.rules is not None and new.rules is not None:
        from tltlc.tools.diff.rules import changed_rules

        yield from changed_rules(old.rules, new.rules)


def _specs(old: Version, new: Version, moves: Sequence[MovedSpec], work: int) -> Iterator[Diagnostic]:
    before = {fspa.name: fspa for fspa in old.automata}
    after = {fspa.name: fspa for fspa in new.automata}
    for name in before:
        if name not in after:
            yield say.spec_gone(name, old.places[name])
    for move in moves:
        if move.old.name == move.new.name:
            yield say.spec_moved(move.new.name, move.was_at, move.is_at)
        else:
            yield say.spec_renamed(move.old.name, move.new.name, move.was_at, move.is_at)
    for name in after:
        if name not in before:
            yield say.spec_added(name, new.places[name])
    pairs = [compared(before[name], fspa, work) for name, fspa in after.items() if name in before]
    pairs += [compared(move.old, move.new, work) for move in moves]
    for pair in pairs:
        place = new.places[pair.b.name]
        if pair.comparison.relation not in ("equivalent", None):
            yield say.other_traces(pair, place)
        for difference in pair.differences:
            if difference.what not in _OF_ALL:
                yield say.judged_otherwise(pair.b.name, difference, place)
    yield from _of_all(pairs, new.places)


def compared(old: Fspa, new: Fspa, work: int) -> SpecPair:
    """Return the differences between two versions of a spec.

    Atoms with the same name are treated as the same atom, and changes of their values are
    differences of their own. A renamed atom or signal is also a difference, under its old name.
    Errors are as in :func:`breaking`.
    """
    renamed_atoms = with_names_of(old, new)
    names = renamed_signals(old, renamed_atoms)
    pair = diff(with_signals(old, names), renamed_atoms, True, work)
    of_old, of_new = ({signal.name: signal for signal in fspa.signals} for fspa in (old, new))
    renamings = [Difference("signal", name, of_old[name], of_new[now]) for name, now in names.items()]
    renamings += [
        Difference("atom", before.name, before, now)
        for before, now in zip(renamed_atoms.atoms, new.atoms, strict=True)
        if before.name != now.name
    ]
    return replace(pair, differences=(*renamings, *pair.differences))


def _of_all(pairs: Sequence[SpecPair], places: Mapping[str, Label]) -> Iterator[Diagnostic]:
    """Yield the changes of the clock, signals, params and atoms.

    Each change comes once for all specs that use it.
    """
    users: dict[Difference, list[SpecPair]] = {}
    for pair in pairs:
        for difference in pair.differences:
            if difference.what in _OF_ALL:
                users.setdefault(difference, []).append(pair)
    new_names = renamed_params(users)
    by_predicate: dict[tuple[str, bool], list[Difference]] = {}
    renamed: dict[str, list[Difference]] = {}
    for difference, using in users.items():
        place, specs = places[using[0].b.name], [pair.b.name for pair in using]
        if difference.what == "clock":
            yield say.clock(difference, specs, place)
        elif difference.what == "signal":
            yield say.signal(difference, specs, place)
        elif difference.what == "param" and difference.name not in new_names.values():
            yield say.param(difference, new_names.get(difference.name), place)
        elif isinstance(difference.a, Atom) and isinstance(difference.b, Atom):
            if difference.b.name != difference.name:
                renamed.setdefault(difference.a.base, []).append(difference)
            elif difference.apart is not None:
                key = difference.a.base, difference.apart.is_judged_otherwise
                by_predicate.setdefault(key, []).append(difference)
    for same_predicate in renamed.values():
        yield say.atoms_called(same_predicate, places[users[same_predicate[0]][0].b.name])
    for first, *rest in by_predicate.values():
        using = users[first]
        # Specs with different names for signals have different samples for the same atom.
        names = list(dict.fromkeys(other.name for other in rest if other.name != first.name))
        yield say.atom(first, names, using[0], places[using[0].b.name])
