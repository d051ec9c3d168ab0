"""The signals of a spec as one sets them on the page: a range to slide in, and the unit."""

from __future__ import annotations

from typing import Any, Final

from tltlc.automaton.fspa import Fspa
from tltlc.resolve.spec import Signal

UNITS: Final = {"length": "m", "time": "s", "speed": "m/s", "angle": "rad"}
_OPEN: Final = 100.0
"""How far a slider goes where a range is open, in SI units, unless a param of the same type says better."""


def signal_values(fspa: Fspa) -> list[dict[str, Any]]:
    """Of each signal its name, type, unit, documentation, its range (None where it is open) and that of its slider."""
    return [
        {
            "name": signal.name,
            "type": signal.type,
            "unit": UNITS.get(signal.type, ""),
            "doc": signal.doc,
            "low": signal.low,
            "high": signal.high,
            "slider": _slider(signal, fspa),
        }
        for signal in fspa.signals
    ]


def _slider(signal: Signal, fspa: Fspa) -> list[float]:
    if signal.type == "bool":
        return [0.0, 1.0]
    reach = max((abs(param.value) for param in fspa.params if param.type == signal.type), default=0.0) or _OPEN
    low, high = signal.low, signal.high
    if low is None:
        low = min(-reach, 0.0 if high is None else high - reach)
    return [low, max(reach, low + reach) if high is None else high]
