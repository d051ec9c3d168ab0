"""Build the automaton of a HOA file from its tree and its atoms."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, Final

from tltlc.automaton.diagrams import Diagrams, at_most_one
from tltlc.automaton.finite.build import distances, verdicts
from tltlc.automaton.finite.machine import OutOfStates
from tltlc.automaton.fspa import Verdict
from tltlc.automaton.infinite.analysis import Analysis, analysis_of_rabin
from tltlc.automaton.infinite.assembled_components import ComponentPlace, join_components
from tltlc.automaton.infinite.automaton import NO_MARKS, Rabin
from tltlc.automaton.infinite.component import IMPOSSIBLE, ComponentAutomaton, ComponentState
from tltlc.automaton.infinite.graphs import components
from tltlc.automaton.infinite.pairs import RabinComponent, clauses_as_pairs, with_pairs
from tltlc.automaton.work import Work
from tltlc.diagnostics.diagnostic import Diagnostic, TltlError
from tltlc.resolve.spec import JudgeMode
from tltlc.tools.hoa.checks import is_finite
from tltlc.tools.hoa.conditions import Acceptance
from tltlc.tools.hoa.transitions import NO, NOT_ALLOWED, YES, HoaTransitions, Move
from tltlc.tools.hoa.tree import Hoa

_MOST_PROBLEMS: Final = 5
"""The most errors that are reported about states that are not deterministic or not complete."""

_StateFunctions = dict[int, int]
"""Maps the number of each reachable state to a node in the decision diagrams.

