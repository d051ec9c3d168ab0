"""Names of cases as they stand in addresses and as folders."""

from __future__ import annotations

import re
from collections.abc import Sequence
from typing import Final

_OTHER: Final = re.compile(r"[^A-Za-z0-9_.+]+")
_LONGEST: Final = 80
_TAKEN: Final = re.compile(r"(con|prn|aux|nul|com[0-9]|lpt[0-9])(\..*)?\Z", re.IGNORECASE)
"""What Windows calls devices by."""


def slugs(names: Sequence[str]) -> tuple[str, ...]:
    """A short name for each, of plain letters: ``navigation:v1`` becomes ``navigation-v1``.

    No two are equal, not even where lower and upper case are; each can be the name of a folder on any system.
    """
    found: list[str] = []
    taken: set[str] = set()
    for name in names:
        plain = _OTHER.sub("-", name)[:_LONGEST].strip("-.") or "case"
        if _TAKEN.match(plain):
            plain = f"case-{plain}"
        slug, number = plain, 1
        while slug.lower() in taken:
            number += 1
            slug = f"{plain}-{number}"
        taken.add(slug.lower())
        found.append(slug)
    return tuple(found)


def episode_link(slug: str, index: int, step: int = 0) -> str:
    """The address, in the page, of a step of a recorded episode."""
    return f"#{slug}/{index}/{step}"
