"""Adapt Gymnasium's vector environments to rsl-rl."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Any

import numpy as np
import torch
from gymnasium import spaces
from numpy.typing import NDArray
from rsl_rl.env import VecEnv
from tensordict import TensorDict
from torch import Tensor

from tltl_runtime.evaluation.clauses import ClauseJudge
from tltl_runtime.policies.spaces.layouts import SpaceLayouts
from tltl_runtime.spec.episode_summary import EpisodeSummary, progress_return, settled_end
from tltl_runtime.training.exploration.action_encoding import ActionEncoding
from tltl_runtime.training.exploration.observation_encoding import ObservationEncoding
from tltl_runtime.training.exploration.replayed_starts import EpisodesInProgress
from tltl_runtime.training.exploration.reverse_curriculum import ReverseCurriculum
from tltl_runtime.training.exploration.search import end_of
from tltl_runtime.training.exploration.self_imitation import SelfImitation
from tltl_runtime.training.imitation.imitation_data import ImitationData
from tltl_runtime.vector import WorkerVectorEnv
from tltl_runtime.wire.lost_episodes import LostEpisodes
from tltl_runtime.wire.surviving_env import LOST, faults_in
from tltlc.api import Diagnostic, TltlError, traces


class TrainingEnv(VecEnv):
    """A vector environment for rsl-rl.

    The environments of ``env`` are :class:`~tltl_runtime.spec.wrapper.TltlEnv`, with ``SAME_STEP``
    autoreset. ``seed`` is the argument of the vector environment's reset: a number, or one for each
    environment.

    An observation has a tensor [num_envs, ...] on ``device`` for each key; rsl-rl calls the keys
    observation groups. ``shapes`` has the shape of each part for one environment. ``layouts`` say
    how observations and actions become arrays. They are None if the network uses these without
    conversion; ``branches`` then has the number of choices of each branch of an action.

    With a ``curriculum``, episodes begin at the starts that it draws, and ``seed`` is not used.
    :meth:`pop_finished` then leaves out the episodes that do not begin at the level's start.

    ``self_imitation`` draws decisions for the runner to imitate; ``imitation_data`` are decisions
    for the algorithm to imitate. ``extra_penalty`` maps the length of a failed episode, in steps,
    to the undiscounted penalty minus the penalty that the environment's reward already contains.
    ``penalty_weight``, in [0, 1] and initially 0, is the share of this difference that is
    subtracted from the reward. ``limit_steps`` is the spec's limit in steps; None if it has no
    limit. ``clause_judge`` says which clauses an episode broke; without it, summaries do not.

    An episode that is lost with its game (:class:`~tltl_runtime.wire.surviving_env.SurvivingEnv`) is
    cut off. It is neither a success nor a failure, so it is not among the finished episodes, and the
    curriculum does not learn from it. ``faults`` says what happened to the games that were lost since
    :meth:`pop_lost` was last called; the list may begin with what happened in a search.

    Raises:
        TypeError: without ``layouts``, the observation space is not a Dict, or the action space is
            not a MultiDiscrete.
    """

    def __init__(
        self,
        env: WorkerVectorEnv,
        seed: int | Sequence[int],
        device: str = "cpu",
        curriculum: ReverseCurriculum | None = None,
        self_imitation: SelfImitation | None = None,
        imitation_data: ImitationData | None = None,
        extra_penalty: Callable[[int], float] | None = None,
        limit_steps: int | None = None,
        layouts: SpaceLayouts | None = None,
        faults: list[Diagnostic] | None = None,
        clause_judge: ClauseJudge | None = None,
    ) -> None:
        self.shapes, self.branches = _plain_shapes(env) if layouts is None else (layouts.shapes, ())
        self.env = env
        self.layouts = layouts
        self.num_envs = env.num_envs
        self._actions, self._encoding = ActionEncoding(env.single_action_space), ObservationEncoding(layouts)
        self.num_actions = self._actions.layout.width
        self.device = device
        self.curriculum = curriculum
        self.self_imitation = self_imitation
        self.imitation_data = imitation_data
        self._extra_penalty = extra_penalty
        self.penalty_weight = 0.0
        self.cfg: dict[str, Any] = {}
        # rsl-rl must not cut off episodes: the spec's limit ends them.
        self.max_episode_length = 2**31
        self.episode_length_buf = torch.zeros(self.num_envs, dtype=torch.long)
        self._replayed_before = 0
        self.faults: list[Diagnostic] = [] if faults is None else faults
        self._episodes = EpisodesInProgress(env, curriculum.draw, self.faults) if curriculum else None
        self._finished: list[EpisodeSummary] = []
        if self._episodes:
            self._observation = self._tensors(self._episodes.observation)
        else:
            observation, infos = env.reset(seed=seed)
            self.faults += faults_in(infos)
            self._observation = self._tensors(observation)
        self._limit_steps, self._clause_judge = limit_steps, clause_judge
        self._episode_count = 0

    def get_observations(self) -> TensorDict:
        """Return the current observations of all environments."""
        return self._observation

    def step(self, actions: Tensor) -> tuple[TensorDict, Tensor, Tensor, dict[str, Any]]:
        """Step all environments with actions [num_envs, width], as the policy's network outputs them.

        Continuous numbers in the actions are squashed to their bounds first. Return observations,
        rewards [num_envs], bools [num_envs] that say which episodes are over, and extras. The
        extras are bools [num_envs]: ``time_outs`` says which episodes ended at a limit or were cut
        off, ``successes`` which met the spec.

        Raises:
            TltlError: TLT0866, an action is not finite.
        """
        rows = self._rows(actions)
        results = self._episodes.step(rows) if self._episodes else self.env.step(self._actions.values(rows))
        observation, reward, terminated, truncated, infos = results
        is_over = terminated | truncated
        played = _played(infos, is_over)
        summaries = self._summaries(infos["final_info"], played) if played.size else {}
        if not self._episodes:
            self.faults += faults_in(infos)
        successes = torch.zeros(self.num_envs, dtype=torch.bool)
        for row, episode in summaries.items():
            successes[row] = episode.success
            if self._extra_penalty and not episode.success:
                reward[row] -= self.penalty_weight * self._extra_penalty(self._episode_steps(row, episode))
        if self._episodes and self.curriculum:
            ends = {row: end_of(infos["final_info"], row) for row, episode in summaries.items() if episode.success}
            states = {row: episode.unmet for row, episode in summaries.items()}
            cut = _update_curriculum(self.curriculum, self._episodes, played, is_over, ends, states)
            summaries = {
                row: episode for row, episode in summaries.items() if self._episodes.starts[row].segment is None
            }
            self._episodes.start_next(is_over)
            if cut.any():
                observation = self._episodes.cut_off(cut)
                is_over, truncated = is_over | cut, truncated | cut
        self._finished += summaries.values()
        self._observation = self._tensors(observation)
        return (
            self._observation,
            torch.from_numpy(reward).to(self.device, torch.float32),
            torch.from_numpy(is_over).to(self.device),
            {"time_outs": torch.from_numpy(truncated).to(self.device), "successes": successes.to(self.device)},
        )

    @property
    def replayed(self) -> int:
        """The number of decisions that were replayed to reach the starts of episodes."""
        return self._replayed_before + (self._episodes.replayed if self._episodes else 0)

    def restart_episodes(self) -> None:
        """Begin new episodes in all environments, for example after a search has used them."""
        if self._episodes and self.curriculum:
            self._replayed_before += self._episodes.replayed
            self._episodes = EpisodesInProgress(self.env, self.curriculum.draw, self.faults)
            observation = self._episodes.observation
        else:
            observation, infos = self.env.reset()
            self.faults += faults_in(infos)
        self._observation = self._tensors(observation)

    def pop_finished(self) -> tuple[EpisodeSummary, ...]:
        """Return the summaries of the episodes that ended since the last call, in order of their ends."""
        summaries, self._finished = tuple(self._finished), []
        return summaries

    def pop_lost(self) -> LostEpisodes | None:
        """Return the number of episodes that were lost with their games since the last call; None without any."""
        lost = LostEpisodes(len(self.faults), self.faults[0]) if self.faults else None
        # A search and the episodes in progress add to the same list.
        self.faults.clear()
        return lost

    def _summaries(self, infos: Mapping[str, Any], rows: NDArray[np.int64]) -> dict[int, EpisodeSummary]:
        """Return the summaries of the episodes that ended in these rows, by row."""
        summaries = _summaries(infos, rows, self._episode_count, self._limit_steps, self._clause_judge)
        self._episode_count += len(summaries)
        return summaries

    def _episode_steps(self, row: int, episode: EpisodeSummary) -> int:
        """Return the number of steps of the episode that ended in this row, including replayed steps."""
        return len(self._episodes.actions[row]) if self._episodes else episode.steps

    def _tensors(self, observation: Any) -> TensorDict:
        return self._encoding.batch(observation, self.num_envs, self.device)

    def _rows(self, actions: Tensor) -> NDArray[Any]:
        """Convert actions to a NumPy array [num_envs, width]; raise TltlError, TLT0866, if one is not finite."""
        try:
            return self._actions.rows(actions.cpu().numpy())
        except ValueError as error:
            help_ = "train again with a smaller `learning_rate` or `max_gradient`"
            raise TltlError([Diagnostic("TLT0866", f"the training has diverged: {error}", help=help_)]) from None


def _played(infos: Mapping[str, Any], is_over: NDArray[np.bool_]) -> NDArray[np.int64]:
    """Return the rows of the episodes that are over, without those that were lost with their games."""
    lost = infos.get("final_info", {}).get(LOST)
    return np.flatnonzero(is_over if lost is None else is_over & ~lost)


def _plain_shapes(env: WorkerVectorEnv) -> tuple[dict[str, tuple[int, ...]], tuple[int, ...]]:
    """Return the shapes of an observation's parts by key, and the number of choices of each branch of an action.

    Raises TypeError if the observation space is not a Dict, or the action space not a
    MultiDiscrete.
    """
    observation, action = env.single_observation_space, env.single_action_space
    if not isinstance(action, spaces.MultiDiscrete):
        raise TypeError(f"the action space must be a MultiDiscrete, not {action}")
    if not isinstance(observation, spaces.Dict):
        raise TypeError(f"the observation space must be a Dict, not {observation}")
    return {key: tuple(space.shape or ()) for key, space in observation.items()}, tuple(map(int, action.nvec))


def _update_curriculum(
    curriculum: ReverseCurriculum,
    episodes: EpisodesInProgress,
    played: NDArray[np.int64],
    is_over: NDArray[np.bool_],
    ends: Mapping[int, int],
    states: Mapping[int, int],
) -> NDArray[np.bool_]:
    """Update the curriculum with all episodes that were played or have reached their limit of decisions.

    ``played`` are the environments whose episodes are over, without those that were lost, and
    ``is_over`` [num_envs] is the mask of all whose episodes are over. ``ends`` maps the index of each
    environment whose episode met the spec to the atoms that were true at the end
    (:func:`~tltl_runtime.training.exploration.search.end_of`). ``states`` maps the index of each
    environment in ``played`` to the automaton state in which its episode ended. Return the mask
    [num_envs] of the episodes that have reached their limit of decisions, and that the caller must
    cut off.
    """
    used_up = np.array([episodes.is_spent(row) for row in range(len(is_over))]) & ~is_over
    for row in [*played.tolist(), *np.flatnonzero(used_up).tolist()]:
        curriculum.record_episode(episodes.starts[row], episodes.actions[row], ends.get(row), states.get(row))
    return used_up


def _summaries(
    infos: Mapping[str, Any],
    rows: NDArray[np.int64],
    first_index: int,
    limit_steps: int | None,
    judge: ClauseJudge | None,
) -> dict[int, EpisodeSummary]:
    """Return the summaries of the episodes that ended in the environments ``rows``, by row.

    ``infos`` is the ``final_info`` of the vector environment. The first summary gets the index
    ``first_index``, each later one the next number.
    """
    lengths = infos["episode"]["l"]
    return {
        row: _summary(infos, row, index, int(lengths[row]), limit_steps, judge)
        for index, row in enumerate(rows.tolist(), start=first_index)
    }


def _summary(
    infos: Mapping[str, Any], row: int, index: int, steps: int, limit_steps: int | None, judge: ClauseJudge | None
) -> EpisodeSummary:
    success, progress = bool(infos["success"][row]), float(infos["progress"][row])
    return EpisodeSummary(
        index=index,
        seed=None,
        success=success,
        end=settled_end(success, infos["verdict"][row]),
        progress=progress,
        reward=progress_return(success, progress, steps, limit_steps),
        steps=steps,
        unmet=int(infos["unmet"][row]),
        cause=_cause(infos, row, steps, judge),
    )


def _cause(infos: Mapping[str, Any], row: int, steps: int, judge: ClauseJudge | None) -> traces.RejectionCause | None:
    """Return which clauses the last sample of an episode broke; None if it broke none, or nobody judges."""
    if judge is None or infos["verdict"][row] != "violated":
        return None
    atoms = {atom.name: float(infos["atoms"][atom.name][row]) for atom in judge.fspa.atoms}
    return traces.RejectionCause("broken", steps, judge.broken(atoms))
