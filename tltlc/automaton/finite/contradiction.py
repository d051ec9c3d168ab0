"""Find the clauses of an unsatisfiable spec that contradict each other."""

from __future__ import annotations

from collections.abc import Callable, Sequence

from tltlc.automaton.diagrams import OutOfSteps
from tltlc.automaton.finite.blowup import recursion_room
from tltlc.automaton.finite.build import minimal_machine
from tltlc.automaton.finite.machine import OutOfStates
from tltlc.automaton.transitions import IMPOSSIBLE, TransitionDiagrams
from tltlc.logic.formula import and_
from tltlc.resolve.spec import Conjunct, Spec

_MOST_PARTS = 40
_STATES = 1_000
_STEPS = 50_000
"""Limits of the search: the most clauses that it tries to leave out, and the most states and steps of an automaton.

A warning must not take longer than the compilation.
"""


Decision = Callable[[Sequence[Conjunct], Spec], bool]
"""A function that returns True if it can prove that no trace satisfies all of the given clauses of a spec."""


def contradiction(spec: Spec, decision: Decision | None = None) -> tuple[Conjunct, ...]:
    """Return clauses of an unsatisfiable spec that contradict each other, such that all of them are needed.

    ``decision`` decides whether clauses contradict each other; by default :func:`unsatisfiable`,
    over finite traces. If a decision takes too much work, the result may have more clauses than
    needed. If the spec has more than :data:`_MOST_PARTS` clauses, returns all of them.
    """
    decision = decision or unsatisfiable
    needed = list(spec.parts)
    for part in spec.parts if len(spec.parts) <= _MOST_PARTS else ():
        without_part = [other for other in needed if other is not part]
        if without_part and decision(without_part, spec):
            needed = without_part
    return tuple(needed)


def unsatisfiable(parts: Sequence[Conjunct], spec: Spec) -> bool:
    """Whether it is certain that no finite trace satisfies all of these clauses.

    Returns False if some trace does, or if a proof would take too many states or steps.
    """
    whole = and_(*(part.formula for part in parts))
    names = [atom.name for atom in spec.atoms]
    try:
        with recursion_room():
            successors, machine, _ = minimal_machine(
                whole, names, _STATES, spec.exclusive, TransitionDiagrams(steps=_STEPS)
            )
    except (OutOfStates, OutOfSteps, RecursionError):
        return False
    diagrams = successors.diagrams
    # The minimal machine of `false` has one state, and no letter is accepted in it.
    leaves = [leaf for leaf in diagrams.leaves(*machine.transitions.values()) if leaf != IMPOSSIBLE]
    return len(machine.transitions) == 1 and not any(diagrams.value[leaf][1] for leaf in leaves)
