"""A level and a variant as arguments of commands name them: ``LEVEL``, ``LEVEL:VARIANT``, ``LEVEL:VARIANT+OVERLAY``."""

from __future__ import annotations

import os
import re
from collections.abc import Iterable
from pathlib import Path
from typing import Final

_PLACE: Final = re.compile(r"(.+?):([A-Za-z_][A-Za-z0-9_]*(?:\+.+)?)\Z", re.DOTALL)
_OVERLAY: Final = re.compile(r"\+([^+/\\]*(?=\+|\Z)|.+?\.toml(?=\+|\Z)|[^+]*)", re.DOTALL)


def level_place(argument: str) -> tuple[str, str | None]:
    """The level and the variant of an argument, as :func:`~tltl_runtime.stealth.levels.file.load_level` takes them.

    The variant is None where the argument has none.  A path that exists, or a drive letter, is never split.
    """
    found = _PLACE.match(argument)
    if not found or os.path.exists(argument):  # noqa: PTH110
        return argument, None
    level, variant = found.groups()
    if len(level) == 1 and level.isalpha() and os.name == "nt":
        return argument, None
    return level, variant


def with_overlays(variant: str, overlays: Iterable[str]) -> str:
    """The variant with overlays added to it, as :func:`overlays_of` tells them: names, or paths of ``.toml`` files.

    Paths that have a ``+`` are made absolute.
    """
    has_plus = re.compile(r".*\+.*\.toml\Z", re.DOTALL).match
    return "+".join((variant, *(str(Path(each).absolute()) if has_plus(each) else each for each in overlays)))


def overlays_of(variant: str) -> tuple[str, tuple[str, ...]]:
    """The variant without what is added to it, and the overlays that are, in their order.

    A path may have a ``+`` from its second part on: ``v0+/home/c++/wider.toml`` is ``v0`` and one overlay.
    """
    base, plus, added = variant.partition("+")
    return base, tuple(_OVERLAY.findall(plus + added))


def shown_variant(variant: str) -> str:
    """The variant as reports call it, with the names of its overlays wherever these lie."""
    base, added = overlays_of(variant)
    return "+".join((base, *(Path(each).stem if each.endswith(".toml") else each for each in added)))


def absolute_variant(variant: str) -> str:
    """The variant with the paths of its overlays made absolute, for whoever loads it from another folder."""
    base, added = overlays_of(variant)
    return "+".join((base, *(str(Path(each).absolute()) if each.endswith(".toml") else each for each in added)))
