"""Build the minimal machine of an obligation: find all reachable obligations, and merge those of the same language.

A machine is a deterministic automaton whose transitions, not states, decide acceptance. Its states
are obligations (what remains to be done after the samples so far). A letter leads to a leaf, which
has the next obligation and says whether a trace that ends with this letter is accepted.
:mod:`tltlc.automaton.finite.build` then makes an automaton with accepting states from the machine.
"""

from __future__ import annotations

from collections.abc import Iterable

from tltlc.automaton.diagrams import LEAF, OutOfSteps
from tltlc.automaton.finite.successors import Successors
from tltlc.automaton.transitions import ACCEPT, IMPOSSIBLE, TransitionDiagrams
from tltlc.core.record import record


class OutOfStates(Exception):
    """Raised when a machine needs more states than its budget allows."""


@record
class Machine:
    """The minimal machine of an obligation: a deterministic automaton whose transitions decide acceptance.

    Its states are obligations (what remains to be done). Of all reachable obligations with the same
    language, only one is a state; ``representative`` maps each reachable obligation to this state.
    ``transitions`` maps each state to its transition, a node of a decision diagram whose leaves
    have the next states. The first key of ``transitions`` is ``initial``, the initial state.
    """

    initial: int
    transitions: dict[int, int]
    representative: dict[int, int]


def machine(successors: Successors, obligation: int, state_budget: int, allowed: int = ACCEPT) -> Machine:
    """Return the minimal machine of an obligation (what remains to be done).

    ``allowed`` is a guard: only letters on which the guard is true can occur. Raises
    :class:`OutOfStates` if there are more than ``state_budget`` reachable obligations, and
    :class:`OutOfSteps` if their transitions take too many steps.
    """
    return minimise(successors, explore(successors, obligation, state_budget, allowed))


def explore(successors: Successors, initial: int, state_budget: int, allowed: int = ACCEPT) -> dict[int, int]:
    """Map every obligation that can be reached from ``initial`` to its transition, in breadth-first order.

    An obligation says what remains to be done. Its transition is a node of a decision diagram that
    maps each letter to the next obligation. Only letters on which the guard ``allowed`` is true can
    occur. Raises :class:`OutOfStates` if there are more than ``state_budget`` obligations, and
    :class:`OutOfSteps` if their transitions take too many steps.
    """
    diagrams = successors.diagrams
    atom, low, high, value = diagrams.variable, diagrams.low, diagrams.high, diagrams.value
    transition_of = successors.of_obligation
    transitions: dict[int, int] = {}
    seen = {initial}
    queue = [initial]
    # Transitions share nodes. The obligations in the leaves below a visited node are already in the queue.
    visited = {IMPOSSIBLE}
    for state in queue:
        if len(queue) > state_budget:
            raise OutOfStates
        transition = transition_of(state)
        if allowed != ACCEPT:
            transition = diagrams.constrain(transition, allowed)
        transitions[state] = transition
        stack = [transition]
        while stack:
            node = stack.pop()
            if node in visited:
                continue
            visited.add(node)
            if atom[node] != LEAF:
                stack.append(high[node])
                stack.append(low[node])
            elif value[node][0] not in seen:
                seen.add(value[node][0])
                queue.append(value[node][0])
    return transitions


def minimise(successors: Successors, transitions: dict[int, int]) -> Machine:
    """Return the machine in which obligations with the same language are merged into one state.

    ``transitions`` is the result of :func:`explore`. The method is partition refinement: start
    with all obligations in one block, and split a block while its members have transitions to
    different blocks. After a split, the largest part keeps the block's number. So only nodes that
    lead to the smaller parts are visited again, as in Hopcroft's algorithm.
    """
    diagrams = successors.diagrams
    atom, low, high, value = diagrams.variable, diagrams.low, diagrams.high, diagrams.value
    block = dict.fromkeys(transitions, 0)
    members: list[list[int]] = [list(transitions)]
    states_of: dict[int, list[int]] = {}
    for state, transition in transitions.items():
        states_of.setdefault(transition, []).append(state)
    parents, leaves_of = _links(diagrams, states_of)

    # Nodes have the same signature if they are equal after each leaf's obligation is replaced by its block. The
    # signature of a leaf is negative; that of an inner node is the number of its triple (atom, low, high).
    signature: dict[int, int] = {}
    triples: dict[tuple[int, int, int], int] = {}
    changed = sorted(parents)
    while changed:
        touched: set[int] = set()
        # Children have lower numbers than their parents, so ascending order visits children first.
        for node in changed:
            if atom[node] == LEAF:
                following, accepted = value[node]
                new = -1 if node == IMPOSSIBLE else -2 - 2 * block[following] - accepted
            else:
                below, above = signature[low[node]], signature[high[node]]
                if below == above:
                    new = below
                else:
                    triple = (atom[node], below, above)
                    new = triples.setdefault(triple, len(triples))
            if signature.get(node) != new:
                signature[node] = new
                for state in states_of.get(node, ()):
                    touched.add(block[state])
        moved: list[int] = []
        for number in sorted(touched):
            parts: dict[int, list[int]] = {}
            for state in members[number]:
                parts.setdefault(signature[transitions[state]], []).append(state)
            if len(parts) == 1:
                continue
            largest = max(parts.values(), key=len)
            members[number] = largest
            for part in parts.values():
                if part is not largest:
                    for state in part:
                        block[state] = len(members)
                        moved += leaves_of.get(state, ())
                    members.append(part)
        changed = sorted(_ancestors(moved, parents))
    return _quotient(successors, transitions, members)


