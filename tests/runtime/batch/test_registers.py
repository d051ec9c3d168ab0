"""A batch monitor remembers the traces so far as one :class:`tltlc.monitor.Monitor` per environment does."""

from __future__ import annotations

import random
from collections.abc import Sequence

import pytest
import torch

from tests.runtime.batch.test_batch_monitor import assert_equal
from tltl_runtime.spec.batch import BatchMonitor
from tltlc import compile_text
from tltlc.automaton.fspa import Fspa
from tltlc.automaton.memory import given_atoms
from tltlc.monitor import Monitor, MonitorError
from tltlc.tools.conformance.corpus import CASES, is_exact

MEMORY = [name for name in CASES if "memory" in name] + ["counts", "timers", "recall", "past", "recurring"]
COUNT = 7


def draw_samples(fspa: Fspa, rng: random.Random) -> list[dict[str, float]]:
    """Return a random sample for each environment: values of signals in their ranges, often equal ones."""
    samples = []
    for _ in range(COUNT):
        sample: dict[str, float] = {}
        for signal in fspa.signals:
            low = -20.0 if signal.low is None else signal.low
            high = low + 40.0 if signal.high is None else signal.high
            value = rng.choice((low, high, low + (high - low) * rng.random(), (low + high) / 2))
            sample[signal.name] = float(rng.random() < 0.4) if signal.type == "bool" else value
        samples.append(sample)
    return samples


def columns(samples: Sequence[dict[str, float]]) -> dict[str, list[float]]:
    return {name: [sample[name] for sample in samples] for name in samples[0]}


@pytest.mark.parametrize("name", [name for name in MEMORY if name != "no_memory"])
def test_a_batch_equals_scalar_monitors_after_resets_of_single_environments(name: str) -> None:
    fspa = CASES[name]().fspa
    rng = random.Random(name)
    batch, monitors = BatchMonitor(fspa, COUNT), [Monitor(fspa) for _ in range(COUNT)]
    successes = [False] * COUNT
    for number in range(120):
        if number % 9 == 8:
            chosen = [rng.random() < 0.4 for _ in range(COUNT)]
            batch.reset(torch.tensor(chosen))
            for index in range(COUNT):
                if chosen[index]:
                    monitors[index].reset()
                    successes[index] = False
        samples = draw_samples(fspa, rng)
        taken = batch.step(columns(samples))
        steps = [monitor.step(sample) for monitor, sample in zip(monitors, samples, strict=True)]
        successes = [monitor.success for monitor in monitors]
        exact = is_exact(fspa)
        assert_equal(taken, steps, successes, fspa, exact)
        expected = torch.tensor([monitor.registers for monitor in monitors], dtype=torch.float64).t()
        assert torch.equal(batch.registers, expected)


@pytest.mark.parametrize("name", ["counts", "past", "timers"])
def test_values_of_atoms_move_the_registers_that_follow_from_them(name: str) -> None:
    fspa = CASES[name]().fspa
    rng = random.Random(name)
    batch, monitors = BatchMonitor(fspa, COUNT), [Monitor(fspa) for _ in range(COUNT)]
    count = len(given_atoms(fspa))
    assert 0 < count < len(fspa.atoms)
    for _ in range(60):
        rows = [[rng.choice((-1.0, -0.5, 0.0, 0.25, 1.0)) for _ in range(count)] for _ in range(COUNT)]
        taken = batch.step_atoms(rows)
        steps = [monitor.step_atoms(row) for monitor, row in zip(monitors, rows, strict=True)]
        assert_equal(taken, steps, [monitor.success for monitor in monitors], fspa)
        expected = torch.tensor([monitor.registers for monitor in monitors], dtype=torch.float64).t()
        assert torch.equal(batch.registers, expected)
    with pytest.raises(ValueError, match=rf"\({COUNT}, {count}\)"):
        batch.step_atoms(torch.zeros((COUNT, len(fspa.atoms))))


