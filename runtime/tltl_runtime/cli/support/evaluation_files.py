"""What an evaluation leaves: a report for people, one for programs, recordings, and pictures of the ways."""

from __future__ import annotations

import re
from contextlib import suppress
from importlib.metadata import version
from pathlib import Path
from typing import Any, Final

from tltl_runtime.evaluation.figures import Evaluation, evaluation_of
from tltl_runtime.evaluation.play import Played
from tltl_runtime.evaluation.player import CHOICES, Result, Setup
from tltl_runtime.evaluation.text import report_text
from tltl_runtime.policies.identity import level_hash
from tltl_runtime.stealth.levels.file import load_level
from tltl_runtime.stealth.levels.made_for import shown
from tltl_runtime.stealth.recording import writable_folder
from tltl_runtime.stealth.recordings.file import SUFFIX, from_bytes, new_path, read_episode
from tltl_runtime.stealth.recordings.trajectory import Trajectory
from tltl_runtime.stealth.recordings.versions import versions
from tltl_runtime.stealth.rendering.plan import draw_episode
from tltl_runtime.stealth.rendering.trajectories import draw_trajectories
from tltl_runtime.support.record_json import to_json
from tltlc.diagnostics.diagnostic import Diagnostic, TltlError
from tltlc.interfaces.cli.paths import is_stdout
from tltlc.io.files import exists, may_be_file
from tltlc.io.json_text import load
from tltlc.io.limits import REPORT
from tltlc.io.writing import write_file, write_files

_REPORT: Final = "evaluation.json"
_PICTURES: Final = {sampled: f"ways-{choice}.png" for sampled, choice in CHOICES.items()}
_KEYS: Final = frozenset({"level", "variant", "level_hash", "spec", "policy", "versions"})
"""What every report has had."""


