"""The rows of ``tltlc list games``."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence
from pathlib import Path
from typing import Any

from tltl_runtime.game.level import LevelSpec
from tltl_runtime.game.level_files import LevelFiles
from tltl_runtime.game.level_name import Variant
from tltl_runtime.game.registry import STEALTH, game_named, game_of, shipped_levels
from tltl_runtime.gymnasium_games.game_file import SUFFIX, GameFile, read_game_file
from tltl_runtime.gymnasium_games.level_scenes import level_of_scene
from tltl_runtime.support.path_text import path_text
from tltlc.api import Diagnostic, TltlError, fileio

Row = dict[str, str]


def rows(add: Callable[[Sequence[Diagnostic]], object]) -> Iterator[Row]:
    """Yield a row for each variant of each scene of each game.

    These are the levels of the stealth game, the scenes of the game files in the current folder,
    and those of the game that the project file names. ``add`` gets the errors of files that cannot
    be read.
    """
    yield from _levels(game_named(STEALTH).level_files, shipped_levels())
    for path in _game_files(add):
        try:
            game = read_game_file(path)
        except TltlError as error:
            add(error.diagnostics)
            continue
        if game.levels is not None:
            yield from _scenes_of_levels(game, add)
            continue
        for scene in game.scenes:
            for variant, own in scene.variants.items():
                spec = path_text(Path(own.spec.text)) if own.spec else ""
                yield {"game": path_text(path), "scene": scene.name, "variant": variant, "spec": spec}


def _scenes_of_levels(game: GameFile, add: Callable[[Sequence[Diagnostic]], object]) -> Iterator[Row]:
    """Yield the rows of a game whose scenes stand for levels; ``add`` gets the errors of levels."""
    path = path_text(game.path)
    for scene in game.scenes:
        level = level_of_scene(f"{game.path}:{scene.name}")
        try:
            yield from [
                {**row, "game": path, "scene": scene.name} for row in _levels(game_of(level).level_files, [level])
            ]
        except TltlError as error:
            add(error.diagnostics)


def _levels(level_files: LevelFiles[Any], levels: Iterable[str]) -> Iterator[Row]:
    for level in levels:
        for variant in level_files.variants(level):
            spec = level_files.load_with_changes(level, Variant(variant))[0].spec
            yield {"game": STEALTH, "scene": level, "variant": variant, "spec": _short_text(spec)}


def _short_text(spec: LevelSpec | None) -> str:
    """Return a level's spec as ``FILE.tltl:NAME``, without the folder; an empty text for None."""
    return LevelSpec(Path(spec.file.name), spec.name).text if spec else ""


def _game_files(add: Callable[[Sequence[Diagnostic]], object]) -> list[Path]:
    """Return the game files in the current folder, and the game file that the project file names; each once.

    ``add`` gets the errors of the project file.
    """
    paths = sorted(filter(fileio.may_be_file, Path().glob(f"*{SUFFIX}")))
    try:
        game = fileio.project_for("-").game
    except TltlError as error:
        add(error.diagnostics)
        game = None
    return paths if game is None or game.resolve() in {path.resolve() for path in paths} else [*paths, game]
