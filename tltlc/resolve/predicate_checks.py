"""Check the range and continuity of predicates, and turn the findings into diagnostics."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, TypeVar

from tltlc.core.record import replace
from tltlc.diagnostics.diagnostic import Diagnostic, Label, Severity
from tltlc.expression.tree import ParamValue as ParamNode
from tltlc.expression.tree import SignalValue as SignalNode
from tltlc.expression.tree import nodes
from tltlc.io.limits import WORK
from tltlc.resolve.context import Context, Instance
from tltlc.resolve.spec import Signal
from tltlc.resolve.values import number_text

if TYPE_CHECKING:
    from tltlc.resolve.range_proof import RangeProblem

N = TypeVar("N", SignalNode, ParamNode)


_CONTINUITY = ("discontinuous", "continuity_unproved", "continuity_unchecked")
_NEVER_NEGATIVE = ("length", "time", "speed")


def check_predicates(context: Context) -> None:
    """Check the range and continuity of every predicate in ``context.instances``, and log the findings.

    A predicate must stay in its range for all values of the params. A jump of its value is reported
    only if the predicate jumps at the current values of the params: ``near(exit, close = 3 m)`` jumps
    in a level of 2 m, which does not matter if the level has 20 m.

    All checks together may take a limited number of steps. If too few steps are left, one warning
    (TLT0503) names the first predicate that was not checked and counts the others.
    """
    from tltlc.resolve.range_proof.work_budget import step_limit

    unchecked: list[Instance] = []
    with step_limit(WORK["checks of all predicates"]) as work:
        for instance in context.instances.values():
            if work.left < WORK["check of a predicate"]:
                unchecked.append(instance)
                continue
            with step_limit(WORK["check of a predicate"]):
                _check(instance, context)
    if unchecked:
        context.log.add(_unchecked_warning(unchecked))


def _check(instance: Instance, context: Context) -> None:
    from tltlc.resolve.range_proof import check_predicate

    findings = check_predicate(instance.expression, context.signals, context.params, instance.low, instance.high)
    for finding in findings:
        if finding.kind == "range_wrong" and _holds_without_negatives(instance, context):
            context.log.add(_diagnostic(instance, finding, negative=True))
        elif finding.kind not in _CONTINUITY or _jumps_at_param_values(instance, context):
            context.log.add(_diagnostic(instance, finding))


def _holds_without_negatives(instance: Instance, context: Context) -> bool:
    """Whether a predicate leaves its range only where some length, time or speed is negative.

    This considers only signals without a declared lower end. The game most likely never makes them
    negative.
    """
    from tltlc.resolve.range_proof import check_predicate

    signals: Mapping[str, Signal] = {
        name: replace(signal, low=0.0) if signal.type in _NEVER_NEGATIVE and signal.low is None else signal
        for name, signal in context.signals.items()
    }
    if all(signals[node.name] is context.signals[node.name] for node in _variables_read(instance, SignalNode)):
        return False
    findings = check_predicate(instance.expression, signals, context.params, instance.low, instance.high)
    return all(finding.kind not in ("range_wrong", "range_unchecked") for finding in findings)


def _jumps_at_param_values(instance: Instance, context: Context) -> bool:
    """Whether the check of a predicate for jumps still reports something if every param has its current value."""
    from tltlc.resolve.range_proof import check_predicate

    if not _variables_read(instance, ParamNode):
        return True
    params = {name: replace(param, low=param.value, high=param.value) for name, param in context.params.items()}
    findings = check_predicate(instance.expression, context.signals, params, instance.low, instance.high)
    return any(finding.kind in (*_CONTINUITY, "range_unchecked") for finding in findings)


def _variables_read(instance: Instance, kind: type[N]) -> list[N]:
    """Return the nodes of class ``kind`` in the expression of a predicate: those that read signals, or params."""
    return [node for node in nodes(instance.expression) if isinstance(node, kind)]


def _unchecked_warning(unchecked: Sequence[Instance]) -> Diagnostic:
    """Return the warning for predicates that were not checked because the step limit ran out."""
    first, remaining = unchecked[0], len(unchecked) - 1
    rest = f" and {remaining} more predicate{'' if remaining == 1 else 's'} were" if remaining else " was"
    why = f"the checks of all predicates may take {WORK['checks of all predicates']:,} steps, but too few are left"
    advice = "let the game compute parts of the predicates before this one and supply them as signals"
    label = Label(first.source, first.span, why)
    return Diagnostic("TLT0503", f"the predicate `{first.name}`{rest} not checked", (label,), advice, "warning")


def _diagnostic(instance: Instance, finding: RangeProblem, negative: bool = False) -> Diagnostic:
    code, severity, title, advice = _CASES[finding.kind]
    if negative:
        code, severity, title, advice = "TLT0401", "warning", *_NEGATIVE
    if not negative and finding.is_undefined:
        title, advice = _UNDEFINED
    elif finding.kind == "range_wrong" and not negative and (instance.low, instance.high) == (-1.0, 1.0):
        advice = _SCALE
    low, high = number_text(instance.low), number_text(instance.high)
    title, advice = title.format(name=instance.name, low=low, high=high), advice.format(low=low, high=high)
    labels: tuple[Label, ...] = (Label(instance.source, instance.span, finding.message),)
    if instance.use and instance.use.source is not instance.source:
        # The predicate comes from a library and is correct. The numbers that this use passes are the problem.
        labels = (replace(instance.use, message=finding.message), replace(labels[0], message="declared here"))
        advice = f"choose other numbers here, or {advice}"
    return Diagnostic(code, title, labels, advice, severity)


_CASES: dict[str, tuple[str, Severity, str, str]] = {
    "range_wrong": (
        "TLT0306",
        "error",
        "the predicate `{name}` leaves its range [{low}, {high}]",
        "declare the range that it really has, or limit the value with `clamp(…, {low}, {high})`",
    ),
    "range_unproved": (
        "TLT0401",
        "warning",
        "the range of the predicate `{name}` could not be proved",
        "declare ranges for the signals and params that it uses, or limit the value with `clamp(…, {low}, {high})`",
    ),
    "range_unchecked": (
        "TLT0503",
        "warning",
        "could not finish checking the range of the predicate `{name}`",
        "let the game compute a part of it and supply it as a signal",
    ),
    "discontinuous": (
        "TLT0402",
        "warning",
        "the predicate `{name}` jumps at the border between two cases of a `when`",
        "let both cases have the same value at the border",
    ),
    "continuity_unproved": (
        "TLT0402",
        "warning",
        "the predicate `{name}` may jump at the border between two cases of a `when`",
        "let both cases have the same value at the border",
    ),
    "continuity_unchecked": (
        "TLT0503",
        "warning",
        "could not finish checking whether the predicate `{name}` jumps",
        "let the game compute a part of it and supply it as a signal",
    ),
}
_SCALE = "scale the value, or limit it with `clamp(…, {low}, {high})`"
"""The advice for a range that cannot be wider, because a predicate must lie in [-1, 1]."""
_UNDEFINED = (
    "the predicate `{name}` is not defined everywhere",
    "keep what it divides by, or takes the root of, above 0 with `max(…, 0.1)`",
)
_NEGATIVE = (
    "the predicate `{name}` leaves its range [{low}, {high}] where a signal is negative",
    "declare the range of that signal, e.g. `in [0 m, inf]`",
)
