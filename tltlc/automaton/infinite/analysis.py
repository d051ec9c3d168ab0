"""What the cycles of a Rabin automaton say of its states: goals, traps, verdicts, and when a spec is judged."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Sequence
from typing import TYPE_CHECKING

from tltlc.automaton.fspa import Fspa, Verdict
from tltlc.automaton.infinite.cycles import Edge, Edges, accepting_parts, parts, rejecting_parts
from tltlc.automaton.infinite.mark_conditions import pair_clauses, pair_marks
from tltlc.automaton.infinite.work import Work
from tltlc.resolve.spec import Judge

if TYPE_CHECKING:
    from tltlc.automaton.infinite.automaton import Rabin


def analysis_of_rabin(automaton: Rabin, work: Work) -> Analysis:
    """The analysis of what the construction makes."""
    edges = [
        (state, target, pair_marks(marks))
        for state in range(len(automaton.steps))
        for target, marks in automaton.leaves(state)
    ]
    return Analysis(len(automaton.steps), edges, automaton.pairs, work)


def analysis_of_fspa(fspa: Fspa, work: Work) -> Analysis:
    """The analysis of an automaton by its edges and pairs, whose indices are in range, and by nothing else of it."""
    edges = [
        (edge.source, edge.target, pair_marks(marks)) for edge, marks in zip(fspa.edges, fspa.marks(), strict=True)
    ]
    return Analysis(len(fspa.states), edges, len(fspa.acceptance), work)


class Analysis:
    """``targets`` are the successors of each state, ``goals`` the states on an accepted cycle (semantics, section 5).

    State 0 is initial; marks are as :func:`~tltlc.automaton.infinite.mark_conditions.pair_marks` numbers them.  Raises
    :class:`~tltlc.automaton.infinite.work.OutOfWork`, in all that it does.
    """

    def __init__(self, states: int, edges: Sequence[Edge], pairs: int, work: Work) -> None:
        self._work = work
        self._clauses = pair_clauses(pairs)
        self.targets: dict[int, list[int]] = {state: [] for state in range(states)}
        for source, target in dict.fromkeys((source, target) for source, target, _ in edges):
            self.targets[source].append(target)
        distinct = frozenset(edges)
        self.goals = _states(accepting_parts(distinct, self._clauses, work))
        self._alive = self._reaching(self.goals)
        self._doubtful = self._reaching(self._rejected(distinct))
        # Runs that avoid traps.
        self._edges = frozenset(edge for edge in distinct if edge[1] in self._alive)

    def verdict(self, state: int) -> Verdict:
        """``satisfied`` where every run is accepted, ``violated`` where none is."""
        if state not in self._alive:
            return "violated"
        if state not in self._doubtful:
            return "satisfied"
        return "holding" if state in self.goals else "pending"

    def default_judge(self) -> Judge:
        """``goal`` where the initial state is no goal, and in goals it is enough to stay out of traps."""
        if 0 in self.goals:
            return "limit"
        rejected = self._rejected(self._edges)
        reached = set(self.goals)
        stack = list(reached)
        while stack:
            for target in self.targets[stack.pop()]:
                if target in self._alive and target not in reached:
                    reached.add(target)
                    stack.append(target)
        return "limit" if reached & rejected else "goal"

    def _rejected(self, edges: Edges) -> set[int]:
        """The states on a cycle that is not accepted."""
        found = (some for part in parts(edges, self._work) for some in rejecting_parts(part, self._clauses, self._work))
        return _states(found)

    def _reaching(self, states: Collection[int]) -> set[int]:
        """The states from which one of these is reached."""
        sources: dict[int, list[int]] = {state: [] for state in self.targets}
        for state, targets in self.targets.items():
            for target in targets:
                sources[target].append(state)
        found = set(states)
        stack = list(found)
        while stack:
            for source in sources[stack.pop()]:
                if source not in found:
                    found.add(source)
                    stack.append(source)
        return found


def _states(parts_: Iterable[Edges]) -> set[int]:
    return {state for part in parts_ for source, target, _ in part for state in (source, target)}
