"""Compare the languages of two automata: equivalence, inclusion, and a trace that only one of them accepts.

Atoms are matched by name; a letter says which atoms of the two automata hold. If one of the automata declares
atoms ``exclusive``, traces on which two of these atoms hold together are ignored.
"""

from __future__ import annotations

from collections.abc import Callable, Hashable, Iterable, Iterator, Mapping, Sequence
from typing import Any, Final, TypeVar

from tltlc.automaton.diagrams import LEAF, Diagrams, at_most_one
from tltlc.automaton.finite.blowup import recursion_room
from tltlc.automaton.fspa import Fspa, Implicant
from tltlc.automaton.infinite.cycles import MarkedEdge, MarkedEdges, marks_of
from tltlc.automaton.infinite.mark_conditions import MarkClause, Marks, pair_marks
from tltlc.automaton.infinite.products import PairLeaf, StatePair, conditions, separating_component
from tltlc.automaton.work import DEFAULT_WORK, Work
from tltlc.core.record import record

_NO_EDGE: Final = -1
_ALLOWED, _RULED_OUT = "allowed", "ruled out"

Letter = frozenset[str]
"""The names of the atoms that hold at a sample."""
NamedLiterals = tuple[tuple[str, bool], ...]
"""Names of atoms, each with its truth value."""
ProductNode = TypeVar("ProductNode", bound=Hashable)


@record
class Trace:
    """A trace: ``prefix``, followed by ``cycle`` forever. The cycle of a finite trace is empty."""

    prefix: tuple[Letter, ...]
    cycle: tuple[Letter, ...] = ()


def separating(
    one: Fspa, other: Fspa, work: int = DEFAULT_WORK, impossible: Iterable[NamedLiterals] = ()
) -> Trace | None:
    """Return a trace that ``one`` accepts and ``other`` rejects; None if there is no such trace.

    Over finite traces, no shorter trace separates the automata. ``impossible`` excludes samples
    from the trace: with ``(("a", True), ("b", False))`` in it, no sample has ``a`` true and ``b``
    false. Samples on which two ``exclusive`` atoms hold are excluded too.

    Raises:
        ValueError: one automaton is over finite traces, and the other over infinite traces.
        OutOfWork: the comparison takes more than ``work`` steps.
    """
    if one.semantics != other.semantics:
        raise ValueError(f"`{one.name}` is over {one.semantics} traces, and `{other.name}` over {other.semantics} ones")
    with recursion_room():
        product = _Product(one, other, Work(work), impossible)
        return product.trace() if one.semantics == "finite" else product.lasso()


def is_included(one: Fspa, other: Fspa, work: int = DEFAULT_WORK) -> bool:
    """Whether ``other`` accepts every trace that ``one`` accepts.

    Raises OutOfWork after ``work`` steps, and ValueError if only one of the automata is over
    infinite traces.
    """
    return separating(one, other, work) is None


def are_equivalent(one: Fspa, other: Fspa, work: int = DEFAULT_WORK) -> bool:
    """Whether two automata accept the same traces.

    Raises OutOfWork if one of the two inclusions takes more than ``work`` steps, and ValueError if
    only one of the automata is over infinite traces.
    """
    return is_included(one, other, work) and is_included(other, one, work)


def state_inclusion(fspa: Fspa, work: int = DEFAULT_WORK) -> Callable[[int, int], bool]:
    """Return a function that compares two states of an automaton over finite traces.

    The function takes the ids of the two states, and returns whether every trace that is accepted
    from the first state is also accepted from the second. It raises OutOfWork when all calls
    together take more than ``work`` steps.
    """
    product = _Product(fspa, fspa, Work(work))

    def is_included_in(one: int, other: int) -> bool:
        with recursion_room():
            return product.trace((one, other)) is None

    return is_included_in


