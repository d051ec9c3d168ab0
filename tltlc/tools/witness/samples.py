"""Find samples for letters: values of signals that give atoms the wanted truth values.

The search does a bounded amount of work. Atoms that share no signal are searched separately
(:mod:`tltlc.tools.witness.search`). If nothing is found, that proves nothing.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import TYPE_CHECKING

from tltlc.automaton.fspa import Fspa, Implicant
from tltlc.core.record import record
from tltlc.monitor import MonitorError
from tltlc.monitor.samples import Samples, check_exclusive, shown
from tltlc.resolve.spec import Signal
from tltlc.tools.witness.search import AtomGroup, Point, groups

if TYPE_CHECKING:
    from tltlc.automaton.compare import Letter

Sample = dict[str, float]
"""The values of all signals of an automaton by name, in SI units; 0 or 1 for a bool."""


@record
class UnsatisfiedLiterals:
    """The reason why there is no sample: literals that no sample was found to make true together.

    ``literals`` are indices of atoms with the wanted truth value. There are as few as could be
    found.
    """

    literals: Implicant

    def text(self, fspa: Fspa) -> str:
        """Return the literals in words, such as ```near(s1)` and not `near(s1, close=3)```."""
        terms = [f"{'' if holds else 'not '}`{fspa.atoms[atom].name}`" for atom, holds in self.literals]
        return terms[0] if len(terms) == 1 else f"{', '.join(terms[:-1])} and {terms[-1]}"


@record
class Unrealised:
    """The first step of a trace, from 1, for which no sample was found, and the reason."""

    step: int
    obstacle: UnsatisfiedLiterals


class Realiser:
    """Finds samples for an automaton with its params at their values, and caches them."""

    def __init__(self, fspa: Fspa) -> None:
        self._fspa = fspa
        self._samples = Samples(fspa, None, [])
        self._groups = groups(fspa)
        self._known: dict[Implicant, Sample | UnsatisfiedLiterals] = {}

    def letter(self, letter: Letter) -> Sample | UnsatisfiedLiterals:
        """Return a sample at which exactly the atoms of a letter hold."""
        return self.literals(tuple((i, atom.name in letter) for i, atom in enumerate(self._fspa.atoms)))

    def literals(self, wanted: Implicant) -> Sample | UnsatisfiedLiterals:
        """Return a sample at which the literals are true.

        Other atoms do not hold if possible.
        """
        if wanted not in self._known:
            self._known[wanted] = self._found(wanted)
        return self._known[wanted]

    def obstacles(self, letter: Letter) -> tuple[UnsatisfiedLiterals, ...]:
        """Return why a letter has no sample; empty if it has one.

        There is an obstacle for each group of atoms that share signals and have no solution.
        """
        sample = self.letter(letter)
        if not isinstance(sample, UnsatisfiedLiterals):
            return ()
        polarity = {i: atom.name in letter for i, atom in enumerate(self._fspa.atoms)}
        points = [_point(group, polarity) for group in self._groups]
        return tuple(point for point in points if isinstance(point, UnsatisfiedLiterals)) or (sample,)

    def letter_of(self, sample: Mapping[str, float]) -> Letter:
        """Return the letter of a sample."""
        return self._letter(self._samples.atom_values(sample, 1))

    def _letter(self, values: tuple[float, ...]) -> Letter:
        return frozenset(atom.name for atom, value in zip(self._fspa.atoms, values, strict=True) if value > 0.0)

    def _found(self, wanted: Implicant) -> Sample | UnsatisfiedLiterals:
        polarity = dict(wanted)
        sample: Sample = {}
        for group in self._groups:
            point = _point(group, polarity)
            if isinstance(point, UnsatisfiedLiterals):
                return point
            sample.update(point)
        try:
            check_exclusive(self._fspa, self._samples.atom_values(sample, 1), 1)
        except MonitorError:
            return UnsatisfiedLiterals(wanted)
        return {signal.name: sample[signal.name] for signal in self._fspa.signals}


def samples(fspa: Fspa, letters: Iterable[Letter]) -> tuple[Sample, ...] | Unrealised:
    """Return the samples of a trace of letters, or the first letter without a sample."""
    realiser = Realiser(fspa)
    trace_samples: list[Sample] = []
    for step, letter in enumerate(letters, start=1):
        sample = realiser.letter(letter)
        if isinstance(sample, UnsatisfiedLiterals):
            return Unrealised(step, sample)
        trace_samples.append(sample)
    return tuple(trace_samples)


def csv_text(fspa: Fspa, samples: Iterable[Sample]) -> str:
    """Return the samples as CSV with the names of the signals as columns.

    ``tltlc monitor`` and generated monitors accept this format.
    """
    import csv
    import io

    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow([signal.name for signal in fspa.signals])
    for sample in samples:
        writer.writerow([_cell(signal, sample[signal.name]) for signal in fspa.signals])
    return text.getvalue()


def _cell(signal: Signal, value: float) -> str:
    if signal.type == "bool":
        return "true" if value else "false"
    return shown(value)


def _point(group: AtomGroup, polarity: Mapping[int, bool]) -> Point | UnsatisfiedLiterals:
    """Return values of a group's signals at which its atoms have the wanted truth values.

    Atoms without a wanted truth value do not hold if possible.
    """
    wanted = tuple((atom, polarity[atom]) for atom in group.atoms if atom in polarity)
    point = group.find(tuple((atom, polarity.get(atom, False)) for atom in group.atoms)) or group.find(wanted)
    return UnsatisfiedLiterals(_least(wanted, group)) if point is None else point


def _least(literals: Implicant, group: AtomGroup) -> Implicant:
    """Return literals for which nothing is found, without those that are not needed."""
    for literal in literals:
        fewer = tuple(other for other in literals if other != literal)
        if fewer and group.find(fewer) is None:
            literals = fewer
    return literals
