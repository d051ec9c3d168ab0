"""PPO of Stable-Baselines3 learns in an environment with a spec, and the guide's program runs as shown."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import tltl_runtime  # noqa: F401  (registers the environments)
from tests.docs.blocks import DOCS, blocks
from tests.runtime.guides import check_program

pytest.importorskip("stable_baselines3")


def test_a_few_updates_change_every_weight_and_actions_are_valid() -> None:
    from stable_baselines3 import PPO
    from stable_baselines3.common.env_util import make_vec_env

    envs = make_vec_env("tltl/CoverAndHide-v0", n_envs=2, seed=1)
    model = PPO("MultiInputPolicy", envs, n_steps=64, batch_size=32, n_epochs=2, seed=1, device="cpu")
    before = {name: weights.clone() for name, weights in model.policy.state_dict().items()}
    model.learn(total_timesteps=3 * 2 * 64)
    after = model.policy.state_dict()
    assert [name for name in before if before[name].equal(after[name])] == []
    observation = envs.reset()
    assert isinstance(observation, dict)
    for deterministic in (False, True):
        actions, _ = model.predict(observation, deterministic=deterministic)
        assert all(envs.action_space.contains(action) for action in np.asarray(actions))
    envs.close()


@pytest.mark.slow
def test_the_program_prints_the_output_shown(tmp_path: Path) -> None:
    program, printed = blocks(DOCS / "guides" / "stable-baselines3.md")
    check_program(program, printed, tmp_path / "program.py")
