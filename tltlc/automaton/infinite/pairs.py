"""Convert the acceptance condition of a component from clauses to Rabin pairs.

The conversion uses the alternating cycle decomposition (:mod:`tltlc.automaton.infinite.cycles`). A
state of the new automaton also stores a position in the tree of the decomposition. At an accepted
node, the position is in one child at a time. It stays there while the run takes only edges of that
child. When the run takes another edge, the position moves on to the next child, and this edge gets
an ``inf`` mark. A run with infinitely many of these marks stays in no rejected child, so it is
accepted. At a rejected node, the position is in all accepted children at once, each with its own
pair. Nodes that have no state in common may share a pair.
"""

from __future__ import annotations

from typing import Any, Final

from tltlc.automaton.diagrams import Diagrams
from tltlc.automaton.fspa import Mark
from tltlc.automaton.infinite.automaton import NO_MARKS, PairMarks
from tltlc.automaton.infinite.component import ComponentAutomaton, ComponentLeaf, ComponentState, explore
from tltlc.automaton.infinite.cycles import CycleNode, MarkedEdge, decomposition
from tltlc.automaton.work import OutOfWork, Work
from tltlc.core.record import record

_FOR_FEWER_PAIRS: Final = 100_000
"""Steps of work for a decomposition when the clauses are Rabin pairs already.

The decomposition may need fewer pairs than there are clauses.
"""

TreePosition = tuple[Any, ...]
"""The position of a run below a node of the tree.

If the position is in one child: the child's index and the position below the child. If it is in
several children at once: the positions below all children that contain the run's state.
"""


@record
class RabinComponent:
    """A component whose acceptance condition is ``pairs`` Rabin pairs.

    ``labels`` maps each state to its label. ``steps`` maps each state to a function from the letter
    to the next state and the marks of Rabin pairs that the edge has.
    """

    labels: dict[ComponentState, int]
    steps: dict[ComponentState, int]
    pairs: int


