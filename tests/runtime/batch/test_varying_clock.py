"""On a clock that varies, a batch monitor adds up the lengths of steps as one monitor per environment does."""

from __future__ import annotations

import random

import pytest
import torch

from tests.runtime.batch.test_batch_monitor import assert_equal
from tests.runtime.batch.test_registers import COUNT, columns, draw_samples
from tltl_runtime.spec.batch import BatchMonitor
from tltlc import compile_text
from tltlc.automaton.fspa import Fspa
from tltlc.automaton.memory import given_atoms
from tltlc.monitor import Monitor, MonitorError

TEXT = """\
clock varies
signal alarm: bool
signal hidden: bool
signal speed: number in [0, 8]

spec answers { keep alarm implies eventually within 2 s hidden }
spec rests { keep alarm implies next always for 1 s speed < 4 }
spec chain { reach alarm then within 3 s hidden then within 1 s alarm }
spec stays { reach always for 2 s hidden }
spec opens { require eventually within 4 s alarm }
spec past { keep once within 3 s hidden reach time_holding(alarm) >= 0.5 s keep time_since(hidden) < 5 s }
"""
LENGTHS = (0.0, 0.1, 0.25, 0.5, 1.0, 2.0, 7.5)


def automata() -> list[Fspa]:
    return list(compile_text(TEXT))


@pytest.mark.parametrize("fspa", automata(), ids=lambda fspa: fspa.name)
@pytest.mark.parametrize("dtype", [torch.float64, torch.float32, torch.bfloat16], ids=str)
def test_a_batch_equals_scalar_monitors(fspa: Fspa, dtype: torch.dtype) -> None:
    rng = random.Random(fspa.name)
    batch, monitors = BatchMonitor(fspa, COUNT, dtype=dtype), [Monitor(fspa) for _ in range(COUNT)]
    for number in range(150):
        if number % 40 == 39:
            chosen = [rng.random() < 0.7 for _ in range(COUNT)]
            batch.reset(torch.tensor(chosen))
            for monitor in (monitor for monitor, is_chosen in zip(monitors, chosen, strict=True) if is_chosen):
                monitor.reset()
        samples, lengths = draw_samples(fspa, rng), [rng.choice(LENGTHS) for _ in range(COUNT)]
        samples = [{**sample, "speed": float(round(sample.get("speed", 0.0)))} for sample in samples]
        taken = batch.step(columns(samples), lengths)
        steps = [monitor.step(sample, dt) for monitor, sample, dt in zip(monitors, samples, lengths, strict=True)]
        if dtype == torch.float64:
            assert_equal(taken, steps, [monitor.success for monitor in monitors], fspa, True)
        assert taken.state.tolist() == [step.state for step in steps]
        expected = torch.tensor([monitor.registers for monitor in monitors], dtype=torch.float64).t()
        assert torch.equal(batch.registers, expected)


def test_one_length_counts_for_all_environments() -> None:
    fspa = automata()[0]
    one, many = BatchMonitor(fspa, COUNT), BatchMonitor(fspa, COUNT)
    atoms = [[1.0, -1.0]] * COUNT
    assert len(given_atoms(fspa)) == 2
    for dt in (0.0, 1.5, 0.75):
        assert one.step_atoms(atoms, dt).state.tolist() == many.step_atoms(atoms, [dt] * COUNT).state.tolist()
    assert one.step_atoms(atoms, 0.0).verdict.tolist() == many.step_atoms(atoms, [0.0] * COUNT).verdict.tolist()


@pytest.mark.parametrize(
    ("dt", "text"),
    [
        (None, "its time since the sample before is missing, and the clock varies"),
        ([0.0] * 6 + [-1.0], "environment 6: its time since the sample before is -1, not a number of seconds"),
        (float("nan"), "environments 0, 1, 2, 3, 4 and 2 more: its time since the sample before is nan"),
    ],
)
def test_a_wrong_length_leaves_all_environments_unchanged(dt: object, text: str) -> None:
    fspa = automata()[0]
    batch = BatchMonitor(fspa, COUNT)
    sample = {"alarm": [1.0] * COUNT, "hidden": [0.0] * COUNT}
    batch.step(sample, 0.0)
    before = batch.registers
    with pytest.raises(MonitorError) as error:
        batch.step(sample, dt)  # type: ignore[arg-type]
    (diagnostic,) = error.value.diagnostics
    assert diagnostic.code == "TLT0619"
    assert text in diagnostic.title
    assert batch.registers is before
    with pytest.raises(ValueError, match="one number or have the shape"):
        batch.step(sample, [0.0])


def test_a_fixed_clock_takes_no_length() -> None:
    (fspa,) = compile_text("signal a: bool\nspec s { keep a }")
    with pytest.raises(MonitorError) as error:
        BatchMonitor(fspa, 1).step({"a": [1.0]}, 0.5)
    assert error.value.diagnostics[0].help == "leave it out, or write `clock varies` in the spec"
