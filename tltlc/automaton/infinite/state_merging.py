"""Remove states of a component by redirecting their edges to another state with the same label.

States with the same label have the same language.  Still, a run that is redirected infinitely often
may lose what its memory has counted, and be accepted or rejected wrongly.  So each removal is
checked exactly: it is done if no cycle in the product of the automata before and after it is
accepted by only one of them (docs/adr/0021).
"""

from __future__ import annotations

from typing import Any

from tltlc.automaton.diagrams import Diagrams
from tltlc.automaton.infinite.graphs import components
from tltlc.automaton.infinite.pairs import Piece
from tltlc.automaton.infinite.products import Both, Leaf, conditions, separating_component, side_by_side
from tltlc.automaton.work import OutOfWork, Work


def shrunk(letters: Diagrams[Any], piece: Piece, work: Work, steps: int) -> Piece:
    """Return the component without the states that another state can replace; stops after ``steps`` steps of work."""
    original = piece
    try:
        with work.at_most(steps):
            for state in reversed(list(piece.steps)):
                if state not in piece.steps:
                    # It was reachable only through a state that was removed.
                    continue
                for other in list(piece.steps):
                    if state == other or piece.labels[state] != piece.labels[other]:
                        continue
                    smaller = _without(letters, piece, state, other)
                    if _is_equal(letters, smaller, original, work):
                        piece = smaller
                        break
    except OutOfWork:
        pass
    return piece


def _without(letters: Diagrams[Any], piece: Piece, state: Any, other: Any) -> Piece:
    """Return the component with ``other`` in place of ``state``, reduced to a bottom component."""

    def redirected(leaf: Any) -> Any:
        return (other, leaf[1]) if leaf[0] == state else leaf

    memo: dict[int, int] = {}
    steps = {source: letters.mapped(redirected, step, memo) for source, step in piece.steps.items() if source != state}

    def within(source: Any) -> list[Any]:
        return [target for target, _ in letters.values(steps[source]) if target[0] != "exit"]

    groups = components(list(steps), within)
    # The first component leads to no other.
    kept = set(groups[0])
    return Piece(
        {source: label for source, label in piece.labels.items() if source in kept},
        {source: step for source, step in steps.items() if source in kept},
        piece.pairs,
    )


def _is_equal(letters: Diagrams[Any], one: Piece, other: Piece, work: Work) -> bool:
    """Whether each state of ``one`` accepts the same runs that stay in the component as the same state of ``other``.

    Raises OutOfWork.
    """
    together = side_by_side(letters, one.pairs, lambda leaf: leaf[0][0] == "exit")

    def leaves(both: Both) -> list[Leaf]:
        successors = together(one.steps[both[0]], other.steps[both[1]])
        work.spend(5 + len(successors))
        return successors

    these, those = conditions(one.pairs, one.pairs)
    starts = [(state, state) for state in one.steps]
    return separating_component(starts, leaves, [(these, those), (those, these)], work) is None
