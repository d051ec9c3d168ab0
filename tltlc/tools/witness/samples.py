"""From letters to samples: values of signals that give atoms a truth, found by a search of bounded work.

Atoms that share no signal are searched for apart (:mod:`tltlc.tools.witness.search`).  That nothing is found proves
nothing.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import TYPE_CHECKING

from tltlc.automaton.fspa import Fspa, Implicant
from tltlc.core.record import record
from tltlc.monitor import MonitorError
from tltlc.monitor.samples import Samples, check_exclusive, shown
from tltlc.resolve.spec import Signal
from tltlc.tools.witness.search import Group, Point, groups

if TYPE_CHECKING:
    from tltlc.automaton.compare import Letter

Sample = dict[str, float]
"""Values of all signals of an automaton by name, in SI units; of a bool, 0 or 1."""


@record
class Obstacle:
    """Why there is no sample: literals, as few as were found, whose truth nothing was found to give together.

    ``literals`` are indices into the atoms, with the polarity that is asked for.
    """

    literals: Implicant

    def text(self, fspa: Fspa) -> str:
        """Such as ```near(s1)` and not `near(s1, close=3)```."""
        said = [f"{'' if holds else 'not '}`{fspa.atoms[atom].name}`" for atom, holds in self.literals]
        return said[0] if len(said) == 1 else f"{', '.join(said[:-1])} and {said[-1]}"


@record
class Unrealised:
    """The first step of a trace, from 1, for which no sample was found, and why."""

    step: int
    obstacle: Obstacle


class Realiser:
    """Finds samples for an automaton, with its params at their values; remembers what it found."""

    def __init__(self, fspa: Fspa) -> None:
        self._fspa = fspa
        self._samples = Samples(fspa, None, [])
        self._groups = groups(fspa)
        self._known: dict[Implicant, Sample | Obstacle] = {}

    def letter(self, letter: Letter) -> Sample | Obstacle:
        """A sample at which the atoms of a letter hold, and no others."""
        return self.literals(tuple((i, atom.name in letter) for i, atom in enumerate(self._fspa.atoms)))

    def literals(self, wanted: Implicant) -> Sample | Obstacle:
        """A sample at which the literals are true; other atoms do not hold where that can be had."""
        if wanted not in self._known:
            self._known[wanted] = self._found(wanted)
        return self._known[wanted]

    def obstacles(self, letter: Letter) -> tuple[Obstacle, ...]:
        """Why there is no such sample, of all atoms that share signals at once; none where there is one."""
        found = self.letter(letter)
        if not isinstance(found, Obstacle):
            return ()
        polarity = {i: atom.name in letter for i, atom in enumerate(self._fspa.atoms)}
        points = [_point(group, polarity) for group in self._groups]
        return tuple(each for each in points if isinstance(each, Obstacle)) or (found,)

    def letter_of(self, sample: Mapping[str, float]) -> Letter:
        """The letter that a sample is."""
        return self._letter(self._samples.atom_values(sample, 1))

    def _letter(self, values: tuple[float, ...]) -> Letter:
        return frozenset(atom.name for atom, value in zip(self._fspa.atoms, values, strict=True) if value > 0.0)

    def _found(self, wanted: Implicant) -> Sample | Obstacle:
        polarity = dict(wanted)
        sample: Sample = {}
        for group in self._groups:
            point = _point(group, polarity)
            if isinstance(point, Obstacle):
                return point
            sample.update(point)
        try:
            check_exclusive(self._fspa, self._samples.atom_values(sample, 1), 1)
        except MonitorError:
            return Obstacle(wanted)
        return {signal.name: sample[signal.name] for signal in self._fspa.signals}


def samples(fspa: Fspa, letters: Iterable[Letter]) -> tuple[Sample, ...] | Unrealised:
    """The samples of a trace of letters, or its first letter for which there is none."""
    realiser = Realiser(fspa)
    found: list[Sample] = []
    for step, letter in enumerate(letters, start=1):
        sample = realiser.letter(letter)
        if isinstance(sample, Obstacle):
            return Unrealised(step, sample)
        found.append(sample)
    return tuple(found)


def csv_text(fspa: Fspa, samples: Iterable[Sample]) -> str:
    """The samples as a trace that ``tltlc monitor`` and generated monitors take: CSV under the names of the signals."""
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


def _point(group: Group, polarity: Mapping[int, bool]) -> Point | Obstacle:
    """Values of a group's signals at which its atoms are as asked for; the others do not hold where that can be had."""
    asked = tuple((atom, polarity[atom]) for atom in group.atoms if atom in polarity)
    point = group.find(tuple((atom, polarity.get(atom, False)) for atom in group.atoms)) or group.find(asked)
    return Obstacle(_least(asked, group)) if point is None else point


def _least(literals: Implicant, group: Group) -> Implicant:
    """Literals for which nothing is found, without those that need not be among them."""
    for literal in literals:
        fewer = tuple(other for other in literals if other != literal)
        if fewer and group.find(fewer) is None:
            literals = fewer
    return literals
