"""Interpret arguments that may name levels, and report levels whose files are missing."""

from __future__ import annotations

import re
from difflib import get_close_matches
from pathlib import Path
from shlex import quote
from typing import TYPE_CHECKING

import click

from tltl_runtime.game.level_name import GAME_FILE, is_scene, level_file, split_level, with_level_file
from tltl_runtime.game.registry import game_of, shipped_levels
from tltl_runtime.gymnasium_games.level_scenes import level_of_scene
from tltl_runtime.spec.task import read_spec
from tltlc.api import Diagnostic, TltlError, fileio

if TYPE_CHECKING:
    from tltl_runtime.gymnasium_games.game_file import GameFile


def names_level(text: str) -> bool:
    """Whether a text is not an existing path, and names a level of the package: ``LEVEL`` or ``LEVEL:VARIANT``."""
    return not fileio.exists(text) and split_level(text)[0] in shipped_levels()


def check_spelling(text: str) -> None:
    """Raise TltlError, TLT0001, if a text looks like a misspelt name of a level, such as ``navigatoin``.

    The text is compared with the names of the levels in the package. The path of an existing file, and
    a text with a folder or an extension, are accepted.
    """
    name = split_level(text)[0]
    close = get_close_matches(name, shipped_levels(), n=1)
    if close and re.fullmatch(r"[\w-]+", name) and not fileio.exists(text):
        title = f"there is neither a file nor a level `{text}`"
        raise TltlError([Diagnostic("TLT0001", title, help=f"did you mean the level `{close[0]}`?")])


def check_named(policy: Path | None, level: str | None) -> None:
    """Check that the policy and the level exist, before the slow import of the modules that play.

    Raises:
        TltlError: the error that reading the policy or the level would raise.
    """
    if policy is not None and not names_level(level_of_scene(str(policy))) and not fileio.exists(policy):
        check_spelling(str(policy))
        check_no_scene(policy)
        fileio.read_bytes(policy, str(policy), 0)
    if level is not None:
        name, variant = split_level(level)
        game_of(name).load_level(name, variant or "v0")


def check_no_scene(policy: Path) -> None:
    """Check that the argument for a policy is no scene of a game file.

    Raises:
        TltlError: TLT0840, it is one; the game file cannot be read, or has no such scene.
    """
    place = split_level(str(policy))[0]
    if is_scene(place) and not fileio.is_dir(policy):
        game_of(place).level_files.variants(place)
        title = f"`{policy}` is a scene of a game file, not a policy"
        help_ = "name a .safetensors file, or the folder of a training; name the scene with --game"
        raise TltlError([Diagnostic("TLT0840", title, help=help_)])


def check_no_toml(spec: str | None, settings: str = "") -> None:
    """Raise UsageError if a ``.toml`` file is given as a spec.

    The message suggests ``--level``. ``settings`` is the command's option for a settings file, such
    as ``--config``; the message suggests it, too. It is empty if the command has no such option.
    """
    path = fileio.split_spec_name(spec)[0] if spec else ""
    if path.endswith(".toml"):
        suggestions = [f"if it contains settings, write `{settings} {quote(path)}`"] if settings else []
        if is_scene(split_level(spec or path)[0]):
            suggestions = [f"if it is a scene of your game, write `--game {quote(spec or path)}`"]
        else:
            suggestions.append(f"if it is a level, write `--level {quote(spec or path)}`")
        raise click.UsageError(f"`{path}` is not a spec: {'; '.join(suggestions)}", click.get_current_context())


def check_level_exists(level: str, variant: str, command: str) -> None:
    """Raise TltlError, TLT0001, if a level's file is missing; a level of the package has none.

    The help of the error suggests ``command`` with ``--level``, or with ``--game`` for a scene of a game
    file.
    """
    file = level_file(level)
    if file is not None and not fileio.exists(file):
        suffix = "" if variant == "v0" else f":{variant}"
        option = "--level FILE.toml"
        if is_scene(level):
            option = f"--game {with_level_file(level, Path(f'FILE{GAME_FILE}'))}"
        title = f"the file of the level, `{file}`, no longer exists"
        help_ = f"put it back, or say where it is now: `{command} {option}{suffix}`"
        raise TltlError([Diagnostic("TLT0001", title, help=help_)])


def own_level(spec: str, how: str = "with --level") -> str:
    """Return the level that a spec names, as an argument of commands.

    Look for a file ``LEVEL.toml`` beside the spec, then for a scene of the project's game, then for a
    level of the package. If the spec names no level, return the scene of the project's game that is made
    for the spec, or its only scene. ``how`` says in messages how to name a level.

    Raises:
        UsageError: the spec names no level, and there is no such scene.
        TltlError: TLT0800, the level does not exist; the spec or the project's game file cannot be read.
    """
    fspa, _ = read_spec(spec)
    path = fileio.split_spec_name(spec)[0]
    game = _project_game(path)
    if fspa.level is None:
        scene = None if game is None else game.scene_for(Path(path), fspa.name)
        if game is not None and scene is not None:
            return level_of_scene(f"{game.path}:{scene.name}")
        message = f"`{fspa.name}` does not name a level: name one {how}"
        raise click.UsageError(message, click.get_current_context())
    beside = Path(path).parent / f"{fspa.level}.toml"
    if fileio.is_file(beside):
        return str(beside)
    if game is not None and fspa.level in [scene.name for scene in game.scenes]:
        return level_of_scene(f"{game.path}:{fspa.level}")
    if fspa.level not in shipped_levels():
        title = (
            f"there is no level `{fspa.level}`: `{beside}` does not exist, and no level of that name comes with tltlc"
        )
        raise TltlError([Diagnostic("TLT0800", title, help=f"name its file {how}")])
    return fspa.level


def _project_game(spec: str) -> GameFile | None:
    """Return the game that is named by the project file for ``spec``; None if there is none."""
    path = fileio.project_for(spec).game
    if path is None:
        return None
    from tltl_runtime.gymnasium_games.game_file import read_game_file

    return read_game_file(path)
