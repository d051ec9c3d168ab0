"""The data to imitate: decisions of demonstrations, each with the agent's observation before it."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from pathlib import Path
from typing import Any

import numpy as np
import torch
from numpy.typing import NDArray
from tensordict import TensorDict
from torch import Tensor

from tltl_runtime.game.episode import RecordedEpisode
from tltl_runtime.game.registry import registered_game
from tltl_runtime.spec.wrapper import TltlEnv
from tltl_runtime.training.imitation.demonstrations import (
    PLAYER,
    Demonstrations,
    Tried,
    by_expert,
    recordings,
    unreadable,
)
from tltlc.api import Diagnostic, TltlError, record

_Sensed = Mapping[str, NDArray[Any]]


@record
class Imitated:
    """The numbers of ``episodes`` and ``decisions`` of demonstrations, and their ``players``.

    ``left_out`` are the names of the other recordings in the folder, each with the reason.
    """

    episodes: int
    decisions: int
    players: tuple[str, ...]
    left_out: tuple[str, ...]


@record
class Demonstrated:
    """All decisions of the demonstrations.

    ``observations`` [n] are those of the environment as float32, ``actions`` is [n, branches].
    """

    observations: TensorDict
    actions: Tensor
    about: Imitated

    def rows(self, chosen: Tensor) -> tuple[TensorDict, Tensor]:
        """Return the observations and actions of the decisions at some indices."""
        return self.observations[chosen], self.actions[chosen]

    def drawn(self, count: int) -> tuple[TensorDict, Tensor]:
        """Draw decisions uniformly with replacement, with torch's generator."""
        return self.rows(torch.randint(len(self.actions), (count,)))

    def shuffled(self, size: int) -> Iterator[tuple[TensorDict, Tensor]]:
        """Yield all decisions once, in random order by torch's generator, in batches of ``size``.

        The last batch may be smaller.
        """
        for indices in torch.randperm(len(self.actions)).split(size):
            yield self.rows(indices)

    def to(self, device: str) -> Demonstrated:
        """Return a copy on a device."""
        return Demonstrated(self.observations.to(device), self.actions.to(device), self.about)


def record_expert(folder: Path, number: int, make: Callable[[], TltlEnv], report: Callable[[Tried], None]) -> None:
    """Record demonstrations of the expert until ``folder`` has ``number``.

    ``report`` is called with each attempt.  Raises the errors of :func:`by_expert`.
    """
    env = registered_game().recorder(make(), PLAYER)
    try:
        demonstrations = Demonstrations(folder, env.get_wrapper_attr("level"), env.get_wrapper_attr("task"))
        for tried in by_expert(env, demonstrations, number):
            report(tried)
    finally:
        env.close()


def read_demonstrations(folder: Path, make: Callable[[], TltlEnv]) -> Demonstrated:
    """Read the demonstrations in a folder; replay each one in an environment from ``make``.

    A recording is left out if it is of another level, does not meet the spec in the replay, or
    cannot be read.

    Raises:
        TltlError: TLT0921, no demonstration remains.
    """
    game, env = registered_game(), make()
    sensed: list[_Sensed] = []
    actions: list[NDArray[np.uint8]] = []
    players: set[str] = set()
    left_out: list[str] = []
    try:
        for path in recordings(folder):
            try:
                episode = game.read_episode(path)
            except TltlError as error:
                left_out.append(f"{path.name}: {unreadable(error)}")
                continue
            replayed = _sensed(env, episode)
            if isinstance(replayed, str):
                left_out.append(f"{path.name}: {replayed}")
                continue
            sensed += replayed
            actions.append(episode.actions)
            players.add(episode.player)
    finally:
        env.close()
    if not actions:
        raise nothing_to_imitate(folder, left_out)
    observations = {
        name: torch.from_numpy(np.stack([observation[name] for observation in sensed])).float() for name in sensed[0]
    }
    return Demonstrated(
        TensorDict(observations, batch_size=[len(sensed)]),
        torch.from_numpy(np.concatenate(actions)).float(),
        Imitated(len(actions), len(sensed), tuple(sorted(players)), tuple(left_out)),
    )


def nothing_to_imitate(folder: Path, left_out: list[str]) -> TltlError:
    """Return error TLT0921: a folder has no demonstration.  It says why its recordings are none."""
    title = f"there is nothing to imitate in `{folder}`: "
    if left_out:
        rest = f", and {len(left_out) - 1} more" if len(left_out) > 1 else ""
        title += f"{left_out[0]}{rest}"
    else:
        title += "it holds no recording" if folder.is_dir() else "there is no such folder"
    help_ = "`tltlc record` makes demonstrations; without --demonstrations the expert's are recorded first"
    return TltlError([Diagnostic("TLT0921", title, help=help_)])


def _sensed(env: TltlEnv, episode: RecordedEpisode) -> list[_Sensed] | str:
    """Replay an episode; return the observation before each decision, or why it does not count."""
    hash_of = registered_game().level_hash
    if hash_of(episode.level) != hash_of(env.get_wrapper_attr("level")):
        return f"it is of another level, `{episode.level.name}:{episode.level.variant}` as it was then"
    observation, info = env.reset(seed=episode.seed)
    sensed: list[_Sensed] = []
    over = False
    for action in episode.actions.tolist():
        if over:
            break
        sensed.append(observation)
        observation, _, terminated, truncated, info = env.step(action)
        over = terminated or truncated
    spec = env.task.fspa.name
    return sensed if over and info["success"] and len(sensed) == len(episode.actions) else f"it does not meet `{spec}`"
