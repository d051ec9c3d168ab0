"""``BatchMonitor`` gives the same results as one scalar ``Monitor`` per environment."""

from __future__ import annotations

import random
from pkgutil import iter_modules
from typing import Any

import numpy as np
import pytest
import torch
from hypothesis import given, settings
from hypothesis import strategies as st

from benchmarks.specs import PAPER_SPECS, source, trace
from tests.fixtures import cover_and_hide
from tests.monitor.strategies import atom_traces, automata
from tltl_runtime.spec.batch import BatchMonitor, BatchStep, reward_modes
from tltl_runtime.spec.batch import guards as batch_guards
from tltl_runtime.spec.batch.progress_and_reward import VERDICTS
from tltlc import compile_file, compile_text
from tltlc.automaton.finite.build import build, spec_from_formula
from tltlc.automaton.fspa import Fspa
from tltlc.core.record import replace
from tltlc.logic import formula as f
from tltlc.monitor import Monitor, MonitorError, RewardOptions, Step
from tltlc.monitor.progress_and_reward import MODES
from tltlc.resolve import spec

TENSOR_MODES = ["progress", *(module.name for module in iter_modules(reward_modes.__path__))]
FAR = {"distance(s1)": 20.0, "distance(s2)": 20.0, "distance(exit)": 20.0, "health": 1.0}

options = st.builds(
    RewardOptions,
    mode=st.sampled_from(MODES),
    termination=st.sampled_from(["entry", "paper"]),
    terminal_penalty=st.sampled_from(["undiscounted", "discounted"]),
    gamma=st.sampled_from([1.0, 0.9]),
)


def tensor(rows: Any) -> torch.Tensor:
    return torch.tensor(rows, dtype=torch.float64)


def assert_equal(batch: BatchStep, steps: list[Step], successes: list[bool], fspa: Fspa, exact: bool = True) -> None:
    """Compare every field of a batch step with the steps of the scalar monitors."""
    tolerance = 0.0 if exact else 1e-12
    names = [atom.name for atom in fspa.atoms]
    assert batch.state.tolist() == [step.state for step in steps]
    assert [VERDICTS[index] for index in batch.verdict.tolist()] == [step.verdict for step in steps]
    assert batch.accepting.tolist() == [step.accepting for step in steps]
    assert batch.done.tolist() == [step.done for step in steps]
    assert batch.success.tolist() == successes
    assert [names[index] if index >= 0 else None for index in batch.limiting.tolist()] == [s.limiting for s in steps]
    for field in ("progress", "reward", "robustness"):
        expected = [getattr(step, field) for step in steps]
        assert getattr(batch, field).tolist() == pytest.approx(expected, rel=0.0, abs=tolerance), field


@settings(max_examples=80, deadline=None)
@given(st.data(), automata(), options, st.booleans())
def test_a_batch_equals_scalar_monitors(
    data: st.DataObject, fspa: Fspa, reward: RewardOptions, by_primes: bool
) -> None:
    count = data.draw(st.integers(1, 3))
    traces = [data.draw(atom_traces(fspa, max_size=6)) for _ in range(count)]
    length = max(map(len, traces))
    resets = data.draw(st.lists(st.lists(st.booleans(), min_size=count, max_size=count), max_size=length))
    with pytest.MonkeyPatch.context() as patch:
        if by_primes:
            patch.setattr(batch_guards, "_LETTER_ATOMS", -1)
        batch = BatchMonitor(fspa, count, reward=reward)
    monitors = [Monitor(fspa, reward=reward) for _ in range(count)]
    ended: list[bool | None] = [None] * count
    for number in range(length):
        if number < len(resets) and number:
            batch.reset(torch.tensor(resets[number]))
            for index in range(count):
                if resets[number][index]:
                    monitors[index].reset()
                    ended[index] = None
        samples = [trace[number % len(trace)] for trace in traces]
        batch_step = batch.step_atoms(tensor(samples).reshape(count, len(fspa.atoms)))
        steps = [monitor.step_atoms(sample) for monitor, sample in zip(monitors, samples, strict=True)]
        for index, step in enumerate(steps):
            if step.done and ended[index] is None:
                ended[index] = step.accepting
        exact = reward.terminal_penalty == "undiscounted" or reward.gamma == 1.0
        assert_equal(batch_step, steps, [bool(success) for success in ended], fspa, exact)
        assert batch.one_hot().argmax(1).tolist() == [step.state for step in steps]


