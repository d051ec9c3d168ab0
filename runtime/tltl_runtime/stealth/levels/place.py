"""A level and a variant as arguments of commands name them: ``LEVEL``, ``LEVEL:VARIANT``, ``LEVEL:VARIANT+OVERLAY``."""

from __future__ import annotations

import os
import re
from pathlib import Path
from typing import Final

_PLACE: Final = re.compile(r"(.+?):([A-Za-z_][A-Za-z0-9_]*(?:\+[^+]+)*)\Z", re.DOTALL)


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


def absolute_variant(variant: str) -> str:
    """The variant with the paths of its overlays made absolute, for whoever loads it from another folder."""
    return "+".join(str(Path(each).absolute()) if each.endswith(".toml") else each for each in variant.split("+"))