class _Product:
    """The product of two automata that read the same trace.

    Each of its states is a pair: a state of the first automaton and a state of the second.
    """

    def __init__(self, one: Fspa, other: Fspa, work: Work, impossible: Iterable[NamedLiterals] = ()) -> None:
        self._pair, self._work = (one, other), work
        impossible = tuple(impossible)
        self._names = _group_related((atom.name for fspa in self._pair for atom in fspa.atoms), impossible)
        self._index_of = {name: index for index, name in enumerate(self._names)}
        self._letters: Diagrams[Any] = Diagrams(work)
        groups = [[fspa.atoms[atom].name for atom in group] for fspa in self._pair for group in fspa.exclusive]
        places = [[self._index_of[name] for name in group] for group in groups]
        # The values are strings: in the table, True and False would be equal to the edge indices 1 and 0.
        self._allowed = at_most_one(self._letters, places, _ALLOWED, _RULED_OUT)
        for literals in impossible:
            cube = self._cube([(self._index_of[name], holds) for name, holds in literals], _RULED_OUT, _ALLOWED)
            self._allowed = self._letters.apply(_allowed_by_both, self._allowed, cube, {})
        self._steps: dict[tuple[int, int], int] = {}
        self._leaving = [_edges_by_source(fspa) for fspa in self._pair]
        self._known: dict[StatePair, list[tuple[StatePair, Marks, Letter]]] = {}
        # The marks of the second automaton are numbered after the marks of the first.
        firsts = (0, 2 * len(one.acceptance))
        self._marks = [
            [pair_marks(marks, first) for marks in fspa.marks()] for fspa, first in zip(self._pair, firsts, strict=True)
        ]

    def trace(self, start: StatePair = (0, 0)) -> Trace | None:
        """Return a shortest finite trace that only the first automaton accepts; None if there is none.

        ``start`` is a pair: the state where the first automaton starts, and the state where the
        second one starts.
        """
        one, other = self._pair

        def separates(both: StatePair) -> bool:
            return one.states[both[0]].accepting and not other.states[both[1]].accepting

        path = _shortest_path([start], self._moves, separates, at_least=1)
        return None if path is None else Trace(path)

    def lasso(self) -> Trace | None:
        """Return an infinite trace that only the first automaton accepts; None if there is none."""
        accepting, rejecting = conditions(*(len(fspa.acceptance) for fspa in self._pair))

        def leaves(both: StatePair) -> list[PairLeaf]:
            return [(target, marks) for target, marks, _ in self._step(both)]

        part = separating_component([(0, 0)], leaves, [(accepting, rejecting)], self._work)
        return None if part is None else self._lasso_through(part, accepting, rejecting)

    def _lasso_through(
        self, part: MarkedEdges, accepting: Sequence[MarkClause], rejecting: Sequence[MarkClause]
    ) -> Trace:
        """Return a trace whose cycle takes only edges of ``part``, a strongly connected set of edges of the product.

        An automaton accepts a run if the marks of the edges that are taken infinitely often meet
        one of its clauses: ``accepting`` for the first automaton, ``rejecting`` for the second. The
        marks of ``part`` meet a clause of ``accepting`` and no clause of ``rejecting``, and so must
        the marks of the cycle. So the cycle takes every ``inf`` mark of the clause that is met, and
        each mark of ``part`` that is a ``fin`` mark of a clause of ``rejecting``.
        """
        marks_in_part = marks_of(part)
        clause = next(clause for clause in accepting if clause.accepts(marks_in_part))
        inside = sorted(part, key=lambda edge: (edge[0], edge[1], sorted(edge[2])))
        letter_of = {edge: self._letter(edge) for edge in inside}
        begin = inside[0][0]
        into = _shortest_path([(0, 0)], self._moves, lambda both: both == begin)
        assert into is not None
        cycle: list[Letter] = []
        place = begin
        missing = set(clause.infs).union(*(clause.fins & marks_in_part for clause in rejecting))

        leaving: dict[StatePair, list[tuple[StatePair, Letter]]] = {}
        for (source, target, _), edge_letter in letter_of.items():
            leaving.setdefault(source, []).append((target, edge_letter))

        while missing or place != begin or not cycle:
            edge = next((edge for edge in letter_of if missing & edge[2]), None)
            goal = begin if edge is None else edge[0]
            path = _shortest_path([place], leaving.__getitem__, goal.__eq__, at_least=int(edge is None and not cycle))
            assert path is not None
            cycle += path
            place = goal
            if edge is not None:
                cycle.append(letter_of[edge])
                place = edge[1]
                missing -= edge[2]
        return Trace(into, tuple(cycle))

    # --- steps ------------------------------------------------------------------------------------

    def _moves(self, both: StatePair) -> Iterator[tuple[StatePair, Letter]]:
        yield from ((target, letter) for target, _, letter in self._step(both))

    def _letter(self, edge: MarkedEdge) -> Letter:
        return next(letter for target, marks, letter in self._step(edge[0]) if (target, marks) == edge[1:])

    def _step(self, both: StatePair) -> list[tuple[StatePair, Marks, Letter]]:
        """Return the successors of a pair of states, each with the marks of both edges and a letter that leads to it.

        Results are cached.
        """
        successors = self._known.get(both)
        if successors is None:
            left, right = (self._edges_by_letter(which, state) for which, state in enumerate(both))
            step = self._letters.apply(self._joint_successor, left, right, {})
            step = self._letters.apply(_keep_if_allowed, step, self._allowed, {})
            successors = self._known[both] = [
                (*leaf, frozenset(letter))
                for leaf, letter in self._values_with_letters(step).items()
                if leaf is not None
            ]
        return successors

    def _joint_successor(self, left: int, right: int) -> tuple[StatePair, Marks]:
        one, other = self._pair
        marks = self._marks[0][left] | self._marks[1][right]
        return (one.edges[left].target, other.edges[right].target), marks

    def _edges_by_letter(self, which: int, state: int) -> int:
        """Return a diagram that maps each letter to the index of the edge that leaves ``state`` on this letter.

        ``which`` is 0 for a state of the first automaton, 1 for a state of the second.
        """
        edge_taken = self._steps.get((which, state))
        if edge_taken is None:
            fspa = self._pair[which]
            place = [self._index_of[atom.name] for atom in fspa.atoms]
            taken = [
                self._edge_function(index, fspa.edges[index].guard.primes, place)
                for index in self._leaving[which][state]
            ]
            edge_taken = self._steps[which, state] = self._maximum(taken)
        return edge_taken

    def _edge_function(self, index: int, primes: Iterable[Implicant], place: Sequence[int]) -> int:
        """Return a diagram that is ``index`` where one of ``primes`` is true, and ``_NO_EDGE`` elsewhere.

        ``place[i]`` is the number, in the product, of atom ``i`` of the automaton.
        """
        return self._maximum(
            [self._cube([(place[atom], holds) for atom, holds in prime], index, _NO_EDGE) for prime in primes]
        )

    def _maximum(self, steps: list[int]) -> int:
        """Return the diagram whose value at each letter is the greatest value of the diagrams ``steps``.

        Combines the diagrams in pairs, then the results in pairs, and so on, so that most
        operations work on small diagrams.
        """
        level = steps or [self._letters.leaf(_NO_EDGE)]
        while len(level) > 1:
            pairs = zip(level[::2], level[1::2], strict=False)
            odd = level[-1:] if len(level) % 2 else []
            level = [*(self._letters.apply(max, one, other, {}) for one, other in pairs), *odd]
        return level[0]

    def _cube(self, literals: Iterable[tuple[int, bool]], inside: Any, outside: Any) -> int:
        """Return the diagram that is ``inside`` where all literals are true, and ``outside`` elsewhere."""
        letters = self._letters
        no, cube = letters.leaf(outside), letters.leaf(inside)
        for atom, holds in sorted(literals, reverse=True):
            cube = letters.node(atom, no, cube) if holds else letters.node(atom, cube, no)
        return cube

    def _values_with_letters(self, step: int) -> dict[Any, list[str]]:
        """Map each value of the diagram ``step`` to a letter on which the diagram has this value.

        The letter is a list of the names of the atoms that hold. The other atoms are false.
        """
        letters = self._letters
        letter_of: dict[Any, list[str]] = {}
        stack: list[tuple[int, list[str]]] = [(step, [])]
        seen = set()
        while stack:
            node, present = stack.pop()
            if node in seen:
                continue
            seen.add(node)
            if letters.variable[node] == LEAF:
                letter_of[letters.value[node]] = present
            else:
                stack.append((letters.high[node], [*present, self._names[letters.variable[node]]]))
                stack.append((letters.low[node], present))
        return letter_of


