"""Counts and times in a sum that is compared with a number stop where they no longer matter."""

from __future__ import annotations

from operator import eq, ge, gt, le, lt, ne
from random import Random

import pytest

from tltlc.diagnostics.diagnostic import TltlError
from tltlc.monitor.monitor import Monitor
from tltlc.pipeline import compile_text

HEAD = "clock 2 Hz signal p: bool signal q: bool signal n: int in [0, 9] signal m: int in [-9, 9] "
SIGNS = {"<": lt, "<=": le, ">": gt, ">=": ge, "==": eq, "!=": ne}


def begun(trace: list[tuple[bool, bool, int]], which: int, last: int | None = None) -> int:
    """Return how often a signal has begun in a trace, or at its last step and the ``last`` before it."""
    first = 0 if last is None else max(0, len(trace) - 1 - last)
    return sum(bool(trace[at][which]) and not (at and trace[at - 1][which]) for at in range(first, len(trace)))


@pytest.mark.parametrize("sign", SIGNS)
@pytest.mark.parametrize(
    ("text", "value"),
    [
        ("times(p) + times(q)", lambda trace: begun(trace, 0) + begun(trace, 1)),
        ("times(p) + (n + times(q))", lambda trace: begun(trace, 0) + begun(trace, 1) + trace[-1][2]),
        (
            "times_within(p, 1 s) + times_within(q, 2 s)",
            lambda trace: begun(trace, 0, 2) + begun(trace, 1, 4),
        ),
    ],
)
def test_a_sum_is_compared_exactly(text: str, value: object, sign: str) -> None:
    random = Random(f"{text} {sign}")
    for bound in range(1, 5):
        for comparison in (f"{text} {sign} {bound}", f"{bound} {sign} ({text})"):
            (fspa,) = compile_text(f"{HEAD} spec s = G({comparison})")
            trace, monitor, holds = [], Monitor(fspa), True
            for _ in range(12):
                trace.append((random.random() < 0.5, random.random() < 0.5, random.choice((0, 0, 0, 3))))
                sides = (value(trace), bound) if comparison.startswith("t") else (bound, value(trace))  # type: ignore[operator]
                holds = holds and SIGNS[sign](*sides)
                p, q, n = trace[-1]
                verdict = monitor.step({"p": p, "q": q, "n": n, "m": 0}).verdict
                assert (verdict != "violated") == holds, (comparison, trace)


@pytest.mark.parametrize("sum_", ["times(p) + m", "times(p) - times(q)", "times(p) + -times(q)", "2 * times(p)"])
def test_other_arithmetic_needs_a_maximum(sum_: str) -> None:
    with pytest.raises(TltlError, match="needs a maximum here"):
        compile_text(f"{HEAD} spec s = G({sum_} <= 3)")


def test_a_sum_of_times_is_compared_exactly() -> None:
    (fspa,) = compile_text(f"{HEAD} spec s = G(total_time(p) + total_time(q) <= 1.5 s)")
    monitor = Monitor(fspa)
    verdicts = [monitor.step({"p": 1, "q": q, "n": 0, "m": 0}).verdict for q in (0, 0, 1, 1)]
    assert verdicts == ["holding", "holding", "holding", "violated"]
