"""Automaton steps per second: N automata at once as torch tensors beside the monitor that takes one sample at a time.

Each of N environments takes the recorded trace of a spec from another sample on, so that they are in different
states; the signals are given as one tensor.  A step is what training needs of it: atoms, transition, progress,
reward, end.  Before anything is timed, some of the environments are checked to be equal to scalar monitors.

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
    """Measure each spec that the store does not have yet, or that failed."""
    measure_missing(store, SECTION, PAPER_SPECS, _measured, say)


def compared(name: str) -> Record:
    """Steps per second of CPU time of both monitors and their ratio; with a GPU, milliseconds a call there too."""
    import torch

    from tltl_runtime.spec.batch import BatchMonitor
    from tltlc import compile_file
    from tltlc.monitor import Monitor

    torch.set_num_threads(1)
    fspa = next(fspa for fspa in compile_file(source(name)) if fspa.name == name)
    samples = trace(name)
    _check(fspa, samples)
    batch, scalar = BatchMonitor(fspa, COUNT), Monitor(fspa)
    inputs = _inputs(samples, batch.signal_names, COUNT, INPUTS)

    def together() -> int:
        for signals in inputs:
            batch.step(signals)
        return COUNT * INPUTS

    def one_by_one() -> int:
        scalar.reset()
        for sample in samples:
            scalar.step(sample)
        return len(samples)

    for work in (together, one_by_one):
        work()
    rates = [(_rate(together), _rate(one_by_one)) for _ in range(ROUNDS)]
    return {
        "count": COUNT,
        "rounds": ROUNDS,
        "steps_per_s": {"batch": round(median([a for a, _ in rates])), "scalar": round(median([b for _, b in rates]))},
        "batch_to_scalar": quartiles([ours / theirs for ours, theirs in rates]),
        **_on_gpu(fspa, samples),
        "torch": str(torch.__version__),
        "source": source_digest("tltlc", "runtime"),
    }


def _measured(name: str) -> Record:
    if find_spec("torch") is None:
        return {"left_out": "torch is not installed (the extra `rl`)"}
    made = run([sys.executable, "-m", "benchmarks.batch", name], TIMEOUT_S, cwd=ROOT)
    record: Record = json.loads(made.output) if made.status == 0 else {"failed": f"exit status {made.status}"}
    return record


def _inputs(samples: list[dict[str, float]], names: tuple[str, ...], count: int, steps: int) -> list[Any]:
    """Tensors [count, signals]: at step t environment n takes sample ``7 n + t`` of the trace, around its end."""
    import torch

    rows = torch.tensor([[sample[name] for name in names] for sample in samples], dtype=torch.float64)
    start = 7 * torch.arange(count)
    return [rows[(start + step) % len(rows)] for step in range(steps)]


def _check(fspa: Fspa, samples: list[dict[str, float]]) -> None:
    """Both monitors over the whole trace, each environment from a sample of its own on."""
    from tltl_runtime.spec.batch import BatchMonitor
    from tltlc.monitor import Monitor

    batch, monitors = BatchMonitor(fspa, CHECKED), [Monitor(fspa) for _ in range(CHECKED)]
    for signals in _inputs(samples, batch.signal_names, CHECKED, len(samples)):
        found = batch.step(signals)
        rows = [dict(zip(batch.signal_names, row, strict=True)) for row in signals.tolist()]
        for index, (monitor, row) in enumerate(zip(monitors, rows, strict=True)):
            step = monitor.step(row)
            same = (int(found.state[index]), bool(found.done[index])) == (step.state, step.done)
            numbers = (
                (found.reward, step.reward),
                (found.progress, step.progress),
                (found.robustness, step.robustness),
            )
            if not same or any(not math.isclose(float(ours[index]), other, abs_tol=1e-12) for ours, other in numbers):
                raise AssertionError(f"monitors disagree at {row}")


def _rate(work: Callable[[], int]) -> float:
    """Steps per second of CPU time."""
    started, steps = time.process_time(), 0
    while time.process_time() - started < ROUND_S:
        steps += work()
    return steps / (time.process_time() - started)


def _on_gpu(fspa: Fspa, samples: list[dict[str, float]]) -> Record:
    """Milliseconds of wall time of a call for a million environments, its end waited for; nothing without a GPU."""
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
        started = time.perf_counter()
        for signals in inputs:
            batch.step(signals)
        torch.cuda.synchronize()
        if round_:
            times.append((time.perf_counter() - started) * 1e3 / INPUTS)
    return {"gpu": torch.cuda.get_device_name(), "gpu_count": GPU_COUNT, "gpu_ms": quartiles(times)}


if __name__ == "__main__":
    print(json.dumps(compared(sys.argv[1])))