def test_a_tensor_and_a_mapping_of_signals_give_the_same_steps() -> None:
    fspa, rng = cover_and_hide(), random.Random(3)
    for reward in (RewardOptions(), RewardOptions(mode="sparse"), RewardOptions(mode="potential", gamma=0.99)):
        tensor_batch, mapping_batch = BatchMonitor(fspa, 5, reward=reward), BatchMonitor(fspa, 5, reward=reward)
        monitors = [Monitor(fspa, reward=reward) for _ in range(5)]
        ended: list[bool | None] = [None] * 5
        for _ in range(60):
            samples = [
                {
                    name: rng.choice([0.0, 1.0, rng.random()])
                    if name == "health"
                    else rng.choice([0.25, 1.0, 20.0, 25.0, 20 * rng.random()]) + 1.0 * (row != number % 3)
                    for number, name in enumerate(FAR)
                }
                for row in [rng.randrange(6) for _ in range(5)]
            ]
            rows = tensor([[sample[name] for name in tensor_batch.signal_names] for sample in samples])
            near = (rows[:, :3] < 1.0).sum(1)
            rows[:, :3] += 1.0 * (near > 1)[:, None]
            samples = [dict(zip(tensor_batch.signal_names, row, strict=True)) for row in rows.tolist()]
            tensor_step = tensor_batch.step(rows)
            mapping_step = mapping_batch.step(
                {name: rows[:, index] for index, name in enumerate(tensor_batch.signal_names)}
            )
            steps = [monitor.step(sample) for monitor, sample in zip(monitors, samples, strict=True)]
            for index, step in enumerate(steps):
                if step.done and ended[index] is None:
                    ended[index] = step.accepting
            assert_equal(tensor_step, steps, [bool(success) for success in ended], fspa)
            assert tensor_step.reward.tolist() == mapping_step.reward.tolist()
        assert len({monitor.state for monitor in monitors}) > 1 or all(monitor.done for monitor in monitors)


@pytest.mark.parametrize("name", PAPER_SPECS)
def test_a_batch_equals_scalar_monitors_on_recorded_traces_of_the_paper(name: str) -> None:
    """Run four environments, each of which starts at a different sample of the trace."""
    fspa = next(fspa for fspa in compile_file(source(name)) if fspa.name == name)
    samples = trace(name)
    batch, monitors = BatchMonitor(fspa, 4), [Monitor(fspa) for _ in range(4)]
    ended: list[bool | None] = [None] * 4
    for number in range(len(samples)):
        rows = [samples[(number + 41 * index) % len(samples)] for index in range(4)]
        batch_step = batch.step(tensor([[row[signal] for signal in batch.signal_names] for row in rows]))
        steps = [monitor.step(row) for monitor, row in zip(monitors, rows, strict=True)]
        for index, step in enumerate(steps):
            if step.done and ended[index] is None:
                ended[index] = step.accepting
        assert_equal(batch_step, steps, [bool(success) for success in ended], fspa)
    assert batch_step.success[0]


def test_values_progress_and_rewards_equal_numbers_computed_by_hand() -> None:
    """Check a distance halfway between b = 1 and B = 20.

    By equation 2 a distance of (b + B) / 2 gives -0.75. On the last edge, to the exit, the progress is
    then 2/3 + 0.25/3 = 0.75.
    """
    batch = BatchMonitor(cover_and_hide(), 2)

    def step(**near: float) -> BatchStep:
        signals = {**FAR, **{f"distance({entity})": distance for entity, distance in near.items()}}
        return batch.step({name: tensor([value, 20.0 if name != "health" else 1.0]) for name, value in signals.items()})

    step(s1=0.5)
    step(s2=0.5)
    half_way = step(exit=10.5)
    assert half_way.values[2].tolist() == [-0.75, -1.0]
    assert half_way.progress.tolist() == pytest.approx([0.75, 0.0])
    assert half_way.reward.tolist() == pytest.approx([0.75 - 2 / 3 - 1 / 400, -1 / 400])
    last = step(exit=0.0)
    assert (last.done.tolist(), last.success.tolist()) == ([True, False], [True, False])
    batch.reset(last.done)
    assert (batch.state.tolist(), batch.steps.tolist(), batch.progress.tolist()) == ([0, 0], [0.0, 4.0], [0.0, 0.0])


