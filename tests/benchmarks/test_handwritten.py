"""The handwritten monitors compute the same as the reference monitor; otherwise comparing their
speed is meaningless."""

from __future__ import annotations

import random

import pytest

from benchmarks.specs import PAPER_SPECS, handwritten_monitor, source, trace
from tltlc import compile_file
from tltlc.monitor import Monitor


@pytest.mark.parametrize("name", PAPER_SPECS)
def test_a_handwritten_monitor_equals_the_reference(name: str) -> None:
    fspa = next(fspa for fspa in compile_file(source(name)) if fspa.name == name)
    reference, by_hand = Monitor(fspa), handwritten_monitor(name)
    generator = random.Random(name)
    recorded = trace(name)
    samples = [recorded, *(_shuffled(recorded, generator) for _ in range(20))]
    reached = set()
    for walk in samples:
        reference.reset()
        by_hand.reset()
        for sample in walk:
            expected, actual = reference.step(sample), by_hand.step(sample)
            assert actual[:5] == expected[:5]
            assert actual[5:8] == pytest.approx(expected[5:8], abs=1e-12)
            assert actual[8] == expected[8]
            reached.add(actual.state)
    assert reached == {state.id for state in fspa.states}


def _shuffled(recorded: list[dict[str, float]], generator: random.Random) -> list[dict[str, float]]:
    """Return a random sequence of the recorded samples, sometimes moved to a place, in which health
    is 0 near the end."""
    walk = []
    for step in range(60):
        sample = dict(generator.choice(recorded))
        places = [signal for signal in sample if signal.startswith("distance")]
        for signal in places:
            sample[signal] = max(sample[signal], 1.5)
        if generator.random() < 0.4:
            sample[generator.choice(places)] = generator.random()
        for signal in ("open_left", "open_right"):
            if signal in sample:
                sample[signal] = float(generator.random() < 0.5)
        if "health" in sample:
            sample["health"] = 0.0 if step == 55 else generator.uniform(0.1, 1.0)
        walk.append(sample)
    return walk
