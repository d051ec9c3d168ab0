"""The hash of a scene: it changes with everything in the game's files that can change an episode."""

from __future__ import annotations

import hashlib
from os.path import relpath
from pathlib import Path

from tltl_runtime.gymnasium_games.game_argument import variant_of
from tltl_runtime.gymnasium_games.game_file import FIRST_VARIANT, GameFile
from tltl_runtime.gymnasium_games.python_files import content_of, python_files
from tltl_runtime.support.json_hash import json_hash


def scene_hash(game: GameFile, scene: str, variant: str = FIRST_VARIANT) -> str:
    """Return the SHA-256, in hexadecimal, of what the game's files say about a variant of a scene.

    It covers the entries of ``[game]``, the name of the scene, its options, the contents of its
    ``files``, and the Python files in the game's folder that the game imports. It does not cover the
    spec, and packages outside the folder. No code of the game runs.

    Raises:
        TltlError: TLT0800, there is no such scene or variant; TLT0001 or TLT0004, a file cannot be
            read or is too large.
    """
    own = variant_of(game, scene, variant)
    return json_hash(
        {
            "gymnasium": game.gymnasium,
            "python": game.python.text if game.python else None,
            **({"process": game.wire.process} if game.wire else {}),
            "import": game.modules,
            "signals": game.signals.text if game.signals else None,
            "clock_s": game.clock_s,
            "observation": game.observation,
            "scene": scene,
            "options": own.options,
            "files": {_name(game.folder, file): _hash(content_of(file)) for file in own.files},
            "python_files": {
                name: _hash(data) for name, data in python_files(game.folder, _named_modules(game)).items()
            },
        }
    )


def file_hashes(game: GameFile, scene: str, variant: str = FIRST_VARIANT) -> tuple[tuple[str, str], ...]:
    """Return the name and the SHA-256, in hexadecimal, of each file that a variant of a scene consists of.

    The first is the game file; the others are the scene's ``files``, and the Python files in the game's
    folder that the game imports. Names are relative to this folder.

    Raises:
        TltlError: the errors of :func:`scene_hash`.
    """
    own = variant_of(game, scene, variant)
    contents = {_name(game.folder, file): content_of(file) for file in (game.path, *own.files)}
    contents |= python_files(game.folder, _named_modules(game))
    return tuple((name, _hash(data)) for name, data in contents.items())


def _named_modules(game: GameFile) -> list[str]:
    """Return the modules that a game file names."""
    functions = [function.module for function in (game.python, game.signals) if function]
    registering, colon, _ = (game.gymnasium or "").partition(":")
    return [*game.modules, *functions, *([registering] if colon else [])]


def _name(folder: Path, file: Path) -> str:
    return Path(relpath(file, folder)).as_posix()


def _hash(data: bytes) -> str:
    return hashlib.sha256(data).hexdigest()
