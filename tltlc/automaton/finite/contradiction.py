"""Which parts of a specification contradict each other, where no trace satisfies it."""

from __future__ import annotations

from collections.abc import Callable, Sequence

from tltlc.automaton.diagrams import IMPOSSIBLE, Diagrams, OutOfSteps
from tltlc.automaton.finite.blowup import recursion_room
from tltlc.automaton.finite.build import minimal_machine
from tltlc.automaton.finite.machine import OutOfStates
from tltlc.logic.formula import and_
from tltlc.resolve.spec import Part, Spec

_MOST_PARTS = 40
_STATES = 1_000
_STEPS = 50_000
"""Above these, parts are not told apart: a warning must not take longer than the compilation."""


Decision = Callable[[Sequence[Part], Spec], bool]
"""Whether it is shown that no trace satisfies all of the parts."""


def contradiction(spec: Spec, decision: Decision | None = None) -> tuple[Part, ...]:
    """Parts of an unsatisfiable spec that are unsatisfiable together, none of which could be left out.

    ``decision`` decides it, by default over finite traces.  Where the work gets too much, parts may be among them
    that could.
    """
    decision = decision or unsatisfiable
    needed = list(spec.parts)
    for part in spec.parts if len(spec.parts) <= _MOST_PARTS else ():
        others = [other for other in needed if other is not part]
        if others and decision(others, spec):
            needed = others
    return tuple(needed)


def unsatisfiable(parts: Sequence[Part], spec: Spec) -> bool:
    """Whether it is shown that no finite trace satisfies all of the parts."""
    whole = and_(*(part.formula for part in parts))
    names = [atom.name for atom in spec.atoms]
    try:
        with recursion_room():
            successors, machine, _ = minimal_machine(whole, names, _STATES, spec.exclusive, Diagrams(step_limit=_STEPS))
    except (OutOfStates, OutOfSteps, RecursionError):
        return False
    diagrams = successors.diagrams
    # All that rejects is one state of a minimal machine: a trap that no possible letter leaves or accepts in.
    leaves = [leaf for leaf in diagrams.leaves(*machine.transitions.values()) if leaf != IMPOSSIBLE]
    return len(machine.transitions) == 1 and not any(diagrams.high[leaf] for leaf in leaves)
