"""The data to imitate: the decisions of demonstrations, each with the observation before it."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
import torch
from numpy.typing import NDArray
from tensordict import TensorDict
from torch import Tensor

from tltl_runtime.game.episode import RecordedEpisode
from tltl_runtime.game.recorder import EpisodeRecorder, closing_on_error
from tltl_runtime.policies.spaces.layouts import SpaceLayouts
from tltl_runtime.policies.spaces.values import unsquashed
from tltl_runtime.spec.wrapper import TltlEnv
from tltl_runtime.training.exploration.action_encoding import ActionEncoding
from tltl_runtime.training.exploration.observation_encoding import ObservationEncoding
from tltl_runtime.training.imitation.demonstrations import (
    PLAYER,
    Attempt,
    Demonstrations,
    ImitationSummary,
    error_text,
    expert_attempts,
    recordings,
)
from tltlc.api import Diagnostic, TltlError, record


@record
class ImitationData:
    """The n decisions of all demonstrations.

    ``observations`` has tensors [n, ...] by key: the observation before each decision. ``actions``
    is [n, width]: the choices of each action, and then its continuous numbers, as the policy's
    network outputs them, before they are squashed to their bounds.
    """

    observations: TensorDict
    actions: Tensor
    summary: ImitationSummary

    def rows(self, indices: Tensor) -> tuple[TensorDict, Tensor]:
        """Return the observations and actions of the decisions at ``indices`` [k]."""
        return self.observations[indices], self.actions[indices]

    def sample(self, count: int) -> tuple[TensorDict, Tensor]:
        """Draw ``count`` decisions uniformly with replacement; return their observations and actions.

        The random numbers are from torch's default generator.
        """
        return self.rows(torch.randint(len(self.actions), (count,)))

    def shuffled_batches(self, size: int) -> Iterator[tuple[TensorDict, Tensor]]:
        """Yield all decisions once, in random order, in batches of ``size``; the last may be smaller.

        The random numbers are from torch's default generator.
        """
        for indices in torch.randperm(len(self.actions)).split(size):
            yield self.rows(indices)

    def to(self, device: str) -> ImitationData:
        """Return a copy on a torch device, such as ``cuda:0``."""
        return ImitationData(self.observations.to(device), self.actions.to(device), self.summary)


def record_expert(folder: Path, number: int, make: Callable[[], TltlEnv], report: Callable[[Attempt], None]) -> None:
    """Let the expert play and record until ``folder`` contains ``number`` demonstrations.

    ``make`` returns a new environment. ``report`` is called with each attempt. Raises the errors of
    :func:`~tltl_runtime.training.imitation.demonstrations.expert_attempts`.
    """
    judged = make()
    recorder = judged.get_wrapper_attr("level").game.recorder
    env: EpisodeRecorder[Any] = closing_on_error(judged, partial(recorder, player=PLAYER))
    try:
        demonstrations = Demonstrations(folder, env.get_wrapper_attr("level"), env.get_wrapper_attr("task"))
        for attempt in expert_attempts(env, demonstrations, number):
            report(attempt)
    finally:
        env.close()


def read_demonstrations(
    folder: Path, make: Callable[[], TltlEnv], layouts: SpaceLayouts | None = None
) -> ImitationData:
    """Read the demonstrations in a folder; replay each to get its observations.

    ``make`` returns a new environment. ``layouts`` say how its observations and actions become
    arrays; None if the network uses them without conversion.

    A recording is left out if it is of another level, does not meet the spec in the replay, or
    cannot be read.

    Raises:
        TltlError: TLT0921, no demonstration remains.
    """
    env = make()
    game = env.get_wrapper_attr("level").game
    observed: list[Any] = []
    actions: list[NDArray[Any]] = []
    players: set[str] = set()
    left_out: list[str] = []
    try:
        for path in recordings(folder):
            try:
                episode = game.read_episode(path)
            except TltlError as error:
                left_out.append(f"{path.name}: {error_text(error)}")
                continue
            result = _replayed_observations(env, episode, layouts)
            if isinstance(result, str):
                left_out.append(f"{path.name}: {result}")
                continue
            observed += result
            actions.append(episode.actions)
            players.add(episode.player)
    finally:
        env.close()
    if not actions:
        raise nothing_to_imitate(folder, left_out)
    encoding = ObservationEncoding(layouts)
    rows = np.concatenate(actions)
    return ImitationData(
        encoding.tensors(encoding.stacked(observed)),
        torch.from_numpy(rows if layouts is None else unsquashed(layouts.action, rows)).float(),
        ImitationSummary(len(actions), len(observed), tuple(sorted(players)), tuple(left_out)),
    )


def nothing_to_imitate(folder: Path, left_out: list[str]) -> TltlError:
    """Return error TLT0921: no recording in a folder is a demonstration.

    ``left_out`` has a text ``FILE: REASON`` for each recording; the message shows the first.
    """
    title = f"there is nothing to imitate in `{folder}`: "
    if left_out:
        rest = f", and {len(left_out) - 1} more" if len(left_out) > 1 else ""
        title += f"{left_out[0]}{rest}"
    else:
        title += "it contains no recording" if folder.is_dir() else "there is no such folder"
    help_ = (
        "record demonstrations with `tltlc record`; without --demonstrations, those of the expert are recorded first"
    )
    if not left_out and any(folder.glob("*.tape.jsonl*")):
        title += ", only tapes"
        help_ = "play the tapes again, so that they become demonstrations: `tltlc record LEVEL --tape FILE --out DIR`"
    return TltlError([Diagnostic("TLT0921", title, help=help_)])


def _replayed_observations(env: TltlEnv, episode: RecordedEpisode, layouts: SpaceLayouts | None) -> list[Any] | str:
    """Replay an episode; return the observation before each decision.

    If the episode does not count as a demonstration, return the reason instead.
    """
    level = env.get_wrapper_attr("level")
    if episode.level.game is not level.game or level.game.level_hash(episode.level) != level.game.level_hash(level):
        return f"it is of another level, `{episode.level.name}:{episode.level.variant}` as it was then"
    observation, info = env.reset(seed=episode.seed)
    encoding = ActionEncoding(env.action_space)
    actions = episode.actions.tolist() if layouts is None else map(encoding.value, episode.actions)
    observed: list[Any] = []
    is_over = False
    for action in actions:
        if is_over:
            break
        observed.append(observation)
        observation, _, terminated, truncated, info = env.step(action)
        is_over = terminated or truncated
    spec = env.task.fspa.name
    return (
        observed
        if is_over and info["success"] and len(observed) == len(episode.actions)
        else f"it does not meet `{spec}`"
    )
