"""The setup of an evaluation, and the player that each worker makes to play its episodes."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, Final, Literal, Protocol

import gymnasium

from tltl_runtime.evaluation.play import play
from tltl_runtime.game.episode import Trajectory, trajectory
from tltl_runtime.game.level_name import Variant
from tltl_runtime.game.recorder import EpisodeRecorder
from tltl_runtime.game.registry import game_of
from tltl_runtime.policies.blas_threads import blas_threads
from tltl_runtime.policies.compatibility import check_spaces
from tltl_runtime.policies.policy import Policy
from tltl_runtime.spec.episode_summary import EpisodeSummary
from tltlc.api import EMPTY, Fspa, RewardOptions, record, replace

RecordMode = Literal["none", "failures", "all"]

CHOICES: Final = {True: "sampled", False: "arg-max"}
"""The names of the two ways to choose actions."""

_POLICY: Final = "policy"
"""The first word of the names of all policies."""

_HASH_DIGITS: Final = 8
"""A name has this many digits of the hash of the policy's file."""


@record
class EpisodeRequest:
    """A request to play episode ``index``.

    If ``sampled``, actions are sampled; otherwise the likeliest actions are taken.
    """

    index: int
    sampled: bool = True


@record
class PlayerName:
    """The name that recordings give to the policy of an evaluation.

    ``labels`` say what the policy was trained for, and ``sha256`` is the hash of its file. Both may be
    empty.
    """

    labels: tuple[str, ...] = ()
    sha256: str = ""

    def text(self, request: EpisodeRequest) -> str:
        """Return the name of the player in the recording of an episode."""
        labels = "".join(f" {label}" for label in self.labels)
        return f"{_POLICY}{labels}{self._hash_mark}, {CHOICES[request.sampled]}, episode {request.index}"

    def is_of(self, player: str) -> bool:
        """Whether ``player`` is the name of a policy with this hash, whatever its labels."""
        return player.startswith(_POLICY) and f"{self._hash_mark}, " in player

    @property
    def _hash_mark(self) -> str:
        """The part of a name that shows the hash; empty without a hash."""
        return f" {self.sha256[:_HASH_DIGITS]}" if self.sha256 else ""


def is_labelled_policy(player: str) -> bool:
    """Whether ``player`` is the name of a policy with labels or a hash, as :class:`PlayerName` makes it."""
    return player.startswith(f"{_POLICY} ")


@record
class Setup:
    """The setup of an evaluation: ``policy`` plays a level with a spec and default reward options.

    ``level`` and ``variant`` are arguments of :meth:`~tltl_runtime.game.game.Game.load_level`.
    ``seed`` is the seed of the evaluation. ``params`` are the values of the spec's params, in SI
    units. ``recorded`` says which episodes to record. Unless it is None, the results also have the
    trajectories of all episodes. ``player`` names the policy in recordings.
    """

    policy: Policy
    level: str
    variant: Variant
    fspa: Fspa
    seed: int
    params: Mapping[str, float] = EMPTY
    recorded: RecordMode | None = None
    player: PlayerName = PlayerName()


@record
class PlayedEpisode:
    """A played episode: its request, and its summary.

    If the setup asks for them, there are also its ``trajectory`` and its ``recording``, which has
    the bytes of the file.
    """

    request: EpisodeRequest
    summary: EpisodeSummary
    trajectory: Trajectory | None = None
    recording: bytes = b""


class EpisodePlayer(Protocol):
    """What a worker needs to play episodes, one after the other."""

    def play(self, request: EpisodeRequest) -> PlayedEpisode:
        """Play the requested episode to its end, and return it."""

    def close(self) -> None:
        """Free the environment and its resources."""


class PolicyPlayer:
    """Lets the policy of an evaluation play the requested episodes, one after the other.

    Each player has an environment of its own.

    Raises:
        TltlError: TLT0843, the observations or actions of the environment are not those of the
            policy; the errors of :meth:`~tltl_runtime.game.game.Game.make_env`.
    """

    def __init__(self, setup: Setup) -> None:
        self._setup = setup
        card = setup.policy.card
        self._game = game_of(setup.level)
        self._env: gymnasium.Env[Any, Any] = self._game.make_env(
            setup.level,
            setup.variant,
            setup.fspa,
            sensors=card.sensors,
            reward=RewardOptions(),
            params=setup.params,
        )
        check_spaces(card, self._env.observation_space, self._env.action_space)
        self._recorder: EpisodeRecorder[Any] | None = None
        if setup.recorded is not None:
            self._env = self._recorder = self._game.recorder(self._env)

    def play(self, request: EpisodeRequest) -> PlayedEpisode:
        """Play the requested episode to its end, and return it."""
        setup = self._setup
        # In one thread, equal observations give equal logits on any number of cores.
        with blas_threads(1):
            summary = play(setup.policy, self._env, setup.seed, request.index, request.sampled)
        if self._recorder is None:
            return PlayedEpisode(request, summary)
        episode = replace(self._recorder.episode, player=setup.player.text(request))
        is_recorded = setup.recorded == "all" or (setup.recorded == "failures" and not summary.success)
        recording = self._game.episode_bytes(episode) if is_recorded else b""
        return PlayedEpisode(request, summary, trajectory(episode), recording)

    def close(self) -> None:
        """Free the environment and its resources."""
        self._env.close()
