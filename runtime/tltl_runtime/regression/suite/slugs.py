"""Short names of cases for addresses and folders."""

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

    The results are distinct, even without regard to case. Each is a valid folder name on any
    system.
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
    """Return the address, within the page, of a step of a recorded episode."""
    return f"#{slug}/{index}/{step}"
