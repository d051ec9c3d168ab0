"""The output of an evaluation: a text report, a JSON report, recordings and pictures of trajectories."""

from __future__ import annotations

import re
from collections.abc import Iterator
from contextlib import suppress
from pathlib import Path
from typing import Any, Final

from tltl_runtime.cli.support.place_title import place_title
from tltl_runtime.evaluation.figures import Evaluation, evaluation_of
from tltl_runtime.evaluation.player import CHOICES, LostEpisode, PlayedEpisode, Setup, is_labelled_policy
from tltl_runtime.evaluation.text import report_text
from tltl_runtime.evaluation.versions import versions
from tltl_runtime.game.episode import RecordedEpisode, Trajectory
from tltl_runtime.game.game import SHOWN_EPISODES
from tltl_runtime.game.recording_path import SUFFIX, new_path
from tltl_runtime.game.registry import game_of
from tltl_runtime.spec.episode_summary import EpisodeSummary
from tltl_runtime.support.record_json import to_json
from tltl_runtime.support.writable_folder import writable_folder
from tltl_runtime.wire.lost_episodes import LostEpisodes
from tltlc.api import Diagnostic, TltlError, cli, fileio, traces

_REPORT: Final = "evaluation.json"
_PICTURES: Final = {sampled: f"ways-{choice}.png" for sampled, choice in CHOICES.items()}
_KEYS: Final = frozenset({"level", "variant", "level_hash", "spec", "policy", "versions"})
"""The keys by which a JSON report is recognized. All versions of the report contain them."""
_EPISODE_KEYS: Final = (
    "index",
    "seed",
    "success",
    "verdict",
    "end",
    "progress",
    "reward",
    "steps",
    "seconds",
    "state",
    "unmet",
    "label",
)
"""The keys of an episode in the JSON report, in order."""


