"""Phrases for the messages and reports of ``tltlc diff``: about signals, params, atoms, samples and specs."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from math import inf
from typing import TYPE_CHECKING, Final, Union

from tltlc.resolve import units
from tltlc.resolve.spec import Param, Signal, ValueType
from tltlc.resolve.values import number_text, range_text
from tltlc.tools.diff.values import ValueDifference

if TYPE_CHECKING:
    from tltlc.automaton.fspa import Fspa
    from tltlc.tools.diff.relation import Comparison

_KINDS: Final = {"finite": "traces that end", "infinite": "traces that never end"}


def unrelated_reason(a: Fspa, b: Fspa) -> str:
    """Return sentences that say why two specs cannot be compared, and what to do.

    One of the specs must be over finite traces, and the other over infinite traces.
    """
    return (
        f"A and B are of different kinds: A is about {_KINDS[a.semantics]}, B is about {_KINDS[b.semantics]}, so no "
        "trace belongs to both. To compare what they require, give both the same `semantics`."
    )


def method_sentence(comparison: Comparison) -> str:
    """Return a sentence that says how specs that remember the trace so far were compared; empty for other specs."""
    if comparison.method == "unfolded" and comparison.unfolded_states:
        a, b = comparison.unfolded_states
        return f"This is exact: what the specs remember was unfolded to {a:,} states in A and {b:,} in B."
    if comparison.method == "clauses":
        text = "This is exact: groups of clauses were compared with each other."
        return text + (" A trace below may not be a shortest one." if comparison.only_a or comparison.only_b else "")
    if comparison.method == "search" and comparison.relation not in ("undecided", "equivalent"):
        text = "This is exact: both monitors have run on each trace below."
        return f"{text} It may not be a shortest one."
    if comparison.method == "search":
        text = "Traces were searched, with a bounded number of steps: "
        text += "what the specs remember has too many values to be unfolded to states."
        if comparison.only_a or comparison.only_b:
            text += " Both monitors have run on each trace below, but it may not be a shortest one."
        return text
    return ""


def name_list(names: Sequence[str], most: int = 4) -> str:
    """Return a list of names as text: ```a`, `b` and `c```. There must be at least one name.

    If there are more than ``most`` names, the text has the first ones, and says how many are left
    out.
    """
    quoted = [f"`{name}`" for name in names]
    if len(quoted) > most:
        quoted = [*quoted[: most - 1], f"{len(quoted) - most + 1} more"]
    return quoted[0] if len(quoted) == 1 else f"{', '.join(quoted[:-1])} and {quoted[-1]}"


def type_text(value: Union[Signal, Param]) -> str:
    """Return the type and range of a signal or param: ``length in [0 m, inf]``.

    Without a range, and for a bool, return the type alone; for an enum, its values: ``(idle, alert)``.
    """
    if isinstance(value, Signal) and value.values:
        return f"({', '.join(value.values)})"
    if value.type == "bool" or (value.low is None and value.high is None):
        return value.type
    return f"{value.type} in {ends_text(value)}"


def ends_text(value: Union[Signal, Param]) -> str:
    """Return the range of a signal or param as text: ``[0 m, inf]``."""
    low, high = -inf if value.low is None else value.low, inf if value.high is None else value.high
    return range_text(low, high, units.TYPES[value.type])


def value_text(value: float, type_: ValueType) -> str:
    """Return a value with the unit of its type: ``3 m``. A bool is ``true`` or ``false``."""
    if type_ == "bool":
        return "true" if value else "false"
    unit = units.si_unit(units.TYPES[type_])
    return number_text(value) + (f" {unit}" if unit else "")


def sample_text(sample: Iterable[tuple[str, float]], types: Mapping[str, ValueType]) -> str:
    """Return a sample in words: ``at distance(s1) = 3 m, seen = true``.

    For an empty sample, the text is ``at every sample``.
    """
    terms = [f"{name} = {value_text(value, types.get(name, 'number'))}" for name, value in sample]
    return f"at {', '.join(terms)}" if terms else "at every sample"


def values_text(difference: ValueDifference) -> tuple[str, str]:
    """Return two texts: the value of an atom in A and its value in B, at the same sample.

    If the atom holds in only one of A and B, each text also says whether it holds:
    ``-0.2 (it does not hold)``. If it has no value in A or B, that text says why.
    """
    first, second = (_value(difference, side) for side in (0, 1))
    return first, second


def _value(difference: ValueDifference, side: int) -> str:
    value = difference.values[side]
    if value is None:
        return f"no value (it {difference.reasons[side]})"
    holds = f" (it {'holds' if value > 0.0 else 'does not hold'})" if difference.differs_in_truth else ""
    return number_text(float(f"{value:.4g}")) + holds
