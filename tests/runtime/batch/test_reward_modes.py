"""Each mode has a module for one automaton, and may have one for many; the pages name only modes that exist."""

from __future__ import annotations

import re
from pathlib import Path
from pkgutil import iter_modules
from typing import Any

import pytest
import torch

from tests.fixtures import cover_and_hide
from tltl_runtime.spec.batch import BatchMonitor
from tltl_runtime.spec.batch import reward_modes as batch_modes
from tltl_runtime.training.files.settings import default_text
from tltlc.monitor import reward_modes as scalar_modes
from tltlc.monitor.progress_and_reward import MODES, RewardOptions

ROOT = Path(__file__).parents[3]
MODULES = {module.name for module in iter_modules(scalar_modes.__path__)}
BATCH_MODULES = sorted(module.name for module in iter_modules(batch_modes.__path__))


def test_every_module_is_a_mode() -> None:
    assert ("progress", *sorted(MODULES)) == MODES
    assert {"edge", "potential", "sparse"} <= set(BATCH_MODULES) <= MODULES


@pytest.mark.parametrize("dtype", [torch.float64, torch.float32], ids=["float64", "float32"])
@pytest.mark.parametrize("mode", BATCH_MODULES)
def test_without_tensors_the_rewards_are_the_same(
    mode: Any, dtype: torch.dtype, monkeypatch: pytest.MonkeyPatch
) -> None:
    fspa, options = cover_and_hide(), RewardOptions(mode=mode, gamma=0.9)
    batched = BatchMonitor(fspa, 8, reward=options, dtype=dtype)
    with monkeypatch.context() as patch:
        patch.setattr("tltl_runtime.spec.batch.monitor.reward_mode", batch_modes.RowByRow)
        row_by_row = BatchMonitor(fspa, 8, reward=options, dtype=dtype)
    names, generator, rewards = batched.signal_names, torch.Generator().manual_seed(2), set[float]()
    successes = 0
    for _ in range(60):
        rows = 1.0 + 19.0 * torch.rand(8, len(names), generator=generator, dtype=torch.float64)
        rows[torch.arange(8), torch.randint(len(names), (8,), generator=generator)] *= 0.05
        alive = torch.rand(8, generator=generator) > 0.05
        rows[:, names.index("health")] = torch.where(alive, 0.5 + rows[:, 0] / 40, 0.0)
        expected, actual = (monitor.step(rows) for monitor in (batched, row_by_row))
        assert actual.reward.dtype == dtype
        assert actual.reward.tolist() == pytest.approx(expected.reward.tolist(), abs=1e-6)
        rewards.update(expected.reward.tolist())
        successes += int(expected.success.sum())
        # Some episodes are cut off, and some go on after their ends.
        resets = torch.rand(8, generator=generator) > torch.where(expected.done, 0.3, 0.95)
        for monitor in (batched, row_by_row):
            monitor.reset(resets)
    assert successes > 0
    assert len(rewards) > 1


def test_without_tensors_a_mode_is_not_called_after_the_end_of_an_episode(monkeypatch: pytest.MonkeyPatch) -> None:
    ends: list[bool] = []

    def reward(_: object, transition: scalar_modes.Transition, *__: object) -> tuple[float, None]:
        ends.append(transition.done)
        return 1.0, None

    monkeypatch.setattr("tltlc.api.monitors.mode_function", lambda _: reward)
    monkeypatch.setattr("tltl_runtime.spec.batch.monitor.reward_mode", batch_modes.RowByRow)
    monitor = BatchMonitor(cover_and_hide(), 1, reward=RewardOptions(mode="sparse"))
    sample = {name: [20.0] for name in monitor.signal_names} | {"health": [1.0]}
    rewards = [monitor.step(sample | {"health": [health]}).reward.item() for health in (1.0, 0.0, 0.0)]
    monitor.reset()
    rewards.append(monitor.step(sample).reward.item())
    assert (rewards, ends) == ([1.0, 1.0, 0.0, 1.0], [False, True, False])


def test_the_semantics_page_has_a_row_for_each_mode() -> None:
    page = (ROOT / "docs" / "semantics.md").read_text(encoding="utf-8")
    documented = set(re.findall(r'^\| `mode="(\w+)"` \|', page, re.MULTILINE))
    assert documented == MODULES


def test_the_default_settings_name_every_mode() -> None:
    (names,) = re.findall(r"^mode = .* # (.*)$", default_text(), re.MULTILINE)
    assert tuple(re.split(", | or ", names)) == MODES


def test_every_mode_has_a_test() -> None:
    texts = [path.read_text(encoding="utf-8") for path in (ROOT / "tests" / "monitor").glob("*.py")]
    assert {mode for mode in MODULES if not any(f'mode="{mode}"' in text for text in texts)} == set()
