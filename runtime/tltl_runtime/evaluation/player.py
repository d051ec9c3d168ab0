"""The setup of an evaluation, and the object with which each worker plays its episodes."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, Final, Literal, Protocol

import gymnasium

from tltl_runtime.evaluation.clauses import ClauseJudge
from tltl_runtime.evaluation.play import episode_seed, play
from tltl_runtime.game.episode import Trajectory, trajectory
from tltl_runtime.game.level_name import Variant
from tltl_runtime.game.recorder import EpisodeRecorder
from tltl_runtime.game.registry import game_of
from tltl_runtime.policies.blas_threads import blas_threads
from tltl_runtime.policies.compatibility import check_spaces, other_clock_error
from tltl_runtime.policies.policy import Policy
from tltl_runtime.spec.episode_summary import EpisodeSummary
from tltl_runtime.spec.wrapper import TltlEnv
from tltl_runtime.wire.errors import WireError
from tltlc.api import EMPTY, Diagnostic, Fspa, RewardOptions, TltlError, record, replace

RecordMode = Literal["none", "failures", "all"]

CHOICES: Final = {True: "sampled", False: "arg-max"}
"""The names of the two ways to choose actions."""

_POLICY: Final = "policy"
"""The first word of the name of every policy in recordings."""

_OTHER_CLOCK: Final = "TLT0617"
"""The code of the error of an environment whose clock is not that of its spec."""

_HASH_DIGITS: Final = 8
"""The name of a policy in recordings has this many digits of the hash of its file."""


@record
class EpisodeRequest:
    """A request to play episode ``index`` of an evaluation.

    If ``sampled``, actions are sampled; otherwise the likeliest actions are taken.
    """

    index: int
    sampled: bool = True


@record
class PlayerName:
    """The parts of the name that recordings give to the policy of an evaluation.

    ``labels`` say what the policy was trained for, and ``sha256`` is the hash of its file. Both may be
    empty.
    """

    labels: tuple[str, ...] = ()
    sha256: str = ""

    def text(self, request: EpisodeRequest) -> str:
        """Return the name for the recording of an episode: ``policy LABEL 0123abcd, sampled, episode 3``."""
        labels = "".join(f" {label}" for label in self.labels)
        return f"{_POLICY}{labels}{self._hash_mark}, {CHOICES[request.sampled]}, episode {request.index}"

    def is_of(self, player: str) -> bool:
        """Whether ``player`` is a name of a policy with this hash, whatever its labels.

        Without a hash, every name of a policy counts.
        """
        return player.startswith(_POLICY) and f"{self._hash_mark}, " in player

    @property
    def _hash_mark(self) -> str:
        """The part of the name that shows the hash, `` 0123abcd``; empty without a hash."""
        return f" {self.sha256[:_HASH_DIGITS]}" if self.sha256 else ""


def is_labelled_policy(player: str) -> bool:
    """Whether ``player`` is a name from :class:`PlayerName` that has labels or a hash."""
    return player.startswith(f"{_POLICY} ")


@record
class Setup:
    """The setup of an evaluation: ``policy`` plays a level, and the spec ``fspa`` judges the episodes.

    ``level`` and ``variant`` are arguments of :meth:`~tltl_runtime.game.game.Game.load_level`.
    ``seed`` is the seed of the evaluation. ``params`` are the values of the spec's params, in SI
    units. ``recorded`` says which episodes to record. If it is None, the results have neither
    recordings nor trajectories; otherwise, they have the trajectories of all episodes. ``player``
    names the policy in recordings. ``clause_judge`` judges failed episodes by the clauses of the spec; if
    it is None, summaries do not name clauses. The rewards are those of the default :class:`RewardOptions`.
    """

    policy: Policy
    level: str
    variant: Variant
    fspa: Fspa
    seed: int
    params: Mapping[str, float] = EMPTY
    recorded: RecordMode | None = None
    player: PlayerName = PlayerName()
    clause_judge: ClauseJudge | None = None


@record
class PlayedEpisode:
    """A played episode: its request and its summary.

    ``recording`` has the bytes of a file with the episode. Unless the setup asks for them,
    ``trajectory`` is None and ``recording`` is empty.
    """

    request: EpisodeRequest
    summary: EpisodeSummary
    trajectory: Trajectory | None = None
    recording: bytes = b""


@record
class LostEpisode:
    """A requested episode that was lost with its game, which ran in another process.

    It is neither a success nor a failure. ``seed`` is the seed of the environment's reset, and ``fault``
    says what happened to the game.
    """

    request: EpisodeRequest
    seed: int
    fault: Diagnostic


class EpisodePlayer(Protocol):
    """The interface of an object with which a worker plays episodes, one after the other."""

    def play(self, request: EpisodeRequest) -> PlayedEpisode | LostEpisode:
        """Play the requested episode to its end, and return it."""

    def close(self) -> None:
        """Close the environment."""


class PolicyPlayer:
    """Plays the requested episodes of an evaluation with its policy, one after the other.

    Each instance has an environment of its own.

    Raises:
        TltlError: TLT0843, the observations or actions of the environment, or its clock, are not those of the
            policy; the errors of :meth:`~tltl_runtime.game.game.Game.make_env`.
    """

    def __init__(self, setup: Setup) -> None:
        self._setup = setup
        card = setup.policy.card
        self._game = game_of(setup.level)
        self._env: gymnasium.Env[Any, Any] = self._made_env()
        self._judge = setup.clause_judge.judge() if setup.clause_judge else None
        self._recorder: EpisodeRecorder[Any] | None = None
        try:
            check_spaces(card, self._env.observation_space, self._env.action_space)
            if setup.recorded is not None:
                self._env = self._recorder = self._game.recorder(self._env)
        except BaseException:
            self._env.close()
            raise

    def _made_env(self) -> TltlEnv:
        setup, card = self._setup, self._setup.policy.card
        try:
            return self._game.make_env(
                setup.level,
                setup.variant,
                setup.fspa,
                sensors=card.sensors,
                reward=RewardOptions(),
                params=setup.params,
            )
        except TltlError as error:
            # The spec has the clock of the training: `set_up` has checked that.
            if any(diagnostic.code == _OTHER_CLOCK for diagnostic in error.diagnostics):
                level = self._game.load_level(setup.level, setup.variant)
                raise other_clock_error(card, level) from error
            raise

    def play(self, request: EpisodeRequest) -> PlayedEpisode | LostEpisode:
        """Play the requested episode to its end, and return it.

        If its game is lost, return a :class:`LostEpisode`; the next episode starts the game again.
        """
        setup = self._setup
        try:
            # In one thread, equal observations give equal logits on any number of cores.
            with blas_threads(1):
                summary = play(setup.policy, self._env, setup.seed, request.index, request.sampled, self._judge)
        except WireError as error:
            return LostEpisode(request, episode_seed(setup.seed, request.index), error.diagnostics[0])
        if self._recorder is None:
            return PlayedEpisode(request, summary)
        episode = replace(self._recorder.episode, player=setup.player.text(request))
        is_recorded = setup.recorded == "all" or (setup.recorded == "failures" and not summary.success)
        recording = self._game.episode_bytes(episode) if is_recorded else b""
        return PlayedEpisode(request, summary, trajectory(episode), recording)

    def close(self) -> None:
        """Close the environment."""
        self._env.close()
