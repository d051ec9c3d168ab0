"""Demonstrations: recorded episodes that meet a spec on a level, kept in a folder; what does not meet it is not kept.

Nothing here needs what the training needs, so that ``tltlc record`` plays without it.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from itertools import count
from pathlib import Path
from typing import Final

from tltl_runtime.policies.identity import level_hash, spec_hash
from tltl_runtime.spec.task import Task
from tltl_runtime.stealth.expert.expert import Expert, play_episode
from tltl_runtime.stealth.level import Level
from tltl_runtime.stealth.recording import RecordEpisode
from tltl_runtime.stealth.recordings.episode import Episode
from tltl_runtime.stealth.recordings.file import SUFFIX, file_stem, new_path, read_episode, to_bytes
from tltlc.core.record import record
from tltlc.diagnostics.diagnostic import Diagnostic, TltlError
from tltlc.io.files import may_be_file
from tltlc.io.writing import write_files

PLAYER: Final = "expert"
"""The name of the scripted expert in recordings."""
MOST_FAILURES: Final = 20
"""After so many episodes in a row that fail, the expert gives up."""


@record
class Tried:
    """An episode that was played to be a demonstration, the ``path`` of its recording, None where it was not kept, and
    how many demonstrations are ``kept`` by then.
    """

    episode: Episode
    path: Path | None
    kept: int


@record
class Other:
    """A recording that is no demonstration of a level and a task, and the reason in words."""

    path: Path
    why: str


class Demonstrations:
    """The demonstrations of a level and a task in ``folder``, which need not be there yet.

    A recording there is one where level, spec, params and success are right; ``others`` are the rest, those among them
    that cannot be read.
    """

    def __init__(self, folder: Path, level: Level, task: Task) -> None:
        self.folder = folder
        self._level, self._spec, self._params = level_hash(level), spec_hash(task.fspa), dict(task.params)
        self._played: list[tuple[str, int]] = []
        self.others: list[Other] = []
        for path in recordings(folder):
            self._note(path)

    @property
    def count(self) -> int:
        """How many there are."""
        return len(self._played)

    def seeds(self, player: str) -> list[int]:
        """The seeds of those that one played."""
        return [seed for name, seed in self._played if name == player]

    def add(self, episode: Episode) -> Tried:
        """Write an episode to the folder where it is a demonstration.  Raises TltlError, TLT0005."""
        path = None
        if not self._why_none(episode):
            recording = to_bytes(episode)
            path = new_path(self.folder, file_stem(episode), recording)
            write_files(self.folder, {path.name: recording})
            self._played.append((episode.player, episode.seed))
        return Tried(episode, path, self.count)

    def _note(self, path: Path) -> None:
        try:
            episode = read_episode(path)
        except TltlError as error:
            self.others.append(Other(path, unreadable(error)))
            return
        if why := self._why_none(episode):
            self.others.append(Other(path, why))
        else:
            self._played.append((episode.player, episode.seed))

    def _why_none(self, episode: Episode) -> str:
        """Why an episode is no demonstration; empty where it is one."""
        if level_hash(episode.level) != self._level:
            return "it is of another level"
        if (spec_hash(episode.fspa), dict(episode.params)) != (self._spec, self._params):
            return "it is of another spec"
        return "" if episode.success else "it does not meet the spec"


def recordings(folder: Path) -> list[Path]:
    """The recordings in a folder, by name; none where there is no such folder. Pipes and devices are left out."""
    return sorted(filter(may_be_file, folder.glob(f"*{SUFFIX}")))


def unreadable(error: TltlError) -> str:
    """Why a recording cannot be read, in words."""
    (first, *_) = error.diagnostics
    return f"{first.code}, {first.title}"


def by_expert(env: RecordEpisode, made: Demonstrations, number: int, seed: int = 0) -> Iterator[Tried]:
    """Have the scripted expert play until there are ``number`` demonstrations, each episode as it ends.

    Seeds count from ``seed`` on, beyond those that it has played already: what is broken off goes on where it was.

    Raises:
        TltlError: TLT0920, it fails too often; TLT0005, a recording cannot be written.
    """
    played = [each for each in made.seeds(PLAYER) if each >= seed]
    failures = 0
    for episode in expert_episodes(env, count(max(played, default=seed - 1) + 1)) if made.count < number else ():
        yield (tried := made.add(episode))
        failures = 0 if tried.path else failures + 1
        if made.count >= number:
            return
        if failures == MOST_FAILURES:
            raise _given_up(env, episode)


def expert_episodes(env: RecordEpisode, seeds: Iterable[int], *, careful: bool = True) -> Iterator[Episode]:
    """Episodes of the scripted expert, one of each seed; ``careful`` as of :class:`Expert`."""
    expert = Expert(env, careful)
    for seed in seeds:
        play_episode(env, expert, seed)
        yield env.episode


def _given_up(env: RecordEpisode, last: Episode) -> TltlError:
    level, spec = last.level, last.fspa.name
    title = f"the expert met `{spec}` in none of {MOST_FAILURES} episodes in a row on `{level.name}:{level.variant}`"
    help_ = (
        f"`tltlc demonstrate {level.name}:{level.variant}` shows how it fails; "
        f"`tltlc record --seed {last.seed + 1}` tries other episodes; "
        "`tltlc record --by keyboard` records a person, whose folder `tltlc train --demonstrations` takes"
    )
    return TltlError([Diagnostic("TLT0920", title, help=help_)])
