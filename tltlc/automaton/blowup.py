"""When an automaton outgrows its budget: which part of the spec is to blame."""

from __future__ import annotations

import sys
from collections.abc import Iterator
from contextlib import contextmanager

from tltlc.automaton.diagrams import Diagrams, OutOfSteps
from tltlc.automaton.guards import TooManyPrimes
from tltlc.automaton.machine import OutOfStates, machine
from tltlc.automaton.successors import Successors
from tltlc.diagnostics.diagnostic import Diagnostic, Label, TltlError
from tltlc.logic.normal_form import negation_normal_form
from tltlc.resolve.spec import Part, Spec

_RECURSION_ROOM = 10_000
_PART_BUDGET = 2_000
"""States tried for one part alone: enough to rank the parts, small enough to answer soon."""


@contextmanager
def recursion_room() -> Iterator[None]:
    """Room for diagrams as deep as a spec has atoms and temporal subformulas; restored afterwards."""
    before = sys.getrecursionlimit()
    sys.setrecursionlimit(max(before, _RECURSION_ROOM))
    try:
        yield
    finally:
        sys.setrecursionlimit(before)


def blow_up(spec: Spec, reason: Exception, state_budget: int) -> TltlError:
    """The error for a spec whose automaton outgrew a budget: TLT0501 (states) or TLT0502 (prime implicants)."""
    sizes = {part: _size(part, spec) for part in spec.parts}
    worst = sorted(spec.parts, key=lambda part: -sizes[part])
    if not worst:
        labels: tuple[Label, ...] = (Label(spec.source, spec.name_span),)
    elif len(worst) == 1 or sizes[worst[0]] >= _PART_BUDGET:
        labels = (_cause(worst[0]),)
    else:
        labels = tuple(
            Label(part.source, part.span, f"{sizes[part]} states alone; the parts multiply") for part in worst[:3]
        )
    if isinstance(reason, TooManyPrimes):
        verb = "has" if reason.whose == "a guard" else "have"
        title = f"{reason.whose} of `{spec.name}` {verb} more than {reason.limit} prime implicants"
        return TltlError([Diagnostic("TLT0502", title, labels, "split the spec, or name the condition as a predicate")])
    title = f"the automaton of `{spec.name}` needs more than {state_budget} states"
    if not isinstance(reason, OutOfStates):
        title = f"the automaton of `{spec.name}` needs too much memory"
    advice = "split the spec, shorten the bounds, or declare atoms that never hold together `exclusive`"
    return TltlError([Diagnostic("TLT0501", title, labels, advice)])


def _cause(part: Part) -> Label:
    """The part's longest bound, where it has one: a bound of n samples may have to be remembered n times over."""
    bound = max(part.bounds, key=lambda bound: bound.samples, default=None)
    if bound is None:
        return Label(part.source, part.span, "it is this part")
    return Label(bound.source, bound.span, "it is this bound")


def _size(part: Part, spec: Spec) -> int:
    """The states of one part's automaton, at most :data:`_PART_BUDGET`."""
    normal = negation_normal_form(part.formula)
    successors = Successors([atom.name for atom in spec.atoms], Diagrams(step_limit=100_000))
    successors.number_variables(normal)
    try:
        return len(machine(successors, successors.obligation(normal), _PART_BUDGET).transitions)
    except (OutOfStates, OutOfSteps, RecursionError):
        return _PART_BUDGET