def test_values_equal_equation_2_at_three_distances() -> None:
    fspa = cover_and_hide()
    batch = BatchMonitor(fspa, 3, params={"level_size": 10.0})
    rows = {name: tensor([value] * 3) for name, value in FAR.items()}
    step = batch.step({**rows, "distance(s1)": tensor([5.0, 5.5, 10.0])})
    assert step.values[0].tolist() == pytest.approx([-56 / 81, -0.75, -1.0], abs=1e-15)


def test_later_steps_do_not_change_a_step() -> None:
    batch = BatchMonitor(cover_and_hide(), 2)
    rows = {name: tensor([value] * 2) for name, value in FAR.items()}
    first = batch.step({**rows, "distance(s1)": tensor([0.5, 20.0])})
    before = [getattr(first, name).clone() for name in ("state", "done", "success", "progress", "reward", "values")]
    batch.reset(torch.tensor([True, False]))
    batch.step({**rows, "health": tensor([0.0, 0.0])})
    after = [getattr(first, name) for name in ("state", "done", "success", "progress", "reward", "values")]
    assert all(torch.equal(old, new) for old, new in zip(before, after, strict=True))


def test_a_batch_in_float32_reaches_the_same_states() -> None:
    batch = BatchMonitor(cover_and_hide(), 2, dtype=torch.float32)
    step = batch.step({**{name: tensor([value] * 2) for name, value in FAR.items()}, "health": tensor([1.0, 0.0])})
    assert (step.reward.dtype, step.state.tolist()) == (torch.float32, [0, 2])


# --- samples --------------------------------------------------------------------------------------


def error_of_step(batch: BatchMonitor, signals: dict[str, torch.Tensor]) -> tuple[str, str]:
    """Return the code and title of the error that a step raises, which must not change the monitor."""
    before = (batch.state.tolist(), batch.steps.tolist())
    with pytest.raises(MonitorError) as caught:
        batch.step(signals)
    assert (batch.state.tolist(), batch.steps.tolist()) == before
    (diagnostic,) = caught.value.diagnostics
    assert diagnostic.help
    return diagnostic.code, diagnostic.title


def test_errors_name_signal_and_environments() -> None:
    batch = BatchMonitor(cover_and_hide(), 8)
    rows = {name: tensor([value] * 8) for name, value in FAR.items()}
    health = tensor([1.0, float("nan"), 1.0, float("inf"), 1.0, 1.0, 1.0, 1.0])
    title = "environments 1 and 3: the signal `health` is nan, not a finite number"
    assert error_of_step(batch, {**rows, "health": health}) == ("TLT0612", title)
    infinite = tensor([float("-inf")] * 8)
    title = "environments 0, 1, 2, 3, 4 and 3 more: the signal `distance(s1)` is -inf, not a finite number"
    assert error_of_step(batch, {**rows, "distance(s1)": infinite}) == ("TLT0612", title)
    del rows["health"]
    assert error_of_step(batch, rows) == ("TLT0611", "no value for `health`")
    with pytest.raises(ValueError, match="shape"):
        batch.step(torch.zeros(8, 3))
    with pytest.raises(ValueError, match="health"):
        batch.step({**rows, "health": torch.ones(7)})


def test_exclusive_atoms_cannot_hold_at_once() -> None:
    batch = BatchMonitor(cover_and_hide(), 2)
    rows = {name: tensor([value] * 2) for name, value in FAR.items()}
    both = {**rows, "distance(s1)": tensor([20.0, 0.5]), "distance(exit)": tensor([0.0, 0.25])}
    code, title = error_of_step(batch, both)
    assert code == "TLT0614"
    assert title.startswith("environment 1: `near(s1)` and `near(exit)` hold at once, against `exclusive near(s1), ")


