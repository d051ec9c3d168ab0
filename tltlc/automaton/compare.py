"""Whether two automata accept the same traces, or one of them fewer, with a trace that tells them apart.

Letters are read over the atoms of both, by their names; traces on which either one's ``exclusive`` atoms hold together
are none.
"""

from __future__ import annotations

from collections.abc import Callable, Hashable, Iterable, Iterator, Mapping, Sequence
from typing import Any, Final, TypeVar

from tltlc.automaton.finite.blowup import recursion_room
from tltlc.automaton.fspa import Fspa, Implicant
from tltlc.automaton.infinite.cycles import Edge, Edges, marks_of
from tltlc.automaton.infinite.letters import LEAF, Letters, at_most_one
from tltlc.automaton.infinite.mark_conditions import Clause, Marks, pair_marks
from tltlc.automaton.infinite.products import Both, Leaf, conditions, telling_apart
from tltlc.automaton.infinite.work import DEFAULT_WORK, Work
from tltlc.core.record import record

_NO_EDGE: Final = -1
_ALLOWED, _RULED_OUT = "allowed", "ruled out"

Letter = frozenset[str]
"""The names of the atoms that hold at a sample."""
Literals = tuple[tuple[str, bool], ...]
"""Names of atoms, each with whether it holds."""
Node = TypeVar("Node", bound=Hashable)


@record
class Trace:
    """``prefix``, and over infinite traces ``cycle`` for ever; over finite ones that is empty."""

    prefix: tuple[Letter, ...]
    cycle: tuple[Letter, ...] = ()


def separating(one: Fspa, other: Fspa, work: int = DEFAULT_WORK, impossible: Iterable[Literals] = ()) -> Trace | None:
    """A trace that ``one`` accepts and ``other`` does not; None where there is none, and all that ``one`` accepts
    ``other`` does.  Over finite traces it is a shortest one.  No letter of it has all of the ``impossible`` literals.

    Raises:
        ValueError: one is over finite traces, and the other over infinite ones.
        OutOfWork: the comparison takes more than ``work`` steps.
    """
    if one.semantics != other.semantics:
        raise ValueError(f"`{one.name}` is over {one.semantics} traces, and `{other.name}` over {other.semantics} ones")
    with recursion_room():
        product = _Product(one, other, Work(work), impossible)
        return product.trace() if one.semantics == "finite" else product.lasso()


def is_included(one: Fspa, other: Fspa, work: int = DEFAULT_WORK) -> bool:
    """Whether ``other`` accepts every trace that ``one`` does; ``work`` and errors as of :func:`separating`."""
    return separating(one, other, work) is None


def are_equivalent(one: Fspa, other: Fspa, work: int = DEFAULT_WORK) -> bool:
    """Whether both accept the same traces; ``work``, for each of both ways, and errors as of :func:`separating`."""
    return is_included(one, other, work) and is_included(other, one, work)


def less_is_left(fspa: Fspa, work: int = DEFAULT_WORK) -> Callable[[int, int], bool]:
    """Tells of two states, over finite traces, whether whatever mends the first mends the second, too.

    Its errors are those of :func:`separating`; all questions together take no more than ``work`` steps.
    """
    product = _Product(fspa, fspa, Work(work))

    def is_left(one: int, other: int) -> bool:
        with recursion_room():
            return product.trace((one, other)) is None

    return is_left


