"""``tltlc new --level``: copy a level with all of its files, for a designer to change."""

from __future__ import annotations

from pathlib import Path
from typing import Final

from tltl_runtime.stealth.levels.default_spec import LEVELS
from tltl_runtime.stealth.levels.file import level_names, level_path, load_level, variants
from tltl_runtime.support.suggestion import suggestion
from tltlc.api import Diagnostic, TltlError, fileio

_STARTER: Final = Path(__file__).parents[2] / "starter" / "vault.toml"
"""A small level to start with, the example of docs/levels.md."""

NAMES: Final = (_STARTER.stem, *level_names())
"""The names of the levels that can be copied."""


def files(name: str) -> dict[str, str]:
    """Return the texts of a level's files (with assets, overlays, spec) and of a README, by file name.

    Names are relative to the level's folder. The level's own file is the first. ``name`` is one of
    :data:`NAMES` or a ``.toml`` file.

    Raises:
        TltlError: TLT0800, there is no such level; the errors of :func:`load_level`.
    """
    if name not in NAMES and not name.endswith(".toml"):
        title = f"there is no level `{name}` to copy"
        raise TltlError([Diagnostic("TLT0800", title, help=suggestion(name, NAMES))])
    path = _STARTER if name == _STARTER.stem else level_path(name)
    levels = [load_level(str(path), variant) for variant in variants(str(path))]
    names = dict.fromkeys(name for level in levels for name, _ in level.files)
    paths = {name: next(place / name for place in (path.parent, LEVELS) if (place / name).is_file()) for name in names}
    spec = levels[0].spec
    if spec:
        paths[spec.file.name] = spec.file
    texts = {name: fileio.read_source(file, name).text for name, file in paths.items()}
    return {**texts, "README.md": _README.format(level=path.name, spec=spec.file.name if spec else "SPEC.tltl")}


_README: Final = """\
# A level of the stealth game

`{level}` describes what is in the level and where, and `{spec}` what a player has to do. `assets/` has files that
several levels may share, and `overlays/` the small changes that make the variants of the level. You can edit all of
these files; `docs/levels.md` of tltlc describes every key.

    tltlc check --level {level}                     is it right, and can anybody do it?
    tltlc check --level {level}:v0 --plan plan.png  what does it look like?
    tltlc play {level}                              play it yourself
    tltlc demonstrate {level}                       watch the scripted expert
    tltlc train {spec} --out bot                    train an agent (extra `rl`)
    tltlc evaluate bot                              see how often it succeeds, and where it fails
    tltlc test {spec}                               does the spec mean what you intend?

The name of the file is the name of the level, as in `level NAME` in the spec: if you rename one, rename both.
"""
