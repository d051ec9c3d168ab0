"""Analyse the cycles of a Rabin automaton: goals, traps, verdicts, and when to judge a spec."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Sequence
from typing import TYPE_CHECKING

from tltlc.automaton.fspa import Fspa, Verdict
from tltlc.automaton.infinite.cycles import MarkedEdge, MarkedEdges, accepting_parts, parts, rejecting_parts
from tltlc.automaton.infinite.mark_conditions import pair_clauses, pair_marks
from tltlc.automaton.work import Work
from tltlc.resolve.spec import JudgeMode

if TYPE_CHECKING:
    from tltlc.automaton.infinite.automaton import Rabin


def analysis_of_rabin(automaton: Rabin, work: Work) -> Analysis:
    """Return the analysis (goals, verdicts, …) of a Rabin automaton."""
    edges = [
        (state, target, pair_marks(marks))
        for state in range(len(automaton.steps))
        for target, marks in automaton.leaves(state)
    ]
    return Analysis(len(automaton.steps), edges, automaton.pairs, work)


def analysis_of_fspa(fspa: Fspa, work: Work) -> Analysis:
    """Return the analysis (goals, verdicts, …) of a finite state predicate automaton over infinite traces.

    Uses only the number of its states, its edges, and its Rabin pairs. The indices in the pairs
    must be valid.
    """
    edges = [
        (edge.source, edge.target, pair_marks(marks)) for edge, marks in zip(fspa.edges, fspa.marks(), strict=True)
    ]
    return Analysis(len(fspa.states), edges, len(fspa.acceptance), work)


class Analysis:
    """The goals and verdicts of a Rabin automaton, computed from its cycles.

    ``docs/semantics.md``, "Infinite traces", defines them. ``targets`` maps each state to its
    successors. ``goals`` is the set of the states on an accepted cycle. The states are the ints
    from 0 to ``states - 1``, and state 0 is initial. An edge is (source, target, marks). A mark
    says that the edge is in a set of one of the ``pairs`` Rabin pairs; marks are numbered as by
    :func:`~tltlc.automaton.infinite.mark_conditions.pair_marks`. The constructor and
    :meth:`default_judge` may raise :class:`~tltlc.automaton.work.OutOfWork`.
    """

    def __init__(self, states: int, edges: Sequence[MarkedEdge], pairs: int, work: Work) -> None:
        self._work = work
        self._clauses = pair_clauses(pairs)
        self.targets: dict[int, list[int]] = {state: [] for state in range(states)}
        for source, target in dict.fromkeys((source, target) for source, target, _ in edges):
            self.targets[source].append(target)
        distinct = frozenset(edges)
        self.goals = _endpoints(accepting_parts(distinct, self._clauses, work))
        self._alive = self._states_reaching(self.goals)
        self._doubtful = self._states_reaching(self._states_on_rejected_cycles(distinct))
        # The edges that do not lead to a trap.
        self._edges = frozenset(edge for edge in distinct if edge[1] in self._alive)

    def verdict(self, state: int) -> Verdict:
        """Return the verdict of a state.

        The verdict is ``satisfied`` if every run from the state is accepted, and ``violated`` if no
        run is accepted. Otherwise it is ``holding`` if the state is a goal, ``pending`` if not.
        """
        if state not in self._alive:
            return "violated"
        if state not in self._doubtful:
            return "satisfied"
        return "holding" if state in self.goals else "pending"

    def default_judge(self) -> JudgeMode:
        """Return when a spec with this automaton is judged, if it has no ``judge`` clause.

        If a spec is judged at its ``goal``, an episode ends on entry into a goal; if at its
        ``limit``, an episode ends at the limit of steps. Returns ``goal`` if the initial state is
        not a goal, and if every run that begins in a goal and enters no trap is accepted. Otherwise
        returns ``limit``.
        """
        if 0 in self.goals:
            return "limit"
        rejected = self._states_on_rejected_cycles(self._edges)
        reached = set(self.goals)
        stack = list(reached)
        while stack:
            for target in self.targets[stack.pop()]:
                if target in self._alive and target not in reached:
                    reached.add(target)
                    stack.append(target)
        return "limit" if reached & rejected else "goal"

    def _states_on_rejected_cycles(self, edges: MarkedEdges) -> set[int]:
        """Return all states that lie on a rejected cycle of ``edges``."""
        rejected = (
            cycle for part in parts(edges, self._work) for cycle in rejecting_parts(part, self._clauses, self._work)
        )
        return _endpoints(rejected)

    def _states_reaching(self, states: Collection[int]) -> set[int]:
        """Return all states that can reach one of the given states."""
        sources: dict[int, list[int]] = {state: [] for state in self.targets}
        for state, targets in self.targets.items():
            for target in targets:
                sources[target].append(state)
        reaching = set(states)
        stack = list(reaching)
        while stack:
            for source in sources[stack.pop()]:
                if source not in reaching:
                    reaching.add(source)
                    stack.append(source)
        return reaching


def _endpoints(parts_: Iterable[MarkedEdges]) -> set[int]:
    return {state for part in parts_ for source, target, _ in part for state in (source, target)}