class _Product:
    """Two automata that are read in step."""

    def __init__(self, one: Fspa, other: Fspa, work: Work, impossible: Iterable[Literals] = ()) -> None:
        self._pair, self._work = (one, other), work
        impossible = tuple(impossible)
        self._names = _in_order((atom.name for fspa in self._pair for atom in fspa.atoms), impossible)
        self._place = {name: index for index, name in enumerate(self._names)}
        self._letters: Letters[Any] = Letters(work)
        groups = [[fspa.atoms[each].name for each in group] for fspa in self._pair for group in fspa.exclusive]
        places = [[self._place[name] for name in group] for group in groups]
        # Not True and False, which the table would take for indices of edges.
        self._allowed = at_most_one(self._letters, places, _ALLOWED, _RULED_OUT)
        for literals in impossible:
            cube = self._cube([(self._place[name], holds) for name, holds in literals], _RULED_OUT, _ALLOWED)
            self._allowed = self._letters.combined(_if_allowed_by, self._allowed, cube, {})
        self._steps: dict[tuple[int, int], int] = {}
        self._leaving = [_edges_by_source(fspa) for fspa in self._pair]
        self._known: dict[Both, list[tuple[Both, Marks, Letter]]] = {}
        # The marks of the other one come behind those of the first.
        firsts = (0, 2 * len(one.acceptance))
        self._marks = [
            [pair_marks(marks, first) for marks in fspa.marks()] for fspa, first in zip(self._pair, firsts, strict=True)
        ]

    def trace(self, start: Both = (0, 0)) -> Trace | None:
        """A shortest finite trace that the first one accepts from its state and the other does not from its own."""
        one, other = self._pair

        def is_wanted(both: Both) -> bool:
            return one.states[both[0]].accepting and not other.states[both[1]].accepting

        way = _way([start], self._moves, is_wanted, at_least=1)
        return None if way is None else Trace(way)

    def lasso(self) -> Trace | None:
        """An infinite trace that the first one accepts and the other does not."""
        these, those = conditions(*(len(fspa.acceptance) for fspa in self._pair))

        def leaves(both: Both) -> list[Leaf]:
            return [(target, marks) for target, marks, _ in self._step(both)]

        found = telling_apart([(0, 0)], leaves, [(these, those)], self._work)
        return None if found is None else self._through(found, these, those)

    def _through(self, part: Edges, these: Sequence[Clause], those: Sequence[Clause]) -> Trace:
        """A lasso whose cycle takes of a part what makes it accepted by the one and not by the other."""
        there = marks_of(part)
        clause = next(each for each in these if each.accepts(there))
        inside = sorted(part, key=lambda edge: (edge[0], edge[1], sorted(edge[2])))
        letter = {edge: self._letter(edge) for edge in inside}
        begin = inside[0][0]
        into = _way([(0, 0)], self._moves, lambda both: both == begin)
        assert into is not None
        cycle: list[Letter] = []
        place = begin
        left = set(clause.infs).union(*(each.fins & there for each in those))

        leaving: dict[Both, list[tuple[Both, Letter]]] = {}
        for (source, target, _), each in letter.items():
            leaving.setdefault(source, []).append((target, each))

        while left or place != begin or not cycle:
            edge = next((each for each in letter if left & each[2]), None)
            goal = begin if edge is None else edge[0]
            way = _way([place], leaving.__getitem__, goal.__eq__, at_least=int(edge is None and not cycle))
            assert way is not None
            cycle += way
            place = goal
            if edge is not None:
                cycle.append(letter[edge])
                place = edge[1]
                left -= edge[2]
        return Trace(into, tuple(cycle))

    # --- steps ------------------------------------------------------------------------------------

    def _moves(self, both: Both) -> Iterator[tuple[Both, Letter]]:
        yield from ((target, letter) for target, _, letter in self._step(both))

    def _letter(self, edge: Edge) -> Letter:
        return next(each for target, marks, each in self._step(edge[0]) if (target, marks) == edge[1:])

    def _step(self, both: Both) -> list[tuple[Both, Marks, Letter]]:
        """Where letters lead from two states, with which marks, and a letter that does."""
        found = self._known.get(both)
        if found is None:
            left, right = (self._edges_by_letter(which, state) for which, state in enumerate(both))
            step = self._letters.combined(self._together, left, right, {})
            step = self._letters.combined(_if_allowed, step, self._allowed, {})
            found = self._known[both] = [
                (*leaf, frozenset(letter)) for leaf, letter in self._with_letters(step).items() if leaf is not None
            ]
        return found

    def _together(self, left: int, right: int) -> tuple[Both, Marks]:
        one, other = self._pair
        marks = self._marks[0][left] | self._marks[1][right]
        return (one.edges[left].target, other.edges[right].target), marks

    def _edges_by_letter(self, which: int, state: int) -> int:
        """The index of the edge that a state takes, as a function of the letter."""
        found = self._steps.get((which, state))
        if found is None:
            fspa = self._pair[which]
            place = [self._place[atom.name] for atom in fspa.atoms]
            taken = [self._taken(index, fspa.edges[index].guard.primes, place) for index in self._leaving[which][state]]
            found = self._steps[which, state] = self._greatest(taken)
        return found

    def _taken(self, index: int, primes: Iterable[Implicant], place: Sequence[int]) -> int:
        """The index of an edge on letters that meet one of its primes, whose atoms have these places."""
        return self._greatest(
            [self._cube([(place[atom], holds) for atom, holds in prime], index, _NO_EDGE) for prime in primes]
        )

    def _greatest(self, steps: list[int]) -> int:
        """The greatest value on each letter.

        Neighbours are combined first: small ones with small ones, so that no large one is walked once for each other.
        """
        left = steps or [self._letters.leaf(_NO_EDGE)]
        while len(left) > 1:
            pairs = zip(left[::2], left[1::2], strict=False)
            odd = left[-1:] if len(left) % 2 else []
            left = [*(self._letters.combined(max, one, other, {}) for one, other in pairs), *odd]
        return left[0]

    def _cube(self, literals: Iterable[tuple[int, bool]], inside: Any, outside: Any) -> int:
        """One value where all literals are true, another one elsewhere."""
        letters = self._letters
        no, cube = letters.leaf(outside), letters.leaf(inside)
        for atom, holds in sorted(literals, reverse=True):
            cube = letters.node(atom, no, cube) if holds else letters.node(atom, cube, no)
        return cube

    def _with_letters(self, step: int) -> dict[Any, list[str]]:
        """The values of a function of the letter, each with the atoms of a letter that has it, as few as may be."""
        letters = self._letters
        found: dict[Any, list[str]] = {}
        stack: list[tuple[int, list[str]]] = [(step, [])]
        seen = set()
        while stack:
            node, holding = stack.pop()
            if node in seen:
                continue
            seen.add(node)
            if letters.atom[node] == LEAF:
                found[letters.value[node]] = holding
            else:
                stack.append((letters.high[node], [*holding, self._names[letters.atom[node]]]))
                stack.append((letters.low[node], holding))
        return found


