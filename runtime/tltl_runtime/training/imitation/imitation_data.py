"""What an agent imitates: the decisions of demonstrations, with what it would have sensed before each."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from pathlib import Path
from typing import Any

import numpy as np
import torch
from numpy.typing import NDArray
from tensordict import TensorDict
from torch import Tensor

from tltl_runtime.policies.identity import level_hash
from tltl_runtime.spec.wrapper import TltlEnv
from tltl_runtime.stealth.recording import RecordEpisode
from tltl_runtime.stealth.recordings.episode import Episode
from tltl_runtime.stealth.recordings.file import read_episode
from tltl_runtime.training.imitation.demonstrations import (
    PLAYER,
    Demonstrations,
    Tried,
    by_expert,
    recordings,
    unreadable,
)
from tltlc.core.record import record
from tltlc.diagnostics.diagnostic import Diagnostic, TltlError

_Sensed = Mapping[str, NDArray[Any]]


@record
class Imitated:
    """What is imitated, in numbers: ``episodes`` that meet the spec, ``decisions`` in them, the ``players``.

    ``left_out`` are the names of the other recordings in the folder, each with the reason.
    """

    episodes: int
    decisions: int
    players: tuple[str, ...]
    left_out: tuple[str, ...]


@record
class Demonstrated:
    """All decisions: ``observations`` [n] as the environments give them, float32, and ``actions`` [n, branches]."""

    observations: TensorDict
    actions: Tensor
    about: Imitated

    def rows(self, chosen: Tensor) -> tuple[TensorDict, Tensor]:
        """The observations and actions of some decisions."""
        return self.observations[chosen], self.actions[chosen]

    def drawn(self, count: int) -> tuple[TensorDict, Tensor]:
        """Decisions drawn with torch's generator, each as likely, the same one more than once perhaps."""
        return self.rows(torch.randint(len(self.actions), (count,)))

    def shuffled(self, size: int) -> Iterator[tuple[TensorDict, Tensor]]:
        """All decisions once in an order drawn with torch's generator, ``size`` at a time, the last ones fewer."""
        for chosen in torch.randperm(len(self.actions)).split(size):
            yield self.rows(chosen)

    def to(self, device: str) -> Demonstrated:
        """The same on a device."""
        return Demonstrated(self.observations.to(device), self.actions.to(device), self.about)


def record_expert(folder: Path, number: int, make: Callable[[], TltlEnv], told: Callable[[Tried], None]) -> None:
    """Record the expert's demonstrations that ``folder`` lacks of a ``number``; errors as of :func:`by_expert`."""
    env = RecordEpisode(make(), PLAYER)
    try:
        made = Demonstrations(folder, env.get_wrapper_attr("level"), env.get_wrapper_attr("task"))
        for tried in by_expert(env, made, number):
            told(tried)
    finally:
        env.close()


def read_demonstrations(folder: Path, make: Callable[[], TltlEnv]) -> Demonstrated:
    """The demonstrations in a folder, each played again in the environment that ``make`` makes.

    One is left out whose level is another, that does not meet the spec when it is played again, or that cannot be read.

    Raises:
        TltlError: TLT0921, none is left.
    """
    env = make()
    along: list[_Sensed] = []
    actions: list[NDArray[np.uint8]] = []
    players: set[str] = set()
    left_out: list[str] = []
    try:
        for path in recordings(folder):
            try:
                episode = read_episode(path)
            except TltlError as error:
                left_out.append(f"{path.name}: {unreadable(error)}")
                continue
            found = _sensed(env, episode)
            if isinstance(found, str):
                left_out.append(f"{path.name}: {found}")
                continue
            along += found
            actions.append(episode.actions)
            players.add(episode.player)
    finally:
        env.close()
    if not actions:
        raise nothing_to_imitate(folder, left_out)
    observations = {name: torch.from_numpy(np.stack([each[name] for each in along])).float() for name in along[0]}
    return Demonstrated(
        TensorDict(observations, batch_size=[len(along)]),
        torch.from_numpy(np.concatenate(actions)).float(),
        Imitated(len(actions), len(along), tuple(sorted(players)), tuple(left_out)),
    )


def nothing_to_imitate(folder: Path, left_out: list[str]) -> TltlError:
    """TLT0921: a folder has no demonstration, and why its recordings are none."""
    title = f"there is nothing to imitate in `{folder}`: "
    if left_out:
        more = f", and {len(left_out) - 1} more" if len(left_out) > 1 else ""
        title += f"{left_out[0]}{more}"
    else:
        title += "it holds no recording" if folder.is_dir() else "there is no such folder"
    help_ = "`tltlc record` makes demonstrations; without --demonstrations the expert's are recorded first"
    return TltlError([Diagnostic("TLT0921", title, help=help_)])


def _sensed(env: TltlEnv, episode: Episode) -> list[_Sensed] | str:
    """What is sensed before each decision of an episode that is played again; where it is no demonstration, why."""
    if level_hash(episode.level) != level_hash(env.get_wrapper_attr("level")):
        return f"it is of another level, `{episode.level.name}:{episode.level.variant}` as it was then"
    observation, info = env.reset(seed=episode.seed)
    along: list[_Sensed] = []
    over = False
    for action in episode.actions.tolist():
        if over:
            break
        along.append(observation)
        observation, _, terminated, truncated, info = env.step(action)
        over = terminated or truncated
    spec = env.task.fspa.name
    return along if over and info["success"] and len(along) == len(episode.actions) else f"it does not meet `{spec}`"
