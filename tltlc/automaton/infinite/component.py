"""Convert a strongly connected component of the after-automaton to an automaton with an acceptance condition.

The states of the after-automaton are labels (obligations). The formula has parts, and a small
automaton observes each part. A state of the new automaton has a label and, for each part, a memory:
the state of the part's automaton.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Sequence
from typing import Any, Final

from tltlc.automaton.diagrams import Diagrams
from tltlc.automaton.infinite.after_automaton import ObligationAutomaton
from tltlc.automaton.infinite.delta2 import is_pi_2
from tltlc.automaton.infinite.graphs import smallest_bottom
from tltlc.automaton.infinite.leaf_automata import Breakpoint, LeafAutomaton, Memory, Recurrence, RoundRobin
from tltlc.automaton.infinite.mark_conditions import MarkClause, Marks, Skeleton, clauses
from tltlc.core.record import record
from tltlc.logic.formula import Formula

IMPOSSIBLE: Final = -1
"""Takes the place of a label where a letter has no successor because ``exclusive`` rules it out."""

ComponentState = tuple[Any, ...]
"""A label, then the memory of each part. A target outside the component is ``("exit", label)`` instead."""

ComponentLeaf = tuple[ComponentState, Marks]
"""The state after a letter, and the marks of the edge: the indices of the parts that mark the letter."""

_NONE: Final[Marks] = frozenset()


@record
class ComponentAutomaton:
    """The automaton of a strongly connected component of the after-automaton, with an acceptance condition.

    The states of the after-automaton are obligations: what remains to be done. ``labels`` maps each
    state of this automaton to its label, the obligation that remains in the state. ``steps``
    maps each state to a function from the letter to a :data:`ComponentLeaf`. A run that stays in
    the component is accepted if it meets a clause of ``accepts``.
    """

    labels: dict[ComponentState, int]
    steps: dict[ComponentState, int]
    accepts: tuple[MarkClause, ...]


def parts_of(
    after: ObligationAutomaton, normal: Formula, *, keep: bool, in_turn: bool
) -> tuple[Skeleton, list[LeafAutomaton]]:
    """Split a normalised formula into parts; return how ``and`` and ``or`` join them, and an automaton for each part.

    The parts are the largest subformulas that are neither an ``and`` nor an ``or``. For
    ``G F a & (p U q | G F b)``, they are ``G F a``, ``p U q`` and ``G F b``. If ``in_turn``, the
    operands ``G F p`` of an ``and`` share one automaton, a
    :class:`~tltlc.automaton.infinite.leaf_automata.RoundRobin`, and so do the operands ``F G p`` of
    an ``or``. ``keep`` is passed to :class:`~tltlc.automaton.infinite.leaf_automata.Recurrence`.
    """
    index_of: dict[Formula | tuple[Formula, ...], int] = {}
    parts: list[LeafAutomaton] = []

    def read(formula: Formula) -> Skeleton:
        if formula.op in ("and", "or"):
            group = tuple(operand for operand in formula.args if operand.op == ("G" if formula.op == "and" else "F"))
            if not in_turn or len(group) < 2:
                return (formula.op, *map(read, formula.args))
            if group not in index_of:
                index_of[group] = len(parts)
                parts.append(RoundRobin(after, [_recurrence(after, operand, keep=keep) for operand in group]))
            rest = [read(operand) for operand in formula.args if operand not in group]
            return (formula.op, ("leaf", index_of[group]), *rest)
        if formula not in index_of:
            index_of[formula] = len(parts)
            rigid = formula.op in ("G", "F")
            parts.append(_recurrence(after, formula, keep=keep) if rigid else _breakpoint(after, formula))
        return ("leaf", index_of[formula])

    return read(normal), parts


def has_turns(normal: Formula) -> bool:
    """Whether an ``and`` in a normalised formula has several operands ``G F p``, or an ``or`` several ``F G p``.

    With ``in_turn``, :func:`parts_of` gives these operands one automaton.
    """
    rigid = {"and": "G", "or": "F"}.get(normal.op)
    if rigid is None:
        return False
    return sum(operand.op == rigid for operand in normal.args) > 1 or any(map(has_turns, normal.args))


def _recurrence(after: ObligationAutomaton, formula: Formula, *, keep: bool) -> Recurrence:
    return Recurrence(after, formula.args[0].args[0], "inf" if formula.op == "G" else "fin", keep=keep)


def _breakpoint(after: ObligationAutomaton, formula: Formula) -> Breakpoint:
    return Breakpoint(after, formula, "inf" if is_pi_2(formula) else "fin")


def bottom_component(
    letters: Diagrams[Any],
    step_of: Callable[[int], int],
    inside: Collection[int],
    first: int,
    skeleton: Skeleton,
    parts: Sequence[LeafAutomaton],
) -> ComponentAutomaton:
    """Return an automaton with an acceptance condition for the component of the labels ``inside``.

    A label is an obligation, and ``step_of(label)`` is a function from the letter to the next
    label. The automata ``parts`` observe the parts of a formula; ``skeleton`` says how ``and`` and
    ``or`` join these parts. The product of the labels and these automata is explored from the label
    ``first`` and the initial states of the automata. The result is the smallest strongly connected
    component of the product that no edge leaves, except to labels outside ``inside``.
    """
    initial: ComponentState = (first, *(part.initial for part in parts))
    steps, best = explore(letters, initial, lambda state: _step(letters, step_of, inside, state, parts))
    kinds = [part.kind for part in parts]
    values = [part.final_value(memory) for part, memory in zip(parts, best[0][1:], strict=True)]
    accepts = clauses(skeleton, kinds, values, letters.work)
    if isinstance(accepts, bool):
        accepts = [MarkClause(frozenset(), frozenset())] if accepts else []
    members = set(best)
    chosen = {state: step for state, step in steps.items() if state in members}
    return ComponentAutomaton({state: state[0] for state in chosen}, chosen, tuple(accepts))


def explore(
    letters: Diagrams[Any], initial: ComponentState, step_of: Callable[[ComponentState], int]
) -> tuple[dict[ComponentState, int], list[ComponentState]]:
    """Return the step of each state that ``initial`` can reach, and the states of the bottom component.

    The step of a state, ``step_of(state)``, is a function from the letter to the next state and
    marks. The first result has the states in breadth-first order. The bottom component is the
    smallest strongly connected component that no edge leaves, except to targets
    ``("exit", label)``.
    """
    steps: dict[ComponentState, int] = {}
    targets: dict[ComponentState, list[ComponentState]] = {}
    queue = [initial]
    seen = {initial}
    for state in queue:
        steps[state] = step_of(state)
        targets[state] = [target for target, _ in letters.values(steps[state]) if target[0] != "exit"]
        for target in targets[state]:
            if target not in seen:
                seen.add(target)
                queue.append(target)
    return steps, smallest_bottom(targets, initial)


def merge_equal_states(letters: Diagrams[Any], component: ComponentAutomaton) -> ComponentAutomaton:
    """Return the component with equal states merged.

    States are equal if they have the same label and, on each letter, equal successors and the same
    marks. Marks that no clause uses do not count.
    """
    labels, steps, accepts = component.labels, component.steps, component.accepts
    used = frozenset().union(*(clause.fins | clause.infs for clause in accepts))
    block = {state: labels[state] for state in steps}
    count = len(set(block.values()))
    while True:
        memo: dict[int, int] = {}

        def change(leaf: ComponentLeaf, block: dict[ComponentState, int] = block) -> Any:
            target, marks = leaf
            return leaf if target[0] == "exit" else (block[target], marks & used)

        signature = {state: (block[state], letters.map_leaves(change, steps[state], memo)) for state in steps}
        numbers: dict[tuple[int, int], int] = {}
        block = {state: numbers.setdefault(signature[state], len(numbers)) for state in steps}
        if len(numbers) == count:
            break
        count = len(numbers)
    first: dict[int, ComponentState] = {}
    for state in steps:
        first.setdefault(block[state], state)
    memo = {}

    def final(leaf: ComponentLeaf) -> ComponentLeaf:
        target, marks = leaf
        return leaf if target[0] == "exit" else (first[block[target]], marks & used)

    merged_steps = {state: letters.map_leaves(final, steps[state], memo) for state in first.values()}
    return ComponentAutomaton({state: labels[state] for state in merged_steps}, merged_steps, accepts)


def _step(
    letters: Diagrams[Any],
    step_of: Callable[[int], int],
    inside: Collection[int],
    state: ComponentState,
    parts: Sequence[LeafAutomaton],
) -> int:
    """Return the step of a state of the product: a function from the letter to a :data:`ComponentLeaf`."""

    def start(label: int) -> ComponentLeaf:
        return ((label,), _NONE) if label in inside else (("exit", label), _NONE)

    step = letters.map_leaves(start, step_of(state[0]), {})
    for index, (part, memory) in enumerate(zip(parts, state[1:], strict=True)):

        def add(leaf: ComponentLeaf, part_leaf: tuple[Memory, bool], index: int = index) -> ComponentLeaf:
            target, marks = leaf
            if target[0] == "exit":
                return leaf
            return (*target, part_leaf[0]), marks | {index} if part_leaf[1] else marks

        step = letters.apply(add, step, part.step(memory), {})
    return step
