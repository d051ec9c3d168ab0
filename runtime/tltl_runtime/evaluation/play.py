"""Play an episode with a policy."""

from __future__ import annotations

from typing import Any

import gymnasium
import numpy as np

from tltl_runtime.game.recorder import recorded_step_s
from tltl_runtime.policies.policy import NotFiniteError, Policy
from tltl_runtime.spec.episode_summary import EpisodeSummary, settled_end
from tltlc.api import Diagnostic, TltlError, label_text, traces

_OF_LEVEL, _OF_ACTIONS = 0, 1
"""The random streams of an episode: for the reset of the environment, and for sampled actions."""


def play(
    policy: Policy,
    env: gymnasium.Env[Any, Any],
    seed: int,
    index: int,
    sampled: bool,
    judge: traces.Judge | None = None,
) -> EpisodeSummary:
    """Play one episode of an evaluation to its end, and return its summary.

    ``seed`` is the seed of the evaluation, and ``index`` the index of the episode. ``env`` is a
    :class:`~tltl_runtime.spec.wrapper.TltlEnv`, possibly wrapped, whose spec has a limit. If
    ``sampled``, actions are sampled, otherwise the likeliest action is taken. The episode depends only
    on the arguments. The seed of the environment's reset does not depend on ``sampled``. ``judge`` says
    which clauses of the spec a failed episode broke or did not meet; without it, the summary does not.

    Raises:
        TltlError: TLT0854, the environment or the policy gives values that are not finite.
    """
    generator = np.random.default_rng(_stream(seed, index, _OF_ACTIONS)) if sampled else None
    reset_seed = episode_seed(seed, index)
    observation, info = env.reset(seed=reset_seed)
    reward, steps, over = 0.0, 0, False
    fspa = env.get_wrapper_attr("task").fspa
    samples: list[dict[str, float]] = []
    while not over:
        try:
            action = policy.choose(observation, generator)
        except NotFiniteError as error:
            where = f"episode {index} of seed {seed} (seed {reset_seed} of the level), step {steps + 1}"
            help_ = "if the environment gives these values, fix it; otherwise train the policy again"
            raise TltlError([Diagnostic("TLT0854", f"{where}: {error}", help=help_)]) from None
        observation, step_reward, terminated, truncated, info = env.step(action)
        reward, steps, over = reward + float(step_reward), steps + 1, terminated or truncated
        if judge is not None:
            sample = env.get_wrapper_attr("sample")
            samples.append({signal.name: float(sample[signal.name]) for signal in fspa.signals})
    return EpisodeSummary(
        index=index,
        seed=reset_seed,
        success=info["success"],
        verdict=info["verdict"],
        end=settled_end(info["success"], info["verdict"]),
        progress=info["progress"],
        reward=reward,
        steps=steps,
        seconds=steps * recorded_step_s(env),
        state=info["state"],
        unmet=info["unmet"],
        label=label_text(fspa, info["unmet"]),
        cause=None if judge is None or info["success"] else judge.verdict(samples).cause,
    )


def episode_seed(seed: int, index: int) -> int:
    """Return the seed, in [0, 2**31), of the environment's reset for episode ``index`` of an evaluation.

    ``seed`` is the seed of the evaluation.
    """
    return int(_stream(seed, index, _OF_LEVEL).generate_state(1)[0]) >> 1


def _stream(seed: int, index: int, purpose: int) -> np.random.SeedSequence:
    return np.random.SeedSequence(seed, spawn_key=(index, purpose))
