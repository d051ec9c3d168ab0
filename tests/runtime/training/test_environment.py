"""The ends of episodes as PPO sees them: terminated, or truncated by a time limit."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import ExitStack
from itertools import cycle

import numpy as np
import pytest
import torch

from tests.runtime.training.runs import STEALTH_ACTIONS
from tltl_runtime.spec.episode_summary import EpisodeSummary
from tltl_runtime.training.exploration.replayed_starts import EpisodeStart, ReplayedStartEnv
from tltl_runtime.training.exploration.reverse_curriculum import ReverseCurriculum
from tltl_runtime.training.exploration.search import SuccessfulEpisode
from tltl_runtime.training.ppo.environment import TrainingEnv
from tltl_runtime.vector import make_vec
from tltl_runtime.vector.env import TLTL_INFO

SPEC = """\
import stealth
predicate leaping in [-1, 1] = 1 - 2 * grounded
spec stoop { level navigation
  limit 4 steps
  reach sneaking
  avoid leaping
}
"""
"""A spec that crouching meets and jumping violates, in one step."""
STAY, WALK, JUMP, CROUCH = [0, 0, 0, 0, 0], [1, 0, 0, 0, 0], [0, 0, 1, 0, 0], [0, 0, 0, 1, 0]
DEMONSTRATION = SuccessfulEpisode(5, [STAY, CROUCH], end=1)
ON_DEMONSTRATION = EpisodeStart(5, [STAY], segment=(DEMONSTRATION.end, 0))
STARTS = (
    EpisodeStart(5),
    EpisodeStart(5),
    EpisodeStart(5),
    ON_DEMONSTRATION,
    ON_DEMONSTRATION,
    EpisodeStart(5, [STAY], segment=(DEMONSTRATION.end, 0), max_decisions=2),
    ON_DEMONSTRATION,
)
"""The start of the episodes of each environment."""


class FixedCurriculum(ReverseCurriculum):
    """A curriculum that returns the same starts in turn."""

    def __init__(self) -> None:
        super().__init__(1, np.random.default_rng(0), STEALTH_ACTIONS)
        self.add(DEMONSTRATION)
        self._starts = cycle(STARTS)

    def draw(self) -> EpisodeStart:
        return next(self._starts)


@pytest.fixture(name="make")
def _make() -> Iterator[Callable[[], TrainingEnv]]:
    with ExitStack() as stack:

        def make() -> TrainingEnv:
            info = {**TLTL_INFO, "cell": np.int64}
            vector_env = make_vec("navigation", "v0", len(STARTS), 1, spec=SPEC, wrapper=ReplayedStartEnv, info=info)
            stack.callback(vector_env.close)
            return TrainingEnv(
                vector_env, 0, curriculum=FixedCurriculum(), extra_penalty=lambda steps: 10.0 * steps, limit_steps=4
            )

        yield make


@pytest.fixture(name="env")
def _env(make: Callable[[], TrainingEnv]) -> TrainingEnv:
    return make()


def test_truncated_episodes_are_time_outs_and_only_full_episodes_count(env: TrainingEnv) -> None:
    first = env.get_observations()
    ends = []
    for actions in ([WALK, JUMP, CROUCH, JUMP, CROUCH, WALK, WALK], *[[WALK] * len(STARTS)] * 3):
        observation, _, dones, extras = env.step(torch.tensor(actions))
        rows, late = (torch.nonzero(mask).flatten().tolist() for mask in (dones, extras["time_outs"]))
        ends.append((rows, late, env.pop_finished()))
        if len(ends) == 2:
            # The truncated episode is followed at once by one with the same start.
            assert all(torch.equal(observation[key][5], first[key][5]) for key in env.shapes)
    violated = EpisodeSummary(0, None, False, "violation", 0.0, -1.0, 1, 0)
    met = EpisodeSummary(1, None, True, "success", 1.0, 0.75, 1, 1)
    assert ends == [
        # Violated or met episodes terminate: they have no value beyond their end.
        ([1, 2, 3, 4], [], (violated, met)),
        # Environment 5 reached the limit of its start, environment 6 the limit of the spec.
        ([5], [5], ()),
        ([6], [6], ()),
        ([0, 3, 4, 5], [0, 3, 4, 5], (EpisodeSummary(5, None, False, "limit", 0.0, -1.0, 4, 0),)),
    ]


def test_failures_cost_more_with_a_greater_penalty_weight(make: Callable[[], TrainingEnv]) -> None:
    without_penalty, with_penalty = make(), make()
    with_penalty.penalty_weight = 0.5
    steps = [[WALK, JUMP, CROUCH, JUMP, CROUCH, WALK, WALK], *[[WALK] * len(STARTS)] * 3]
    extra_penalties = torch.stack(
        [without_penalty.step(actions)[1] - with_penalty.step(actions)[1] for actions in map(torch.tensor, steps)]
    )
    expected = torch.zeros(4, len(STARTS))
    # A violation at once, and a violation after replayed actions.
    expected[0, 1], expected[0, 3] = 5.0, 10.0
    # The limit of the spec is a failure, too; a truncated episode is not.
    expected[2, 6] = expected[3, 0] = expected[3, 3] = expected[3, 4] = 20.0
    torch.testing.assert_close(extra_penalties, expected)
