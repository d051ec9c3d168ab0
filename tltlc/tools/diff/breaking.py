"""Find the changes between two versions of a file that affect a host or a recorded baseline.

A host is a game that supplies signals and runs a monitor. A baseline is an earlier recording that a
spec has judged. Each change is a diagnostic: an error if it breaks a host or a baseline, a warning
if it only changes numbers, and a note if hosts and baselines can ignore it.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import TYPE_CHECKING, Final

from tltlc.automaton.work import DEFAULT_WORK
from tltlc.core.record import EMPTY, record, replace
from tltlc.diagnostics.diagnostic import Diagnostic, Label
from tltlc.resolve.spec import Atom
from tltlc.tools.diff import findings
from tltlc.tools.diff.differences import Difference, new_param_names
from tltlc.tools.diff.pairs import SpecPair, diff
from tltlc.tools.diff.renaming import new_signal_names, rename_signals, with_old_atom_names

if TYPE_CHECKING:
    from tltlc.automaton.fspa import Fspa
    from tltlc.tools.diff.library import Export
    from tltlc.tools.diff.library_settings import Rules

_SHARED: Final = ("clock", "signal", "param", "atom")
"""The kinds of differences that are reported once for all specs of a file."""


@record
class Version:
    """One version of a file.

    ``automata`` are those of its specs. ``places`` has the place of each spec in the text, by name,
    for messages. A file without specs is a library. Then ``exports`` has the declarations that other
    files can import, and ``rules`` has the clock and the exclusive atoms that the library sets for
    all specs that import it.
    """

    automata: tuple[Fspa, ...] = ()
    places: Mapping[str, Label] = EMPTY
    exports: Mapping[str, Export] = EMPTY
    rules: Rules | None = None


@record
class MovedSpec:
    """A spec that moved to another file or was renamed, with its old and its new place."""

    old: Fspa
    new: Fspa
    old_place: Label
    new_place: Label


@record
class FileChange:
    """Two versions of the file at a path.

    If the file did not exist, or no longer exists, that version is empty. ``moves`` lists the specs
    that moved into the file or were renamed; ``old`` and ``new`` do not have these specs.
    """

    path: str
    old: Version
    new: Version
    moves: tuple[MovedSpec, ...] = ()


def version_changes(change: FileChange, work: int = DEFAULT_WORK) -> tuple[Diagnostic, ...]:
    """Return a diagnostic for each change of a file.

    The changes of its specs come first, then those of their clock, signals, params and atoms. If
    neither version has specs, the file is a library. Then the changes are those of its declarations,
    its clock and its exclusive atoms.

    Error (:class:`~tltlc.diagnostics.diagnostic.TltlError`): TLT0750 if a comparison takes more
    than ``work`` steps.
    """
    old, new = change.old, change.new
    if not (old.automata or new.automata or change.moves):
        from tltlc.tools.diff.export_changes import export_changes

        return (*export_changes(old.exports, new.exports), *_changed_rules(old, new))
    return tuple(_spec_changes(old, new, change.moves, work))


def _changed_rules(old: Version, new: Version) -> Iterator[Diagnostic]:
    if old.rules is not None and new.rules is not None:
        from tltlc.tools.diff.library_settings import changed_rules

        yield from changed_rules(old.rules, new.rules)


def _spec_changes(old: Version, new: Version, moves: Sequence[MovedSpec], work: int) -> Iterator[Diagnostic]:
    before = {fspa.name: fspa for fspa in old.automata}
    after = {fspa.name: fspa for fspa in new.automata}
    for name in before:
        if name not in after:
            yield findings.spec_removed(name, old.places[name])
    for move in moves:
        if move.old.name == move.new.name:
            yield findings.spec_moved(move.new.name, move.old_place, move.new_place)
        else:
            yield findings.spec_renamed(move.old.name, move.new.name, move.old_place, move.new_place)
    for name in after:
        if name not in before:
            yield findings.spec_added(name, new.places[name])
    pairs = [compare_versions(before[name], fspa, work) for name, fspa in after.items() if name in before]
    pairs += [compare_versions(move.old, move.new, work) for move in moves]
    for pair in pairs:
        place = new.places[pair.b.name]
        if pair.comparison.relation not in ("equivalent", None):
            yield findings.traces_changed(pair, place)
        for difference in pair.differences:
            if difference.kind not in _SHARED:
                yield findings.setting_changed(pair.b.name, difference, place)
    yield from _shared_changes(pairs, new.places)


def compare_versions(old: Fspa, new: Fspa, work: int) -> SpecPair:
    """Return the differences between two versions of a spec.

    Atoms with the same name count as the same atom. If their values differ, this is a separate
    difference. A renamed atom or signal is a difference under its old name.

    Error (:class:`~tltlc.diagnostics.diagnostic.TltlError`): TLT0750 if the comparison takes more
    than ``work`` steps.
    """
    renamed_atoms = with_old_atom_names(old, new)
    names = new_signal_names(old, renamed_atoms)
    pair = diff(rename_signals(old, names), renamed_atoms, True, work)
    signals_old, signals_new = ({signal.name: signal for signal in fspa.signals} for fspa in (old, new))
    renamings = [Difference("signal", name, signals_old[name], signals_new[now]) for name, now in names.items()]
    renamings += [
        Difference("atom", before.name, before, now)
        for before, now in zip(renamed_atoms.atoms, new.atoms, strict=True)
        if before.name != now.name
    ]
    return replace(pair, differences=(*renamings, *pair.differences))


def _shared_changes(pairs: Sequence[SpecPair], places: Mapping[str, Label]) -> Iterator[Diagnostic]:
    """Yield a diagnostic for each change of the clock, a signal, a param or an atom.

    A change that affects several specs is yielded once. ``places`` has the place of each spec, by
    name.
    """
    users: dict[Difference, list[SpecPair]] = {}
    for pair in pairs:
        for difference in pair.differences:
            if difference.kind in _SHARED:
                users.setdefault(difference, []).append(pair)
    new_names = new_param_names(users)
    by_predicate: dict[tuple[str, bool], list[Difference]] = {}
    renamed: dict[str, list[Difference]] = {}
    for difference, using in users.items():
        place, specs = places[using[0].b.name], [pair.b.name for pair in using]
        if difference.kind == "clock":
            yield findings.clock_changed(difference, specs, place)
        elif difference.kind == "signal":
            yield findings.signal_changed(difference, specs, place)
        elif difference.kind == "param" and difference.name not in new_names.values():
            yield findings.param_changed(difference, new_names.get(difference.name), place)
        elif isinstance(difference.a, Atom) and isinstance(difference.b, Atom):
            if difference.b.name != difference.name:
                renamed.setdefault(difference.a.base, []).append(difference)
            elif difference.value_difference is not None:
                key = difference.a.base, difference.value_difference.differs_in_truth
                by_predicate.setdefault(key, []).append(difference)
    for same_predicate in renamed.values():
        yield findings.atoms_renamed(same_predicate, places[users[same_predicate[0]][0].b.name])
    for first, *rest in by_predicate.values():
        using = users[first]
        # An atom has several differences if specs give its signals different names. Name it once.
        names = list(dict.fromkeys(difference.name for difference in rest if difference.name != first.name))
        yield findings.atom_changed(first, names, using[0], places[using[0].b.name])
