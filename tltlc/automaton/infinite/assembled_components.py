"""Join the automata of all components into one automaton, and merge equal states.

A component is a strongly connected component of the after-automaton
(:mod:`tltlc.automaton.infinite.after_automaton`). States are equal if, on each letter, they have
the same marks and lead to equal states.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Collection, Iterable, Mapping, Sequence
from typing import Any

from tltlc.automaton.diagrams import Diagrams
from tltlc.automaton.infinite.automaton import NO_MARKS, PairMarks, Rabin
from tltlc.automaton.infinite.component import IMPOSSIBLE, ComponentState
from tltlc.automaton.infinite.pairs import RabinComponent

ComponentPlace = tuple[int, ComponentState]
"""The number of a component, and one of its states."""


def join_components(
    letters: Diagrams[Any],
    components: Sequence[RabinComponent],
    entry: Mapping[int, ComponentPlace],
    initial: ComponentPlace,
    apart: Collection[int] = (),
) -> tuple[Rabin, dict[ComponentPlace, int]]:
    """Return the automaton that joins ``components``, and the number that each reachable state has in it.

    The automaton has only the states that can be reached from ``initial``, which becomes state 0.
    An edge that leaves its component has a label (an obligation) in place of a target; ``entry``
    maps this label to the state of another component to which the edge leads. States keep their
    labels. Equal states are merged, but a state with a label in ``apart`` only with states whose
    labels are in ``apart`` too.
    """
    steps = _steps(letters, components, entry)
    reached = _reachable(letters, steps, initial)
    is_apart = [components[index].labels[state] in apart for index, state in reached]
    number = _number_states(letters, steps, reached, is_apart)
    first: dict[int, ComponentPlace] = {}
    for place in reached:
        first.setdefault(number[place], place)
    memo: dict[int, int] = {}
    final = tuple(_number_targets(letters, steps[place], number, memo) for place in first.values())
    labels = tuple(components[index].labels[state] for index, state in first.values())
    return Rabin(letters, final, labels, max(component.pairs for component in components)), number


def _steps(
    letters: Diagrams[Any], components: Sequence[RabinComponent], entry: Mapping[int, ComponentPlace]
) -> dict[ComponentPlace, int]:
    """Return the step of each state: a function from the letter to the next state and the marks of the edge.

    The function is a decision diagram. Its value is None on letters that ``exclusive`` rules out.
    An edge that leaves its component leads to the state that ``entry`` has for the edge's label.
    """
    steps: dict[ComponentPlace, int] = {}
    for number, component in enumerate(components):

        def leaf(
            inner: tuple[ComponentState, PairMarks], number: int = number
        ) -> tuple[ComponentPlace, PairMarks] | None:
            target, marks = inner
            if target[0] != "exit":
                return (number, target), marks
            return None if target[1] == IMPOSSIBLE else (entry[target[1]], NO_MARKS)

        memo: dict[int, int] = {}
        for state, step in component.steps.items():
            steps[number, state] = letters.map_leaves(leaf, step, memo)
    return steps


def _reachable(
    letters: Diagrams[Any], steps: Mapping[ComponentPlace, int], initial: ComponentPlace
) -> list[ComponentPlace]:
    reached, seen = [initial], {initial}
    for place in reached:
        for leaf in letters.values(steps[place]):
            if leaf is not None and leaf[0] not in seen:
                seen.add(leaf[0])
                reached.append(leaf[0])
    return reached


def _number_states(
    letters: Diagrams[Any],
    steps: Mapping[ComponentPlace, int],
    reached: Sequence[ComponentPlace],
    apart: Sequence[bool],
) -> dict[ComponentPlace, int]:
    """Number the states from 0 in the order of ``reached``; states that are merged get the same number.

    ``apart`` has a truth value for each state of ``reached``. States are merged if they have the
    same value in ``apart`` and, on each letter, the same marks and merged targets. The method is
    partition refinement: a block of states is split while its states have different steps, and only
    states that lead to a state of a new block are examined again.
    """
    sources: dict[ComponentPlace, list[ComponentPlace]] = {place: [] for place in reached}
    for place in reached:
        for leaf in letters.values(steps[place]):
            if leaf is not None:
                sources[leaf[0]].append(place)
    block: dict[ComponentPlace, int] = dict(zip(reached, map(int, apart), strict=True))
    sizes = Counter(block.values())
    signature: dict[int, int | None] = dict.fromkeys(sizes)
    """The step of all states of a block, with blocks as targets.

    It is None until the block is examined.
    """
    dirty: Iterable[ComponentPlace] = reached
    while dirty:
        memo: dict[int, int] = {}
        groups: dict[tuple[int, int], list[ComponentPlace]] = {}
        for place in dirty:
            letters.work.spend()
            groups.setdefault((block[place], _number_targets(letters, steps[place], block, memo)), []).append(place)
        moved: list[ComponentPlace] = []
        for (number, step), members in groups.items():
            if signature[number] == step:
                continue
            if signature[number] is None or len(members) == sizes[number]:
                signature[number] = step
                continue
            sizes[number] -= len(members)
            new = len(sizes)
            sizes[new], signature[new] = len(members), step
            block.update(dict.fromkeys(members, new))
            moved += members
        dirty = dict.fromkeys(source for place in moved for source in sources[place])
    numbers: dict[int, int] = {}
    return {place: numbers.setdefault(block[place], len(numbers)) for place in reached}


def _number_targets(
    letters: Diagrams[Any], step: int, number: Mapping[ComponentPlace, int], memo: dict[int, int]
) -> int:
    """Return a step (see :func:`_steps`) with each target state replaced by its number."""
    return letters.map_leaves(lambda leaf: leaf and (number[leaf[0]], leaf[1]), step, memo)
