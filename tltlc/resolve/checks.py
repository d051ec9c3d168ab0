"""What the symbolic check of predicates found, as diagnostics."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, TypeVar

from tltlc.core.record import replace
from tltlc.diagnostics.diagnostic import Diagnostic, Label, Severity
from tltlc.expression.tree import Param as ParamNode
from tltlc.expression.tree import Signal as SignalNode
from tltlc.expression.tree import nodes
from tltlc.io.limits import WORK
from tltlc.resolve.context import Context, Instance
from tltlc.resolve.spec import Signal

if TYPE_CHECKING:
    from tltlc.resolve.range_proof import Finding

N = TypeVar("N", SignalNode, ParamNode)

_UNDEFINED_ENDINGS = ("divides by zero", "takes a root or power that no real number has")

_CONTINUITY = ("discontinuous", "continuity_unproved", "continuity_unchecked")
_NEVER_NEGATIVE = ("length", "time", "speed")


def check_predicates(context: Context) -> None:
    """Checks range and continuity of every predicate in use, each once; the findings go to the log.

    A range must hold for all values of the params; a jump counts only if there is one at their present values:
    `near(exit, close = 3 m)` jumps in a level of 2 m, but nobody plays it there.

    All checks together take a bounded number of steps. One warning names the predicates that were left (TLT0503).
    """
    from tltlc.resolve.range_proof.work import limited

    left: list[Instance] = []
    with limited(WORK["checks of all predicates"]) as work:
        for instance in context.instances.values():
            if work.left < WORK["check of a predicate"]:
                left.append(instance)
                continue
            with limited(WORK["check of a predicate"]):
                _check(instance, context)
    if left:
        context.log.add(_not_checked(left))


def _check(instance: Instance, context: Context) -> None:
    from tltlc.resolve.range_proof import check_predicate

    found = check_predicate(instance.expression, context.signals, context.params, instance.low, instance.high)
    for finding in found:
        if finding.kind == "range_wrong" and _holds_without_negatives(instance, context):
            context.log.add(_diagnostic(instance, finding, negative=True))
        elif finding.kind not in _CONTINUITY or _jumps_at_present(instance, context):
            context.log.add(_diagnostic(instance, finding))


def _holds_without_negatives(instance: Instance, context: Context) -> bool:
    """Whether the range is only wrong where a length, time or speed without a range would be negative."""
    from tltlc.resolve.range_proof import check_predicate

    signals: Mapping[str, Signal] = {
        name: replace(signal, low=0.0) if signal.type in _NEVER_NEGATIVE and signal.low is None else signal
        for name, signal in context.signals.items()
    }
    if all(signals[node.name] is context.signals[node.name] for node in _read(instance, SignalNode)):
        return False
    again = check_predicate(instance.expression, signals, context.params, instance.low, instance.high)
    return all(finding.kind not in ("range_wrong", "range_unchecked") for finding in again)


def _jumps_at_present(instance: Instance, context: Context) -> bool:
    """Whether there is a finding on continuity with every param at its value."""
    from tltlc.resolve.range_proof import check_predicate

    if not _read(instance, ParamNode):
        return True
    params = {name: replace(param, low=param.value, high=param.value) for name, param in context.params.items()}
    again = check_predicate(instance.expression, context.signals, params, instance.low, instance.high)
    return any(finding.kind in (*_CONTINUITY, "range_unchecked") for finding in again)


def _read(instance: Instance, kind: type[N]) -> list[N]:
    """The signals or params that a predicate reads."""
    return [node for node in nodes(instance.expression) if isinstance(node, kind)]


def _not_checked(left: Sequence[Instance]) -> Diagnostic:
    """Where a program's predicates take too long: those that are left."""
    first, more = left[0], len(left) - 1
    others = f" and {more} more {'predicate was' if more == 1 else 'predicates were'}" if more else " was"
    why = f"too few are left of the {WORK['checks of all predicates']:,} steps for the checks of all predicates"
    advice = "let the game compute parts of the predicates before this one and offer them as signals"
    label = Label(first.source, first.span, why)
    return Diagnostic("TLT0503", f"the predicate `{first.name}`{others} not checked", (label,), advice, "warning")


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
    "range_unchecked": (
        "TLT0503",
        "warning",
        "the range of the predicate `{name}` could not be checked to the end",
        "let the game compute a part of it and offer that as a signal",
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
    "continuity_unchecked": (
        "TLT0503",
        "warning",
        "whether the predicate `{name}` jumps could not be checked to the end",
        "let the game compute a part of it and offer that as a signal",
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
