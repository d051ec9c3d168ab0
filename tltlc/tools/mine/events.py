"""Choose the atoms from which clauses about two atoms are built, if there are too many atoms to try all pairs."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import accumulate
from math import inf, isqrt
from typing import Final

from tltlc.io.limits import WORK
from tltlc.tools.mine.evidence import Evidence, LabelledTrace

MOST_EVENTS: Final = isqrt(WORK["mined pairs"])
"""The most atoms from which clauses about two atoms are built: every ordered pair is tried."""


def best_events(evidence: Evidence, events: Sequence[str], most: int = MOST_EVENTS) -> list[str]:
    """Return the ``most`` atoms of ``events`` that best separate traces from counterexamples.

    An atom separates them well in two cases:

    - it first holds early in the traces and late in the counterexamples, or vice versa;
    - it holds at every sample of the traces but not of the counterexamples, or vice versa.

    The order of ``events`` is kept.
    """
    if len(events) <= most:
        return list(events)
    firsts = [_first_samples(trace) for trace in evidence.all]
    always = [frozenset.intersection(*trace.letters) for trace in evidence.all]
    good = len(evidence.traces)

    def sort_key(name: str) -> tuple[float, str]:
        first = _separation([samples.get(name, inf) for samples in firsts], good)
        throughout = _separation([float(name in names) for names in always], good)
        return (-max(first, throughout), name)

    chosen = set(sorted(events, key=sort_key)[:most])
    return [name for name in events if name in chosen]


def _first_samples(trace: LabelledTrace) -> dict[str, float]:
    """Return, for each atom, the number of the first sample at which it holds, counted from 0."""
    firsts: dict[str, float] = {}
    for number, letter in enumerate(trace.letters):
        for name in letter:
            firsts.setdefault(name, number)
    return firsts


def _separation(values: Sequence[float], good: int) -> float:
    """Return how well a threshold can separate the first ``good`` values from the rest, in [0, 1].

    The result is Youden's index of the best threshold: 1 if it separates all values correctly. The
    result is 0 if there are no values after the first ``good``.
    """
    bad = len(values) - good
    if not bad:
        return 0.0
    steps: dict[float, float] = {}
    for number, value in enumerate(values):
        steps[value] = steps.get(value, 0.0) + (1 / good if number < good else -1 / bad)
    return round(max(abs(total) for total in accumulate(steps[value] for value in sorted(steps))), 9)
