"""The hash of a scene: it changes with everything in the game's files that can change an episode."""

from __future__ import annotations

import hashlib
from collections.abc import Iterator
from contextlib import suppress
from importlib.metadata import PackageNotFoundError, version
from itertools import pairwise
from os.path import relpath
from pathlib import Path

from tltl_runtime.gymnasium_games.game_argument import variant_of
from tltl_runtime.gymnasium_games.game_file import FIRST_VARIANT, GameFile
from tltl_runtime.gymnasium_games.python_files import content_of, possible_python_files, python_files
from tltl_runtime.support.json_hash import json_hash
from tltl_runtime.wire.wire_game import TLTL
from tltlc.api import fileio


def scene_hash(game: GameFile, scene: str, variant: str = FIRST_VARIANT) -> str:
    """Return the SHA-256, in hexadecimal, of everything in a game's files that can change an episode of a scene.

    It covers the entries of ``[game]`` that say how the game is made and what it shows, the name of the
    scene, its options, the contents of its ``files``, the files that the game consists of
    (:func:`game_files`), and the versions of the packages that ``[game]`` names. For a game in another
    process, it covers the name of the variant, too. It does not cover the spec. No code of the game
    runs.

    Raises:
        TltlError: TLT0800, there is no such scene or variant; TLT0001 or TLT0004, a file cannot be
            read or is too large.
    """
    own = variant_of(game, scene, variant)
    return json_hash(
        {
            "gymnasium": game.gymnasium,
            "python": game.python.text if game.python else None,
            **({"process": game.wire.process, "connect": game.wire.connect, "variant": variant} if game.wire else {}),
            **({"protocol": game.wire.protocol} if game.wire and game.wire.protocol != TLTL else {}),
            "import": game.modules,
            "signals": game.signals.text if game.signals else None,
            "clock_s": game.clock_s,
            "observation": game.observation,
            "scene": scene,
            "options": own.options,
            "files": {_name(game.folder, file): _hash(content_of(file)) for file in own.files},
            "python_files": {name: _hash(data) for name, data in game_files(game).items()},
            "packages": _package_versions(game),
        }
    )


def file_hashes(game: GameFile, scene: str, variant: str = FIRST_VARIANT) -> tuple[tuple[str, str], ...]:
    """Return the name and the SHA-256, in hexadecimal, of each file that a variant of a scene consists of.

    The first is the game file; the others are the scene's ``files``, and the files of
    :func:`game_files`. Names are relative to the folder of the game file.

    Raises:
        TltlError: the errors of :func:`scene_hash`.
    """
    own = variant_of(game, scene, variant)
    contents = {_name(game.folder, file): content_of(file) for file in (game.path, *own.files)}
    contents |= game_files(game)
    return tuple((name, _hash(data)) for name, data in contents.items())


def game_files(game: GameFile) -> dict[str, bytes]:
    """Return the contents of the files in a game's folder that the game consists of, by name.

    These are the Python files that the game imports. For a game in another process, they are the files
    that its command names, also as modules (``-m MODULE``), and the Python files that these import.
    Names are relative to the folder.

    Raises:
        TltlError: TLT0001 or TLT0004, a file cannot be read or is too large.
    """
    contents = python_files(game.folder, (*named_modules(game), *_run_modules(game)))
    for word in game.wire.process if game.wire else ():
        file = game.folder / word
        if not fileio.is_file(file) or not file.resolve().is_relative_to(game.folder.resolve()):
            continue
        contents[_name(game.folder, file)] = content_of(file)
        if file.suffix == ".py":
            imported = python_files(file.parent, [file.stem])
            contents |= {_name(game.folder, file.parent / name): data for name, data in imported.items()}
    return dict(sorted(contents.items()))


def possible_files(game: GameFile) -> list[Path]:
    """Return the paths of the Python files that a game may import, whether they exist or not."""
    return possible_python_files(game.folder, (*named_modules(game), *_run_modules(game)))


def _package_versions(game: GameFile) -> dict[str, str]:
    """Return the versions of the packages that a game file names, by module: ``{"minigrid": "2.3.1"}``.

    A module is left out unless an installed package has its name.
    """
    versions: dict[str, str] = {}
    for module in named_modules(game):
        top = module.partition(".")[0]
        with suppress(PackageNotFoundError):
            versions[top] = version(top)
    return versions


def named_modules(game: GameFile) -> list[str]:
    """Return the Python modules that a game file names, for example in ``import`` and ``signals``."""
    functions = [function.module for function in (game.python, game.signals) if function]
    registering, colon, _ = (game.gymnasium or "").partition(":")
    return [*game.modules, *functions, *([registering] if colon else [])]


def _run_modules(game: GameFile) -> Iterator[str]:
    """Yield the modules that the command of a game in another process runs: those after ``-m``.

    Python runs the module ``__main__`` of a package.
    """
    words = game.wire.process if game.wire else ()
    for option, word in pairwise(words):
        if option == "-m" and all(map(str.isidentifier, word.split("."))):
            yield from (word, f"{word}.__main__")


def _name(folder: Path, file: Path) -> str:
    return Path(relpath(file, folder)).as_posix()


def _hash(data: bytes) -> str:
    return hashlib.sha256(data).hexdigest()