class EvaluationFiles:
    """The results of an evaluation as they come, and where they go.

    ``path`` is the policy's file, ``sha256`` that of its bytes, in hexadecimal, and ``first`` the index of the first
    episode; ``command`` evaluates the same episodes again.  ``folder``, which is made where it is missing, gets
    recordings and pictures, ``json_file`` the report for programs; both are optional.  The report and the pictures of
    the ways that an earlier evaluation left in the folder are removed with the first result, and so are the recordings
    of another policy on this level: ``removed`` has their names.

    Raises:
        TltlError: TLT0005, nothing can be written there; of ``add`` and ``write`` too.  TLT0722, a file is in the way
            that has the name of a report or of a picture, and that no evaluation wrote.
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
        self._json = None if is_stdout(json_file) else json_file
        self._level = load_level(setup.level, setup.variant)
        self._played: dict[bool, list[Played]] = {True: [], False: []}
        self._trajectories: dict[bool, list[Trajectory]] = {True: [], False: []}
        self._recorded: list[str] = []
        self._removed: tuple[str, ...] = ()
        if folder is not None:
            _check_place(folder)
            writable_folder(folder)

    @property
    def played(self) -> dict[str, int]:
        """How many episodes were played, by the name of the way to choose actions."""
        return {CHOICES[sampled]: len(played) for sampled, played in self._played.items()}

    @property
    def removed(self) -> tuple[str, ...]:
        """Names of what an earlier evaluation left in the folder, and what is neither there any more nor anew."""
        return tuple(name for name in self._removed if self._folder and not (self._folder / name).exists())

    def add(self, result: Result) -> None:
        """Take the next result, and write its recording where there is one."""
        sampled = result.task.sampled
        if self._folder is not None and not any(self._played.values()):
            self._removed = self._remove_older(self._folder)
        self._played[sampled].append(result.played)
        if result.trajectory is not None:
            self._trajectories[sampled].append(result.trajectory)
        if result.recording and self._folder is not None:
            stem = f"{self._name}-{self._setup.seed}-{result.task.index}-{CHOICES[sampled]}"
            path = new_path(self._folder, stem, result.recording, [".png"])
            plan = draw_episode(from_bytes(result.recording, path.name))
            files = {path.name: result.recording, f"{path.name.removesuffix(SUFFIX)}.png": plan}
            write_files(self._folder, files)
            self._recorded.append(path.name)

    def text(self) -> str:
        """The report for people."""
        setup = self._setup
        # A level of one's own may be called like one that comes with tltlc.
        level = shown(Path(setup.level)) if setup.level.endswith(".toml") else self._level.name
        head = f"{level} {self._level.variant}, spec {setup.fspa.name}, seed {setup.seed}: {self._path}"
        found = {CHOICES[sampled]: each for sampled, each in self._evaluations().items()}
        text = f"{head}\n{self._note()}\n{report_text(found)}"
        failed = [each.index for episodes in self._played.values() for each in episodes if not each.success]
        if failed and self._folder is None:
            again = f"{self._command} --first {failed[0]} --episodes 1 --out evaluation"
            text += f"\nTo record one of them, for `tltlc replay`:\n  {again}\n"
        return text

    def document(self, complete: bool) -> dict[str, Any]:
        """The report for programs, JSON data: figures of sampled actions, those of the likeliest under ``argmax``.

        It does not depend on who played.  ``complete`` says whether all episodes were played.
        """
        setup, found = self._setup, self._evaluations()
        card = setup.policy.card
        return {
            "level": self._level.name,
            "variant": self._level.variant,
            "level_hash": level_hash(self._level),
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
            "versions": {**versions(), "torch": version("torch")},
            **(_as_json(found[True]) if True in found else {}),
            "argmax": _as_json(found[False]) if False in found else None,
        }

    def write(self, text: str) -> str:
        """Write the report for programs, and pictures of the ways where there is a folder for them; what there is in
        it then, for people, empty without a folder.
        """
        if self._json is not None:
            write_file(self._json, text, "name another place with --json")
        if self._folder is None:
            return ""
        pictures: dict[str, str | bytes] = {}
        for sampled, trajectories in self._trajectories.items():
            if trajectories:
                title = f"{self._level.name} {self._level.variant}: {len(trajectories)} episodes, {CHOICES[sampled]}"
                pictures[_PICTURES[sampled]] = draw_trajectories(self._level, self._setup.fspa, trajectories, title)
        write_files(self._folder, {_REPORT: text, **pictures})
        count = len(self._recorded)
        recorded = f"{count or 'no'} recording{'s' * (count != 1)}{' with plans' * (count > 0)}"
        look_at = f"; look at {next(iter(pictures))} first" if pictures else ""
        return f"{self._folder}: {recorded}, {', '.join((*pictures, _REPORT))}{look_at}"

    def _note(self) -> str:
        """A line for people where the level is not the one that the policy was trained on."""
        card, level = self._setup.policy.card, self._level
        if level_hash(level) == card.level_hash:
            return ""
        if (level.name, level.variant) == (card.level, card.variant):
            return "note: the level has changed since the policy was trained on it\n"
        return f"note: the policy was trained on another level, {card.level} {card.variant}\n"

    def _remove_older(self, folder: Path) -> tuple[str, ...]:
        """Remove what is written anew, and recordings of this level that another policy played: their names."""
        choices = "|".join(CHOICES.values())
        recording = re.compile(rf"({re.escape(self._name)}-\d+-\d+-({choices})(-\d+)?){re.escape(SUFFIX)}")
        # The report goes last: it says that the pictures are an evaluation's.
        older = [folder / name for name in (*_PICTURES.values(), _REPORT)]
        for path in sorted(filter(may_be_file, folder.iterdir())):
            if (found := recording.fullmatch(path.name)) and self._is_of_another(path):
                older += [path, folder / f"{found[1]}.png"]
        there = [path for path in older if path.is_file()]
        for path in there:
            # What cannot be removed cannot be replaced, either, and that is told.
            with suppress(OSError):
                path.unlink()
        return tuple(path.name for path in there)

    def _is_of_another(self, path: Path) -> bool:
        """Whether a file is a recording of what another policy played, which this evaluation says nothing of."""
        try:
            player = read_episode(path).player
        except TltlError:
            return False
        return player.startswith("policy ") and player.rsplit(", ", 2)[0].split()[-1] != self._sha256[:8]

    @property
    def _name(self) -> str:
        return f"{self._level.name}-{self._level.variant}"

    def _evaluations(self) -> dict[bool, Evaluation]:
        return {sampled: evaluation_of(played) for sampled, played in self._played.items() if played}


def _check_place(folder: Path) -> None:
    """Raise TltlError, TLT0722, where a file of the user would be replaced by the report or by a picture."""
    there = [folder / name for name in (_REPORT, *_PICTURES.values()) if exists(folder / name)]
    if there and not _is_report(folder / _REPORT):
        title = f"`{there[0]}` is there already, and no evaluation wrote it"
        raise TltlError([Diagnostic("TLT0722", title, help="name another folder with --out")])


def _is_report(path: Path) -> bool:
    """Whether an evaluation wrote this file."""
    try:
        document = load(path, REPORT) if may_be_file(path) else None
    except (TltlError, OSError, ValueError):
        return False
    return isinstance(document, dict) and document.keys() >= _KEYS


def _as_json(found: Evaluation) -> dict[str, Any]:
    """The figures, how failed episodes ended, and the ``episodes``: these themselves, and not how many they are."""
    figures = {name: each for name, each in to_json(found.figures).items() if name != "episodes"}
    return {**figures, "ended": to_json(found.ended), "episodes": to_json(found.episodes)}
