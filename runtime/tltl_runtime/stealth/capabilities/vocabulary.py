"""The vocabulary that a level offers to specs: signals with types and ranges, and params."""

from __future__ import annotations

from math import dist, pi

from tltl_runtime.stealth.level import StealthLevel
from tltl_runtime.stealth.signals import AXES, level_signals
from tltlc.api import record, specs


@record
class OfferedSignal:
    """The type and the range of one of a level's signals, in SI units.

    ``low`` or ``high`` is None if that end of the range is open.
    """

    type: specs.ValueType
    low: float | None
    high: float | None


def offered_signals(level: StealthLevel) -> dict[str, OfferedSignal]:
    """Return the type and range of each signal of a level, by name; aliases are included."""
    return {name: _offered_signal(signal.base, level) for name, signal in level_signals(level).items()}


def params(level: StealthLevel) -> dict[str, float]:
    """Return the values that a level defines for params of specs, by name.

    There is one, ``level_size``: the length of the diagonal of the level's bounds, in metres.
    """
    return {"level_size": dist(level.bounds.low, level.bounds.high)}


def _offered_signal(base: str, level: StealthLevel) -> OfferedSignal:
    if base in ("health", "stamina"):
        return OfferedSignal("ratio", 0.0, 1.0)
    if base == "time":
        return OfferedSignal("time", 0.0, None)
    if base == "bearing":
        return OfferedSignal("angle", -pi, pi)
    if base == "distance":
        return OfferedSignal("length", 0.0, params(level)["level_size"])
    if base in AXES:
        axis = AXES[base]
        return OfferedSignal("length", level.bounds.low[axis], level.bounds.high[axis])
    return OfferedSignal("bool", 0.0, 1.0)
