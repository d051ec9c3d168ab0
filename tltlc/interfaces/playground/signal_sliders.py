"""The data of the sliders with which a user of the playground sets the signals of a spec."""

from __future__ import annotations

from typing import Any, Final

from tltlc.automaton.fspa import Fspa
from tltlc.resolve.spec import Signal

UNITS: Final = {"length": "m", "time": "s", "speed": "m/s", "angle": "rad"}
_OPEN: Final = 100.0
"""How far a slider reaches where the range of its signal has no end, in SI units.

If there are params of the signal's type, the greatest absolute value among them is used instead,
unless it is 0.
"""


def signal_values(fspa: Fspa) -> list[dict[str, Any]]:
    """Return for each signal a dict with its name, type, enum values, unit, documentation, range and slider range.

    ``low`` and ``high`` are None where the range has no end; ``slider`` always has two finite ends.
    """
    return [
        {
            "name": signal.name,
            "type": signal.type,
            "values": list(signal.values),
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
