"""Find and read the scenes of game files."""

from __future__ import annotations

import json
from collections.abc import Iterator
from os.path import relpath
from pathlib import Path
from typing import Any

from tltl_runtime.game.level_files import LevelFiles
from tltl_runtime.game.level_name import Variant, split_scene
from tltl_runtime.gymnasium_games.game_argument import scene_of, variant_of
from tltl_runtime.gymnasium_games.game_file import FIRST_VARIANT, GameFile, GameScene, read_game_file
from tltl_runtime.gymnasium_games.installed_code import own_package_files
from tltl_runtime.gymnasium_games.scene_hash import file_hashes, possible_files, scene_hash
from tltl_runtime.gymnasium_games.scene_level import SceneLevel
from tltl_runtime.spec.spec_files import spec_files
from tltlc.api import Diagnostic, TltlError


class SceneFiles(LevelFiles[SceneLevel]):
    """Finds and reads scenes. The name of a scene is ``FILE.game.toml`` or ``FILE.game.toml:SCENE``."""

    def names(self) -> tuple[str, ...]:
        """Return no names: no game file comes with the package."""
        return ()

    def path(self, name: str) -> Path:
        """Return the path of the game file."""
        return Path(split_scene(name)[0])

    def level_name(self, name: str) -> str:
        """Return the name of a scene. If ``name`` has none, read the game file and return its first scene's name."""
        return split_scene(name)[1] or _scene(name)[1].name

    def variants(self, name: str) -> tuple[str, ...]:
        """Return the variants of a scene, in the order of the game file."""
        return tuple(_scene(name)[1].variants)

    def overlays(self, name: str) -> tuple[str, ...]:
        """Return no names: scenes have no overlays."""
        del name
        return ()

    def load_with_changes(self, name: str, variant: Variant) -> tuple[SceneLevel, tuple[str, ...]]:
        """Load a scene in one of its variants; also return a sentence on what the variant changes in the scene.

        Without a change in the game file, there is no sentence.

        Raises:
            TltlError: the errors of ``read_game_file``; TLT0800, there is no such scene or variant.
        """
        if variant.overlays:
            title = f"`{variant.overlays[0]}` cannot be added: the scenes of a game file have no overlays"
            raise TltlError([Diagnostic("TLT0800", title, help="write a variant in the game file instead")])
        game, scene = _scene(name)
        own = variant_of(game, scene.name, variant.name)
        level = SceneLevel(
            name=scene.name,
            variant=variant.name,
            game_name=game.name,
            options=own.options,
            spec=own.spec,
            content_hash=scene_hash(game, scene.name, variant.name),
            files=file_hashes(game, scene.name, variant.name),
            place=f"{game.path}:{scene.name}",
        )
        changes = _changes_text(game, scene, variant.name)
        return level, ((changes,) if changes else ())

    def dependencies(self, name: str, variant: Variant) -> Iterator[Path]:
        """Yield the game file, the files of the scene, the Python files that the game imports, and the spec.

        If the game file or one of these files cannot be read, yield the game file and its folder instead.
        """
        yield self.path(name)
        try:
            game, scene = _scene(name)
            own = variant_of(game, scene.name, variant.name)
            yield from (game.folder / file for file, _ in file_hashes(game, scene.name, variant.name))
            yield from possible_files(game)
            yield from own_package_files(game)
        except TltlError:
            # Any file in the folder may have the error, or a file may be missing in it.
            yield self.path(name).parent
            return
        if own.spec is not None:
            yield from spec_files(own.spec.file)

    def candidates(self, name: str, variant: Variant, file_name: str) -> Iterator[Path]:
        """Yield the only path at which a file of the scene may be: its name is relative to the game file's folder."""
        del variant
        yield self.path(name).parent / file_name


def _changes_text(game: GameFile, scene: GameScene, variant: str) -> str:
    """Say which options and files of a scene a variant changes: ```large`: `size` = 8, was 6``; empty for none."""
    first, own = (variant_of(game, scene.name, name) for name in (FIRST_VARIANT, variant))
    texts = []
    for name, value in own.options.items():
        if name not in first.options:
            texts.append(f"`{name}` = {_value_text(value)}")
        elif first.options[name] != value:
            texts.append(f"`{name}` = {_value_text(value)}, was {_value_text(first.options[name])}")
    texts += [f"also {relpath(file, game.folder)}" for file in own.files if file not in first.files]
    return f"`{variant}`: {'; '.join(texts)}" if texts else ""


def _value_text(value: Any) -> str:
    return json.dumps(value, ensure_ascii=False, default=str)


def _scene(name: str) -> tuple[GameFile, GameScene]:
    path, scene = split_scene(name)
    game = read_game_file(Path(path))
    return game, scene_of(game, scene)