def test_values_out_of_range_are_clamped_and_counted() -> None:
    batch, monitor = BatchMonitor(cover_and_hide(), 3), Monitor(cover_and_hide())
    rows = {name: tensor([value] * 3) for name, value in FAR.items()}
    for _ in range(2):
        step = batch.step({**rows, "health": tensor([1.5, 1.0, 100.0]), "distance(s1)": tensor([20.0, 20.0, -3.0])})
    assert batch.clamped == {"health": 4, "distance(s1)": 2}
    assert step.values[:, 2].tolist() == [1.0, -1.0, -1.0, 1.0]
    monitor.step({**FAR, "health": 100.0, "distance(s1)": -3.0})
    assert list(monitor.values) == step.values[:, 2].tolist()


def test_a_boolean_signal_must_be_true_or_false() -> None:
    fspa = build(spec_from_formula(f.eventually(f.atom("p"))))
    fspa = replace(fspa, signals=(spec.Signal("p", "bool", None, None),))
    batch = BatchMonitor(fspa, 2)
    assert batch.step({"p": torch.tensor([True, False])}).success.tolist() == [True, False]
    for wrong in (0.5, 2.0):
        text = f"environment 1: the signal `p` is {wrong:g}, not true or false"
        assert error_of_step(batch, {"p": tensor([1.0, wrong])}) == ("TLT0612", text)


def test_arrays_and_lists_work_like_tensors() -> None:
    (fspa,) = compile_text("signal x in [-1, 1]\npredicate p in [-1, 1] = x\nspec s { limit 9 steps reach p then !p }")
    monitor = BatchMonitor(fspa, 2)
    rows = [[0.5], [-0.25]]
    for signals in (rows, np.array(rows), torch.tensor(rows), {"x": [0.5, -0.25]}, {"x": np.array([0.5, -0.25])}):
        monitor.reset()
        assert monitor.step(signals).values.tolist() == [[0.5, -0.25]]
    before = monitor.state.tolist()
    monitor.reset([True, False])
    assert monitor.state.tolist() == [0, before[1]]
    monitor.reset(np.array([False, True]))
    assert monitor.state.tolist() == [0, 0]
    with pytest.raises(ValueError, match=r"the mask must be torch.bool of the shape \(2,\), not torch.bool of \(3,\)"):
        monitor.reset([True] * 3)
    with pytest.raises(ValueError, match=r"the signals must have the shape \(2, 1\), not \(2,\)"):
        monitor.step([0.5, 0.5])


def test_arguments_of_the_wrong_type_are_rejected() -> None:
    with pytest.raises(TypeError, match=r"an automaton is needed, not 'plan\.tltl'"):
        BatchMonitor("plan.tltl", 3)  # type: ignore[arg-type]
    with pytest.raises(TypeError, match="RewardOptions"):
        BatchMonitor(cover_and_hide(), 3, reward="sparse")  # type: ignore[arg-type]


# --- unchecked ------------------------------------------------------------------------------------

FIELDS = ("state", "done", "success", "truncated", "progress", "reward", "verdict", "robustness", "limiting", "values")


@pytest.fixture(params=[False, True], ids=["by letters", "by primes"])
def by_primes(request: pytest.FixtureRequest, monkeypatch: pytest.MonkeyPatch) -> None:
    """Run the test with a lookup table of letters, and with prime implicants instead."""
    if request.param:
        monkeypatch.setattr(batch_guards, "_LETTER_ATOMS", -1)


