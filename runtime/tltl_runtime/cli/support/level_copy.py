"""``tltlc new --level``: copy a level with all of its files, for a designer to change."""

from __future__ import annotations

from pathlib import Path
from typing import Final

from tltl_runtime.game.level_name import Variant
from tltl_runtime.game.registry import game_of, shipped_levels
from tltl_runtime.gymnasium_games.level_scenes import level_of_scene
from tltl_runtime.support.suggestion import suggestion
from tltlc.api import Diagnostic, TltlError, fileio

_STARTER: Final = Path(__file__).parents[2] / "starter" / "vault.toml"
"""A small level to start with, the example of docs/levels.md."""

NAMES: Final = (_STARTER.stem, *shipped_levels())
"""The names of the levels that can be copied."""


def files(name: str) -> dict[str, str]:
    """Return the texts of all files of a level, and of a README, by file name.

    These are the level's own file, which comes first, its assets and overlays, and its spec. Names are
    relative to the level's folder. ``name`` is one of :data:`NAMES`, a ``.toml`` file, or a
    scene that stands for one of these.

    Raises:
        TltlError: TLT0800, there is no such level; the errors of loading it.
    """
    name = level_of_scene(name)
    if name not in NAMES and not name.endswith(".toml"):
        title = f"there is no level `{name}` to copy"
        raise TltlError([Diagnostic("TLT0800", title, help=suggestion(name, NAMES))])
    game = game_of(name)
    path = _STARTER if name == _STARTER.stem else game.level_files.path(name)
    levels = {Variant(text): game.load_level(str(path), text) for text in game.level_files.variants(str(path))}
    paths = {
        file_name: next(filter(Path.is_file, game.level_files.candidates(str(path), variant, file_name)))
        for variant, level in levels.items()
        for file_name, _ in level.files
    }
    spec = next(iter(levels.values())).spec
    if spec:
        paths[spec.file.name] = spec.file
    texts = {name: fileio.read_source(file, name).text for name, file in paths.items()}
    return {**texts, "README.md": _README.format(level=path.name, spec=spec.file.name if spec else "SPEC.tltl")}


_README: Final = """\
# A level of the stealth game

`{level}` describes what is in the level and where, and `{spec}` what a player has to do. `assets/` has files that
several levels may share, and `overlays/` the small changes that make the variants of the level. You can edit all of
these files; `docs/levels.md` of tltlc describes every key.

    tltlc check --level {level}                     does it have errors, and can a player meet its spec?
    tltlc check --level {level}:v0 --plan plan.png  what does it look like?
    tltlc play {level}                              play it yourself
    tltlc demonstrate {level}                       watch the scripted expert
    tltlc train {spec} --out bot                    train an agent (extra `rl`)
    tltlc evaluate bot                              see how often it succeeds, and where it fails
    tltlc test {spec}                               does the spec mean what you intend?

The name of the file is the name of the level. The spec has it, too, in `level NAME`: if you rename one, rename both.
"""
