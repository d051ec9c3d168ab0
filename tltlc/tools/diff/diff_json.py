"""Write the differences between two files as JSON, in the form of ``diff.schema.json``."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from tltlc.automaton.compare import Trace
from tltlc.expression.json import to_json
from tltlc.resolve.spec import Atom, Param, Signal
from tltlc.tools.diff.phrases import unrelated_reason
from tltlc.tools.diff.traces import ordered_atoms

if TYPE_CHECKING:
    from tltlc.tools.diff.differences import Difference
    from tltlc.tools.diff.pairs import FileDiff, SpecPair


def document(report: FileDiff) -> dict[str, Any]:
    """Return ``report``, the differences between two files, as a JSON object."""
    return {
        "a": report.a,
        "b": report.b,
        "same": report.is_same,
        "specs": [_pair(pair) for pair in report.pairs],
        "only_in_a": list(report.only_a),
        "only_in_b": list(report.only_b),
    }


def _pair(pair: SpecPair) -> dict[str, Any]:
    comparison = pair.comparison
    return {
        "name_a": pair.a.name,
        "name_b": pair.b.name,
        "relation": comparison.relation,
        "method": comparison.method,
        "reason": unrelated_reason(pair.a, pair.b) if comparison.relation is None else None,
        "beginnings": _beginnings(pair),
        "only_a": _trace(pair, comparison.only_a),
        "only_b": _trace(pair, comparison.only_b),
        "different_atoms": list(comparison.split_names),
        "left_out": [
            [{"atom": name, "holds": holds} for name, holds in literals] for literals in comparison.impossible
        ],
        "exclusive": [
            {"atoms": list(group.names), "in_a": group.in_a, "in_b": group.in_b} for group in comparison.exclusive
        ],
        "differences": [_difference(difference) for difference in pair.differences],
    }


def _beginnings(pair: SpecPair) -> dict[str, Any] | None:
    """Return as JSON which finite beginnings of traces only one of the two specs allows.

    This is the field ``beginnings`` of :class:`~tltlc.tools.diff.relation.Comparison`. Return None
    unless one spec is over finite traces and the other over infinite traces.
    """
    comparison = pair.comparison.beginnings
    if comparison is None:
        return None
    only_a, only_b = (
        trace and [ordered_atoms(pair, letter) for letter in trace.prefix]
        for trace in (comparison.only_a, comparison.only_b)
    )
    return {"relation": comparison.relation, "only_a": only_a, "only_b": only_b}


def _trace(pair: SpecPair, trace: Trace | None) -> Any:
    """Return a trace as JSON: a finite trace as a list of samples, an infinite trace as its prefix and cycle.

    Each sample is the list of the atoms that hold. Return None if ``trace`` is None.
    """
    if trace is None:
        return None
    prefix, cycle = ([ordered_atoms(pair, letter) for letter in letters] for letters in (trace.prefix, trace.cycle))
    return {"prefix": prefix, "cycle": cycle} if pair.a.semantics == "infinite" else prefix


def _difference(difference: Difference) -> dict[str, Any]:
    fields: dict[str, Any] = {
        "what": difference.kind,
        "name": difference.name or None,
        "a": _value(difference.a),
        "b": _value(difference.b),
    }
    if difference.value_difference is not None:
        first, second = difference.value_difference.values
        fields["sample"] = {"signals": dict(difference.value_difference.sample), "a": first, "b": second}
    return fields


def _value(value: object) -> Any:
    match value:
        case Signal():
            values = {"values": list(value.values)} if value.values else {}
            return {"type": value.type, "range": [value.low, value.high], **values}
        case Param():
            return {"type": value.type, "range": [value.low, value.high], "value": value.value}
        case Atom():
            return to_json(value.expression)
        case tuple():
            return list(value)
        case _:
            return value
