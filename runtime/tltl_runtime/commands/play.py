"""``tltlc play``: a level in a window, played with the keyboard and judged by a spec while it is recorded."""

from __future__ import annotations

import os
import sys
from contextlib import suppress
from pathlib import Path
from tempfile import gettempdir
from typing import Final

import click

from tltl_runtime.commands.ending import requests_heard
from tltl_runtime.commands.level_faults import level_faults
from tltl_runtime.stealth.env import make_env
from tltl_runtime.stealth.episodes.cause import cause
from tltl_runtime.stealth.episodes.episode import Episode
from tltl_runtime.stealth.episodes.file import SUFFIX, write_episode
from tltl_runtime.stealth.keyboard import KeyboardPlayer
from tltl_runtime.stealth.pictures.camera import VIEWS, View
from tltl_runtime.stealth.pictures.hud import KEYS
from tltl_runtime.stealth.pictures.render import Renderer
from tltl_runtime.stealth.recording import RecordEpisode
from tltl_runtime.stealth.supply.feasible import warnings
from tltl_runtime.stealth.window.window import Window
from tltlc.cli.report import show
from tltlc.diagnostics.diagnostic import Diagnostic, TltlError
from tltlc.files import reason
from tltlc.spec_file import split

CROUCHES: Final = ("hold", "toggle")
_SIZE: Final = (640, 400)


@click.command(
    epilog=f"""\b
Keys:
  {KEYS[0]}
  {KEYS[1]}

\b
Examples:
  tltlc play cover_and_hide
  tltlc play branching:v1 --seed 7 -o mine.episode.npz
  tltlc play my_level.toml --spec my_plan.tltl:careful --view top_down
"""
)
@click.argument("level", metavar="LEVEL[:VARIANT]")
@click.option(
    "--spec", metavar="SPEC[:NAME]", help="What is to be done; by default the spec that the level is made for."
)
@click.option("--seed", type=click.IntRange(min=0), help="Of the first episode; by default another one each time.")
@click.option(
    "--output",
    "--out",
    "-o",
    "out",
    metavar="PLACE",
    type=click.Path(path_type=Path),
    help=f"Where to record: NAME{SUFFIX}, or a folder, made where it is missing.  Older recordings stay.",
)
@click.option("--view", type=click.Choice(VIEWS), default="third_person", show_default=True)
@click.option("--crouch", type=click.Choice(CROUCHES), default="hold", show_default=True, help="What C does.")
@level_faults()
def command(level: str, spec: str | None, seed: int | None, out: Path | None, view: View, crouch: str) -> None:
    """Play a level with the keyboard, in real time, in a window.

    The spec judges while you play: the screen shows what it still asks for.  Each episode is recorded to a file,
    those that you stop, too.  `tltlc replay FILE` shows a recording.
    """
    with requests_heard():
        _play(*split(level), spec, seed, out, view, crouch)


def _play(
    path: str, variant: str | None, spec: str | None, seed: int | None, out: Path | None, view: View, crouch: str
) -> None:
    env = RecordEpisode(make_env(path, variant or "v0", spec), "keyboard")
    try:
        shown = env.unwrapped.level  # type: ignore[attr-defined]
        files = Files(out, f"{shown.name}-{shown.variant}")
        # A spec that asks for what the level does not have is told before there is a window.
        env.reset()
        show(warnings(shown, env.get_wrapper_attr("task").fspa), "text", sys.stderr)
        window = Window(f"{shown.name} {shown.variant}", _SIZE, side=True, sticky_crouch=crouch == "toggle")
        renderer = Renderer(shown, *_SIZE)
        try:
            KeyboardPlayer(env, window, renderer, view, files).play(seed)
        finally:
            renderer.close()
            window.close()
    finally:
        env.close()


class Files:
    """Where episodes are written: to new files, with a number where there is one of that name already."""

    def __init__(self, out: Path | None, name: str) -> None:
        self._folder, self._name = Path(), name
        self._unfinished: Path | None = None
        if out is not None and out.name.endswith(SUFFIX):
            self._folder, self._name = out.parent, out.name.removesuffix(SUFFIX)
        elif out is not None:
            if out.suffix and not out.is_dir():
                raise click.UsageError(
                    f"--output is a folder or a name with {SUFFIX}, not `{out}`", click.get_current_context(silent=True)
                )
            self._folder = out
        why = _refusal(self._folder, make=self._folder == out)
        if why:
            title = f"cannot record to `{self._folder}`: {why}"
            raise TltlError([Diagnostic("TLT0005", title, help="name another place with -o")])

    def keep(self, episode: Episode) -> None:
        """Write an episode that goes on, to be there if the process is killed; ``save`` takes it away again."""
        if self._unfinished is None:
            self._unfinished = self._new(self._folder, f"{self._name}.unfinished")
        with suppress(TltlError):
            write_episode(self._unfinished, episode)

    def save(self, episode: Episode) -> str:
        """Write an episode, where it must be to the folder for temporary files, and return its name."""
        path = self._new(self._folder, self._name)
        try:
            write_episode(path, episode)
        except TltlError as error:
            click.echo(f"{error}", err=True)
            path = self._new(Path(gettempdir()), self._name)
            write_episode(path, episode)
        if self._unfinished is not None:
            self._unfinished.unlink(missing_ok=True)
            self._unfinished = None
        click.echo(f"{path}: {_judged(episode)}")
        return str(path)

    @staticmethod
    def _new(folder: Path, name: str) -> Path:
        """A file that is not there yet."""
        path, number = folder / f"{name}{SUFFIX}", 1
        while path.exists():
            number += 1
            path = folder / f"{name}-{number}{SUFFIX}"
        return path


def _refusal(folder: Path, make: bool) -> str:
    """Why nothing can be written to a folder, which is made where that is asked for; empty where it can."""
    try:
        if make:
            folder.mkdir(parents=True, exist_ok=True)
    except (OSError, ValueError) as error:
        return reason(error)
    if not folder.is_dir():
        return "there is no such folder"
    return "" if os.access(folder, os.W_OK) else "permission denied"


def _judged(episode: Episode) -> str:
    return f"{cause(episode).text}; {episode.verdict}, progress {episode.progress[-1]:.2f}, seed {episode.seed}"
