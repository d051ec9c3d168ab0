"""Which atoms are worth relating to others, where there are too many to relate all of them."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import accumulate
from math import inf, isqrt
from typing import Final

from tltlc.io.limits import WORK
from tltlc.tools.mine.evidence import Evidence, Recorded

MOST_EVENTS: Final = isqrt(WORK["mined pairs"])
"""Atoms that are related to each other: every ordered pair is tried."""


def best_events(evidence: Evidence, events: Sequence[str], most: int = MOST_EVENTS) -> list[str]:
    """At most ``most`` of the events, in their order: those that tell traces from counterexamples best by themselves.

    An event tells them apart by the sample at which it holds for the first time, or whether it holds at every sample.
    """
    if len(events) <= most:
        return list(events)
    firsts = [_first_samples(trace) for trace in evidence.all]
    always = [frozenset.intersection(*trace.letters) for trace in evidence.all]
    good = len(evidence.traces)

    def worth(name: str) -> tuple[float, str]:
        first = _separation([each.get(name, inf) for each in firsts], good)
        throughout = _separation([float(name in each) for each in always], good)
        return (-max(first, throughout), name)

    chosen = set(sorted(events, key=worth)[:most])
    return [name for name in events if name in chosen]


def _first_samples(trace: Recorded) -> dict[str, float]:
    """The sample at which each atom holds for the first time, from 0."""
    found: dict[str, float] = {}
    for number, letter in enumerate(trace.letters):
        for name in letter:
            found.setdefault(name, number)
    return found


def _separation(values: Sequence[float], good: int) -> float:
    """How well a threshold separates the first ``good`` values from the others, in [0, 1]: Youden's index."""
    bad = len(values) - good
    if not bad:
        return 0.0
    steps: dict[float, float] = {}
    for number, value in enumerate(values):
        steps[value] = steps.get(value, 0.0) + (1 / good if number < good else -1 / bad)
    return round(max(abs(each) for each in accumulate(steps[value] for value in sorted(steps))), 9)
