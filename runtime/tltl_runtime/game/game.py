"""The interface of a game for training, evaluation and regression tests."""

from __future__ import annotations

import os
from abc import ABC, abstractmethod
from collections.abc import Iterable, Iterator, Mapping
from pathlib import Path
from typing import Any, Final, Generic

import gymnasium

from tltl_runtime.game.capability_error import no_expert_error
from tltl_runtime.game.episode import Cause
from tltl_runtime.game.episode_summary import summary_of
from tltl_runtime.game.films import Films
from tltl_runtime.game.geometry import Box, Point
from tltl_runtime.game.keyboard import Keyboard
from tltl_runtime.game.level import UnreachableEntity
from tltl_runtime.game.level_check import LevelCheck
from tltl_runtime.game.level_files import LevelFiles, LevelT
from tltl_runtime.game.level_maps import LevelMaps
from tltl_runtime.game.level_name import Variant, parse_variant
from tltl_runtime.game.pictures import Pictures
from tltl_runtime.game.recorder import EpisodeRecorder, EpisodeT
from tltl_runtime.game.recording_summary import GameFigures
from tltl_runtime.game.sensors import SensorChoice, Sensors
from tltl_runtime.spec.episode_summary import EpisodeSummary
from tltl_runtime.spec.wrapper import TltlEnv
from tltlc.api import EMPTY, Diagnostic, Fspa, RewardOptions, TltlError

SHOWN_EPISODES: Final = 10
"""The most episodes from which reports learn what the files of a level do not say (:meth:`Game.played_level`)."""


