"""Components put together to an automaton, in which states that nothing tells apart are one."""

from __future__ import annotations

from collections import Counter
from collections.abc import Collection, Iterable, Mapping, Sequence
from typing import Any

from tltlc.automaton.infinite.automaton import NO_MARKS, PairMarks, Rabin
from tltlc.automaton.infinite.component import IMPOSSIBLE, State
from tltlc.automaton.infinite.letters import Letters
from tltlc.automaton.infinite.pairs import Piece

Place = tuple[int, State]
"""A state of the component that has this number."""


def joined(
    letters: Letters[Any],
    pieces: Sequence[Piece],
    entry: Mapping[int, Place],
    initial: Place,
    apart: Collection[int] = (),
) -> tuple[Rabin, dict[Place, int]]:
    """The automaton of all that is reached, with the labels of the components, and the numbers of its states.

    ``initial`` has 0.  An exit to a label leads to its ``entry``; states whose labels are in ``apart`` do not become
    one with others.
    """
    steps = _steps(letters, pieces, entry)
    reached = _reached(letters, steps, initial)
    number = _told_apart(letters, steps, reached, [pieces[piece].labels[state] in apart for piece, state in reached])
    first: dict[int, Place] = {}
    for place in reached:
        first.setdefault(number[place], place)
    memo: dict[int, int] = {}
    final = tuple(_read(letters, steps[place], number, memo) for place in first.values())
    labels = tuple(pieces[piece].labels[state] for piece, state in first.values())
    return Rabin(letters, final, labels, max(piece.pairs for piece in pieces)), number


def _steps(letters: Letters[Any], pieces: Sequence[Piece], entry: Mapping[int, Place]) -> dict[Place, int]:
    """The steps of all components, with their exits leading to where the next ones are entered."""
    steps: dict[Place, int] = {}
    for number, piece in enumerate(pieces):

        def leaf(each: tuple[State, PairMarks], number: int = number) -> tuple[Place, PairMarks] | None:
            target, marks = each
            if target[0] != "exit":
                return (number, target), marks
            return None if target[1] == IMPOSSIBLE else (entry[target[1]], NO_MARKS)

        memo: dict[int, int] = {}
        for state, step in piece.steps.items():
            steps[number, state] = letters.mapped(leaf, step, memo)
    return steps


def _reached(letters: Letters[Any], steps: Mapping[Place, int], initial: Place) -> list[Place]:
    reached, seen = [initial], {initial}
    for place in reached:
        for leaf in letters.values(steps[place]):
            if leaf is not None and leaf[0] not in seen:
                seen.add(leaf[0])
                reached.append(leaf[0])
    return reached


def _told_apart(
    letters: Letters[Any], steps: Mapping[Place, int], reached: Sequence[Place], apart: Sequence[bool]
) -> dict[Place, int]:
    """Numbers from 0 on in order, the same for states that ``apart``, targets and marks do not tell apart.

    Blocks are split until they are none; only states that lead to what got a new number are looked at again.
    """
    sources: dict[Place, list[Place]] = {place: [] for place in reached}
    for place in reached:
        for leaf in letters.values(steps[place]):
            if leaf is not None:
                sources[leaf[0]].append(place)
    block: dict[Place, int] = dict(zip(reached, map(int, apart), strict=True))
    sizes = Counter(block.values())
    signature: dict[int, int | None] = dict.fromkeys(sizes)
    """What all states of a block had in common when it was last looked at."""
    dirty: Iterable[Place] = reached
    while dirty:
        memo: dict[int, int] = {}
        groups: dict[tuple[int, int], list[Place]] = {}
        for place in dirty:
            letters.work.spend()
            groups.setdefault((block[place], _read(letters, steps[place], block, memo)), []).append(place)
        moved: list[Place] = []
        for (number, found), members in groups.items():
            if signature[number] == found:
                continue
            if signature[number] is None or len(members) == sizes[number]:
                signature[number] = found
                continue
            sizes[number] -= len(members)
            new = len(sizes)
            sizes[new], signature[new] = len(members), found
            block.update(dict.fromkeys(members, new))
            moved += members
        dirty = dict.fromkeys(source for place in moved for source in sources[place])
    numbers: dict[int, int] = {}
    return {place: numbers.setdefault(block[place], len(numbers)) for place in reached}


def _read(letters: Letters[Any], step: int, number: Mapping[Place, int], memo: dict[int, int]) -> int:
    """A step with targets read as their numbers."""
    return letters.mapped(lambda leaf: leaf and (number[leaf[0]], leaf[1]), step, memo)
