"""Levels and variants in arguments: ``LEVEL``, ``LEVEL:VARIANT``, ``LEVEL:VARIANT+OVERLAY``."""

from __future__ import annotations

import os
import re
from collections.abc import Iterable
from pathlib import Path
from typing import Final

_PLACE: Final = re.compile(r"(.+?):([A-Za-z_][A-Za-z0-9_]*(?:\+.+)?)\Z", re.DOTALL)
_OVERLAY: Final = re.compile(r"\+([^+/\\]*(?=\+|\Z)|.+?\.toml(?=\+|\Z)|[^+]*)", re.DOTALL)


def split_level(argument: str) -> tuple[str, str | None]:
    """Split an argument into a level and a variant, for :meth:`~tltl_runtime.game.game.Game.load_level`.

    The variant is None if the argument has none. The path of an existing file is not split, and
    neither is a drive letter of Windows.
    """
    match = _PLACE.match(argument)
    if not match or os.path.exists(argument):  # noqa: PTH110
        return argument, None
    level, variant = match.groups()
    if len(level) == 1 and level.isalpha() and os.name == "nt":
        return argument, None
    return level, variant


def with_overlays(variant: str, overlays: Iterable[str]) -> str:
    """Return a variant with added overlays; :func:`split_overlays` is the inverse.

    An overlay is a name or the path of a ``.toml`` file. Paths that contain a ``+`` are made absolute.
    """
    has_plus = re.compile(r".*\+.*\.toml\Z", re.DOTALL).match
    return "+".join(
        (variant, *(str(Path(overlay).absolute()) if has_plus(overlay) else overlay for overlay in overlays))
    )


def split_overlays(variant: str) -> tuple[str, tuple[str, ...]]:
    """Return the variant without its added overlays, and the overlays in order.

    A path may contain a ``+`` after its first part: ``v0+/home/c++/wider.toml`` is ``v0`` and one
    overlay.
    """
    base, plus, added = variant.partition("+")
    return base, tuple(_OVERLAY.findall(plus + added))


def variant_text(variant: str) -> str:
    """Return the variant as reports show it: overlays that are paths have only their names."""
    base, added = split_overlays(variant)
    return "+".join((base, *(Path(overlay).stem if overlay.endswith(".toml") else overlay for overlay in added)))


def absolute_variant(variant: str) -> str:
    """Return the variant with absolute overlay paths, for loading from another folder."""
    base, added = split_overlays(variant)
    return "+".join(
        (base, *(str(Path(overlay).absolute()) if overlay.endswith(".toml") else overlay for overlay in added))
    )
