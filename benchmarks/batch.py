"""Measure automaton steps per second: many automata at once as torch tensors, and the monitor for one sample.

Each of N environments starts the recorded trace of a spec at another sample, so that their automata
are in different states; the signals are one tensor. A step computes what training needs: atoms,
transition, progress, reward, end. Before anything is timed, some of the environments are compared
with scalar monitors.

``python -m benchmarks.batch SPEC`` measures one spec in a process of its own, on one core.
"""

from __future__ import annotations

import json
import math
import sys
import time
from collections.abc import Callable
from importlib.util import find_spec
from typing import TYPE_CHECKING, Any

from benchmarks.measure import median, quartiles, run
from benchmarks.specs import PAPER_SPECS, source, trace
from benchmarks.store import ROOT, Record, Store, measure_missing, source_digest

if TYPE_CHECKING:
    from tltlc.automaton.fspa import Fspa

SECTION = "batch"
COUNT = 4096
GPU_COUNT = 1_000_000
CHECKED = 16
INPUTS = 8
ROUNDS = 15
ROUND_S = 0.05
TIMEOUT_S = 600.0


def measure(store: Store, _: float, say: Callable[[str], None]) -> None:
    """Measure each spec without a record in the store, or with a failed one."""
    measure_missing(store, SECTION, PAPER_SPECS, _measure_in_process, say)


def compare_monitors(name: str) -> Record:
    """Return the steps per second of CPU time of both monitors, and their ratio.

    If there is a GPU, also return the milliseconds that a call takes on it.
    """
    import torch

    from tltl_runtime.spec.batch import BatchMonitor
    from tltlc import compile_file
    from tltlc.monitor import Monitor

    torch.set_num_threads(1)
    fspa = next(fspa for fspa in compile_file(source(name)) if fspa.name == name)
    samples = trace(name)
    _check_equal(fspa, samples)
    batch, scalar = BatchMonitor(fspa, COUNT), Monitor(fspa)
    inputs = _inputs(samples, batch.signal_names, COUNT, INPUTS)

    def step_batch() -> int:
        for signals in inputs:
            batch.step(signals)
        return COUNT * INPUTS

    def step_scalar() -> int:
        scalar.reset()
        for sample in samples:
            scalar.step(sample)
        return len(samples)

    for work in (step_batch, step_scalar):
        work()
    rates = [(_rate(step_batch), _rate(step_scalar)) for _ in range(ROUNDS)]
    return {
        "count": COUNT,
        "rounds": ROUNDS,
        "steps_per_s": {"batch": round(median([a for a, _ in rates])), "scalar": round(median([b for _, b in rates]))},
        "batch_to_scalar": quartiles([ours / theirs for ours, theirs in rates]),
        **_on_gpu(fspa, samples),
        "torch": str(torch.__version__),
        "source": source_digest("tltlc", "runtime"),
    }


def _measure_in_process(name: str) -> Record:
    if find_spec("torch") is None:
        return {"left_out": "torch is not installed (the extra `rl`)"}
    process_run = run([sys.executable, "-m", "benchmarks.batch", name], TIMEOUT_S, cwd=ROOT)
    record: Record = (
        json.loads(process_run.output) if process_run.status == 0 else {"failed": f"exit status {process_run.status}"}
    )
    return record


def _inputs(samples: list[dict[str, float]], names: tuple[str, ...], count: int, steps: int) -> list[Any]:
    """Return a tensor (count, signals) for each step.

    At step t, environment n takes sample ``7 n + t`` of the trace, modulo its length.
    """
    import torch

    rows = torch.tensor([[sample[name] for name in names] for sample in samples], dtype=torch.float64)
    start = 7 * torch.arange(count)
    return [rows[(start + step) % len(rows)] for step in range(steps)]


def _check_equal(fspa: Fspa, samples: list[dict[str, float]]) -> None:
    """Raise AssertionError if the monitors differ on the trace; each environment starts at another sample."""
    from tltl_runtime.spec.batch import BatchMonitor
    from tltlc.monitor import Monitor

    batch, monitors = BatchMonitor(fspa, CHECKED), [Monitor(fspa) for _ in range(CHECKED)]
    for signals in _inputs(samples, batch.signal_names, CHECKED, len(samples)):
        batch_step = batch.step(signals)
        rows = [dict(zip(batch.signal_names, row, strict=True)) for row in signals.tolist()]
        for index, (monitor, row) in enumerate(zip(monitors, rows, strict=True)):
            step = monitor.step(row)
            is_same = (int(batch_step.state[index]), bool(batch_step.done[index])) == (step.state, step.done)
            numbers = (
                (batch_step.reward, step.reward),
                (batch_step.progress, step.progress),
                (batch_step.robustness, step.robustness),
            )
            if not is_same or any(
                not math.isclose(float(ours[index]), theirs, abs_tol=1e-12) for ours, theirs in numbers
            ):
                raise AssertionError(f"monitors disagree at {row}")


def _rate(work: Callable[[], int]) -> float:
    """Return steps per second of CPU time."""
    start, steps = time.process_time(), 0
    while time.process_time() - start < ROUND_S:
        steps += work()
    return steps / (time.process_time() - start)


def _on_gpu(fspa: Fspa, samples: list[dict[str, float]]) -> Record:
    """Return the wall time, in milliseconds, of a call for a million environments on a GPU.

    Return an empty record without a GPU. The time includes the wait for the GPU to finish.
    """
    import torch

    from tltl_runtime.spec.batch import BatchMonitor

    if not torch.cuda.is_available():
        return {}
    batch = BatchMonitor(fspa, GPU_COUNT, device="cuda")
    # Rows of signals lie one behind the other, as a simulation on the GPU would supply them.
    inputs = [
        signals.t().contiguous().cuda().t() for signals in _inputs(samples, batch.signal_names, GPU_COUNT, INPUTS)
    ]
    times = []
    for round_ in range(ROUNDS + 1):
        torch.cuda.synchronize()
        start = time.perf_counter()
        for signals in inputs:
            batch.step(signals)
        torch.cuda.synchronize()
        if round_:
            times.append((time.perf_counter() - start) * 1e3 / INPUTS)
    return {"gpu": torch.cuda.get_device_name(), "gpu_count": GPU_COUNT, "gpu_ms": quartiles(times)}


if __name__ == "__main__":
    print(json.dumps(compare_monitors(sys.argv[1])))
