"""States of a component that can do without each other: of two with one label, one takes the other's place.

Both have the same language, and yet a run that is sent from the one to the other again and again may lose what it has
counted, and be accepted or rejected wrongly.  So each such exchange is decided exactly: the automata before and after
it are read in step, and if no cycle tells them apart, it is made (docs/adr/0021).
"""

from __future__ import annotations

from typing import Any

from tltlc.rabin.graphs import components
from tltlc.rabin.languages import only_here
from tltlc.rabin.letters import Letters
from tltlc.rabin.pairs import Piece
from tltlc.rabin.skeleton import Clause
from tltlc.rabin.work import OutOfWork, Work


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
    """Whether each state of ``one`` accepts what the state of that name of ``other`` does, of runs that stay."""
    memo: dict[tuple[int, int], int] = {}
    known: dict[Any, list[Any]] = {}
    right_from = 2 * one.pairs  # The first mark of the right one.

    def together(left: Any, right: Any) -> Any:
        if left[0][0] == "exit":
            return None
        marks = {2 * pair + (kind == "inf") for pair, kind in left[1]}
        marks |= {right_from + 2 * pair + (kind == "inf") for pair, kind in right[1]}
        return (left[0], right[0]), frozenset(marks)

    def step(state: Any) -> list[Any]:
        if state not in known:
            found = letters.combined(together, one.steps[state[0]], other.steps[state[1]], memo)
            known[state] = [leaf for leaf in letters.values(found) if leaf is not None]
            work.spend(5 + len(known[state]))
        return known[state]

    these, those = (
        [Clause(frozenset((at + 2 * pair,)), frozenset((at + 2 * pair + 1,))) for pair in range(one.pairs)]
        for at in (0, right_from)
    )
    starts = [(state, state) for state in one.steps]
    for group in components(starts, lambda state: [target for target, _ in step(state)]):
        members = set(group)
        edges = [(state, target, marks) for state in group for target, marks in step(state) if target in members]
        if edges and (only_here(edges, these, those, work) or only_here(edges, those, these, work)):
            return False
    return True