class EvaluationFiles:
    """Collects the results of an evaluation and writes its files.

    ``path`` is the policy's file, ``sha256`` the hash of its bytes, in hexadecimal, and ``first``
    the index of the first episode. ``command`` is the shell command that repeats the evaluation,
    without ``--first`` and ``--episodes``.

    Recordings, pictures and the JSON report go into ``folder``, which is created if it is missing.
    The JSON report is also written to ``json_file``. Each of the two is None if it was not requested.
    The first call of ``add`` removes from the folder the report and the pictures of an earlier
    evaluation, and the recordings of other policies on this level.

    Raises:
        TltlError: TLT0005, a file cannot be written, also from ``add`` and ``write``; TLT0722, a
            file has the name of a report or a picture, but no evaluation wrote it.
    """

    def __init__(
        self,
        setup: Setup,
        path: Path,
        sha256: str,
        first: int,
        command: str,
        folder: Path | None,
        json_file: Path | None,
    ) -> None:
        self._setup, self._path, self._sha256, self._first, self._folder = setup, path, sha256, first, folder
        self._command = command
        self._json = None if cli.is_stdout(json_file) else json_file
        self._game = game_of(setup.level)
        self._level = self._game.load_level(setup.level, setup.variant)
        # Show the path of a user's level, which may have the name of a level of the package. Read the name of a scene
        # now: the game file may change while the episodes are played.
        self._place = place_title(setup.level, self._level.variant)
        self._summaries: dict[bool, list[EpisodeSummary]] = {True: [], False: []}
        self._lost: dict[bool, list[LostEpisode]] = {True: [], False: []}
        self._trajectories: dict[bool, list[Trajectory]] = {True: [], False: []}
        self._recorded: list[str] = []
        self._removed: tuple[str, ...] = ()
        self._drawn: list[RecordedEpisode] = []
        if folder is not None:
            _check_folder(folder)
            writable_folder(folder)

    @property
    def episode_counts(self) -> dict[str, int]:
        """The number of played episodes, for ``sampled`` and for ``arg-max`` actions."""
        return {CHOICES[sampled]: len(summaries) for sampled, summaries in self._summaries.items()}

    @property
    def lost_counts(self) -> dict[str, int]:
        """The number of episodes that were lost with their games, for ``sampled`` and for ``arg-max`` actions."""
        return {CHOICES[sampled]: len(lost) for sampled, lost in self._lost.items()}

    @property
    def lost_episodes(self) -> LostEpisodes | None:
        """How many episodes were lost with their games, and how the first one was lost; None if none was."""
        lost = [*self._lost[True], *self._lost[False]]
        return LostEpisodes(len(lost), lost[0].fault) if lost else None

    @property
    def removed_files(self) -> tuple[str, ...]:
        """The names of files of an earlier evaluation that were removed and not written again."""
        return tuple(name for name in self._removed if self._folder and not (self._folder / name).exists())

    def add(self, result: PlayedEpisode) -> None:
        """Add the next result. If it has a recording, write the recording, and a picture of its path if possible."""
        sampled = result.request.sampled
        if self._folder is not None and not any(self._summaries.values()):
            self._removed = self._remove_older(self._folder)
        self._summaries[sampled].append(result.summary)
        if result.trajectory is not None:
            self._trajectories[sampled].append(result.trajectory)
        if result.recording and self._folder is not None:
            stem = f"{self._name}-{self._setup.seed}-{result.request.index}-{CHOICES[sampled]}"
            pictures = self._game.pictures
            episode = self._game.episode_from_bytes(result.recording, stem) if pictures else None
            if pictures is None or episode is None or not pictures.draws(episode):
                pictures = None
            elif len(self._drawn) < SHOWN_EPISODES:
                self._drawn.append(episode)
            path = new_path(self._folder, stem, result.recording, [".png"] if pictures else [])
            files = {path.name: result.recording}
            if pictures:
                files[f"{path.name.removesuffix(SUFFIX)}.png"] = pictures.episode(episode)
            fileio.write_files(self._folder, files)
            self._recorded.append(path.name)

    def add_lost(self, lost: LostEpisode) -> None:
        """Add an episode that was lost with its game."""
        self._lost[lost.request.sampled].append(lost)

    def text(self) -> str:
        """Return the text report."""
        setup = self._setup
        head = f"{self._place}, spec {setup.fspa.name}, seed {setup.seed}: {self._path}"
        evaluations = {CHOICES[sampled]: evaluation for sampled, evaluation in self._evaluations().items()}
        text = f"{head}\n{self._note()}\n{report_text(evaluations)}"
        failed = [episode.index for episodes in self._summaries.values() for episode in episodes if not episode.success]
        if failed and self._folder is None:
            command = f"{self._command} --first {failed[0]} --episodes 1 --out evaluation"
            text += f"\nTo record one of them, for `tltlc replay`:\n  {command}\n"
        return text

    def document(self, complete: bool) -> dict[str, Any]:
        """Return the JSON report.

        It has the figures with sampled actions, and under ``argmax`` those with the most probable
        actions. The report does not depend on the workers that played. ``complete`` says whether
        all episodes were played.
        """
        setup, evaluations = self._setup, self._evaluations()
        card = setup.policy.card
        return {
            "level": self._level.name,
            "variant": self._level.variant,
            "level_hash": self._game.level_hash(self._level),
            "spec": setup.fspa.name,
            "seed": setup.seed,
            "first": self._first,
            "complete": complete,
            "policy": {
                "file": self._path.name,
                "sha256": self._sha256,
                "level": card.level,
                "variant": card.variant,
                "level_hash": card.level_hash,
            },
            "versions": versions(),
            **(_as_json(evaluations[True]) if True in evaluations else {}),
            "argmax": _as_json(evaluations[False]) if False in evaluations else None,
        }

    def write(self, text: str) -> str:
        """Write the JSON report ``text`` and, if there is a folder, the pictures of trajectories.

        A game that cannot draw has no pictures. Return a description of the folder's contents; an
        empty text if there is no folder.
        """
        if self._json is not None:
            fileio.write_file(self._json, text, "name another place with --json")
        if self._folder is None:
            return ""
        pictures = dict(self._pictures())
        fileio.write_files(self._folder, {_REPORT: text, **pictures})
        count, has_plans = len(self._recorded), bool(self._drawn)
        recordings_text = f"{count or 'no'} recording{'s' * (count != 1)}{' with plans' * has_plans}"
        hint = f"; look at {next(iter(pictures))} first" if pictures else ""
        return f"{self._folder}: {recordings_text}, {', '.join((*pictures, _REPORT))}{hint}"

    def _pictures(self) -> Iterator[tuple[str, bytes]]:
        """Yield the name and the content of each picture of trajectories."""
        # Some games show their levels only while they are played: take what the recordings show.
        level = self._game.played_level(self._level, self._drawn)
        for sampled, trajectories in self._trajectories.items():
            if trajectories and self._game.pictures:
                title = f"{self._level.name}:{self._level.variant}: {len(trajectories)} episodes, {CHOICES[sampled]}"
                picture = self._game.pictures.trajectories(level, self._setup.fspa, trajectories, title)
                yield _PICTURES[sampled], picture

    def _note(self) -> str:
        """Return a note if the policy was trained on another level, or on an earlier version of this one.

        Otherwise, return an empty text.
        """
        card, level = self._setup.policy.card, self._level
        if self._game.level_hash(level) == card.level_hash:
            return ""
        if (level.name, level.variant) == (card.level, card.variant):
            return "note: the level has changed since the policy was trained on it\n"
        return f"note: the policy was trained on another level, {card.level}:{card.variant}\n"

    def _remove_older(self, folder: Path) -> tuple[str, ...]:
        """Remove the pictures and the report of an earlier evaluation; return the names of removed files.

        Also remove recordings of another policy on this level, with the plans (pictures of the
        path) beside them.
        """
        choices = "|".join(CHOICES.values())
        recording = re.compile(rf"({re.escape(self._name)}-\d+-\d+-({choices})(-\d+)?){re.escape(SUFFIX)}")
        # Remove the report last: it shows that the pictures belong to an evaluation.
        paths = [folder / name for name in (*_PICTURES.values(), _REPORT)]
        for path in sorted(filter(fileio.may_be_file, folder.iterdir())):
            if (match := recording.fullmatch(path.name)) and self._is_by_another_policy(path):
                paths += [path, folder / f"{match[1]}.png"]
        existing = [path for path in paths if path.is_file()]
        for path in existing:
            # If a file cannot be removed, it cannot be replaced, either, and `write` raises an error.
            with suppress(OSError):
                path.unlink()
        return tuple(path.name for path in existing)

    def _is_by_another_policy(self, path: Path) -> bool:
        """Whether a file is a recording of another policy in this game; False if it cannot be read."""
        try:
            episode = self._game.read_episode(path)
        except TltlError:
            return False
        player = episode.player
        if not self._game.is_same_game(self._level, episode.level):
            return False
        return is_labelled_policy(player) and not self._setup.player.is_of(player)

    @property
    def _name(self) -> str:
        return f"{self._level.name}-{self._level.variant}"

    def _evaluations(self) -> dict[bool, Evaluation]:
        return {
            sampled: evaluation_of(summaries, self._lost[sampled])
            for sampled, summaries in self._summaries.items()
            if summaries
        }


