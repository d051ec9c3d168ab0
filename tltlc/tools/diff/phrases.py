"""Phrases about signals, params, atoms and samples for messages and reports."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from math import inf
from typing import TYPE_CHECKING, Final, Union

from tltlc.resolve import units
from tltlc.resolve.spec import Param, Signal, ValueType
from tltlc.resolve.values import number_text, range_text
from tltlc.tools.diff.values import Apart

if TYPE_CHECKING:
    from tltlc.automaton.fspa import Fspa

_KINDS: Final = {"finite": "traces that end", "infinite": "traces that never end"}


def unrelated(a: Fspa, b: Fspa) -> str:
    """Return why a spec over finite traces and one over infinite traces cannot be compared.

    The text includes a suggestion.
    """
    return (
        f"B is of another kind than A: A is about {_KINDS[a.semantics]}, B about {_KINDS[b.semantics]}, so no trace is "
        "one of both. To compare what they ask for, give both the same `semantics`."
    )


def listed(names: Sequence[str], most: int = 4) -> str:
    """Return names in backquotes, with ``and`` before the last one.

    If there are more than ``most``, it has the first ones and the number of the others.
    """
    quoted = [f"`{name}`" for name in names]
    if len(quoted) > most:
        quoted = [*quoted[: most - 1], f"{len(quoted) - most + 1} more"]
    return quoted[0] if len(quoted) == 1 else f"{', '.join(quoted[:-1])} and {quoted[-1]}"


def type_text(of: Union[Signal, Param]) -> str:
    """Return the type of a signal or param: ``length in [0 m, inf]``.

    The range is left out if there is none.
    """
    if of.type == "bool" or (of.low is None and of.high is None):
        return of.type
    return f"{of.type} in {ends_text(of)}"


def ends_text(of: Union[Signal, Param]) -> str:
    """Return the range of a signal or param: ``[0 m, inf]``."""
    low, high = -inf if of.low is None else of.low, inf if of.high is None else of.high
    return range_text(low, high, units.TYPES[of.type])


def value_text(value: float, type_: ValueType) -> str:
    """Return a value with the unit of its type: ``3 m``. A bool is ``true`` or ``false``."""
    if type_ == "bool":
        return "true" if value else "false"
    unit = units.si_unit(units.TYPES[type_])
    return number_text(value) + (f" {unit}" if unit else "")


def sample_text(sample: Iterable[tuple[str, float]], types: Mapping[str, ValueType]) -> str:
    """Return a sample in words: ``at distance(s1) = 3 m, seen = true``.

    If no signal is read, it is ``at every sample``.
    """
    shown = [f"{name} = {value_text(value, types.get(name, 'number'))}" for name, value in sample]
    return f"at {', '.join(shown)}" if shown else "at every sample"


def values_text(apart: Apart) -> tuple[str, str]:
    """Return the two values of an atom at a sample in words.

    They include whether the atom holds if it does so in only one version, and the reason if there
    is no value.
    """
    first, second = (_value(apart, side) for side in (0, 1))
    return first, second


def _value(apart: Apart, side: int) -> str:
    value = apart.values[side]
    if value is None:
        return f"no value (it {apart.reasons[side]})"
    holds = f" (it {'holds' if value > 0.0 else 'does not hold'})" if apart.is_judged_otherwise else ""
    return number_text(float(f"{value:.4g}")) + holds
