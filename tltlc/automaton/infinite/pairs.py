"""From clauses over marks to Rabin pairs, along the alternating cycle decomposition.

Below an accepted node a run goes round its rejected children: it stays at one as long as it takes only edges of that,
and goes on to the next one otherwise, which marks the letter.  A run that does so for ever is inside no child, so it is
accepted.  Below a rejected node all accepted children are followed at once, each with a pair of its own; pairs are
shared by nodes that have no state in common.
"""

from __future__ import annotations

from typing import Any, Final

from tltlc.automaton.fspa import Mark
from tltlc.automaton.infinite.automaton import NO_MARKS, PairMarks
from tltlc.automaton.infinite.component import Leaf, Local, State, explored
from tltlc.automaton.infinite.cycles import Edge, Node, decomposition
from tltlc.automaton.infinite.letters import Letters
from tltlc.automaton.infinite.work import OutOfWork, Work
from tltlc.core.record import record

_FOR_FEWER_PAIRS: Final = 100_000
"""Steps for a decomposition where the marks are Rabin pairs as they stand, so that it saves pairs at best."""

Walk = tuple[Any, ...]
"""Where a run is in a tree: the child that it follows and where it is in that, or the latter of each child."""


@record
class Piece:
    """A component whose letters are marked with pairs; exits and labels are as those of :class:`Local`."""

    labels: dict[State, int]
    steps: dict[State, int]
    pairs: int