The node stands for a function that maps each letter to a ``Move`` or ``NOT_ALLOWED``.
"""


class FiniteAnalysis:
    """An automaton over finite traces: its accepting states, and the successors and verdict of each state.

    ``goals`` are the accepting states, and ``targets`` maps each state to its successors.
    """

    def __init__(self, automaton: Rabin, goals: set[int]) -> None:
        self.goals = goals
        self.targets = {
            state: list(dict.fromkeys(target for target, _ in automaton.leaves(state)))
            for state in range(len(automaton.steps))
        }
        self._verdicts = verdicts(self.targets, distances(self.targets, goals.__contains__), goals.__contains__)

    def verdict(self, state: int) -> Verdict:
        """Return the verdict of a state."""
        return self._verdicts[state]

    def default_judge(self) -> JudgeMode:
        """Return when an episode is judged if the file does not say so: at the ``goal`` or at the ``limit``.

        It is ``limit`` if the initial state is accepting, else ``goal``.
        """
        return "limit" if 0 in self.goals else "goal"


def automaton_of(
    hoa: Hoa, atoms: Sequence[str], exclusive: Sequence[Sequence[int]], work: Work, state_budget: int
) -> tuple[Rabin, Analysis | FiniteAnalysis]:
    """Return the automaton of a file, and its analysis, which gives the verdict of each state.

    The file must have passed :func:`~tltlc.tools.hoa.checks.check`. ``atoms`` has the names of all
    atoms, those of the file first. ``exclusive`` has groups of indices into ``atoms``; at most one
    atom of each group holds at a time. The labels of states are their numbers in the file. States
    with the same behaviour are merged.

    Over infinite traces, the acceptance condition of each strongly connected component is converted
    to Rabin pairs. The conversion adds states if no pairs over the existing states express the
    condition.

    Raises:
        TltlError: TLT0651 if a label is wrong; TLT0653 if the automaton is not deterministic;
            TLT0654 if it is not complete.
        OutOfWork: the conversion to pairs takes more work than is left.
        OutOfStates: more than ``state_budget`` states are reached.
    """
    letters: Diagrams[Any] = Diagrams(work)
    moves = _moves(hoa, HoaTransitions(hoa, atoms, letters, at_most_one(letters, exclusive, YES, NO)), state_budget)
    return (_finite_automaton if is_finite(hoa) else _infinite_automaton)(hoa, moves, letters)


def _moves(hoa: Hoa, transitions: HoaTransitions, state_budget: int) -> _StateFunctions:
    """Return, for each reachable state, where each letter leads and which acceptance sets it visits.

    Raises:
        TltlError: at most ``_MOST_PROBLEMS`` errors, with the codes TLT0651, TLT0653 and TLT0654 as
            in :func:`automaton_of`.
        OutOfStates: more than ``state_budget`` states are reached.
    """
    states = {state.number: state for state in hoa.states}
    queue = list(hoa.starts[0].states)
    moves: _StateFunctions = {}
    reached = set(queue)
    problems: list[Diagnostic] = []
    for number in queue:
        try:
            moves[number] = transitions.moves(states[number])
        except TltlError as error:
            problems += error.diagnostics
        for edge in states[number].edges:
            queue += [target for target in edge.targets.states if target not in reached]
            reached.update(edge.targets.states)
        if len(reached) > state_budget:
            raise OutOfStates
    if problems:
        raise TltlError(problems[:_MOST_PROBLEMS])
    return moves


def _finite_automaton(
    hoa: Hoa, moves: _StateFunctions, letters: Diagrams[Any]
) -> tuple[Rabin, Analysis | FiniteAnalysis]:
    def leaf(move: Move | None) -> Any:
        return (("exit", IMPOSSIBLE), NO_MARKS) if move is NOT_ALLOWED else ((move[0],), NO_MARKS)

    memo: dict[int, int] = {}
    steps: dict[ComponentState, int] = {
        (number,): letters.map_leaves(leaf, step, memo) for number, step in moves.items()
    }
    accepting = {state.number for state in hoa.states if state.sets.numbers}
    piece = RabinComponent({(number,): number for number in moves}, steps, 0)
    automaton, _ = join_components(letters, [piece], {}, (0, hoa.starts[0].states), accepting)
    goals = {state for state, number in enumerate(automaton.labels) if number in accepting}
    return automaton, FiniteAnalysis(automaton, goals)


def _infinite_automaton(
    hoa: Hoa, moves: _StateFunctions, letters: Diagrams[Any]
) -> tuple[Rabin, Analysis | FiniteAnalysis]:
    acceptance = Acceptance(hoa, letters.work)

    def targets(number: int) -> list[int]:
        return [move[0] for move in letters.values(moves[number]) if move is not NOT_ALLOWED]

    pieces: list[RabinComponent] = []
    entry: dict[int, ComponentPlace] = {}
    (initial,) = hoa.starts[0].states
    for group in components([initial], targets):
        inside = frozenset(group)

        def leaf(move: Move | None, inside: frozenset[int] = inside) -> Any:
            if move is NOT_ALLOWED:
                return ("exit", IMPOSSIBLE), NO_MARKS
            target, sets = move
            return ((target,), acceptance.marks(sets)) if target in inside else (("exit", target), NO_MARKS)

        memo: dict[int, int] = {}
        labels: dict[ComponentState, int] = {(number,): number for number in group}
        steps: dict[ComponentState, int] = {
            (number,): letters.map_leaves(leaf, moves[number], memo) for number in group
        }
        stays = any(target in inside for number in group for target in targets(number))
        piece = (
            _piece(letters, ComponentAutomaton(labels, steps, acceptance.clauses))
            if stays
            else RabinComponent(labels, steps, 0)
        )
        for state, number in piece.labels.items():
            entry.setdefault(number, (len(pieces), state))
        pieces.append(piece)
    automaton, _ = join_components(letters, pieces, entry, entry[initial])
    return automaton, analysis_of_rabin(automaton, letters.work)


def _piece(letters: Diagrams[Any], component: ComponentAutomaton) -> RabinComponent:
    """Convert the acceptance condition of a component from clauses to Rabin pairs.

    If the clauses already have the form of Rabin pairs, they are kept, unless the conversion finds
    fewer pairs.
    """
    best, unchanged = with_pairs(letters, component, letters.work), clauses_as_pairs(letters, component)
    return unchanged if unchanged is not None and unchanged.pairs <= best.pairs else best