def _in_order(names: Iterable[str], impossible: Iterable[Literals]) -> tuple[str, ...]:
    """The names, behind each those that are impossible with it: diagrams explode where such atoms are far apart."""
    partners: dict[str, dict[str, None]] = {}
    for literals in impossible:
        for name, _ in literals:
            partners.setdefault(name, {}).update(dict.fromkeys(other for other, _ in literals))
    found: dict[str, None] = {}
    for name in names:
        found |= dict.fromkeys((name, *partners.get(name, ())))
    return tuple(found)


def _edges_by_source(fspa: Fspa) -> list[list[int]]:
    """Of each state the indices of the edges that leave it."""
    found: list[list[int]] = [[] for _ in fspa.states]
    for index, edge in enumerate(fspa.edges):
        found[edge.source].append(index)
    return found


def _if_allowed(leaf: Any, allowed: str) -> Any:
    return leaf if allowed == _ALLOWED else None


def _if_allowed_by(one: str, other: str) -> str:
    return one if one == _RULED_OUT else other


def _way(
    starts: Iterable[Node],
    moves: Callable[[Node], Iterable[tuple[Node, Letter]]],
    is_goal: Callable[[Node], bool],
    at_least: int = 0,
) -> tuple[Letter, ...] | None:
    """The letters of a shortest way to a goal, of so many at least (0 or 1); None where there is none."""
    before: dict[tuple[Node, int], tuple[tuple[Node, int], Letter] | None] = {(each, 0): None for each in starts}
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
    found: list[Letter] = []
    while (step := before[place]) is not None:
        place, letter = step
        found.append(letter)
    return tuple(reversed(found))
