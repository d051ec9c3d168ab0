"""What messages and reports say of signals, params, atoms and samples."""

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
    """Why a spec over finite traces and one over infinite ones do not relate, with a way out."""
    return (
        f"B is of another kind than A: A is about {_KINDS[a.semantics]}, B about {_KINDS[b.semantics]}, so no trace is "
        "one of both. To compare what they ask for, give both the same `semantics`."
    )


def listed(names: Sequence[str], most: int = 4) -> str:
    """Names in backquotes, the last one behind ``and``; of many, the first ones and how many more."""
    quoted = [f"`{name}`" for name in names]
    if len(quoted) > most:
        quoted = [*quoted[: most - 1], f"{len(quoted) - most + 1} more"]
    return quoted[0] if len(quoted) == 1 else f"{', '.join(quoted[:-1])} and {quoted[-1]}"


def type_text(of: Union[Signal, Param]) -> str:
    """The type of a signal or param, with its range unless it has none: ``length in [0 m, inf]``."""
    if of.type == "bool" or (of.low is None and of.high is None):
        return of.type
    return f"{of.type} in {ends_text(of)}"


def ends_text(of: Union[Signal, Param]) -> str:
    """The range of a signal or param: ``[0 m, inf]``."""
    low, high = -inf if of.low is None else of.low, inf if of.high is None else of.high
    return range_text(low, high, units.TYPES[of.type])


def value_text(value: float, type_: ValueType) -> str:
    """A value with the unit of its type: ``3 m``; of a bool ``true`` or ``false``."""
    if type_ == "bool":
        return "true" if value else "false"
    unit = units.si_unit(units.TYPES[type_])
    return number_text(value) + (f" {unit}" if unit else "")


def sample_text(sample: Iterable[tuple[str, float]], types: Mapping[str, ValueType]) -> str:
    """A sample as ``at distance(s1) = 3 m, seen = true``; where no signal is read, that it is so at every one."""
    shown = [f"{name} = {value_text(value, types.get(name, 'number'))}" for name, value in sample]
    return f"at {', '.join(shown)}" if shown else "at every sample"


def values_text(apart: Apart) -> tuple[str, str]:
    """The two values of an atom at a sample; with whether it holds, where only one does; or why there is none."""
    first, second = (_value(apart, side) for side in (0, 1))
    return first, second


def _value(apart: Apart, side: int) -> str:
    value = apart.values[side]
    if value is None:
        return f"no value (it {apart.reasons[side]})"
    holds = f" (it {'holds' if value > 0.0 else 'does not hold'})" if apart.is_judged_otherwise else ""
    return number_text(float(f"{value:.4g}")) + holds
