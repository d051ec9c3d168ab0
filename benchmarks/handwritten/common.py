"""The result of the handwritten monitors, and functions that read samples."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from math import isfinite
from typing import NamedTuple


class Step(NamedTuple):
    """The fields of a generated monitor's step."""

    state: int
    label: str
    verdict: str
    accepting: bool
    done: bool
    progress: float
    reward: float
    robustness: float
    limiting: str | None


def read(signals: Mapping[str, float], names: Sequence[str]) -> list[float]:
    """Return the values of the signals; raises KeyError if one is missing, ValueError if one is not finite."""
    values = [signals[name] for name in names]
    if not all(map(isfinite, values)):
        raise ValueError(f"not finite: {dict(zip(names, values, strict=True))}")
    return values


def near(distance: float, level_size: float) -> float:
    """Return the closeness in [-1, 1] (eq. 2 of the paper): 1 at the target, 0 at 1 m, -1 from ``level_size`` on."""
    if distance < 1.0:
        return 1.0 - distance if distance > 0.0 else 1.0
    if distance <= level_size:
        return ((level_size - distance) / (level_size - 1.0)) ** 2 - 1.0
    return -1.0
