"""The vocabulary that a level offers to specs: signals with types and ranges, and params."""

from __future__ import annotations

from math import dist, pi

from tltl_runtime.stealth.level import StealthLevel
from tltl_runtime.stealth.signals import AXES, level_signals
from tltlc.api import record, specs


@record
class OfferedSignal:
    """What a level says about one of its signals: the type, and the range in SI units; None is an open end."""

    type: specs.ValueType
    low: float | None
    high: float | None


def offered_signals(level: StealthLevel) -> dict[str, OfferedSignal]:
    """Return the signals of a level, by name, including aliases."""
    return {name: _offered_signal(signal.base, level) for name, signal in level_signals(level).items()}


def params(level: StealthLevel) -> dict[str, float]:
    """Return a level's params: ``level_size``, the diagonal of its bounds in metres."""
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
