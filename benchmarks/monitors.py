"""Steps per second: the generated Python monitor, one written by hand, and the online monitors of RTAMT and Reelay.

All of them see the same recorded trace.  Before anything is timed they are checked to agree: the
hand-written one in every field of each step, the peers in whether the prefix is accepted.

``python -m benchmarks.monitors SPEC`` measures one spec in a process of its own.
"""

from __future__ import annotations

import json
import math
import sys
import time
from collections.abc import Callable, Sequence
from types import ModuleType
from typing import Any

from benchmarks.measure import median, quartiles, run
from benchmarks.peer_monitors import PEERS
from benchmarks.specs import PAPER_SPECS, hand_written, source, trace
from benchmarks.store import ROOT, Record, Store, measure_missing, source_digest

SECTION = "monitors"
ROUNDS = 15
ROUND_S = 0.05
TIMEOUT_S = 600.0


def measure(store: Store, _: float, say: Callable[[str], None]) -> None:
    """Measure each spec that the store does not have yet, or that failed."""
    measure_missing(store, SECTION, PAPER_SPECS, _measured, say)


def _measured(name: str) -> Record:
    made = run([sys.executable, "-m", "benchmarks.monitors", name], TIMEOUT_S, cwd=ROOT)
    record: Record = json.loads(made.output) if made.status == 0 else {"failed": f"exit status {made.status}"}
    return record


def compared(name: str) -> Record:
    """The steps per second of every monitor of a spec, and the ratio of the generated one to the hand-written one."""
    from tltlc import compile_file
    from tltlc.backends import emit
    from tltlc.monitor import Monitor

    fspa = next(fspa for fspa in compile_file(source(name)) if fspa.name == name)
    module = ModuleType("generated")
    files = emit("python", fspa, None)
    sys.modules[module.__name__] = module
    exec(compile(next(iter(files.values())), f"{name}_monitor.py", "exec"), module.__dict__)
    generated, by_hand, reference = module.Monitor(), hand_written(name), Monitor(fspa)
    samples = trace(name)
    for sample in samples:
        ours = generated.step(sample)
        _agree(ours, by_hand.step(sample))
        _agree(ours, reference.step(sample))

    passes = {
        "generated": _pass(generated, samples),
        "hand_written": _pass(by_hand, samples),
        "tltlc.monitor": _pass(reference, samples),
    }
    atoms, accepting = _atom_values(reference, samples)
    left_out: dict[str, str] = {}
    for peer, make in PEERS.items():
        try:
            passes[peer] = _checked(make(name, atoms), accepting, peer)
        except ImportError:
            left_out[peer] = "not installed"

    rates = _rates(passes, len(samples))
    return {
        "samples": len(samples),
        "rounds": ROUNDS,
        "steps_per_s": {who: round(median(values)) for who, values in rates.items()},
        "generated_to_hand_written": quartiles(
            [ours / hand for ours, hand in zip(rates["generated"], rates["hand_written"], strict=True)]
        ),
        "left_out": left_out,
        "source": source_digest("tltlc"),
    }


def _agree(found: Sequence[Any], expected: Sequence[Any]) -> None:
    for one, other in zip(found, expected, strict=True):
        if one != other and not (isinstance(one, float) and math.isclose(one, other, abs_tol=1e-12)):
            raise AssertionError(f"monitors disagree: {found} and {expected}")


def _pass(monitor: Any, samples: list[dict[str, float]]) -> Callable[[], None]:
    """One pass over the whole trace from its beginning."""

    def once() -> None:
        monitor.reset()
        step = monitor.step
        for sample in samples:
            step(sample)

    return once


def _atom_values(monitor: Any, samples: list[dict[str, float]]) -> tuple[list[dict[str, float]], list[bool]]:
    """The values of the atoms at each sample, by name, and whether the prefix up to it is accepted."""
    monitor.reset()
    names = [atom.name for atom in monitor.fspa.atoms]
    values, accepting = [], []
    for sample in samples:
        accepting.append(monitor.step(sample).accepting)
        values.append(dict(zip(names, monitor.values, strict=True)))
    return values, accepting


def _checked(
    peer: tuple[Callable[[], None], Callable[[], list[float]]], accepting: list[bool], name: str
) -> Callable[[], None]:
    once, outputs = peer
    if [value > 0 for value in outputs()] != accepting:
        raise AssertionError(f"{name} judges the trace otherwise")
    return once


def _rates(passes: dict[str, Callable[[], None]], steps: int) -> dict[str, list[float]]:
    """Steps per second of CPU time for each monitor, one value per round; in a round all run, one after the other."""
    repeats = {}
    for who, once in passes.items():
        started = time.process_time()
        count = 0
        while time.process_time() - started < ROUND_S:
            once()
            count += 1
        repeats[who] = count
    rates: dict[str, list[float]] = {who: [] for who in passes}
    for _ in range(ROUNDS):
        for who, once in passes.items():
            started = time.process_time()
            for _ in range(repeats[who]):
                once()
            rates[who].append(repeats[who] * steps / (time.process_time() - started))
    return rates


if __name__ == "__main__":
    print(json.dumps(compared(sys.argv[1])))
