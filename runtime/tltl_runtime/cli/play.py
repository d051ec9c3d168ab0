"""``tltlc play``: play a level in a window with the keyboard; each episode is judged by a spec and recorded."""

from __future__ import annotations

from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

import click

from tltl_runtime.cli.support.keyboard_play import keyboard_of, keyboard_options, play_at_keyboard
from tltl_runtime.cli.support.level_faults import level_faults
from tltl_runtime.cli.support.recording_files import RecordingFiles
from tltl_runtime.cli.support.slow_starts import slow_starts_shown
from tltl_runtime.game.level_name import split_level
from tltl_runtime.game.recording_path import SUFFIX
from tltl_runtime.game.registry import STEALTH, game_named, game_of
from tltl_runtime.gymnasium_games.level_scenes import level_of_scene
from tltlc.api import cli

if TYPE_CHECKING:
    from tltl_runtime.game.keyboard import Crouch


def _keys() -> str:
    """Return the lines that say which key does what in the stealth game."""
    keyboard = game_named(STEALTH).keyboard
    return "\n".join(f"  {line}" for line in (keyboard.keys if keyboard else ()))


@click.command(
    epilog=f"""\b
Keys in a scene:
  those that `keys` in the game file names, one for each action
  else those of the environment's `get_keys_to_action()`
  else 1 to 9
  R starts again; Escape stops

\b
Keys in the stealth game:
{_keys()}

\b
Examples:
  tltlc play lake.game.toml:small
  tltlc play lake.game.toml:small:slippery --seed 7 -o mine.episode.npz
  tltlc play my_level.toml --spec my_plan.tltl:careful --view top_down
"""
)
@click.argument("level", metavar="LEVEL[:VARIANT]")
@click.option("--spec", metavar="SPEC[:NAME]", help="The spec that judges the player (default: the spec of the level).")
@click.option(
    "--seed", type=cli.WholeRange(min=0), help="The seed of the first episode (default: a new seed each time)."
)
@click.option(
    "--output",
    "--out",
    "-o",
    "out",
    metavar="PLACE",
    type=cli.OutputPath("place"),
    help=f"The recording: NAME{SUFFIX}, or a folder, which is created if it is missing. Older recordings are kept.",
)
@keyboard_options
@level_faults()
@slow_starts_shown()
def command(level: str, spec: str | None, seed: int | None, out: Path | None, view: str, crouch: Crouch) -> None:
    """Play a game with the keyboard, in a window.

    LEVEL is a scene of your game, `FILE.game.toml:SCENE`, or a level of the stealth game that comes with tltlc: its
    name (`tltlc list levels`) or its file.

    The spec judges you while you play: the screen shows what remains to be done. Each episode is recorded to a file,
    also if you stop it. `tltlc replay FILE` shows a recording.
    """
    _play(*split_level(level_of_scene(level)), spec, seed, out, view, crouch)


def _play(
    path: str, variant: str | None, spec: str | None, seed: int | None, out: Path | None, view: str, crouch: Crouch
) -> None:
    from tltl_runtime.game.recorder import closing_on_error

    game = game_of(path)
    level = game.load_level(path, variant or "v0")
    mode = keyboard_of(level).render_mode
    env = closing_on_error(
        game.make_env(path, variant or "v0", spec, render_mode=mode), partial(game.recorder, player="keyboard")
    )
    try:
        play_at_keyboard(env, level, partial(RecordingFiles, out), seed=seed, view=view, crouch=crouch)
    finally:
        env.close()