@pytest.mark.parametrize("mode", TENSOR_MODES)
@pytest.mark.usefixtures("by_primes")
def test_valid_samples_give_the_same_results_unchecked(mode: Any) -> None:
    fspa, reward = cover_and_hide(), RewardOptions(mode=mode)
    checked, unchecked = (BatchMonitor(fspa, 64, reward=reward, checked=is_checked) for is_checked in (True, False))
    health = checked.signal_names.index("health")
    distance_columns = torch.tensor([column for column in range(4) if column != health])
    generator, seen_states = torch.Generator().manual_seed(1), set[int]()
    for _ in range(40):
        rows = 1.0 + 19.0 * torch.rand(64, 4, generator=generator, dtype=torch.float64)
        rows[torch.arange(64), distance_columns[torch.randint(3, (64,), generator=generator)]] -= 1.0
        rows[:, health] = 1.0
        checked_step, unchecked_step = checked.step(rows), unchecked.step(rows)
        for field in FIELDS:
            assert torch.equal(getattr(checked_step, field), getattr(unchecked_step, field)), field
        seen_states |= set(checked_step.state.tolist())
        for monitor in (checked, unchecked):
            monitor.reset(checked_step.done)
    assert len(seen_states) == len(fspa.states) - 1


@pytest.mark.parametrize("mode", TENSOR_MODES)
@pytest.mark.usefixtures("by_primes")
def test_an_unchecked_step_does_not_read_values(mode: Any) -> None:
    """Tensors on the device "meta" have no values, so reading one raises an error."""
    monitor = BatchMonitor(cover_and_hide(), 4096, reward=RewardOptions(mode=mode), device="meta", checked=False)
    for signals in (torch.empty(4096, 4, device="meta"), {name: torch.empty(4096, device="meta") for name in FAR}):
        step = monitor.step(signals)
        monitor.reset(step.done)
        results = [getattr(step, field) for field in FIELDS] + [monitor.one_hot(), monitor.state, monitor.progress]
        assert {result.device.type for result in results} == {"meta"}
    with pytest.raises((NotImplementedError, RuntimeError)):
        BatchMonitor(cover_and_hide(), 4096, device="meta").step(signals)


@pytest.mark.skipif(not torch.cuda.is_available(), reason="no GPU is at hand")
@pytest.mark.parametrize("mode", TENSOR_MODES)
@pytest.mark.usefixtures("by_primes")
def test_an_unchecked_step_does_not_wait_for_a_gpu(mode: Any) -> None:
    monitor = BatchMonitor(cover_and_hide(), 4096, reward=RewardOptions(mode=mode), device="cuda", checked=False)
    rows = torch.full((4096, 4), 0.5, device="cuda")
    torch.cuda.set_sync_debug_mode("error")
    try:
        for _ in range(3):
            step = monitor.step(rows)
            monitor.reset(step.done | step.truncated)
            monitor.one_hot()
    finally:
        torch.cuda.set_sync_debug_mode("default")


@pytest.mark.usefixtures("by_primes")
def test_an_invalid_sample_affects_only_its_own_environment_when_unchecked() -> None:
    batch = BatchMonitor(cover_and_hide(), 4, checked=False)
    near = tensor([20.0, 20.0, 20.0, 0.0])
    rows = {name: tensor([value] * 4) for name, value in FAR.items()}
    rows |= {"health": tensor([1.0, float("nan"), 100.0, 1.0]), "distance(s1)": near, "distance(s2)": near}
    step = batch.step(rows)
    assert step.state.tolist()[:3] == [0, 2, 0]
    assert torch.isfinite(step.reward)[[0, 2, 3]].all()
    assert step.values[:, 2].tolist() == [-1.0, -1.0, -1.0, 1.0]
    assert batch.fspa.edges[int(step.edge[3])].source == 0
    assert batch.clamped == {}


def test_only_the_limit_truncates() -> None:
    text = "signal x in [-1, 1]\npredicate p in [-1, 1] = x\nspec s { limit 2 steps reach p keep x > -0.5 }"
    (fspa,) = compile_text(text)
    batch = BatchMonitor(fspa, 3)
    steps = [batch.step({"x": tensor(row)}) for row in ([-0.25, -0.25, -0.25], [-0.25, 0.5, -0.75])]
    assert [step.truncated.tolist() for step in steps] == [[False, False, False], [True, False, False]]
    assert steps[1].done.tolist() == [True, True, True]
