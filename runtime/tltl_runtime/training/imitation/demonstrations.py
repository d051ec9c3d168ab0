"""Demonstrations: recorded episodes that meet a spec on a level, kept in a folder.

This module needs none of the packages for training, so ``tltlc record`` works without them.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from functools import partial
from itertools import count
from pathlib import Path
from typing import Any, Final

from tltl_runtime.game.episode import RecordedEpisode
from tltl_runtime.game.level import Level
from tltl_runtime.game.recorder import EpisodeRecorder
from tltl_runtime.game.recording_path import SUFFIX, file_stem, new_path
from tltl_runtime.policies.identity import spec_hash
from tltl_runtime.spec.task import Task
from tltl_runtime.wire.lost_episodes import LossLimit, going_on, most_lost
from tltlc.api import Diagnostic, TltlError, fileio, record

PLAYER: Final = "expert"
"""The name of the scripted expert in recordings."""
MOST_FAILURES: Final = 20
"""The expert gives up after this many failed episodes in a row."""


@record
class ImitationSummary:
    """A summary of the demonstrations that an agent imitates.

    ``episodes`` counts the demonstrations, and ``decisions`` the actions in them. ``players`` are
    the names of those who played them, such as ``expert``. ``left_out`` has a text ``FILE: REASON``
    for each recording that is not a demonstration.
    """

    episodes: int
    decisions: int
    players: tuple[str, ...]
    left_out: tuple[str, ...]


@record
class Attempt:
    """An episode that was played to record a demonstration.

    ``path`` is the file of its recording, or None if the episode is not a demonstration and was not
    kept. ``kept`` is the number of demonstrations in the folder after this attempt.
    """

    episode: RecordedEpisode
    path: Path | None
    kept: int


@record
class RejectedRecording:
    """A recording that is not a demonstration, and the reason in words."""

    path: Path
    reason: str


class Demonstrations:
    """The demonstrations on a level in ``folder``, which need not exist yet.

    A recording in the folder is a demonstration if its level is ``level``, its spec and params are
    those of ``task``, and it meets the spec. ``rejected`` are the recordings that are not
    demonstrations or cannot be read.
    """

    def __init__(self, folder: Path, level: Level, task: Task) -> None:
        self.folder = folder
        self._game = level.game
        self._level, self._spec = self._game.level_hash(level), spec_hash(task.fspa)
        self._params = dict(task.params)
        self._players_and_seeds: list[tuple[str, int]] = []
        self.rejected: list[RejectedRecording] = []
        for path in recordings(folder):
            self._read(path)

    @property
    def count(self) -> int:
        """The number of demonstrations."""
        return len(self._players_and_seeds)

    def seeds(self, player: str) -> list[int]:
        """Return the seeds of the demonstrations that ``player`` played."""
        return [seed for name, seed in self._players_and_seeds if name == player]

    def add(self, episode: RecordedEpisode) -> Attempt:
        """Write an episode to the folder if it is a demonstration; otherwise keep nothing.

        The ``path`` of the returned attempt is its file, or None if nothing was kept. A demonstration
        that the folder already has counts once. Raises TltlError, TLT0005, if the file cannot be written.
        """
        path = None
        if not self._rejection(episode):
            recording = self._game.episode_bytes(episode)
            path = new_path(self.folder, file_stem(episode), recording)
            is_new = not path.exists()
            fileio.write_files(self.folder, {path.name: recording})
            if is_new:
                self._players_and_seeds.append((episode.player, episode.seed))
        return Attempt(episode, path, self.count)

    def _read(self, path: Path) -> None:
        try:
            episode = self._game.read_episode(path)
        except TltlError as error:
            self.rejected.append(RejectedRecording(path, error_text(error)))
            return
        if reason := self._rejection(episode):
            self.rejected.append(RejectedRecording(path, reason))
        else:
            self._players_and_seeds.append((episode.player, episode.seed))

    def _rejection(self, episode: RecordedEpisode) -> str:
        """Return why an episode is not a demonstration; empty if it is one."""
        if self._game.level_hash(episode.level) != self._level:
            return "it is of another level"
        if (spec_hash(episode.fspa), dict(episode.params)) != (self._spec, self._params):
            return "it is of another spec"
        return "" if episode.success else "it does not meet the spec"


def recordings(folder: Path) -> list[Path]:
    """Return the paths of the recordings in a folder, sorted by name.

    The list is empty if the folder does not exist. Pipes and devices are left out.
    """
    return sorted(filter(fileio.may_be_file, folder.glob(f"*{SUFFIX}")))


def error_text(error: TltlError) -> str:
    """Return why a recording cannot be read: the code and the title of the error, as ``CODE, TITLE``."""
    (diagnostic, *_) = error.diagnostics
    return f"{diagnostic.code}, {diagnostic.title}"


def expert_attempts(
    env: EpisodeRecorder[Any],
    store: Demonstrations,
    number: int,
    seed: int = 0,
    *,
    on_lost: Callable[[Diagnostic], None] | None = None,
) -> Iterator[Attempt]:
    """Let the scripted expert play until ``store`` has ``number`` demonstrations; yield each attempt.

    An episode that meets the spec is written to the folder of ``store``. The first episode has the
    seed ``seed``, and each later one the next seed. If the expert has demonstrations with ``seed``
    or later seeds, the first episode has the seed after the last of them. So an interrupted
    recording continues where it stopped. An episode that is lost with its game is no attempt:
    ``on_lost`` gets what happened. Without it, the first loss ends the attempts.

    Raises:
        WireError: too many episodes were lost with their games, or too many in a row.
        TltlError: TLT0920, the expert fails too often; TLT0005, a recording cannot be written.
    """
    played = [played_seed for played_seed in store.seeds(PLAYER) if played_seed >= seed]
    failures = 0
    if store.count >= number:
        return
    left = count(max(played, default=seed - 1) + 1)
    begin = partial(env.get_wrapper_attr("level").game.expert_episodes, env, left)
    # There is always another episode to play.
    limit = LossLimit(most_lost(number + 1))
    for episode in going_on(begin, limit, on_lost) if on_lost else begin():
        yield (attempt := store.add(episode))
        failures = 0 if attempt.path else failures + 1
        if store.count >= number:
            return
        if failures == MOST_FAILURES:
            raise _expert_failed(episode)


def _expert_failed(episode: RecordedEpisode) -> TltlError:
    level, spec = episode.level, episode.fspa.name
    title = f"the expert failed to meet `{spec}` in {MOST_FAILURES} episodes in a row on `{level.name}:{level.variant}`"
    help_ = (
        f"`tltlc demonstrate --seed {episode.seed}` with the same level and --spec shows how it fails; "
        f"`tltlc record --seed {episode.seed + 1}` tries other episodes, and `tltlc record --by keyboard` records a "
        "person; give the folder to `tltlc train --method imitation --demonstrations`"
    )
    return TltlError([Diagnostic("TLT0920", title, help=help_)])
