"""Find the clauses of a spec that make its automaton larger than the budget allows."""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager
from typing import Final, NamedTuple

from tltlc.automaton.diagrams import OutOfSteps
from tltlc.automaton.finite.labels import LabelsTooLong
from tltlc.automaton.finite.machine import OutOfStates, machine
from tltlc.automaton.finite.successors import Successors
from tltlc.automaton.guards import TooManyPrimes
from tltlc.automaton.transitions import TransitionDiagrams
from tltlc.diagnostics.diagnostic import Diagnostic, Label, TltlError
from tltlc.io.limits import WORK
from tltlc.logic.normal_form import negation_normal_form
from tltlc.resolve.spec import Bound, Conjunct, Spec

ADVICE: Final = "split the spec, shorten the bounds, or declare atoms that never hold together `exclusive`"
_RECURSION_ROOM = 10_000
_PART_BUDGET = 2_000
"""The state budget for the automaton of one clause alone: enough to compare the clauses, small enough to be quick."""


class ClauseSize(NamedTuple):
    """The size of the automaton of one clause alone: ``number`` to compare clauses, ``words`` for messages.

    ``words`` is a text such as "12 states".
    """

    number: int
    words: str


@contextmanager
def recursion_room() -> Iterator[None]:
    """Raise Python's recursion limit inside the ``with`` block, for functions that recurse over diagrams.

    A diagram can be as deep as the spec has atoms and temporal subformulas.
    """
    before = sys.getrecursionlimit()
    sys.setrecursionlimit(max(before, _RECURSION_ROOM))
    try:
        yield
    finally:
        sys.setrecursionlimit(before)


def budget_error(spec: Spec, reason: Exception, state_budget: int) -> TltlError:
    """Return the error for a spec whose automaton is too large.

    ``reason`` is the exception that stopped the construction. The error is TLT0502 if there are too
    many edges or prime implicants, and TLT0501 otherwise.
    """
    too_large = f"needs more than {state_budget} states" if isinstance(reason, OutOfStates) else failure_text(reason)
    remaining = WORK["states of blamed parts"]

    def size(part: Conjunct, spec: Spec) -> ClauseSize | None:
        nonlocal remaining
        if remaining < 0:
            # The budget for measuring is used up. The message names the three largest clauses, and more have been
            # measured by now. Size 0 puts this clause behind them.
            return ClauseSize(0, "")
        measured = _size(part, spec)
        remaining -= measured.number if measured else 0
        return measured

    return error_with_clauses(spec, reason, too_large, size)


def failure_text(reason: Exception) -> str:
    """Return in words why the automaton could not be built, such as "needs too much memory".

    A LabelsTooLong is reported as labels that are too long, a RecursionError as formulas that nest
    too deeply, and any other ``reason`` as too much memory.
    """
    if isinstance(reason, LabelsTooLong):
        return f"needs labels with more than {WORK['label nodes']} operators and atoms"
    return "needs formulas that nest too deeply" if isinstance(reason, RecursionError) else "needs too much memory"


def error_with_clauses(
    spec: Spec,
    reason: Exception,
    too_large: str,
    size: Callable[[Conjunct, Spec], ClauseSize | None],
    advice: str = ADVICE,
) -> TltlError:
    """Return the error for a spec whose automaton is too large, with labels on the clauses that make it large.

    At most three clauses get a label. ``size`` returns the size of the automaton of one clause
    alone, or None if this automaton is too large to build. ``too_large`` says in the title why the
    automaton of the spec could not be built, for example ``needs too much memory``. ``advice`` is
    the suggestion of the message. If ``reason`` is TooManyPrimes, ``too_large`` and ``advice`` are
    not used: that error has a title and an advice of its own.
    """
    sizes: dict[Conjunct, ClauseSize | None] = {}
    alone: list[Conjunct] = []
    for part in spec.parts:
        sizes[part] = size(part, spec)
        if sizes[part] is None:
            # One clause that is too large alone is cause enough.
            alone.append(part)
            break
    worst = sorted(
        ((part, measured) for part, measured in sizes.items() if measured), key=lambda sized: -sized[1].number
    )
    if not sizes:
        labels: tuple[Label, ...] = (Label(spec.source, spec.name_span),)
    elif alone or len(spec.parts) == 1:
        labels = (_cause_label(next(iter(alone or sizes))),)
    else:
        labels = tuple(
            Label(part.source, part.span, f"{measured.words} alone; the parts multiply") for part, measured in worst[:3]
        )
    from tltlc.resolve.chains import MOST_GOALS  # Back ends, which need `recursion_room`, load less without it.

    times = max((_times_in_sequence(part, spec) for part in alone or sizes), default=0)
    if isinstance(reason, TooManyPrimes):
        advice = _sequence_advice(times) if times >= MOST_GOALS else _guard_advice(spec, reason)
        return TltlError([Diagnostic("TLT0502", reason.title(spec.name), labels, advice)])
    title = f"the automaton of `{spec.name}` {too_large}"
    lasting = next((text for part in alone or sizes if (text := _lasting_goal(part))), "")
    if lasting:
        advice = lasting
    elif bound := longest_bound(alone or sizes):
        advice = bound_advice(bound)
    elif times >= MOST_GOALS:
        advice = _sequence_advice(times)
    return TltlError([Diagnostic("TLT0501", title, labels, advice)])


