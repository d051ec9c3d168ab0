"""What specs can use of a level: its signals, with types and ranges, and values of parameters."""

from __future__ import annotations

from math import dist, pi

from tltl_runtime.stealth.level import StealthLevel
from tltl_runtime.stealth.signals import AXES, level_signals
from tltlc.api import record, specs


@record
class AvailableSignal:
    """The type and the range of one of a level's signals, in SI units.

    ``low`` or ``high`` is None if that end of the range is open.
    """

    type: specs.ValueType
    low: float | None
    high: float | None


def available_signals(level: StealthLevel) -> dict[str, AvailableSignal]:
    """Return the type and range of each signal of a level, by name; aliases are included."""
    return {name: _available_signal(signal.base, level) for name, signal in level_signals(level).items()}


def params(level: StealthLevel) -> dict[str, float]:
    """Return the values that a level defines for parameters of specs, by name.

    There is one, ``level_size``: the length of the diagonal of the level's bounds, in metres.
    """
    return {"level_size": dist(level.bounds.low, level.bounds.high)}


def _available_signal(base: str, level: StealthLevel) -> AvailableSignal:
    if base in ("health", "stamina"):
        return AvailableSignal("ratio", 0.0, 1.0)
    if base == "time":
        return AvailableSignal("time", 0.0, None)
    if base == "bearing":
        return AvailableSignal("angle", -pi, pi)
    if base == "distance":
        return AvailableSignal("length", 0.0, params(level)["level_size"])
    if base in AXES:
        axis = AXES[base]
        return AvailableSignal("length", level.bounds.low[axis], level.bounds.high[axis])
    return AvailableSignal("bool", 0.0, 1.0)
