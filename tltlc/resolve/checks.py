"""What the symbolic check of predicates found, as diagnostics."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

from tltlc.diagnostics.diagnostic import Diagnostic, Label, Severity
from tltlc.record import replace
from tltlc.resolve.context import Context, Instance
from tltlc.resolve.spec import Signal

if TYPE_CHECKING:
    from tltlc.resolve.predicate_check import Finding

_UNDEFINED_ENDINGS = ("divides by zero", "takes a root or power that no real number has")

_CONTINUITY = ("discontinuous", "continuity_unproved")
_NEVER_NEGATIVE = ("length", "time", "speed")


def check_predicates(context: Context) -> None:
    """Checks range and continuity of every predicate in use, each once; the findings go to the log.

    A range must hold for all values of the params; a jump counts only if there is one at their present values:
    `near(exit, close = 3 m)` jumps in a level of 2 m, but nobody plays it there.
    """
    from tltlc.resolve.predicate_check import check_predicate

    for instance in context.instances.values():
        found = check_predicate(instance.expression, context.signals, context.params, instance.low, instance.high)
        for finding in found:
            if finding.kind == "range_wrong" and _holds_without_negatives(instance, context):
                context.log.add(_diagnostic(instance, finding, negative=True))
            elif finding.kind not in _CONTINUITY or _jumps_at_present(instance, context):
                context.log.add(_diagnostic(instance, finding))


def _holds_without_negatives(instance: Instance, context: Context) -> bool:
    """Whether the range is only wrong where a length, time or speed without a range would be negative."""
    from tltlc.resolve.predicate_check import check_predicate

    signals: Mapping[str, Signal] = {
        name: replace(signal, low=0.0) if signal.type in _NEVER_NEGATIVE and signal.low is None else signal
        for name, signal in context.signals.items()
    }
    again = check_predicate(instance.expression, signals, context.params, instance.low, instance.high)
    return all(finding.kind != "range_wrong" for finding in again)


def _jumps_at_present(instance: Instance, context: Context) -> bool:
    """Whether there is a finding on continuity with every param at its value."""
    from tltlc.resolve.predicate_check import check_predicate

    params = {name: replace(param, low=param.value, high=param.value) for name, param in context.params.items()}
    again = check_predicate(instance.expression, context.signals, params, instance.low, instance.high)
    return any(finding.kind in _CONTINUITY for finding in again)


def _diagnostic(instance: Instance, finding: Finding, negative: bool = False) -> Diagnostic:
    code, severity, title, advice = _CASES[finding.kind]
    if negative:
        code, severity, title, advice = "TLT0401", "warning", *_NEGATIVE
    if not negative and finding.message.endswith(_UNDEFINED_ENDINGS):
        title, advice = _UNDEFINED
    labels: tuple[Label, ...] = (Label(instance.source, instance.span, finding.message),)
    if instance.use and instance.use.source is not instance.source:
        # A library's predicate is right as it stands: the numbers given to it here are not.
        labels = (replace(instance.use, message=finding.message), replace(labels[0], message="declared here"))
        advice = f"choose other numbers here, or {advice}"
    return Diagnostic(code, title.format(name=instance.name), labels, advice, severity)


_CASES: dict[str, tuple[str, Severity, str, str]] = {
    "range_wrong": (
        "TLT0306",
        "error",
        "the predicate `{name}` leaves its declared range",
        "declare the range it has, or hold the value inside with `clamp(…, -1, 1)`",
    ),
    "range_unproved": (
        "TLT0401",
        "warning",
        "the range of the predicate `{name}` could not be proved",
        "declare ranges for the signals and params it uses, or hold the value inside with `clamp(…, -1, 1)`",
    ),
    "discontinuous": (
        "TLT0402",
        "warning",
        "the predicate `{name}` jumps at the border of a `when`",
        "let both sides of the border have the same value there",
    ),
    "continuity_unproved": (
        "TLT0402",
        "warning",
        "the predicate `{name}` may jump at the border of a `when`",
        "let both sides of the border have the same value there",
    ),
}
_UNDEFINED = (
    "the predicate `{name}` has no value everywhere",
    "hold what it divides by, or takes the root of, inside with `max(…, 0.1)`",
)
_NEGATIVE = (
    "the predicate `{name}` leaves its declared range where a signal is negative",
    "declare its range, e.g. `in [0 m, inf]`",
)
