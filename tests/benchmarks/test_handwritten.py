"""The hand-written monitors compute what the reference monitor computes, or the comparison would be void."""

from __future__ import annotations

import random

import pytest

from benchmarks.specs import PAPER_SPECS, hand_written, source, trace
from tltlc import compile_file
from tltlc.monitor import Monitor


@pytest.mark.parametrize("name", PAPER_SPECS)
def test_equals_the_monitor_of_the_package(name: str) -> None:
    fspa = next(fspa for fspa in compile_file(source(name)) if fspa.name == name)
    reference, by_hand = Monitor(fspa), hand_written(name)
    generator = random.Random(name)
    recorded = trace(name)
    samples = [recorded, *(_shuffled(recorded, generator) for _ in range(20))]
    reached = set()
    for walk in samples:
        reference.reset()
        by_hand.reset()
        for sample in walk:
            expected, found = reference.step(sample), by_hand.step(sample)
            assert found[:5] == expected[:5]
            assert found[5:8] == pytest.approx(expected[5:8], abs=1e-12)
            assert found[8] == expected[8]
            reached.add(found.state)
    assert reached == {state.id for state in fspa.states}


def _shuffled(recorded: list[dict[str, float]], generator: random.Random) -> list[dict[str, float]]:
    """A walk that jumps among the recorded samples, sometimes at a place, and dies near its end."""
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
