"""Write a person's recordings, so that none is lost or overwritten."""

from __future__ import annotations

import os
from contextlib import suppress
from pathlib import Path
from tempfile import gettempdir

import click

from tltl_runtime.game.episode import RecordedEpisode
from tltl_runtime.game.recording_path import SUFFIX, new_path
from tltl_runtime.support.number_text import share
from tltlc.api import Diagnostic, TltlError, fileio


class RecordingFiles:
    """Writes each episode to a new file.

    ``out`` is a path ``NAME.episode.npz``, or a folder for files that are called ``name``, which is
    created if it is missing. None means the working directory.

    Raises:
        UsageError: ``out`` has another extension.
        TltlError: TLT0005, the folder cannot be written.
    """

    def __init__(self, out: Path | None, name: str) -> None:
        self._folder, self._name = Path(), name
        self._unfinished: Path | None = None
        if out is not None and out.name.endswith(SUFFIX):
            self._folder, self._name = out.parent, out.name.removesuffix(SUFFIX)
        elif out is not None:
            if out.suffix and not out.is_dir():
                raise click.UsageError(
                    f"--output must be a folder or a name that ends with {SUFFIX}, not `{out}`",
                    click.get_current_context(silent=True),
                )
            self._folder = out
        problem = _write_problem(self._folder, make=self._folder == out)
        if problem:
            title = f"cannot record to `{self._folder}`: {problem}"
            raise TltlError([Diagnostic("TLT0005", title, help="name another place with -o")])

    def keep(self, episode: RecordedEpisode) -> None:
        """Write an unfinished episode, in case the process is killed; ``save`` removes the file."""
        if self._unfinished is None:
            self._unfinished = new_path(self._folder, f"{self._name}.unfinished")
        with suppress(TltlError):
            _write(self._unfinished, episode)

    def save(self, episode: RecordedEpisode) -> str:
        """Write an episode, print its result, and return the path of its file.

        If the folder cannot be written, the file goes to the folder for temporary files. If this fails,
        too, raise TltlError, TLT0005.
        """
        path = new_path(self._folder, self._name)
        try:
            _write(path, episode)
        except TltlError as error:
            path = write_elsewhere(episode, self._name, error)
        if self._unfinished is not None:
            self._unfinished.unlink(missing_ok=True)
            self._unfinished = None
        click.echo(f"{path}: {_result_text(episode)}")
        return str(path)


def write_elsewhere(episode: RecordedEpisode, name: str, error: TltlError) -> Path:
    """Print an error and write the episode to the folder for temporary files instead; return its path.

    Raises:
        TltlError: TLT0005, that folder cannot be written, either.
    """
    click.echo(f"{error}", err=True)
    path = new_path(Path(gettempdir()), name)
    _write(path, episode)
    return path


def _write(path: Path, episode: RecordedEpisode) -> None:
    fileio.write_file(path, episode.level.game.episode_bytes(episode))


def _write_problem(folder: Path, make: bool) -> str:
    """Return why a folder cannot be written; empty if it can. With ``make``, create it first."""
    try:
        if make:
            folder.mkdir(parents=True, exist_ok=True)
    except (OSError, ValueError) as error:
        return fileio.reason(error)
    if not folder.is_dir():
        return "there is no such folder"
    return "" if os.access(folder, os.W_OK) else "permission denied"


def _result_text(episode: RecordedEpisode) -> str:
    cause = episode.level.game.cause(episode)
    return f"{cause.text}; {episode.verdict}, progress {share(episode.progress[-1])}, seed {episode.seed}"