def _group_related(names: Iterable[str], impossible: Iterable[NamedLiterals]) -> tuple[str, ...]:
    """Return the names without duplicates, and move names of the same ``impossible`` conjunction next to each other.

    If the atoms of a conjunction were far apart, diagrams would become very large.
    """
    partners: dict[str, dict[str, None]] = {}
    for literals in impossible:
        for name, _ in literals:
            partners.setdefault(name, {}).update(dict.fromkeys(other for other, _ in literals))
    ordered: dict[str, None] = {}
    for name in names:
        ordered |= dict.fromkeys((name, *partners.get(name, ())))
    return tuple(ordered)


def _edges_by_source(fspa: Fspa) -> list[list[int]]:
    """Return, for each state, the indices of the edges that leave the state."""
    leaving: list[list[int]] = [[] for _ in fspa.states]
    for index, edge in enumerate(fspa.edges):
        leaving[edge.source].append(index)
    return leaving


def _keep_if_allowed(leaf: Any, allowed: str) -> Any:
    return leaf if allowed == _ALLOWED else None


def _allowed_by_both(one: str, other: str) -> str:
    return one if one == _RULED_OUT else other


def _shortest_path(
    starts: Iterable[ProductNode],
    moves: Callable[[ProductNode], Iterable[tuple[ProductNode, Letter]]],
    is_goal: Callable[[ProductNode], bool],
    at_least: int = 0,
) -> tuple[Letter, ...] | None:
    """Return the letters on a shortest path from one of ``starts`` to a goal; None if no path exists.

    ``moves`` returns the successors of a node, each with a letter that leads to it. The path has at
    least ``at_least`` steps, which is 0 or 1.
    """
    before: dict[tuple[ProductNode, int], tuple[tuple[ProductNode, int], Letter] | None] = {
        (start, 0): None for start in starts
    }
    queue = list(before)
    for place in queue:
        node, moved = place
        if moved >= at_least and is_goal(node):
            return _letters_to(place, before)
        for target, letter in moves(node):
            following = (target, 1 if at_least else 0)
            if following not in before:
                before[following] = place, letter
                queue.append(following)
    return None


def _letters_to(place: Any, before: Mapping[Any, Any]) -> tuple[Letter, ...]:
    letters: list[Letter] = []
    while (step := before[place]) is not None:
        place, letter = step
        letters.append(letter)
    return tuple(reversed(letters))
