"""Search for a trace that one of two specs accepts and the other does not, by what their guards ask for.

Both monitors take each step of the traces that are tried, so each trace that is found shows a difference,
whatever else the specs ask for. If none is found, there may be one.
"""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping, Sequence
from itertools import zip_longest
from typing import TYPE_CHECKING, Final

from tltlc.automaton.compare import Letter, Trace
from tltlc.automaton.memory import given_atoms
from tltlc.tools.diff.feasible_letters import joint_automaton
from tltlc.tools.witness.candidate_samples import LiteralSamples, without_registers
from tltlc.tools.witness.guard_inputs import EdgeAim, GuardInputs, Literals, distances_to
from tltlc.tools.witness.guided_search import GuidedSearch
from tltlc.tools.witness.memory_search import Configuration, MemorySearch, Position
from tltlc.tools.witness.step_lengths import atoms_of, length_of, letter_with_length, sample_with_length

if TYPE_CHECKING:
    from tltlc.automaton.fspa import Fspa
    from tltlc.resolve.spec import Signal
    from tltlc.tools.witness.guard_inputs import InputsFor
    from tltlc.tools.witness.memory_search import TraceInput

_MOST_COMPUTED: Final = 2_000_000
"""The most atoms and registers that all searches together compute."""


class DifferenceSearch:
    """Searches traces that one of two specs over finite traces accepts and the other does not.

    ``named`` are the two automata with the names that atoms have in traces. No two atoms of a group in
    ``exclusive`` hold together. With ``by_name``, atoms that do not follow from others may hold in any
    combination.
    """

    def __init__(
        self,
        automata: tuple[Fspa, Fspa],
        named: tuple[Fspa, Fspa],
        exclusive: Sequence[Collection[str]],
        *,
        by_name: bool,
    ) -> None:
        self._automata, self._by_name = automata, by_name
        self._names = [[atom.name for atom in fspa.atoms] for fspa in named]
        self._search = MemorySearch(automata, (), self._names, exclusive)
        self._left = _MOST_COMPUTED
        self._given = {fspa.atoms[atom].name for fspa in named for atom in given_atoms(fspa)}
        self._samples: LiteralSamples | None = None
        view = None if by_name else joint_automaton(*map(without_registers, named))
        if view is not None:
            signals: dict[str, Signal] = {signal.name: signal for fspa in automata[::-1] for signal in fspa.signals}
            registers = [register for fspa in automata for register in fspa.registers]
            self._samples = LiteralSamples(view, signals.values(), registers)
            self._place = {atom.name: place for place, atom in enumerate(view.atoms)}

    def trace(self, side: int, beginning: Trace | None = None) -> Trace | None:
        """Return a trace that only A accepts, if ``side`` is 0, or only B, if it is 1; None if none is found.

        The search goes on from the first sample and from the end of ``beginning``, and tries its parts first.
        """
        if not self._by_name and self._samples is None:
            return None
        starts = [self._search.start()]
        for letter in () if beginning is None else beginning.prefix:
            position = self._after(starts[-1], letter)
            if position is None:
                break
            starts.append(position)
            if self._is_difference(side, position.edges):
                return Trace(self._search.letters(position))
        end = starts[-1]
        if self._automata[1 - side].states[end.configuration.states[1 - side]].verdict == "violated":
            return self._completed(end, side)
        aim = _DifferenceAim([self._part(index, accepts=index == side) for index in (0, 1)])
        positions = GuidedSearch(self._search, aim).positions(dict.fromkeys((end, starts[0])))
        positions = self._within_work(positions, self._automata)
        found = next((position for position in positions if self._is_difference(side, position.edges)), None)
        if found is None:
            return None
        found = self._search.shorter(found, lambda edges: self._is_difference(side, edges))
        return Trace(self._search.letters(found))

    def _completed(self, end: Position, side: int) -> Trace | None:
        """Return a trace that goes on from ``end``, where the other spec is broken for good, until one is met.

        So only the spec that is to be met takes the steps that are tried.
        """
        fspa, states, registers = self._automata[side], end.configuration.states, end.configuration.registers
        alone = MemorySearch((fspa,), (), (self._names[side],))
        start = Position(None, -1, 0, (), Configuration((states[side],), (registers[side],)))
        accepting = {index for index, edge in enumerate(fspa.edges) if fspa.states[edge.target].accepting}
        aim = EdgeAim(alone, fspa, self._names[side], accepting, self._inputs_for)
        found = None
        for position in self._within_work(GuidedSearch(alone, aim).positions((start,)), (fspa,)):
            if position.edges[0] in accepting:
                found = alone.shorter(position, lambda edges: edges[0] in accepting)
                break
        for number in () if found is None else found.trace():
            own = self._search.add_one(alone.inputs[number])
            step = self._search.step(end.configuration, own)
            if step is None:
                return None
            end = Position(end, own, 1, step.edges, step.after)
        is_met = found is not None and self._is_difference(side, end.edges)
        return Trace(self._search.letters(end)) if is_met else None

    def _within_work(self, positions: Iterator[Position], automata: Sequence[Fspa]) -> Iterator[Position]:
        """Yield positions until half of the work is done that is left for this and all later searches."""
        size = sum(len(fspa.atoms) + len(fspa.registers) for fspa in automata)
        least = self._left // 2
        for position in positions:
            self._left -= size
            yield position
            if self._left <= least:
                return

    def _part(self, index: int, *, accepts: bool) -> _Part:
        fspa = self._automata[index]
        targets = [fspa.states[edge.target] for edge in fspa.edges]
        wanted = {edge for edge, target in enumerate(targets) if target.accepting == accepts}
        broken = {edge for edge in wanted if targets[edge].verdict == "violated"}
        best = broken if broken and not accepts else wanted
        return _Part(fspa, self._names[index], best, wanted, self._search, self._inputs_for)

    def _is_difference(self, side: int, edges: tuple[int, ...]) -> bool:
        accepts = [
            fspa.states[fspa.edges[edge].target].accepting for fspa, edge in zip(self._automata, edges, strict=True)
        ]
        return accepts[side] and not accepts[1 - side]

    def _after(self, before: Position, letter: Letter) -> Position | None:
        """Return where a letter leads, the atoms of which are held by a sample; None if there is none."""
        atoms = atoms_of(letter)
        seconds = length_of(letter, self._automata[0])
        exact = self._inputs_for({name: name in atoms for name in self._given})
        for given in (*exact, *self._inputs_for(dict.fromkeys(atoms & self._given, True))):
            number = self._search.add_one(_with_length(given, seconds))
            step = self._search.step(before.configuration, number)
            if step is not None:
                return Position(before, number, 1, step.edges, step.after)
        return None

    def _inputs_for(self, literals: Literals) -> Sequence[TraceInput]:
        """Return inputs at which literals are true."""
        if self._samples is None:
            return [frozenset(name for name, holds in literals.items() if holds)]
        known = {self._place[name]: holds for name, holds in literals.items() if name in self._place}
        return self._samples.samples(tuple(sorted(known.items())))


