"""What is different from one file to another, as JSON: ``diff.schema.json`` beside this file says of what form."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from tltlc.automaton.compare import Trace
from tltlc.expression.json import to_json
from tltlc.resolve.spec import Atom, Param, Signal
from tltlc.tools.diff.phrases import unrelated
from tltlc.tools.diff.traces import in_order

if TYPE_CHECKING:
    from tltlc.tools.diff.differences import Difference
    from tltlc.tools.diff.pairs import FileDiff, Pair


def document(found: FileDiff) -> dict[str, Any]:
    """The report as a JSON object."""
    return {
        "a": found.a,
        "b": found.b,
        "same": found.is_same,
        "specs": [_pair(pair) for pair in found.pairs],
        "only_in_a": list(found.only_a),
        "only_in_b": list(found.only_b),
    }


def _pair(pair: Pair) -> dict[str, Any]:
    comparison = pair.comparison
    return {
        "name_a": pair.a.name,
        "name_b": pair.b.name,
        "relation": comparison.relation,
        "reason": unrelated(pair.a, pair.b) if comparison.relation is None else None,
        "beginnings": _beginnings(pair),
        "only_a": _trace(pair, comparison.only_a),
        "only_b": _trace(pair, comparison.only_b),
        "different_atoms": list(comparison.split),
        "left_out": [[{"atom": name, "holds": holds} for name, holds in each] for each in comparison.impossible],
        "exclusive": [
            {"atoms": list(each.names), "in_a": each.in_a, "in_b": each.in_b} for each in comparison.exclusive
        ],
        "differences": [_difference(each) for each in pair.differences],
    }


def _beginnings(pair: Pair) -> dict[str, Any] | None:
    """How what does not break the two for good relates, where traces of two kinds do not."""
    found = pair.comparison.beginnings
    if found is None:
        return None
    only_a, only_b = (
        trace and [in_order(pair, letter) for letter in trace.prefix] for trace in (found.only_a, found.only_b)
    )
    return {"relation": found.relation, "only_a": only_a, "only_b": only_b}


def _trace(pair: Pair, trace: Trace | None) -> Any:
    """A finite trace as a list of samples, each the atoms that hold; an infinite one as its prefix and cycle."""
    if trace is None:
        return None
    prefix, cycle = ([in_order(pair, letter) for letter in letters] for letters in (trace.prefix, trace.cycle))
    return {"prefix": prefix, "cycle": cycle} if pair.a.semantics == "infinite" else prefix


def _difference(difference: Difference) -> dict[str, Any]:
    found: dict[str, Any] = {
        "what": difference.what,
        "name": difference.name or None,
        "a": _value(difference.a),
        "b": _value(difference.b),
    }
    if difference.apart is not None:
        first, second = difference.apart.values
        found["sample"] = {"signals": dict(difference.apart.sample), "a": first, "b": second}
    return found


def _value(value: object) -> Any:
    match value:
        case Signal():
            return {"type": value.type, "range": [value.low, value.high]}
        case Param():
            return {"type": value.type, "range": [value.low, value.high], "value": value.value}
        case Atom():
            return to_json(value.expression)
        case tuple():
            return list(value)
        case _:
            return value
