"""Unfold registers into states: an automaton without memory that accepts the same traces."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import product
from typing import Final, NamedTuple

from tltlc.automaton.fspa import Edge, Fspa, Guard, Implicant, Pair
from tltlc.automaton.memory import given_atoms, registers_from_atoms
from tltlc.automaton.work import Work
from tltlc.core.record import replace
from tltlc.logic.formula import Formula, and_, atom, not_, or_
from tltlc.monitor.errors import MonitorError
from tltlc.monitor.exclusive import check_exclusive
from tltlc.monitor.guards import holds
from tltlc.monitor.samples import Samples
from tltlc.resolve.sources import names_read

_STEP_WORK: Final = 40
"""The work of a step of the monitor: it takes as long as this many steps of :class:`~tltlc.automaton.work.Work`."""
_MOST_ATOMS: Final = 12
"""The most atoms whose combinations of truth values are tried."""


class _Configuration(NamedTuple):
    """A state and the values of the registers. In a trap over finite traces, the values are left out."""

    state: int
    registers: tuple[float, ...]


class _Step(NamedTuple):
    edge: int
    after: _Configuration


def unfolded(fspa: Fspa, work: Work) -> Fspa | None:
    """Return an automaton without registers that accepts the same traces, or None.

    Its atoms are those that do not follow from others. It has a state for each state and values of
    registers that a trace can lead to, with the label and verdict of that state of ``fspa``. It is not
    minimal, and verdicts may come late.

    The result is None if the truth of these atoms does not determine what is remembered, as with
    ``highest(x)``, if there are too many of them, or if the clock varies.

    Raises:
        OutOfWork: the unfolding takes more than ``work``.
    """
    if not fspa.registers:
        return fspa
    if fspa.clock_varies:
        return None
    given = given_atoms(fspa)
    names = {register.name for register in fspa.registers}
    reads_memory = any(not names.isdisjoint(names_read(fspa.atoms[index].expression)) for index in given)
    if registers_from_atoms(fspa) != names or reads_memory or len(given) > _MOST_ATOMS:
        return None
    return _Unfolding(fspa, given, work).result()


class _Unfolding:
    def __init__(self, fspa: Fspa, given: Sequence[int], work: Work) -> None:
        self._fspa, self._given, self._work = fspa, given, work
        self._samples = Samples(fspa, None, [])
        self._traps = frozenset(
            state.id for state in fspa.states if state.distance is None and fspa.semantics == "finite"
        )
        self._leaving: list[list[int]] = [[] for _ in fspa.states]
        for index, edge in enumerate(fspa.edges):
            self._leaving[edge.source].append(index)
        place = {index: number for number, index in enumerate(given)}
        groups = [tuple(place[index] for index in group if index in place) for group in fspa.exclusive]
        self._exclusive = tuple(group for group in groups if len(group) > 1)
        self._letters = list(product((-1.0, 1.0), repeat=len(given)))
        self._guards: dict[tuple[Implicant, ...], Guard] = {}

    def result(self) -> Fspa | None:
        fspa = self._fspa
        number = {_Configuration(0, self._samples.initial): 0}
        edges: list[Edge] = []
        origins: dict[int, list[int]] = {}
        queue = list(number)
        for configuration in queue:
            steps = [self._step(configuration, letter) for letter in self._letters]
            # Where an atom that follows from others excludes one of them, no list of atoms says what is excluded.
            if any(
                step is None and self._is_allowed(letter) for step, letter in zip(steps, self._letters, strict=True)
            ):
                return None
            for step in steps:
                if step is not None and step.after not in number:
                    number[step.after] = len(number)
                    queue.append(step.after)
            cubes: dict[_Step, list[Implicant]] = {}
            for step, cube in _cubes(steps):
                cubes.setdefault(step, []).append(cube)
            for step in sorted(cubes, key=lambda step: (number[step.after], step.edge)):
                origins.setdefault(step.edge, []).append(len(edges))
                edges.append(Edge(number[configuration], number[step.after], self._guard(tuple(cubes[step]))))

        def copies(old: Sequence[int]) -> tuple[int, ...]:
            return tuple(sorted(new for edge in old for new in origins.get(edge, ())))

        return replace(
            fspa,
            atoms=tuple(fspa.atoms[index] for index in self._given),
            exclusive=self._exclusive,
            states=tuple(replace(fspa.states[where.state], id=index) for where, index in number.items()),
            edges=tuple(edges),
            acceptance=tuple(Pair(copies(pair.fin), copies(pair.inf)) for pair in fspa.acceptance),
            registers=(),
        )

    def _step(self, before: _Configuration, letter: Sequence[float]) -> _Step | None:
        """Return what a monitor does at a sample; None if it rejects the sample."""
        self._work.spend(_STEP_WORK)
        fspa = self._fspa
        leaving = self._leaving[before.state]
        if before.state in self._traps:
            return _Step(leaving[0], before)
        values = self._samples.from_atoms(letter, before.registers, (), 1)
        try:
            check_exclusive(fspa, values.atoms, 1)
        except MonitorError:
            return None
        edge = next(edge for edge in leaving if holds(fspa.edges[edge].guard, values.atoms))
        target = fspa.edges[edge].target
        return _Step(edge, _Configuration(target, () if target in self._traps else values.registers))

    def _is_allowed(self, letter: Sequence[float]) -> bool:
        return not any(sum(letter[place] > 0.0 for place in group) > 1 for group in self._exclusive)

    def _guard(self, cubes: tuple[Implicant, ...]) -> Guard:
        """Return a guard with these conjunctions, which need not be all prime implicants."""
        guard = self._guards.get(cubes)
        if guard is None:
            formula = or_(*(and_(*(self._literal(*literal) for literal in cube)) for cube in cubes))
            guard = self._guards[cubes] = Guard(formula, cubes)
        return guard

    def _literal(self, place: int, is_true: bool) -> Formula:
        name = atom(self._fspa.atoms[self._given[place]].name)
        return name if is_true else not_(name)


def _cubes(steps: Sequence[_Step | None], place: int = 0) -> Iterator[tuple[_Step, Implicant]]:
    """Yield each step with conjunctions of literals that are true for exactly the letters that take it.

    ``steps`` has the step of each letter, in the order of binary numbers. The literals begin with the
    atom ``place``. A letter without a step may be in any conjunction.
    """
    taken = {step for step in steps if step is not None}
    if len(taken) <= 1:
        yield from ((step, ()) for step in taken)
        return
    half = len(steps) // 2
    low, high = steps[:half], steps[half:]
    if low == high:
        yield from _cubes(low, place + 1)
        return
    for is_true, part in ((False, low), (True, high)):
        for step, cube in _cubes(part, place + 1):
            yield step, ((place, is_true), *cube)