def _ancestors(nodes: list[int], parents: dict[int, list[int]]) -> set[int]:
    """Return the given nodes and all their ancestors; ``parents`` maps each node to its parents."""
    ancestors = set(nodes)
    stack = list(ancestors)
    while stack:
        for parent in parents[stack.pop()]:
            if parent not in ancestors:
                ancestors.add(parent)
                stack.append(parent)
    return ancestors


def _links(diagrams: TransitionDiagrams, roots: Iterable[int]) -> tuple[dict[int, list[int]], dict[int, list[int]]]:
    """Return two dicts: the parents of each node that ``roots`` can reach, and the leaves that lead to each state."""
    atom, low, high, value = diagrams.variable, diagrams.low, diagrams.high, diagrams.value
    parents: dict[int, list[int]] = {root: [] for root in roots}
    leaves_of: dict[int, list[int]] = {}
    stack = list(parents)
    while stack:
        node = stack.pop()
        if atom[node] == LEAF:
            leaves_of.setdefault(value[node][0], []).append(node)
            continue
        for child in (low[node], high[node]):
            known = parents.get(child)
            if known is None:
                parents[child] = [node]
                stack.append(child)
            else:
                known.append(node)
    return parents, leaves_of


def _quotient(successors: Successors, transitions: dict[int, int], blocks: list[list[int]]) -> Machine:
    """Return the machine with one state for each block: the member that comes first in ``transitions``."""
    initial = next(iter(transitions))
    if len(blocks) == len(transitions):
        return Machine(initial, transitions, {state: state for state in transitions})
    diagrams = successors.diagrams
    order = {state: position for position, state in enumerate(transitions)}
    representative: dict[int, int] = {}
    for group in blocks:
        first = min(group, key=order.__getitem__)
        representative.update(dict.fromkeys(group, first))
    memo: dict[int, int] = {IMPOSSIBLE: IMPOSSIBLE}

    def to_representative(leaf: tuple[int, int]) -> tuple[int, int]:
        return representative[leaf[0]], leaf[1]

    return Machine(
        initial=initial,
        transitions={
            state: diagrams.map_leaves(to_representative, transition, memo)
            for state, transition in transitions.items()
            if representative[state] == state
        },
        representative=representative,
    )


def matches_state(
    successors: Successors,
    machine: Machine,
    known: dict[int, int],
    obligation: int,
    state: int,
    pair_limit: int,
    allowed: int = ACCEPT,
) -> bool:
    """Whether an obligation has the same language as a state of a minimal machine.

    An obligation says what remains to be done; its language is the set of traces that satisfy it.
    Explores the obligation and the machine together, letter by letter. If the languages are equal,
    each obligation meets only one state, since states of a minimal machine have different
    languages. ``known`` maps obligations to the states with the same language; if the result is
    True, this function adds the obligations that it has compared. ``allowed`` is a guard: only
    letters on which the guard is true can occur. Raises :class:`OutOfSteps` if there are more than
    ``pair_limit`` obligations to compare.
    """
    diagrams = successors.diagrams
    atom, low, high, value = diagrams.variable, diagrams.low, diagrams.high, diagrams.value
    if obligation in known:
        return known[obligation] == state
    assumed = {obligation: state}
    queue = [obligation]
    for current in queue:
        if len(queue) > pair_limit:
            raise OutOfSteps
        transition = successors.of_obligation(current)
        if allowed != ACCEPT:
            transition = diagrams.constrain(transition, allowed)
        stack = [(transition, machine.transitions[assumed[current]])]
        visited = set(stack)
        while stack:
            m, n = stack.pop()
            am, an = atom[m], atom[n]
            if am == an == LEAF:
                if m == n == IMPOSSIBLE:
                    continue
                (following, accepted), (expected, accepting) = value[m], value[n]
                if IMPOSSIBLE in (m, n) or accepted != accepting:
                    return False
                matched = known.get(following, assumed.get(following))
                if matched is None:
                    assumed[following] = expected
                    queue.append(following)
                elif matched != expected:
                    return False
                continue
            lows = (low[m] if am <= an else m, low[n] if an <= am else n)
            highs = (high[m] if am <= an else m, high[n] if an <= am else n)
            for pair in (lows, highs):
                if pair not in visited:
                    visited.add(pair)
                    stack.append(pair)
    known.update(assumed)
    return True