@pytest.mark.parametrize(
    ("x", "y", "text"),
    [
        (1e200, 1.0, "environment 2: the register `highest(x * x)` is too large to compute"),
        (1.0, 0.0, "environment 2: the register `lowest(8 / y)` divides by zero"),
        (1.0, 1e150, "environment 2: the register `last value of (y * y * y)` is too large to compute"),
        (float("nan"), 1.0, "environment 2: the signal `x` is nan, not a finite number"),
    ],
)
def test_a_register_without_a_value_leaves_all_environments_unchanged(x: float, y: float, text: str) -> None:
    fspa = CASES["no_memory"]().fspa
    batch, monitors = BatchMonitor(fspa, COUNT), [Monitor(fspa) for _ in range(COUNT)]
    rng = random.Random(5)
    for _ in range(4):
        samples = [{"x": rng.uniform(-9, 9), "y": rng.choice((0.5, 2.0, 7.0))} for _ in range(COUNT)]
        taken = batch.step(columns(samples))
        steps = [monitor.step(sample) for monitor, sample in zip(monitors, samples, strict=True)]
        assert_equal(taken, steps, [monitor.success for monitor in monitors], fspa)
        before = batch.registers
        wrong = columns([*samples[:2], {"x": x, "y": y}, *samples[3:]])
        with pytest.raises(MonitorError) as error:
            batch.step(wrong)
        assert error.value.diagnostics[0].title == text
        assert torch.equal(batch.registers, before)


def test_a_batch_in_float32_counts_as_one_in_float64() -> None:
    fspa = CASES["counts"]().fspa
    rng = random.Random(2)
    single, double = BatchMonitor(fspa, COUNT, dtype=torch.float32), BatchMonitor(fspa, COUNT)
    unchecked = BatchMonitor(fspa, COUNT, checked=False)
    for _ in range(80):
        sample = columns(draw_samples(fspa, rng))
        steps = [monitor.step(sample) for monitor in (single, double, unchecked)]
        assert len({tuple(step.state.tolist()) for step in steps}) == 1
        assert torch.allclose(single.registers.double(), double.registers, rtol=0.0, atol=1e-6)
        assert torch.equal(unchecked.registers, double.registers)


@pytest.mark.parametrize("dtype", [torch.bfloat16, torch.float16, torch.float32])
def test_a_deadline_expires_in_small_formats(dtype: torch.dtype) -> None:
    (fspa,) = compile_text("signal a: bool\nsignal b: bool\nspec s { keep a implies eventually within 300 steps b }")
    batch, monitor = BatchMonitor(fspa, 1, dtype=dtype), Monitor(fspa)
    for number in range(302):
        sample = {"a": float(number == 0), "b": 0.0}
        assert batch.step(columns([sample])).state.tolist() == [monitor.step(sample).state]
    assert fspa.states[monitor.state].verdict == "violated"


def test_a_batch_follows_chains_and_many_rules_like_scalar_monitors() -> None:
    signals = "".join(f"signal x{number}: number in [-1, 1]\n" for number in range(6))
    chain = " then within 4 steps ".join(f"x{number} > 0" for number in range(6))
    rules = " ".join(f"keep x{number} > 0 implies x{number + 1} < 0.99 or x0 > 0.5" for number in range(1, 5))
    for spec in (f"reach {chain}", f"reach {chain} {rules}", f"avoid {chain} {rules}"):
        (fspa,) = compile_text(f"{signals}spec s {{ {spec} }}")
        assert {"chain"} <= {atom.base for atom in fspa.atoms}
        rng = random.Random(spec)
        batch, monitors = BatchMonitor(fspa, COUNT), [Monitor(fspa) for _ in range(COUNT)]
        for _ in range(60):
            samples = [{signal.name: rng.uniform(-1, 1) for signal in fspa.signals} for _ in range(COUNT)]
            taken = batch.step(columns(samples))
            steps = [monitor.step(sample) for monitor, sample in zip(monitors, samples, strict=True)]
            assert_equal(taken, steps, [monitor.success for monitor in monitors], fspa, is_exact(fspa))
