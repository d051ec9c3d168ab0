"""Slugs: short names of cases for folders and for addresses within the HTML report."""

from __future__ import annotations

import re
from collections.abc import Sequence
from typing import Final

_NOT_ALLOWED: Final = re.compile(r"[^A-Za-z0-9_.+]+")
_MAX_LENGTH: Final = 80
_RESERVED: Final = re.compile(r"(con|prn|aux|nul|com[0-9]|lpt[0-9])(\..*)?\Z", re.IGNORECASE)
"""Device names that Windows reserves."""


def slugs(names: Sequence[str]) -> tuple[str, ...]:
    """Return a short ASCII name for each name: ``navigation:v1`` becomes ``navigation-v1``.

    The results are distinct, even where upper and lower case are not distinguished. Each is a valid
    name of a folder on any system.
    """
    unique: list[str] = []
    taken: set[str] = set()
    for name in names:
        base = _NOT_ALLOWED.sub("-", name)[:_MAX_LENGTH].strip("-.") or "case"
        if _RESERVED.match(base):
            base = f"case-{base}"
        slug, number = base, 1
        while slug.lower() in taken:
            number += 1
            slug = f"{base}-{number}"
        taken.add(slug.lower())
        unique.append(slug)
    return tuple(unique)


def episode_link(slug: str, index: int, step: int = 0) -> str:
    """Return the address of a step of a recorded episode within the HTML report: ``#navigation-v1/3/120``.

    ``slug`` is the case's short name, and ``index`` is that of the episode.
    """
    return f"#{slug}/{index}/{step}"