def with_pairs(letters: Letters[Any], one: Local, work: Work) -> Piece:
    """The component with Rabin pairs, as small as the ways known here make it; raises OutOfWork."""
    found: list[Piece] = []
    direct = as_it_stands(letters, one)
    try:
        with work.at_most(work.left // 2 if direct is None else _FOR_FEWER_PAIRS):
            tree = decomposition(_edges(letters, one), one.accepts, work)
            found.append(_walked(letters, one, tree, one_at_a_time=False, work=work))
            found.append(_walked(letters, one, tree, one_at_a_time=True, work=work))
    except OutOfWork:
        pass
    if direct is not None:
        found.append(direct)
    if not found:
        found.append(_in_turn(letters, one, work))
    return min(found, key=lambda piece: (len(piece.steps), piece.pairs))


def as_it_stands(letters: Letters[Any], one: Local) -> Piece | None:
    """The component itself, where each clause is a Rabin pair: it asks for one ``inf`` at most; None elsewhere."""
    if any(len(clause.infs) > 1 for clause in one.accepts):
        return None

    def change(leaf: Leaf) -> tuple[State, PairMarks]:
        target, marks = leaf
        if target[0] == "exit":
            return target, NO_MARKS
        said: set[Mark] = {(pair, "inf") for pair, each in enumerate(one.accepts) if each.infs <= marks}
        said |= {(pair, "fin") for pair, each in enumerate(one.accepts) if each.fins & marks}
        return target, frozenset(said)

    memo: dict[int, int] = {}
    steps = {state: letters.mapped(change, step, memo) for state, step in one.steps.items()}
    return Piece(one.labels, steps, len(one.accepts))


def _in_turn(letters: Letters[Any], one: Local, work: Work) -> Piece:
    """The component where each clause waits for its ``infs`` one after the other, which is always a Rabin pair."""
    orders = [sorted(clause.infs) for clause in one.accepts]
    first = next(iter(one.steps))

    def step_of(state: State) -> int:
        inner, waiting = state

        def change(leaf: Leaf) -> tuple[State, PairMarks]:
            target, marks = leaf
            if target[0] == "exit":
                return target, NO_MARKS
            work.spend(1 + len(orders))
            said: set[Mark] = {(pair, "fin") for pair, each in enumerate(one.accepts) if each.fins & marks}
            following = []
            for pair, (order, place) in enumerate(zip(orders, waiting, strict=True)):
                while place < len(order) and order[place] in marks:
                    place += 1
                if place == len(order):
                    said.add((pair, "inf"))
                    place = 0
                following.append(place)
            return (target, tuple(following)), frozenset(said)

        work.spend(10)
        return letters.mapped(change, one.steps[inner], {})

    steps, best = explored(letters, (first, (0,) * len(orders)), step_of)
    return Piece({state: one.labels[state[0]] for state in best}, {state: steps[state] for state in best}, len(orders))


def _edges(letters: Letters[Any], one: Local) -> list[Edge]:
    return [
        (state, target, marks)
        for state, step in one.steps.items()
        for target, marks in letters.values(step)
        if target[0] != "exit"
    ]


class _Walks:
    """The walks along a tree; ``one_at_a_time``: below rejected nodes, too, one child is followed and then the next."""

    def __init__(self, tree: Node, *, one_at_a_time: bool) -> None:
        self._one_at_a_time = one_at_a_time
        self.tree = tree
        self.pair: dict[int, int] = {}
        self._share(tree)
        self.pairs = len(set(self.pair.values()))

    def _share(self, tree: Node) -> None:
        """Give accepted nodes their pairs."""
        taken: list[list[Node]] = []
        stack = [tree]
        while stack:
            node = stack.pop(0)
            stack += node.below
            if node.accepted:
                free = next(
                    (
                        number
                        for number, others in enumerate(taken)
                        if all(node.states.isdisjoint(other.states) for other in others)
                    ),
                    len(taken),
                )
                if free == len(taken):
                    taken.append([])
                taken[free].append(node)
                self.pair[node.index] = free

    def begin(self, node: Node, state: State) -> Walk:
        """The walk below a node in one of its states."""
        there = [place for place, child in enumerate(node.below) if state in child.states]
        if not there:
            return ()
        if node.accepted or self._one_at_a_time:
            return (there[0], self.begin(node.below[there[0]], state))
        return tuple(self.begin(node.below[place], state) for place in there)

    def step(self, node: Node, walk: Walk, edge: Edge, active: set[int], marked: set[int]) -> Walk:
        """The walk after an edge of the node; ``active`` gets the accepted nodes that have it, ``marked`` those whose
        round goes on.
        """
        source, target, _ = edge
        if node.accepted:
            active.add(node.index)
        if node.accepted or self._one_at_a_time:
            if walk:
                place, inner = walk
                child = node.below[place]
                if edge in child.edges:
                    return (place, self.step(child, inner, edge, active, marked))
            else:
                place = -1
            if node.accepted:
                marked.add(node.index)
            for step in range(1, len(node.below) + 1):
                following = (place + step) % len(node.below)
                if target in node.below[following].states:
                    return (following, self.begin(node.below[following], target))
            return ()
        before = dict(zip((child.index for child in node.below if source in child.states), walk, strict=True))
        return tuple(
            self.step(child, before[child.index], edge, active, marked)
            if edge in child.edges
            else self.begin(child, target)
            for child in node.below
            if target in child.states
        )


def _walked(letters: Letters[Any], one: Local, tree: Node, *, one_at_a_time: bool, work: Work) -> Piece:
    walks = _Walks(tree, one_at_a_time=one_at_a_time)
    first = next(iter(one.steps))

    def step_of(state: State) -> int:
        inner, walk = state

        def change(leaf: Leaf) -> tuple[State, PairMarks]:
            target, marks = leaf
            if target[0] == "exit":
                return target, NO_MARKS
            active: set[int] = set()
            marked: set[int] = set()
            after = walks.step(tree, walk, (inner, target, marks), active, marked)
            work.spend(1 + len(active) + walks.pairs // 4)
            said: set[Mark] = {(walks.pair[index], "inf") for index in marked}
            there = {walks.pair[index] for index in active}
            said |= {(pair, "fin") for pair in range(walks.pairs) if pair not in there}
            return (target, after), frozenset(said)

        work.spend(10)
        return letters.mapped(change, one.steps[inner], {})

    steps, best = explored(letters, (first, walks.begin(tree, first)), step_of)
    return Piece({state: one.labels[state[0]] for state in best}, {state: steps[state] for state in best}, walks.pairs)
