"""Levels and variants in arguments: ``LEVEL``, ``LEVEL:VARIANT``, ``LEVEL:VARIANT+OVERLAY``.

A level may also be a scene of a game file: ``FILE.game.toml``, ``FILE.game.toml:SCENE`` or
``FILE.game.toml:SCENE:VARIANT``. Without ``SCENE``, it is the first scene of the file.
"""

from __future__ import annotations

import os
import re
from pathlib import Path
from typing import Final

from tltlc.api import record

_PLACE: Final = re.compile(r"(.+?):([A-Za-z_][A-Za-z0-9_]*(?:\+.+)?)\Z", re.DOTALL)
GAME_FILE: Final = ".game.toml"
"""The ending of the names of game files."""

_SCENE: Final = re.compile(
    rf"(?P<file>.+?{re.escape(GAME_FILE)})(?::(?P<scene>[^:]+)(?::(?P<variant>[^:]+))?)?\Z", re.DOTALL
)
_OVERLAY: Final = re.compile(r"\+([^+/\\]*(?=\+|\Z)|.+?\.toml(?=\+|\Z)|[^+]*)", re.DOTALL)


@record
class Variant:
    """A variant of a level, and the overlays that are added to it, in order.

    An overlay is a name or the path of a ``.toml`` file.
    """

    name: str
    overlays: tuple[str, ...] = ()

    @property
    def text(self) -> str:
        """The variant as an argument: the text that :func:`parse_variant` parses.

        Paths that contain a ``+`` are made absolute: the text would be ambiguous otherwise.
        """
        has_plus = re.compile(r".*\+.*\.toml\Z", re.DOTALL).match
        return "+".join(
            (self.name, *(_absolute(overlay) if has_plus(overlay) else overlay for overlay in self.overlays))
        )

    @property
    def title(self) -> str:
        """The variant as reports show it: ``v0+wider`` for ``v0+mine/wider.toml``."""
        overlays = (Path(overlay).stem if overlay.endswith(".toml") else overlay for overlay in self.overlays)
        return "+".join((self.name, *overlays))

    def absolute(self) -> Variant:
        """Return the variant with absolute overlay paths, for loading from another folder."""
        return Variant(
            self.name,
            tuple(_absolute(overlay) if overlay.endswith(".toml") else overlay for overlay in self.overlays),
        )


def split_level(argument: str) -> tuple[str, str | None]:
    """Split an argument into a level and a variant, for :meth:`~tltl_runtime.game.game.Game.load_level`.

    ``"vault:v1" -> ("vault", "v1")``, and ``"lake.game.toml:small" -> ("lake.game.toml:small", None)``.
    The variant is None if the argument has none. The path of an existing file is not split, unless it
    is a game file, and neither is a drive letter of Windows.
    """
    scene = _SCENE.match(argument)
    if scene:
        level = scene["file"] if scene["scene"] is None else f"{scene['file']}:{scene['scene']}"
        return level, scene["variant"]
    match = _PLACE.match(argument)
    if not match or os.path.exists(argument):  # noqa: PTH110
        return argument, None
    level, variant = match.groups()
    if len(level) == 1 and level.isalpha() and os.name == "nt":
        return argument, None
    return level, variant


def is_scene(level: str) -> bool:
    """Whether a level, named without a variant, is a scene of a game file, such as ``lake.game.toml:small``."""
    return _SCENE.match(level) is not None


def level_file(level: str) -> Path | None:
    """Return the path of the level file or game file in the name of a level; None if the name has no path.

    Without a path, the level comes with the package. ``level`` has no variant.
    """
    if is_scene(level):
        return Path(split_scene(level)[0])
    return Path(level) if level.endswith(".toml") else None


def level_stem(level: str) -> str:
    """Return a short name for a level, named without a variant: ``mine/vault.toml`` has the name ``vault``.

    For a scene of a game file, this is the name of the scene or, without one, that of the game file.
    """
    file, scene = split_scene(level) if is_scene(level) else (level, None)
    return scene or Path(file).name.removesuffix(GAME_FILE).removesuffix(".toml")


def level_option(level: str) -> str:
    """Return the option with which commands get a level: ``--game`` for a scene, else ``--level``."""
    return "--game" if is_scene(split_level(level)[0]) else "--level"


def with_level_file(level: str, path: Path) -> str:
    """Return the name of a level with ``path`` in place of its file; ``level`` has no variant.

    ``"lake.game.toml:small"`` with the path ``new/lake.game.toml`` becomes ``"new/lake.game.toml:small"``.
    """
    scene = split_scene(level)[1] if is_scene(level) else None
    return str(path) if scene is None else f"{path}:{scene}"


def split_scene(level: str) -> tuple[str, str | None]:
    """Split the level ``FILE.game.toml:SCENE`` into file and scene; the scene is None if there is none.

    Raises:
        ValueError: the level is not a scene of a game file.
    """
    match = _SCENE.match(level)
    if match is None:
        raise ValueError(f"`{level}` is not a scene of a game file")
    return match["file"], match["scene"]


def parse_variant(text: str) -> Variant:
    """Parse ``VARIANT`` or ``VARIANT+OVERLAY+…``, as arguments and files contain it.

    The path of an overlay may contain a ``+`` after its first slash: ``v0+/home/c++/wider.toml`` is
    ``v0`` and one overlay.
    """
    name, plus, overlays = text.partition("+")
    return Variant(name, tuple(_OVERLAY.findall(plus + overlays)))


def _absolute(overlay: str) -> str:
    return str(Path(overlay).absolute())
