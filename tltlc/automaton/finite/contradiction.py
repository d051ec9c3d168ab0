"""Find the parts of an unsatisfiable spec that contradict each other."""

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
"""Limits of the search, above which it gives up: a warning must not take longer than the compilation."""


Decision = Callable[[Sequence[Conjunct], Spec], bool]
"""Whether it can be proved that no trace satisfies all of the parts."""


def contradiction(spec: Spec, decision: Decision | None = None) -> tuple[Conjunct, ...]:
    """Return parts of an unsatisfiable spec that contradict each other and are all needed for that.

    ``decision`` decides whether parts contradict each other, by default over finite traces.  If a
    decision takes too much work, some of the parts returned may not be needed.
    """
    decision = decision or unsatisfiable
    needed = list(spec.parts)
    for part in spec.parts if len(spec.parts) <= _MOST_PARTS else ():
        without_part = [other for other in needed if other is not part]
        if without_part and decision(without_part, spec):
            needed = without_part
    return tuple(needed)


def unsatisfiable(parts: Sequence[Conjunct], spec: Spec) -> bool:
    """Whether it can be proved, within the limits, that no finite trace satisfies all of the parts."""
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
    # The minimal machine of `false` has one state: a trap that no possible letter leaves or accepts in.
    leaves = [leaf for leaf in diagrams.leaves(*machine.transitions.values()) if leaf != IMPOSSIBLE]
    return len(machine.transitions) == 1 and not any(diagrams.value[leaf][1] for leaf in leaves)
