"""The weights of the losses and of the penalty depend on the pass rate."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.runtime.training.runs import run_in
from tltl_runtime.training.files.settings import read_settings
from tltl_runtime.training.ppo.scheduled_weights import ScheduledWeights, penalty_rise, scheduled_weights
from tltlc.core.record import replace


@pytest.mark.parametrize(
    ("met", "entropy", "penalty_weight", "inverse_temperature"),
    [(0.0, 0.01, 0.0, 1.0), (0.5, 0.005, 0.0, 1.0), (0.75, 0.0025, 0.5, 2.0), (1.0, 0.0, 1.0, 3.0)],
)
def test_the_entropy_weight_falls_and_the_other_weights_rise_from_half_on(
    met: float, entropy: float, penalty_weight: float, inverse_temperature: float
) -> None:
    ppo = replace(read_settings().ppo, sharpening=3.0)
    assert scheduled_weights(ppo, met) == ScheduledWeights(pytest.approx(entropy), penalty_weight, inverse_temperature)
    assert scheduled_weights(replace(ppo, entropy_schedule="fixed"), met) == ScheduledWeights(
        None, penalty_weight, inverse_temperature
    )
    assert scheduled_weights(replace(ppo, sharpening=1.0), met).inverse_temperature == 1.0


def test_the_discounted_penalty_rises_to_the_undiscounted_one(tmp_path: Path) -> None:
    run = run_in(tmp_path / "rising")
    limit = run.fspa.limit_steps
    rise = penalty_rise(run)
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
    assert penalty_rise(run_in(tmp_path / "other", **changes)) is None