def longest_bound(parts: Iterable[Conjunct]) -> Bound | None:
    """Return the longest bound that is unfolded to states in some clauses; None if none is."""
    return max((bound for part in parts for bound in part.bounds), key=lambda bound: bound.samples, default=None)


def _lasting_goal(part: Conjunct) -> str:
    """Return how to write `eventually within 60 s always for 3 s q` with few states; "" without such bounds."""
    for goal in part.bounds:
        for length in part.bounds:
            between = goal.source.text[goal.span.end : length.span.start].strip(" (")
            if goal.op == "F" and length.op == "G" and goal.words and length.words and between == length.operator:
                time, shorter = (bound.source.slice(bound.span).split()[1:] for bound in (goal, length))
                whole = f"{goal.samples + length.samples} steps"
                if time[-1] == shorter[-1]:
                    whole = f"{float(time[0]) + float(shorter[0]):g} {time[-1]}"
                return (
                    f"write `{goal.operator} within {whole} time_holding(q) >= {' '.join(shorter)}` for "
                    f"`{goal.operator} within {' '.join(time)} {length.operator} for {' '.join(shorter)} q`, which "
                    "needs few states: then q may have begun before it is asked for. If each beginning of q must last, "
                    f"write `keep p implies {goal.operator} within {' '.join(time)} q` and "
                    f"`keep begins q implies {length.operator} for {' '.join(shorter)} q`"
                )
    return ""


def bound_advice(bound: Bound) -> str:
    """Return how to write a bound that becomes states so that it needs none."""
    text = " ".join(bound.source.slice(bound.span).split())
    shorten = "shorten it, or choose a slower `clock`"
    if bound.op == "F" and bound.words:
        form = f"`keep p implies {bound.operator} {text} q`"
    elif bound.op == "G" and bound.words:
        form = f"`keep p implies {bound.operator} {text} q`, also with `next` before `{bound.operator}`,"
    else:
        return shorten
    help_ = f"{form} needs no states if `p` and `q` are about one step each"
    if bound.op == "F":
        help_ += (
            f"; for `keep p implies {bound.operator} {text} (q and (r until s))`, write that, and "
            "`keep q implies (r until s)`"
        )
    return f"{help_}; otherwise {shorten}"


def _times_in_sequence(part: Conjunct, spec: Spec) -> int:
    """Return how many goals of a clause wait for another one with a timer (:mod:`tltlc.resolve.deadlines`)."""
    timers = [atom for atom in spec.atoms if atom.timer is not None]
    passed = {atom.name for atom in timers if atom.base == "passed" and len(atom.arguments) > 1}
    recent = {atom.name for atom in timers if atom.base in ("recent", "lately")}  # where the clock varies
    waits = (node.args[0] for node in part.formula.walk() if node.op == "U")
    return sum(1 for wait in waits if wait.name in recent or (wait.op == "not" and wait.args[0].name in passed))


def _sequence_advice(times: int) -> str:
    """Return how to write a sequence with many times so that it needs few states."""
    return (
        f"a sequence with {times} times has up to {2**times:,} states inside another operator, and two as a `reach` or"
        " `avoid` clause of its own; otherwise leave out some of the times"
    )


def _guard_advice(spec: Spec, reason: TooManyPrimes) -> str:
    """Return advice on how to make the guards smaller or fewer."""
    pairs = sum(len(group) * (len(group) - 1) // 2 for group in spec.exclusive)
    if reason.subject == "a guard" and 2 * pairs > reason.limit:
        # D says that no two `exclusive` atoms hold together. The prime implicants are those of `guard or not D`, and
        # `not D` has one for each pair.
        return f"declare fewer atoms `exclusive`, or use several smaller groups: now there are {pairs} exclusive pairs"
    if reason.subject == "a guard":
        return "split the spec, or declare the condition as a predicate"
    order = "give the goals an order, or split the spec"
    return order if spec.exclusive else f"declare atoms that never hold together `exclusive`, {order}"


def _cause_label(part: Conjunct) -> Label:
    """Return a label on the longest bound of a clause, such as ``within 100 steps``; on the clause if it has no bound.

    Long bounds make automata large: a bound of n samples may have to be counted from n different
    starts at once.
    """
    bound = longest_bound([part])
    if bound is None:
        return Label(part.source, part.span, "because of this part")
    return Label(bound.source, bound.span, "because of this bound")


def _size(part: Conjunct, spec: Spec) -> ClauseSize | None:
    """Return the number of states of the automaton of one clause; None if this automaton is too large to build.

    It is too large if it has :data:`_PART_BUDGET` states or more, or if its decision diagrams take
    too many steps or are too deep.
    """
    normal = negation_normal_form(part.formula)
    successors = Successors([atom.name for atom in spec.atoms], TransitionDiagrams(steps=100_000))
    successors.number_variables(normal)
    try:
        states = len(machine(successors, successors.obligation(normal), _PART_BUDGET).transitions)
    except (OutOfStates, OutOfSteps, RecursionError):
        return None
    return ClauseSize(states, f"{states} state{'s' * (states != 1)}") if states < _PART_BUDGET else None
