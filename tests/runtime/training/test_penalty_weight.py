"""The weights of the losses and of the penalty depend on the pass rate."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.runtime.training.runs import run_in
from tltl_runtime.training.ppo.penalty_weight import Weighing, raised_penalty, weighing
from tltl_runtime.training.run.settings import read_settings
from tltlc.core.record import replace


@pytest.mark.parametrize(
    ("met", "entropy", "severity", "sharpness"),
    [(0.0, 0.01, 0.0, 1.0), (0.5, 0.005, 0.0, 1.0), (0.75, 0.0025, 0.5, 2.0), (1.0, 0.0, 1.0, 3.0)],
)
def test_the_entropy_weight_falls_and_the_other_weights_rise_from_half_on(
    met: float, entropy: float, severity: float, sharpness: float
) -> None:
    ppo = replace(read_settings().ppo, sharpening=3.0)
    assert weighing(ppo, met) == Weighing(pytest.approx(entropy), severity, sharpness)
    assert weighing(replace(ppo, entropy_schedule="fixed"), met) == Weighing(None, severity, sharpness)
    assert weighing(replace(ppo, sharpening=1.0), met).sharpness == 1.0


def test_the_discounted_penalty_rises_to_the_undiscounted_one(tmp_path: Path) -> None:
    run = run_in(tmp_path / "rising")
    limit = run.fspa.limit_steps
    rise = raised_penalty(run)
    assert limit is not None
    assert rise is not None
    assert rise(0) == pytest.approx(1 - (1 - 0.99**limit) / (0.01 * limit))
    assert rise(limit - 1) == pytest.approx(0.0)
    assert rise(limit) == 0.0


@pytest.mark.parametrize(
    "changes",
    [
        {"reward__penalty_schedule": "fixed"},
        {"reward__terminal_penalty": "undiscounted"},
        {"reward__mode": "sparse"},
        {"method": "imitation"},
        {"spec": "import stealth\nspec unlimited { level cover_and_hide\n reach sneaking }\n"},
    ],
)
def test_with_other_settings_the_penalty_does_not_rise(tmp_path: Path, changes: dict[str, str]) -> None:
    assert raised_penalty(run_in(tmp_path / "other", **changes)) is None