def with_pairs(letters: Diagrams[Any], component: ComponentAutomaton, work: Work) -> RabinComponent:
    """Return the component with an acceptance condition of Rabin pairs instead of clauses.

    Tries several constructions, and returns the result with the fewest states; of these, the result
    with the fewest pairs. Raises OutOfWork.
    """
    candidates: list[RabinComponent] = []
    direct = clauses_as_pairs(letters, component)
    try:
        with work.at_most(work.left // 2 if direct is None else _FOR_FEWER_PAIRS):
            tree = decomposition(_edges(letters, component), component.accepts, work)
            candidates.append(_follow_tree(letters, component, tree, one_at_a_time=False, work=work))
            candidates.append(_follow_tree(letters, component, tree, one_at_a_time=True, work=work))
    except OutOfWork:
        pass
    if direct is not None:
        candidates.append(direct)
    if not candidates:
        candidates.append(_wait_in_turn(letters, component, work))
    return min(candidates, key=lambda candidate: (len(candidate.steps), candidate.pairs))


def clauses_as_pairs(letters: Diagrams[Any], component: ComponentAutomaton) -> RabinComponent | None:
    """Return the component with a Rabin pair for each clause, and with the same states.

    Returns None if a clause needs more than one ``inf`` mark.
    """
    if any(len(clause.infs) > 1 for clause in component.accepts):
        return None

    def change(leaf: ComponentLeaf) -> tuple[ComponentState, PairMarks]:
        target, marks = leaf
        if target[0] == "exit":
            return target, NO_MARKS
        pair_marks: set[Mark] = {(pair, "inf") for pair, clause in enumerate(component.accepts) if clause.infs <= marks}
        pair_marks |= {(pair, "fin") for pair, clause in enumerate(component.accepts) if clause.fins & marks}
        return target, frozenset(pair_marks)

    memo: dict[int, int] = {}
    steps = {state: letters.map_leaves(change, step, memo) for state, step in component.steps.items()}
    return RabinComponent(component.labels, steps, len(component.accepts))


def _wait_in_turn(letters: Diagrams[Any], component: ComponentAutomaton, work: Work) -> RabinComponent:
    """Return the component with a Rabin pair for each clause; it may have more states than before.

    For each clause, a state of the result also stores a count. The run waits for the marks ``infs``
    of the clause one after another, in ascending order, and the count says how many it has taken.
    The edge on which the run takes the last of them gets the ``inf`` mark of the pair, and the
    count starts again.
    """
    orders = [sorted(clause.infs) for clause in component.accepts]
    first = next(iter(component.steps))

    def step_of(state: ComponentState) -> int:
        inner, waiting = state

        def change(leaf: ComponentLeaf) -> tuple[ComponentState, PairMarks]:
            target, marks = leaf
            if target[0] == "exit":
                return target, NO_MARKS
            work.spend(1 + len(orders))
            pair_marks: set[Mark] = {
                (pair, "fin") for pair, clause in enumerate(component.accepts) if clause.fins & marks
            }
            following = []
            for pair, (order, place) in enumerate(zip(orders, waiting, strict=True)):
                while place < len(order) and order[place] in marks:
                    place += 1
                if place == len(order):
                    pair_marks.add((pair, "inf"))
                    place = 0
                following.append(place)
            return (target, tuple(following)), frozenset(pair_marks)

        work.spend(10)
        return letters.map_leaves(change, component.steps[inner], {})

    steps, best = explore(letters, (first, (0,) * len(orders)), step_of)
    return RabinComponent(
        {state: component.labels[state[0]] for state in best}, {state: steps[state] for state in best}, len(orders)
    )


def _edges(letters: Diagrams[Any], component: ComponentAutomaton) -> list[MarkedEdge]:
    return [
        (state, target, marks)
        for state, step in component.steps.items()
        for target, marks in letters.values(step)
        if target[0] != "exit"
    ]


class _Walks:
    """Computes the positions of runs in the tree of an alternating cycle decomposition.

    At an accepted node, the position is in one child. At a rejected node, the position is in all
    children that contain the state of the run; with ``one_at_a_time``, in only one of them.
    ``pair`` maps the index of each accepted node to the number of its Rabin pair, and ``pairs`` is
    the number of pairs.
    """

    def __init__(self, tree: CycleNode, *, one_at_a_time: bool) -> None:
        self._one_at_a_time = one_at_a_time
        self.tree = tree
        self.pair: dict[int, int] = {}
        self._assign_pairs(tree)
        self.pairs = len(set(self.pair.values()))

    def _assign_pairs(self, tree: CycleNode) -> None:
        """Choose a Rabin pair for each accepted node, and store its number in ``pair`` under the node's index."""
        taken: list[list[CycleNode]] = []
        stack = [tree]
        while stack:
            node = stack.pop(0)
            stack += node.children
            if node.accepted:
                free = next(
                    (
                        number
                        for number, sharing in enumerate(taken)
                        if all(node.states.isdisjoint(other.states) for other in sharing)
                    ),
                    len(taken),
                )
                if free == len(taken):
                    taken.append([])
                taken[free].append(node)
                self.pair[node.index] = free

    def begin(self, node: CycleNode, state: ComponentState) -> TreePosition:
        """Return the initial position below a node of the tree for a run that is in ``state``."""
        places = [place for place, child in enumerate(node.children) if state in child.states]
        if not places:
            return ()
        if node.accepted or self._one_at_a_time:
            return (places[0], self.begin(node.children[places[0]], state))
        return tuple(self.begin(node.children[place], state) for place in places)

    def step(
        self, node: CycleNode, walk: TreePosition, edge: MarkedEdge, active: set[int], marked: set[int]
    ) -> TreePosition:
        """Return the position of a run below ``node`` after the run takes ``edge``, an edge of the node.

        ``walk`` is the position before the edge. This method also adds indices of accepted nodes at
        this position to two sets. ``active`` gets the nodes that contain the edge. ``marked`` gets
        those of these nodes whose current child does not contain the edge, or that have no child.
        """
        source, target, _ = edge
        if node.accepted:
            active.add(node.index)
        if node.accepted or self._one_at_a_time:
            if walk:
                place, inner = walk
                child = node.children[place]
                if edge in child.edges:
                    return (place, self.step(child, inner, edge, active, marked))
            else:
                place = -1
            if node.accepted:
                marked.add(node.index)
            for step in range(1, len(node.children) + 1):
                following = (place + step) % len(node.children)
                if target in node.children[following].states:
                    return (following, self.begin(node.children[following], target))
            return ()
        before = dict(zip((child.index for child in node.children if source in child.states), walk, strict=True))
        return tuple(
            self.step(child, before[child.index], edge, active, marked)
            if edge in child.edges
            else self.begin(child, target)
            for child in node.children
            if target in child.states
        )


def _follow_tree(
    letters: Diagrams[Any], component: ComponentAutomaton, tree: CycleNode, *, one_at_a_time: bool, work: Work
) -> RabinComponent:
    walks = _Walks(tree, one_at_a_time=one_at_a_time)
    first = next(iter(component.steps))

    def step_of(state: ComponentState) -> int:
        inner, walk = state

        def change(leaf: ComponentLeaf) -> tuple[ComponentState, PairMarks]:
            target, marks = leaf
            if target[0] == "exit":
                return target, NO_MARKS
            active: set[int] = set()
            marked: set[int] = set()
            after = walks.step(tree, walk, (inner, target, marks), active, marked)
            work.spend(1 + len(active) + walks.pairs // 4)
            pair_marks: set[Mark] = {(walks.pair[index], "inf") for index in marked}
            active_pairs = {walks.pair[index] for index in active}
            pair_marks |= {(pair, "fin") for pair in range(walks.pairs) if pair not in active_pairs}
            return (target, after), frozenset(pair_marks)

        work.spend(10)
        return letters.map_leaves(change, component.steps[inner], {})

    steps, best = explore(letters, (first, walks.begin(tree, first)), step_of)
    return RabinComponent(
        {state: component.labels[state[0]] for state in best}, {state: steps[state] for state in best}, walks.pairs
    )
