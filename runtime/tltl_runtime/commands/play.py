"""``tltlc play``: a level in a window, played with the keyboard and judged by a spec while it is recorded."""

from __future__ import annotations

import os
import signal
import sys
from pathlib import Path
from tempfile import gettempdir
from typing import Any

import click

from tltl_runtime.stealth.env import make_env
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
from tltlc.spec_file import split

_SIZE = (640, 400)


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
    "-o", "--out", metavar="FILE", type=click.Path(path_type=Path), help=f"Where to record: NAME{SUFFIX}, or a folder."
)
@click.option("--view", type=click.Choice(VIEWS), default="third_person", show_default=True)
def command(level: str, spec: str | None, seed: int | None, out: Path | None, view: View) -> None:
    """Play a level with the keyboard, in real time, in a window.

    The spec judges while you play: the screen shows what it still asks for.  Each episode is recorded to a file,
    those that you stop, too.  `tltlc replay FILE` shows a recording.
    """
    path, variant = split(level)
    # Asked to end, it records what was played, as it does for Ctrl-C.
    for name in ("SIGTERM", "SIGHUP"):
        if hasattr(signal, name):
            signal.signal(getattr(signal, name), _interrupt)
    env = RecordEpisode(make_env(path, variant or "v0", spec), "keyboard")
    try:
        shown = env.unwrapped.level  # type: ignore[attr-defined]
        files = Files(out, f"{shown.name}-{shown.variant}")
        # A spec that asks for what the level does not have is told before there is a window.
        env.reset()
        show(warnings(shown, env.get_wrapper_attr("task").fspa), "text", sys.stderr)
        window = Window(f"{shown.name} {shown.variant}", _SIZE, side=True)
        renderer = Renderer(shown, *_SIZE)
        try:
            KeyboardPlayer(env, window, renderer, view, files.save).play(seed)
        finally:
            renderer.close()
            window.close()
    finally:
        env.close()


class Files:
    """Where episodes are written: a file that is named, or new ones in a folder that is, else in the current one."""

    def __init__(self, out: Path | None, name: str) -> None:
        self._folder, self._name, self._replace = Path(), name, False
        if out is not None and out.is_dir():
            self._folder = out
        elif out is not None:
            if not out.name.endswith(SUFFIX):
                raise click.UsageError(
                    f"--out is a folder or a name with {SUFFIX}, not `{out}`", click.get_current_context(silent=True)
                )
            self._folder, self._name, self._replace = out.parent, out.name.removesuffix(SUFFIX), True
        if not os.access(self._folder, os.W_OK):
            title = f"cannot write to `{self._folder}`"
            raise TltlError([Diagnostic("TLT0005", title, help="name another place with -o")])

    def save(self, episode: Episode) -> str:
        """Write an episode, where it must be to the folder for temporary files, and return its name."""
        path = self._next(self._folder)
        try:
            write_episode(path, episode)
        except TltlError as error:
            click.echo(f"{error}", err=True)
            path = self._next(Path(gettempdir()))
            write_episode(path, episode)
        click.echo(f"{path}: {_judged(episode)}")
        return str(path)

    def _next(self, folder: Path) -> Path:
        """The file that was named, the first time; later, and without one, one that is not there yet."""
        path, number = folder / f"{self._name}{SUFFIX}", 1
        if self._replace:
            self._replace = False
            return path
        while path.exists():
            number += 1
            path = folder / f"{self._name}-{number}{SUFFIX}"
        return path


def _judged(episode: Episode) -> str:
    ended = f"{episode.end} after {episode.snapshots[-1].time:.1f} s"
    return f"{ended}, {episode.verdict}, progress {episode.progress[-1]:.2f}, seed {episode.seed}"


def _interrupt(*_: Any) -> None:
    raise KeyboardInterrupt