class Game(ABC, Generic[LevelT, EpisodeT]):
    """A game with levels of type ``LevelT`` and recorded episodes of type ``EpisodeT``.

    A game implements the abstract methods. The other methods are optional: the defaults are those of a
    game that does not offer the feature. An instance has no state, so that its methods can be sent to
    other processes.
    """

    choices: Mapping[str, tuple[str, ...]] = EMPTY
    """The branches of an action by name, each with the names of its choices: ``{"jump": ("no", "yes")}``.

    An action makes one choice in each branch. By default empty: the actions of the game have no
    names.
    """

    level_files: LevelFiles[LevelT]
    """Finds and reads the files of levels."""

    pictures: Pictures[LevelT, EpisodeT] | None = None
    """Draws episodes; None if the game draws none."""

    maps: LevelMaps[LevelT, EpisodeT] | None = None
    """Draws maps of levels with bounds, for pages; None if the game has none."""

    films: Films[EpisodeT] | None = None
    """Draws films of episodes; None if the game has none."""

    keyboard: Keyboard[EpisodeT] | None = None
    """Lets a person play; None if only programs can play."""

    recordings_have_levels: bool = True
    """Whether a recording contains all that is needed to play it again; if not, :meth:`located` adds the rest."""

    promises_replays: bool = True
    """Whether equal seeds and actions give equal episodes in every level; if not, a training measures it."""

    modules: tuple[str, ...]
    """The modules that a process needs to play.

    A fork server imports them once. The worker processes that it starts then have them already.
    """

    @property
    def branches(self) -> tuple[int, ...]:
        """The number of choices in each branch of an action.

        ``choices`` explains branches and choices.
        """
        return tuple(map(len, self.choices.values()))

    # --- levels ------------------------------------------------------------------------------------

    @abstractmethod
    def load_level(self, name: str, variant: str | Variant = "v0") -> LevelT:
        """Load a level in one of its variants; ``name`` may be the path of a file.

        ``variant`` may be a text such as ``v0`` or ``v0+OVERLAY``, as in arguments of commands.

        Raises:
            TltlError: there is no such level or variant, or its file is invalid.
        """

    @abstractmethod
    def level_hash(self, level: LevelT) -> str:
        """Return the SHA-256, in hexadecimal, of everything in a level that can change an episode."""

    def installed_code(self, level: LevelT) -> str:
        """Return a hash of the installed code that plays a level and that its hash does not cover; empty without any.

        The hash may differ on another machine, where the code does the same.
        """
        del level
        return ""

    def params(self, level: LevelT) -> dict[str, float]:
        """Return the values that a level gives to the params of specs, in SI units; by default none."""
        del level
        return {}

    def clock_s(self, level: LevelT) -> float | None:
        """Return the seconds of a step on a level; None if that is not known before it is played."""
        del level
        return None

    @abstractmethod
    def check_fit(self, level: LevelT, fspa: Fspa, spec: str | Path | Fspa) -> None:
        """Raise TltlError if a level lacks something that a spec needs.

        The error has a diagnostic for each thing that is missing. ``fspa`` is the automaton of ``spec``.
        The labels of the diagnostics point into the spec's source.
        """

    def level_check(self, name: str, variant: str | Variant, sensors: SensorChoice | None) -> LevelCheck | None:
        """Read a level, so that it can be checked against specs.

        ``sensors`` are those of the agents that will play it; None means the level's own. By default
        None: the game cannot check its levels.

        Raises:
            TltlError: the level cannot be read, or lacks something that ``sensors`` names.
        """
        del name, variant, sensors
        return None

    def choose_sensors(self, level: LevelT, choice: SensorChoice | None = None) -> Sensors:
        """Return the sensors that an agent uses: ``choice``, or those of the level if it is None.

        By default, agents have no sensors that can be chosen.

        Raises:
            TltlError: it has a diagnostic TLT0815 for each mistake in ``choice``. By default, everything
                that ``choice`` names is a mistake, unless it equals the level's sensors.
        """
        keys = Sensors.__match_args__ if isinstance(choice, Sensors) else tuple(choice or ())
        if choice is None or not keys or choice == level.sensors:
            return level.sensors
        title = f"agents have no sensors to choose in `{level.name}`"
        raise TltlError([Diagnostic("TLT0815", f"{title}: `{key}`", help="leave it out") for key in keys])

    def missing_sensors(self, level: LevelT, sensors: Sensors) -> Iterator[str]:
        """Yield what ``sensors`` names but the level does not have, for example "the entity `exit`".

        By default nothing.
        """
        del level, sensors
        return iter(())

    def landmarks(self, level: LevelT) -> dict[str, Point]:
        """Return the positions of the entities that do not move, by name; by default none are known."""
        del level
        return {}

    def solids(self, level: LevelT) -> dict[str, Box]:
        """Return the boxes that stop a player and never open, by name; by default none are known."""
        del level
        return {}

    def barriers(self, level: LevelT) -> dict[str, Box]:
        """Return the boxes that can open, by name; by default none are known."""
        del level
        return {}

    def played_level(self, level: LevelT, episodes: Iterable[EpisodeT]) -> LevelT:
        """Return ``level`` with what ``episodes`` showed of it, so that reports can draw it.

        Some games know where things are only while they are played. By default, return ``level``
        unchanged.
        """
        del episodes
        return level

    def unreachable_entities(self, level: LevelT, fspa: Fspa) -> list[UnreachableEntity]:
        """Return the entities of a spec that no player can reach.

        The result is empty if the level is too large to search, and by default.
        """
        del level, fspa
        return []

    def is_infeasible(self, level: LevelT, fspa: Fspa) -> bool:
        """Return True if it is certain that no player can meet the spec; by default False."""
        del level, fspa
        return False

    def play_warnings(self, level: LevelT, fspa: Fspa) -> list[Diagnostic]:
        """Return the warnings to show before play, for example that nobody can reach a goal.

        By default none.
        """
        del level, fspa
        return []

    def level_fault(self, error: RuntimeError) -> TltlError | None:
        """Return the error to report if the level has caused ``error`` in play, else None.

        By default None: no error of the game is its level's fault.
        """
        del error
        return None

    def is_same_game(self, level: LevelT, other: LevelT) -> bool:
        """Return whether two levels belong to the same game.

        By default always, which is right for a class that stands for a single game. The class for game
        files stands for many games.
        """
        del level, other
        return True

    # --- episodes ----------------------------------------------------------------------------------

    @abstractmethod
    def make_env(
        self,
        level: str | os.PathLike[str],
        variant: str | Variant = "v0",
        spec: str | Path | Fspa | None = None,
        *,
        sensors: SensorChoice | None = None,
        reward: RewardOptions | None = None,
        params: Mapping[str, float] | None = None,
        render_mode: str | None = None,
    ) -> TltlEnv:
        """Make an environment of a level with a spec, by default the spec that the level is made for.

        After resets with the same seed, equal actions give equal episodes. The environment has the
        attribute ``level``.

        Raises:
            TltlError: the errors of :meth:`load_level`, :meth:`check_fit` and ``TltlEnv``; the level
                lacks something that ``sensors`` names; TLT0721, there is no spec.
        """

    @abstractmethod
    def recorder(self, env: gymnasium.Env[Any, Any], player: str = "unknown") -> EpisodeRecorder[EpisodeT]:
        """Wrap an environment of :meth:`make_env` in a recorder of its episodes.

        ``player`` is the name of the player in the recordings.
        """

    def player_position(self, env: gymnasium.Env[Any, Any]) -> Point | None:
        """Return where the player is now in an environment of :meth:`make_env`, in metres.

        None if the player is gone, and by default: the game does not say where the player is.
        """
        del env
        return None

    def level_bounds(self, env: gymnasium.Env[Any, Any]) -> Box | None:
        """Return the bounds of the level of an environment, in metres; None by default, where they are unknown."""
        del env
        return None

    def runs_already(self, level: LevelT) -> bool:
        """Return whether tltlc connects to a running game of a level, which plays for one environment at a time."""
        del level
        return False

    def plays_at_once(self, env: gymnasium.Env[Any, Any]) -> bool:
        """Return whether several environments like this one can play at the same time; by default True."""
        del env
        return True

    def has_expert(self, env: EpisodeRecorder[EpisodeT]) -> bool:
        """Return whether a scripted expert can play an environment; by default False."""
        del env
        return False

    def expert_episodes(
        self, env: EpisodeRecorder[EpisodeT], seeds: Iterable[int], *, careful: bool = True
    ) -> Iterator[EpisodeT]:
        """Yield an episode of the scripted expert for each seed.

        An expert that is not ``careful`` plays as if no enemy could see it.

        Raises:
            TltlError: TLT0731, by default: the game has no scripted expert.
        """
        del seeds, careful
        raise no_expert_error(env.get_wrapper_attr("level"))

    @abstractmethod
    def read_episode(self, path: Path) -> EpisodeT:
        """Read a recorded episode; raises TltlError if the file cannot be read."""

    @abstractmethod
    def episode_from_bytes(self, data: bytes, name: str) -> EpisodeT:
        """Return the episode in the bytes of a file; messages call the file ``name``."""

    @abstractmethod
    def episode_bytes(self, episode: EpisodeT) -> bytes:
        """Return the bytes of the file of an episode; equal episodes give equal bytes."""

    def located(self, episode: EpisodeT, level: str, variant: str | None) -> EpisodeT:
        """Return ``episode`` with the place of its level, so that it can be played again there.

        ``level`` names the level, and ``variant`` its variant; None means the recorded one. By default,
        return the episode unchanged, because its recording contains the level.

        Raises:
            TltlError: TLT0800, there is no such level, or the episode was played on another one.
        """
        recorded, name = episode.level, self.level_files.level_name(level)
        wanted = recorded.variant if variant is None else parse_variant(variant).title
        if (recorded.name, recorded.variant) != (name, wanted):
            title = f"the recording is of `{recorded.name}:{recorded.variant}`, not of `{name}:{wanted}`"
            help_ = "name that one, or none: the recording contains its level"
            raise TltlError([Diagnostic("TLT0800", title, help=help_)])
        return episode

    def check_replay(self, episode: EpisodeT) -> tuple[Diagnostic, ...] | None:
        """Play the actions of an episode again, and compare the result with the recording.

        Return the diagnostic TLT0824 if they differ, and an empty tuple if they are equal. By default,
        return None: the game cannot play a recording again.

        Raises:
            TltlError: TLT0730, a package that plays is not installed.
        """
        del episode
        return None

    def summary(self, episode: EpisodeT, index: int = 0) -> EpisodeSummary:
        """Return the summary of an episode; ``index`` is its number in an evaluation."""
        return summary_of(episode, index)

    def figures(self, episode: EpisodeT) -> GameFigures:
        """Return the figures of an episode that only this game has, such as health; by default none."""
        del episode
        return GameFigures()

    @abstractmethod
    def cause(self, episode: EpisodeT) -> Cause:
        """Return the reason why an episode ended."""

    def observers(self, episode: EpisodeT, begin_s: float, end_s: float) -> tuple[str, ...]:
        """Return the names of the enemies that saw the player between two times, in the order of the level.

        The times are in seconds since the reset. By default none: the game has no enemies that see.
        """
        del episode, begin_s, end_s
        return ()

    def shut_barriers(self, episode: EpisodeT) -> tuple[str, ...]:
        """Return the names of the barriers that were shut at the end of an episode and that players cannot pass.

        They are in the order of the level. By default none: the game has no barriers.
        """
        del episode
        return ()
