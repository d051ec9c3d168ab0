"""Remove states of a component by redirecting their edges to another state with the same label.

States with the same label have the same language. But a run that is redirected infinitely often
may be accepted or rejected wrongly, because the memories of the two states differ. So each removal
is checked: a state is removed only if the automaton without it accepts the same cycles as the
original one (docs/adr/0021).
"""

from __future__ import annotations

from typing import Any

from tltlc.automaton.diagrams import Diagrams
from tltlc.automaton.infinite.graphs import components
from tltlc.automaton.infinite.pairs import RabinComponent
from tltlc.automaton.infinite.products import PairLeaf, StatePair, conditions, product_leaves, separating_component
from tltlc.automaton.work import OutOfWork, Work


def shrink(letters: Diagrams[Any], component: RabinComponent, work: Work, steps: int) -> RabinComponent:
    """Return the component without the states that another state of the same label can replace.

    The search stops after ``steps`` steps of work; the states that are left then are kept.
    """
    original = component
    try:
        with work.at_most(steps):
            for state in reversed(list(component.steps)):
                if state not in component.steps:
                    # This state was reachable only through a state that was removed.
                    continue
                for other in list(component.steps):
                    if state == other or component.labels[state] != component.labels[other]:
                        continue
                    smaller = _redirect(letters, component, state, other)
                    if _is_equal(letters, smaller, original, work):
                        component = smaller
                        break
    except OutOfWork:
        pass
    return component


def _redirect(letters: Diagrams[Any], component: RabinComponent, state: Any, other: Any) -> RabinComponent:
    """Return the component without ``state``, with all edges to ``state`` redirected to ``other``.

    Also removes other states if the rest would not be strongly connected.
    """

    def redirected(leaf: Any) -> Any:
        return (other, leaf[1]) if leaf[0] == state else leaf

    memo: dict[int, int] = {}
    steps = {
        source: letters.map_leaves(redirected, step, memo)
        for source, step in component.steps.items()
        if source != state
    }

    def within(source: Any) -> list[Any]:
        return [target for target, _ in letters.values(steps[source]) if target[0] != "exit"]

    groups = components(list(steps), within)
    # The first component leads to no other.
    bottom = set(groups[0])
    return RabinComponent(
        {source: label for source, label in component.labels.items() if source in bottom},
        {source: step for source, step in steps.items() if source in bottom},
        component.pairs,
    )


def _is_equal(letters: Diagrams[Any], one: RabinComponent, other: RabinComponent, work: Work) -> bool:
    """Whether each state of ``one`` accepts the same traces in ``one`` as in ``other``.

    Compares only traces whose runs never leave the component. Raises OutOfWork.
    """
    together = product_leaves(letters, one.pairs, lambda leaf: leaf[0][0] == "exit")

    def leaves(both: StatePair) -> list[PairLeaf]:
        successors = together(one.steps[both[0]], other.steps[both[1]])
        work.spend(5 + len(successors))
        return successors

    of_one, of_other = conditions(one.pairs, one.pairs)
    starts = [(state, state) for state in one.steps]
    return separating_component(starts, leaves, [(of_one, of_other), (of_other, of_one)], work) is None
