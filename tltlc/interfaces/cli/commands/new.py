"""``tltlc new``: create a starter project."""

from __future__ import annotations

import shlex
from collections.abc import Mapping
from pathlib import Path
from typing import Final

import click

from tltlc.diagnostics.diagnostic import Diagnostic, TltlError
from tltlc.interfaces.cli import plugins
from tltlc.interfaces.cli.paths import OutputPath


@click.command(
    epilog="""\b
Examples:
  tltlc new my_game
  tltlc test my_game
  tltlc new my_hall --game python
  tltlc new my_vault --level vault
  tltlc play my_vault/vault.toml
"""
)
@click.argument("folder", metavar="NAME", type=OutputPath("folder"))
@click.option(
    "--level",
    metavar="LEVEL",
    help="Copy a level of the stealth game that comes with tltlc, with its spec, assets and overlays: the small level "
    "`vault`, or one from `tltlc list levels`.",
)
@click.option(
    "--game",
    metavar="KIND",
    help="Write a small game that agents can play, with its level, spec, suite and CI file: `godot`, `love`, "
    "`python`, `unity`, `unreal` or `web`.",
)
def command(folder: Path, level: str | None, game: str | None) -> int:
    """Create the folder NAME with a spec that compiles, a test, a recorded trace and a project file.

    With --game, the folder contains a small game instead, which agents can play at once. With --level, it contains a
    level for you to change, of the stealth game that comes with tltlc.
    """
    from tltlc.interfaces.cli.folders import is_free, occupied_folder_error
    from tltlc.interfaces.cli.report import Report
    from tltlc.io.writing import write_files

    with Report() as report:
        if not is_free(folder):
            raise occupied_folder_error(folder, "choose another name, or an empty folder")
        files, steps = _files(folder, level, game)
        for path in write_files(folder, files, advice="choose another place, e.g. `tltlc new my_game`"):
            report.say(f"wrote {path}")
        for step in steps:
            report.say(f"Next: {step}")
    return report.status


def _files(folder: Path, level: str | None, game: str | None) -> tuple[Mapping[str, str], tuple[str, ...]]:
    """Return the texts of the new files by path, and the commands that follow.

    Raises:
        TltlError: TLT0700, both a level and a game; the errors of the plugin that knows the level or the game.
    """
    if level is not None and game is not None:
        title, help_ = "a new folder has either a level or a game", "leave out --level or --game"
        raise TltlError([Diagnostic("TLT0700", title, help=help_)])
    if game is not None:
        texts, commands = plugins.load_from("tltlc.games", "new", "`tltlc new --game`")(game)
        return texts, (f"cd {shlex.quote(str(folder))}", *commands)
    if level is not None:
        texts = plugins.load_from("tltlc.levels", "new", "`tltlc new --level`")(level)
        return texts, (f"tltlc check --level {shlex.quote(str(folder / next(iter(texts))))}",)
    return _FILES, (f"tltlc test {shlex.quote(str(folder))}",)


_SPEC: Final = """\
// What a playtester should manage in the first level.
import stealth

entity key, door
exclusive near(key), near(door)

/// Fetch the key, then leave by the door, alive.
spec leave_with_key {
    limit 200 steps
    reach near(key) then near(door)
    keep alive
}

test "the door alone is not enough" for leave_with_key {
    step alive, near(door)
    expect pending
}

test "key, then door" for leave_with_key {
    step 3x alive
    step alive, near(key)
    step alive, near(door)
    expect holding
}
"""

_TRACE: Final = """\
step,distance(key),distance(door),health
1,8.0,12.0,1.0
2,5.5,9.5,1.0
3,3.0,7.5,0.9
4,0.5,6.0,0.9
5,2.5,4.0,0.9
6,4.5,2.0,0.8
7,6.0,0.4,0.8
"""

_PROJECT: Final = """\
# Every key is optional.
targets = ["json", "dot", "python"]   # `tltlc list targets` shows them all
libraries = []                        # folders of your own predicate libraries

[style]
notation = "unicode"                  # of formulas in pictures: unicode, ascii or english
"""

_README: Final = """\
# A plan for a playtester

`first_level.tltl` says what a player has to do in the first level; `first_level.csv` is a recorded trace.

    tltlc check first_level.tltl                      does it have errors?
    tltlc explain first_level.tltl                    what does it ask for?
    tltlc lint first_level.tltl                       does it have likely mistakes?
    tltlc test first_level.tltl                       do its tests pass?
    tltlc compile first_level.tltl -o build           the automaton and its monitor
    tltlc render first_level.tltl -o first_level.svg  a picture of it
    tltlc monitor first_level.tltl first_level.csv    does the trace meet it?

While you write, `tltlc watch` checks, lints and tests the spec whenever you save it. `tltlc serve --open` opens a page
for trying out specs.
"""

_FILES: Final = {
    "tltl.toml": _PROJECT,
    "first_level.tltl": _SPEC,
    "first_level.csv": _TRACE,
    "README.md": _README,
}
