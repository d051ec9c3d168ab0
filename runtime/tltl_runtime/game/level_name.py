"""Levels and variants in arguments: ``LEVEL``, ``LEVEL:VARIANT``, ``LEVEL:VARIANT+OVERLAY``."""

from __future__ import annotations

import os
import re
from collections.abc import Iterable
from pathlib import Path
from typing import Final

_PLACE: Final = re.compile(r"(.+?):([A-Za-z_][A-Za-z0-9_]*(?:\+.+)?)\Z", re.DOTALL)
_OVERLAY: Final = re.compile(r"\+([^+/\\]*(?=\+|\Z)|.+?\.toml(?=\+|\Z)|[^+]*)", re.DOTALL)


def level_place(argument: str) -> tuple[str, str | None]:
    """Split an argument into level and variant.

    The result is for :meth:`~tltl_runtime.game.game.Game.load_level`. The variant is None if the
    argument has none. A path that exists is never split, nor is a drive letter.
    """
    match = _PLACE.match(argument)
    if not match or os.path.exists(argument):  # noqa: PTH110
        return argument, None
    level, variant = match.groups()
    if len(level) == 1 and level.isalpha() and os.name == "nt":
        return argument, None
    return level, variant


def with_overlays(variant: str, overlays: Iterable[str]) -> str:
    """Add overlays to a variant: names, or paths of ``.toml`` files; see :func:`overlays_of`.

    Paths that contain a ``+`` are made absolute.
    """
    has_plus = re.compile(r".*\+.*\.toml\Z", re.DOTALL).match
    return "+".join(
        (variant, *(str(Path(overlay).absolute()) if has_plus(overlay) else overlay for overlay in overlays))
    )


def overlays_of(variant: str) -> tuple[str, tuple[str, ...]]:
    """Return the variant without its added overlays, and these overlays in order.

    A path may contain a ``+`` after its first part: ``v0+/home/c++/wider.toml`` is ``v0`` and one
    overlay.
    """
    base, plus, added = variant.partition("+")
    return base, tuple(_OVERLAY.findall(plus + added))


def shown_variant(variant: str) -> str:
    """Return the variant as reports show it, with the overlays' names without their folders."""
    base, added = overlays_of(variant)
    return "+".join((base, *(Path(overlay).stem if overlay.endswith(".toml") else overlay for overlay in added)))


def absolute_variant(variant: str) -> str:
    """Return the variant with absolute overlay paths, for loading from another folder."""
    base, added = overlays_of(variant)
    return "+".join(
        (base, *(str(Path(overlay).absolute()) if overlay.endswith(".toml") else overlay for overlay in added))
    )
