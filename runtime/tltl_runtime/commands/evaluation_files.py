"""What an evaluation leaves: a report for people, one for programs, recordings, and pictures of the ways."""

from __future__ import annotations

from importlib.metadata import version
from pathlib import Path
from typing import Any, Final

from tltl_runtime.evaluation.figures import Figures, figures_of
from tltl_runtime.evaluation.play import Played
from tltl_runtime.evaluation.player import Result, Setup
from tltl_runtime.evaluation.text import report_text
from tltl_runtime.record_json import to_json
from tltl_runtime.stealth.episodes.file import SUFFIX, from_bytes, new_path
from tltl_runtime.stealth.episodes.trajectory import Trajectory
from tltl_runtime.stealth.episodes.versions import versions
from tltl_runtime.stealth.levels.file import load_level
from tltl_runtime.stealth.pictures.plan import draw_episode
from tltl_runtime.stealth.pictures.trajectories import draw_trajectories
from tltl_runtime.stealth.recording import writable_folder
from tltlc.writing import write_file, write_files

CHOICES: Final = {True: "sampled", False: "arg-max"}
"""What the ways to choose actions are called."""


class EvaluationFiles:
    """The results of an evaluation as they come, and where they go.

    ``path`` is the policy's file, ``sha256`` that of its bytes, in hexadecimal, and ``first`` the index of the first
    episode.  ``folder`` gets recordings and pictures, ``json_file`` the report for programs; both are optional, and
    folders are made where they are missing.

    Raises:
        TltlError: TLT0005, nothing can be written there; of ``add`` and ``write`` too.
    """

    def __init__(
        self, setup: Setup, path: Path, sha256: str, first: int, folder: Path | None, json_file: Path | None
    ) -> None:
        self._setup, self._path, self._sha256, self._first, self._folder = setup, path, sha256, first, folder
        self._json = None if str(json_file) == "-" else json_file
        self._level = load_level(setup.level, setup.variant)
        self._played: dict[bool, list[Played]] = {True: [], False: []}
        self._trajectories: dict[bool, list[Trajectory]] = {True: [], False: []}
        for place in (folder, self._json and self._json.parent):
            if place is not None:
                writable_folder(place)

    @property
    def played(self) -> dict[str, int]:
        """How many episodes were played, by the name of the way to choose actions."""
        return {CHOICES[sampled]: len(played) for sampled, played in self._played.items()}

    def add(self, result: Result) -> None:
        """Take the next result, and write its recording where there is one."""
        sampled = result.task.sampled
        self._played[sampled].append(result.played)
        if result.trajectory is not None:
            self._trajectories[sampled].append(result.trajectory)
        if result.recording and self._folder is not None:
            stem = f"{self._name}-{self._setup.seed}-{result.task.index}-{CHOICES[sampled]}"
            path = new_path(self._folder, stem, result.recording)
            plan = draw_episode(from_bytes(result.recording, path.name))
            files = {path.name: result.recording, f"{path.name.removesuffix(SUFFIX)}.png": plan}
            write_files(self._folder, files)

    def text(self) -> str:
        """The report for people."""
        setup = self._setup
        head = f"{self._level.name} {self._level.variant}, spec {setup.fspa.name}, seed {setup.seed}: {self._path}"
        text = f"{head}\n\n{report_text({CHOICES[sampled]: each for sampled, each in self._figures().items()})}"
        failed = [each.index for episodes in self._played.values() for each in episodes if not each.success]
        if failed and self._folder is None:
            again = f"--seed {setup.seed} --first {failed[0]} --episodes 1 --out DIR"
            text += f"\n`{again}` records one of them, for `tltlc replay`.\n"
        return text

    def document(self, complete: bool) -> dict[str, Any]:
        """The report for programs, JSON data: figures of sampled actions, those of the likeliest under ``argmax``.

        It does not depend on who played.  ``complete`` says whether all episodes were played.
        """
        setup, figures = self._setup, self._figures()
        card = setup.policy.card
        return {
            "level": self._level.name,
            "variant": self._level.variant,
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
            **(to_json(figures[True]) if True in figures else {}),
            "argmax": to_json(figures[False]) if False in figures else None,
        }

    def write(self, text: str) -> None:
        """Write the report for programs, and pictures of the ways where there is a folder for them."""
        if self._json is not None:
            write_file(self._json, text, "name another place with --json")
        if self._folder is None:
            return
        pictures: dict[str, str | bytes] = {}
        for sampled, trajectories in self._trajectories.items():
            if trajectories:
                title = f"{self._level.name} {self._level.variant}: {len(trajectories)} episodes, {CHOICES[sampled]}"
                pictures[f"ways-{CHOICES[sampled]}.png"] = draw_trajectories(
                    self._level, self._setup.fspa, trajectories, title
                )
        write_files(self._folder, {"evaluation.json": text, **pictures})

    @property
    def _name(self) -> str:
        return f"{self._level.name}-{self._level.variant}"

    def _figures(self) -> dict[bool, Figures]:
        return {sampled: figures_of(played) for sampled, played in self._played.items() if played}