class _Part:
    """The aim for one of the specs: its ``wanted`` edges, or where these are out of reach, the edges ``or_else``."""

    def __init__(
        self,
        fspa: Fspa,
        names: Sequence[str],
        wanted: Collection[int],
        or_else: Collection[int],
        search: MemorySearch,
        inputs_for: InputsFor,
    ) -> None:
        self.distance = {**distances_to(fspa, or_else), **distances_to(fspa, wanted)}

        def rank(edge: int) -> int | None:
            return -1 if edge in wanted else self.distance.get(fspa.edges[edge].target)

        self.guards = GuardInputs(search, fspa, names, rank, inputs_for)


class _DifferenceAim:
    """The aim that one spec is met, while the other is broken for good, or at least not met."""

    def __init__(self, parts: Sequence[_Part]) -> None:
        self._parts = parts

    def rank(self, states: tuple[int, ...]) -> int | None:
        """Return how many edges both specs are from where they differ; None if they cannot."""
        ranks = [part.distance.get(state) for part, state in zip(self._parts, states, strict=True)]
        return None if None in ranks else sum(rank for rank in ranks if rank is not None)

    def lack(self, states: tuple[int, ...], values: tuple[tuple[float, ...], ...]) -> float:
        """Return by how much the memory of both misses the nearest guards that lead on."""
        both = zip(self._parts, states, values, strict=True)
        return sum(part.guards.lack(state, atoms) for part, state, atoms in both)

    def inputs(self, states: tuple[int, ...], values: tuple[tuple[float, ...], ...] | None) -> Iterator[int]:
        """Yield the inputs that the guards of both ask for."""
        pairs = zip(self._parts, states, values or (None, None), strict=True)
        numbers = (part.guards.of_state(state, atoms) for part, state, atoms in pairs)
        return (number for turn in zip_longest(*numbers) for number in turn if number is not None)


def _with_length(given: TraceInput, seconds: float | None) -> TraceInput:
    """Return an input with the length of its step in seconds; the input itself if ``seconds`` is None."""
    if seconds is None:
        return given
    return sample_with_length(given, seconds) if isinstance(given, Mapping) else letter_with_length(given, seconds)