def _check_folder(folder: Path) -> None:
    """Raise TltlError, TLT0722, if the report or a picture would replace a file that no evaluation wrote."""
    existing = [folder / name for name in (_REPORT, *_PICTURES.values()) if fileio.exists(folder / name)]
    if existing and not _is_report(folder / _REPORT):
        title = f"`{existing[0]}` already exists, and no evaluation wrote it"
        raise TltlError([Diagnostic("TLT0722", title, help="name another folder with --out")])


def _is_report(path: Path) -> bool:
    """Whether a file is the report of an evaluation."""
    try:
        document = fileio.load_json(path, fileio.limits.REPORT) if fileio.may_be_file(path) else None
    except (TltlError, OSError, ValueError):
        return False
    return isinstance(document, dict) and document.keys() >= _KEYS


def _as_json(evaluation: Evaluation) -> dict[str, Any]:
    """Return the JSON data of an evaluation: figures, why and how failed episodes ended, and all episodes.

    The value of the key ``episodes`` is the list of episodes, not their number as in ``Figures``.
    """
    figures = {name: value for name, value in to_json(evaluation.figures).items() if name != "episodes"}
    return {
        **figures,
        **({"lost": [_lost_json(lost) for lost in evaluation.lost]} if evaluation.lost else {}),
        "causes": [
            {**traces.group_json(group), "episodes": list(map(int, group.traces))} for group in evaluation.causes
        ],
        "ended": to_json(evaluation.ended),
        "episodes": [_episode_json(episode) for episode in evaluation.episodes],
    }


def _episode_json(episode: EpisodeSummary) -> dict[str, Any]:
    """Return the entry of an episode in the JSON report."""
    return {key: getattr(episode, key) for key in _EPISODE_KEYS}


def _lost_json(lost: LostEpisode) -> dict[str, Any]:
    """Return the entry of a lost episode in the JSON report: its index and seed, and what happened to the game."""
    fault = lost.fault
    return {
        "index": lost.request.index,
        "seed": lost.seed,
        "code": fault.code,
        "title": fault.title,
        "help": fault.help,
    }
