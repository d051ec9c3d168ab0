"""Measure steps per second of the generated Python monitor, a handwritten one, RTAMT and Reelay.

All of them read the same recorded trace. Before anything is timed, they are compared: the
handwritten monitor in every field of each step, the peers in whether the prefix is accepted.

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
from benchmarks.specs import PAPER_SPECS, handwritten_monitor, source, trace
from benchmarks.store import ROOT, Record, Store, measure_missing, source_digest

SECTION = "monitors"
ROUNDS = 15
ROUND_S = 0.05
TIMEOUT_S = 600.0


def measure(store: Store, _: float, say: Callable[[str], None]) -> None:
    """Measure each spec without a record in the store, or with a failed one."""
    measure_missing(store, SECTION, PAPER_SPECS, _measure_in_process, say)


def _measure_in_process(name: str) -> Record:
    process_run = run([sys.executable, "-m", "benchmarks.monitors", name], TIMEOUT_S, cwd=ROOT)
    record: Record = (
        json.loads(process_run.output) if process_run.status == 0 else {"failed": f"exit status {process_run.status}"}
    )
    return record


def compare_monitors(name: str) -> Record:
    """Return the steps per second of every monitor of a spec, and the ratio of generated to handwritten."""
    from tltlc import compile_file
    from tltlc.backends import emit
    from tltlc.monitor import Monitor

    fspa = next(fspa for fspa in compile_file(source(name)) if fspa.name == name)
    module = ModuleType("generated")
    files = emit("python", fspa, None)
    sys.modules[module.__name__] = module
    exec(compile(next(iter(files.values())), f"{name}_monitor.py", "exec"), module.__dict__)
    generated, by_hand, reference = module.Monitor(), handwritten_monitor(name), Monitor(fspa)
    samples = trace(name)
    for sample in samples:
        ours = generated.step(sample)
        _check_equal(ours, by_hand.step(sample))
        _check_equal(ours, reference.step(sample))

    passes = {
        "generated": _pass_over(generated, samples),
        "hand_written": _pass_over(by_hand, samples),
        "tltlc.monitor": _pass_over(reference, samples),
    }
    atoms, accepting = _atom_values(reference, samples)
    left_out: dict[str, str] = {}
    for peer, make in PEERS.items():
        try:
            passes[peer] = _check_peer(make(name, atoms), accepting, peer)
        except ImportError:
            left_out[peer] = "not installed"

    rates = rounds_of(passes, len(samples), ROUNDS)
    return {
        "samples": len(samples),
        "rounds": ROUNDS,
        "steps_per_s": {monitor_name: round(median(values)) for monitor_name, values in rates.items()},
        "generated_to_hand_written": quartiles(
            [ours / hand for ours, hand in zip(rates["generated"], rates["hand_written"], strict=True)]
        ),
        "left_out": left_out,
        "source": source_digest("tltlc"),
    }


def _check_equal(step: Sequence[Any], expected: Sequence[Any]) -> None:
    for value, expected_value in zip(step, expected, strict=True):
        if value != expected_value and not (
            isinstance(value, float) and math.isclose(value, expected_value, abs_tol=1e-12)
        ):
            raise AssertionError(f"monitors disagree: {step} and {expected}")


def _pass_over(monitor: Any, samples: list[dict[str, float]]) -> Callable[[], None]:
    """Return a function that runs a monitor over the whole trace."""

    def run_pass() -> None:
        monitor.reset()
        step = monitor.step
        for sample in samples:
            step(sample)

    return run_pass


def _atom_values(monitor: Any, samples: list[dict[str, float]]) -> tuple[list[dict[str, float]], list[bool]]:
    """Return the values of the atoms at each sample, by name, and whether each prefix is accepted."""
    monitor.reset()
    names = [atom.name for atom in monitor.fspa.atoms]
    values, accepting = [], []
    for sample in samples:
        accepting.append(monitor.step(sample).accepting)
        values.append(dict(zip(names, monitor.values, strict=True)))
    return values, accepting


def _check_peer(
    peer: tuple[Callable[[], None], Callable[[], list[float]]], accepting: list[bool], name: str
) -> Callable[[], None]:
    run_pass, outputs = peer
    if [value > 0 for value in outputs()] != accepting:
        raise AssertionError(f"{name} judges the trace otherwise")
    return run_pass


def rounds_of(passes: dict[str, Callable[[], None]], steps: int, rounds: int) -> dict[str, list[float]]:
    """Return steps per second of CPU time for each monitor, one value per round; each round runs all in turn."""
    repeats = {}
    for monitor_name, run_pass in passes.items():
        start = time.process_time()
        count = 0
        while time.process_time() - start < ROUND_S:
            run_pass()
            count += 1
        repeats[monitor_name] = count
    rates: dict[str, list[float]] = {monitor_name: [] for monitor_name in passes}
    for _ in range(rounds):
        for monitor_name, run_pass in passes.items():
            start = time.process_time()
            for _ in range(repeats[monitor_name]):
                run_pass()
            rates[monitor_name].append(repeats[monitor_name] * steps / (time.process_time() - start))
    return rates


if __name__ == "__main__":
    print(json.dumps(compare_monitors(sys.argv[1])))
