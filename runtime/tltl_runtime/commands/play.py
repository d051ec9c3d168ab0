"""``tltlc play``: a level in a window, played with the keyboard and judged by a spec while it is recorded."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Final

import click

from tltl_runtime.commands.ending import requests_heard
from tltl_runtime.commands.level_faults import level_faults
from tltl_runtime.commands.recording_files import RecordingFiles
from tltl_runtime.stealth.env import make_env
from tltl_runtime.stealth.episodes.file import SUFFIX
from tltl_runtime.stealth.keyboard import KeyboardPlayer
from tltl_runtime.stealth.pictures.camera import VIEWS, View
from tltl_runtime.stealth.pictures.hud import KEYS
from tltl_runtime.stealth.pictures.render import Renderer
from tltl_runtime.stealth.recording import RecordEpisode
from tltl_runtime.stealth.supply.feasible import reach_warnings
from tltl_runtime.stealth.window.window import Window
from tltlc.cli.report import show
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
        files = RecordingFiles(out, f"{shown.name}-{shown.variant}")
        # A spec that asks for what the level does not have is told before there is a window.
        env.reset()
        show(reach_warnings(shown, env.get_wrapper_attr("task").fspa), "text", sys.stderr)
        window = Window(f"{shown.name} {shown.variant}", _SIZE, side=True, sticky_crouch=crouch == "toggle")
        renderer = Renderer(shown, *_SIZE)
        try:
            KeyboardPlayer(env, window, renderer, view, files).play(seed)
        finally:
            renderer.close()
            window.close()
    finally:
        env.close()
