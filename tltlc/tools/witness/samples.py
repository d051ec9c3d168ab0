"""Find samples for letters: values of signals at which exactly the atoms of a letter hold.

Atoms that share no signal are searched separately (:mod:`tltlc.tools.witness.search`). The work is
bounded, so the search may find no sample although there is one.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import TYPE_CHECKING

from tltlc.automaton.fspa import Fspa, Implicant
from tltlc.core.record import record
from tltlc.monitor import MonitorError
from tltlc.monitor.exclusive import check_exclusive
from tltlc.monitor.samples import STEP_LENGTH, Samples, number_text
from tltlc.resolve.spec import Signal
from tltlc.tools.witness.search import AtomGroup, SignalPoint, atom_groups

if TYPE_CHECKING:
    from tltlc.automaton.compare import Letter
    from tltlc.monitor.traces import TraceSample


@record
class UnsatisfiedLiterals:
    """A set of literals for which no sample was found that makes all of them true.

    Each literal is the index of an atom and its truth value. The set is minimal: the search finds a
    sample if one of the literals is left out. Only if a sample is rejected because exclusive atoms
    hold together, the set has all literals that were asked for.
    """

    literals: Implicant

    def text(self, fspa: Fspa) -> str:
        """Return the literals in words, for example ```near(s1)` and not `near(s1, close=3)```."""
        terms = [f"{'' if holds else 'not '}`{fspa.atoms[atom].name}`" for atom, holds in self.literals]
        return terms[0] if len(terms) == 1 else f"{', '.join(terms[:-1])} and {terms[-1]}"


@record
class MissingSample:
    """The first step of a trace, counted from 1, for which no sample was found, and the reason."""

    step: int
    obstacle: UnsatisfiedLiterals


class SampleFinder:
    """Finds samples at which given atoms of an automaton hold or do not hold, and caches them."""

    def __init__(self, fspa: Fspa) -> None:
        self._fspa = fspa
        self._samples = Samples(fspa, None, [])
        self._groups = atom_groups(fspa)
        self._cache: dict[Implicant, TraceSample | UnsatisfiedLiterals] = {}

    def sample_for_letter(self, letter: Letter) -> TraceSample | UnsatisfiedLiterals:
        """Return a sample at which exactly the atoms of a letter hold, or the literals that prevent it."""
        return self.sample_for_literals(tuple((i, atom.name in letter) for i, atom in enumerate(self._fspa.atoms)))

    def sample_for_literals(self, literals: Implicant) -> TraceSample | UnsatisfiedLiterals:
        """Return a sample at which the literals are true, or those of them for which none was found.

        If possible, no other atom holds at the sample.
        """
        if literals not in self._cache:
            self._cache[literals] = self._search(literals)
        return self._cache[literals]

    def obstacles(self, letter: Letter) -> tuple[UnsatisfiedLiterals, ...]:
        """Return sets of literals that explain why no sample was found for a letter; empty if one was found.

        Each group of atoms with common signals is searched separately, and each group without a
        sample gives one set. If samples were found for all groups, exclusive atoms hold together.
        Then the only set has all literals of the letter.
        """
        sample = self.sample_for_letter(letter)
        if not isinstance(sample, UnsatisfiedLiterals):
            return ()
        polarity = {i: atom.name in letter for i, atom in enumerate(self._fspa.atoms)}
        points = [_point(group, polarity) for group in self._groups]
        return tuple(point for point in points if isinstance(point, UnsatisfiedLiterals)) or (sample,)

    def letter_of(self, sample: Mapping[str, float]) -> Letter:
        """Return the letter of a sample: the atoms that hold at it."""
        return self._letter(self._samples.atom_values(sample, 1))

    def _letter(self, values: tuple[float, ...]) -> Letter:
        return frozenset(atom.name for atom, value in zip(self._fspa.atoms, values, strict=True) if value > 0.0)

    def _search(self, literals: Implicant) -> TraceSample | UnsatisfiedLiterals:
        polarity = dict(literals)
        sample: TraceSample = {}
        for group in self._groups:
            point = _point(group, polarity)
            if isinstance(point, UnsatisfiedLiterals):
                return point
            sample.update(point)
        try:
            check_exclusive(self._fspa, self._samples.atom_values(sample, 1), 1)
        except MonitorError:
            return UnsatisfiedLiterals(literals)
        return {signal.name: sample[signal.name] for signal in self._fspa.signals}


def samples(fspa: Fspa, letters: Iterable[Letter]) -> tuple[TraceSample, ...] | MissingSample:
    """Return a sample for each letter of a trace, or the first step for which no sample was found."""
    finder = SampleFinder(fspa)
    trace_samples: list[TraceSample] = []
    for step, letter in enumerate(letters, start=1):
        sample = finder.sample_for_letter(letter)
        if isinstance(sample, UnsatisfiedLiterals):
            return MissingSample(step, sample)
        trace_samples.append(sample)
    return tuple(trace_samples)


def csv_text(fspa: Fspa, samples: Iterable[TraceSample]) -> str:
    """Return samples as CSV: a header with the names of the signals, and a row for each sample.

    If the clock varies, the last column has the lengths of the steps.
    ``tltlc monitor`` and generated monitors read this format.
    """
    import csv
    import io

    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    names = [signal.name for signal in fspa.signals]
    # Readers find this column in upper case, too.
    length = [] if not fspa.clock_varies else ["DT" if "dt" in names else "dt"]
    writer.writerow([*names, *length])
    for sample in samples:
        cells = [_cell(signal, sample[signal.name]) for signal in fspa.signals]
        writer.writerow([*cells, *(number_text(sample[STEP_LENGTH]) for _ in length)])
    return text.getvalue()


def _cell(signal: Signal, value: float) -> str:
    if signal.type == "bool":
        return "true" if value else "false"
    return number_text(value)


def _point(group: AtomGroup, polarity: Mapping[int, bool]) -> SignalPoint | UnsatisfiedLiterals:
    """Return values of the signals of a group at which its atoms have the truth values in ``polarity``.

    ``polarity`` maps indices of atoms to truth values. If possible, the atoms that are not in
    ``polarity`` do not hold. If no values are found, return a minimal set of literals for which no
    values are found.
    """
    literals = tuple((atom, polarity[atom]) for atom in group.atoms if atom in polarity)
    point = group.find(tuple((atom, polarity.get(atom, False)) for atom in group.atoms)) or group.find(literals)
    return UnsatisfiedLiterals(_minimal(literals, group)) if point is None else point


def _minimal(literals: Implicant, group: AtomGroup) -> Implicant:
    """Return a minimal subset of ``literals`` for which no point is found; none is found for all of them."""
    for literal in literals:
        fewer = tuple(candidate for candidate in literals if candidate != literal)
        if fewer and group.find(fewer) is None:
            literals = fewer
    return literals
