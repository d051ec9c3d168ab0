"""Names of cases as they stand in addresses."""

from __future__ import annotations

import re
from collections.abc import Sequence
from typing import Final

_OTHER: Final = re.compile(r"[^A-Za-z0-9_.+]+")


def slugs(names: Sequence[str]) -> tuple[str, ...]:
    """A name for each, of plain letters and none twice: ``navigation:v1`` becomes ``navigation-v1``."""
    found: list[str] = []
    for name in names:
        plain = _OTHER.sub("-", name).strip("-") or "case"
        slug, number = plain, 1
        while slug in found:
            number += 1
            slug = f"{plain}-{number}"
        found.append(slug)
    return tuple(found)


def episode_link(slug: str, index: int, step: int = 0) -> str:
    """The address, in the page, of a step of a recorded episode."""
    return f"#{slug}/{index}/{step}"
