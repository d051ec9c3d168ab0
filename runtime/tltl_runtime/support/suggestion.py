"""Suggest similar names for a name that does not exist."""

from __future__ import annotations

from collections.abc import Iterable
from difflib import get_close_matches
from typing import Final

MOST_SUGGESTIONS: Final = 100
"""Once a file has this many diagnostics, further ones suggest no similar names.

With thousands of diagnostics, the search for similar names takes too long.
"""

_LONGEST: Final = 100
"""For a name longer than this, in characters, no similar name is searched, because that takes too long."""


def similar_name(name: str, known: Iterable[str]) -> str | None:
    """Return the most similar name of ``known``; None if there is none."""
    names = list(known)
    close = get_close_matches(name, names, n=1) if len(name) <= _LONGEST else []
    return next(iter(close or [candidate for candidate in names if candidate.lower() == name.lower()]), None)


def suggestion(name: str, known: Iterable[str], listed: str | None = None) -> str:
    """Return a hint for an unknown name, with a similar name of ``known``, or else with all of them.

    Examples are "did you mean `door`?" and "there are: `door`, `key`". ``listed``, if given,
    replaces the list of all names.
    """
    names = list(known)
    close = similar_name(name, names)
    if close is not None:
        return f"did you mean `{close}`?"
    if listed is not None:
        return f"there are: {listed}"
    return "there are: " + ", ".join(f"`{candidate}`" for candidate in names) if names else "there are none"
