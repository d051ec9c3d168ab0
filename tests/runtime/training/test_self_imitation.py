"""Self-imitation: the imitated decisions, and the effect on the policy."""

from __future__ import annotations

from functools import partial
from pathlib import Path
from typing import Any

import gymnasium
import numpy as np
import pytest
import torch

from tests.runtime.training.runs import run_in
from tests.runtime.training.test_search import curriculum_of
from tltl_runtime.stealth.env import make_env
from tltl_runtime.training.exploration.search import SuccessfulEpisode
from tltl_runtime.training.exploration.self_imitation import BATCH, SelfImitation, imitate
from tltl_runtime.training.files.settings import rsl_config
from tltl_runtime.training.ppo.environment import TrainingEnv
from tltl_runtime.training.runner import Runner
from tltl_runtime.vector import make_vec

DEMONSTRATION = SuccessfulEpisode(5, [[index % 3, 1, 0, 0, index % 2] for index in range(40)], 1)
make = partial(make_env, "cover_and_hide")


class Counting(gymnasium.Wrapper[Any, Any, Any, Any]):
    """An environment that counts its resets."""

    resets = 0

    def reset(self, **options: Any) -> tuple[Any, dict[str, Any]]:
        self.resets += 1
        return super().reset(**options)


def test_decisions_are_drawn_with_the_observations_before_them() -> None:
    self_imitation = SelfImitation(make, curriculum_of([DEMONSTRATION], 4))
    batch = self_imitation.draw()
    self_imitation.close()
    assert batch is not None
    observations, actions = batch
    env = make()
    first, _ = env.reset(seed=DEMONSTRATION.seed)
    step_observations = [first, *(env.step(action)[0] for action in DEMONSTRATION.actions)]
    env.close()
    entities = np.stack([step_observation["entities"] for step_observation in step_observations])
    for sensed, action in zip(observations["entities"].numpy(), actions.tolist(), strict=True):
        (decisions,) = np.nonzero((entities == sensed).all(axis=1))
        assert action in [DEMONSTRATION.actions[index] for index in decisions]


def test_a_demonstration_is_replayed_only_once() -> None:
    other = SuccessfulEpisode(6, [[1, 1, 0, 0, 0]] * 30, 1)
    curriculum = curriculum_of([DEMONSTRATION, other], 4)
    env = Counting(make())
    self_imitation = SelfImitation(lambda: env, curriculum)
    for rates in ([0, 0, 0, 0.5], [1, 0, 0, 0], [0, 0, 0.5, 0.5]):
        curriculum.rates[1][:] = rates
        for _ in range(5):
            self_imitation.draw()
    self_imitation.close()
    assert env.resets == 2


@pytest.mark.parametrize(
    ("rates", "segments"), [([0, 0, 0, 0.5], {0, 1, 2, 3}), ([0, 1, 0, 0], {0}), ([1, 0, 0, 0], set())]
)
def test_learned_segments_are_not_imitated(rates: list[float], segments: set[int]) -> None:
    curriculum = curriculum_of([DEMONSTRATION], 4)
    curriculum.rates[1][:] = rates
    decisions = curriculum.draw_decisions(BATCH)
    curriculum.start_rate = 1.0
    assert not curriculum.draw_decisions(BATCH)
    curriculum.start_rate = 0.0
    assert {index // 10 for _, index in decisions} == segments
    assert len(decisions) <= BATCH
    assert (SelfImitation(make, curriculum).draw() is None) == (not segments)


def test_a_runner_loads_optimizer_moments_with_another_memory_layout() -> None:
    run = run_in(Path("none"))
    vector_env = make_vec("cover_and_hide", "v0", 2, 1)
    env = TrainingEnv(vector_env, 1)
    config = rsl_config(run.settings, env.shapes, env.branches)
    saved_runner, runner = (Runner(env, dict(config)) for _ in range(2))
    self_imitation = SelfImitation(make, curriculum_of([DEMONSTRATION], 4))
    batch = self_imitation.draw()
    self_imitation.close()
    vector_env.close()
    assert batch is not None
    imitate(saved_runner.alg, *batch)
    saved = saved_runner.alg.save()
    for model in (runner.alg.actor, runner.alg.critic):
        model.to(memory_format=torch.contiguous_format)
    runner.load_algorithm(saved)
    weights = runner.alg.optimizer.param_groups[0]["params"]
    strides = [parameter.stride() for parameter in saved_runner.alg.optimizer.param_groups[0]["params"]]
    assert strides != [parameter.stride() for parameter in weights]
    # The parameters of the critic have no moments yet.
    moments = saved["optimizer_state_dict"]["state"]
    for number in moments:
        for name in ("exp_avg", "exp_avg_sq"):
            moment = runner.alg.optimizer.state[weights[number]][name]
            assert moment.stride() == weights[number].stride()
            assert moment.equal(moments[number][name])
    assert len(moments) == len(list(runner.alg.actor.parameters()))


def test_imitation_makes_the_actions_likelier() -> None:
    run = run_in(Path("none"))
    vector_env = make_vec("cover_and_hide", "v0", 2, 1)
    env = TrainingEnv(vector_env, 1)
    torch.manual_seed(0)
    runner = Runner(env, rsl_config(run.settings, env.shapes, env.branches))
    self_imitation = SelfImitation(make, curriculum_of([DEMONSTRATION], 4))
    batch = self_imitation.draw()
    assert batch is not None
    losses = [imitate(runner.alg, *batch) for _ in range(200)]
    self_imitation.close()
    vector_env.close()
    assert losses[-1] < 0.7 * losses[0]
