"""States of a component that can do without each other: of two with one label, one takes the other's place.

Both have the same language, and yet a run that is sent from the one to the other again and again may lose what it has
counted, and be accepted or rejected wrongly.  So each such exchange is decided exactly: the automata before and after
it are read in step, and if no cycle tells them apart, it is made (docs/adr/0021).
"""

from __future__ import annotations

from typing import Any

from tltlc.automaton.infinite.graphs import components
from tltlc.automaton.infinite.letters import Letters
from tltlc.automaton.infinite.pairs import Piece
from tltlc.automaton.infinite.products import Both, Leaf, conditions, side_by_side, telling_apart
from tltlc.automaton.infinite.work import OutOfWork, Work


def shrunk(letters: Letters[Any], piece: Piece, work: Work, steps: int) -> Piece:
    """The component without the states that others can take the place of, as far as so many steps of work allow."""
    original = piece
    try:
        with work.at_most(steps):
            for state in reversed(list(piece.steps)):
                if state not in piece.steps:
                    # It was reached through one that is gone alone.
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


def _without(letters: Letters[Any], piece: Piece, state: Any, other: Any) -> Piece:
    """The component where ``other`` takes the place of a state; and of what is not reached any more."""

    def leaf(each: Any) -> Any:
        return (other, each[1]) if each[0] == state else each

    memo: dict[int, int] = {}
    steps = {source: letters.mapped(leaf, step, memo) for source, step in piece.steps.items() if source != state}

    def within(source: Any) -> list[Any]:
        return [target for target, _ in letters.values(steps[source]) if target[0] != "exit"]

    groups = components(list(steps), within)
    # The first one that is found leads to no other.
    kept = set(groups[0])
    return Piece(
        {source: label for source, label in piece.labels.items() if source in kept},
        {source: step for source, step in steps.items() if source in kept},
        piece.pairs,
    )


def _is_equal(letters: Letters[Any], one: Piece, other: Piece, work: Work) -> bool:
    """Whether each state of ``one`` accepts what the state of that name of ``other`` does, of runs that stay.

    Raises OutOfWork.
    """
    together = side_by_side(letters, one.pairs, lambda leaf: leaf[0][0] == "exit")

    def leaves(both: Both) -> list[Leaf]:
        found = together(one.steps[both[0]], other.steps[both[1]])
        work.spend(5 + len(found))
        return found

    these, those = conditions(one.pairs, one.pairs)
    starts = [(state, state) for state in one.steps]
    return telling_apart(starts, leaves, [(these, those), (those, these)], work) is None
