"""Suggestions for names that do not exist."""

from __future__ import annotations

from collections.abc import Iterable
from difflib import get_close_matches
from typing import Final

MOST_SUGGESTIONS: Final = 100
"""Once a file has this many diagnostics, further ones suggest no similar names.

With thousands of diagnostics, the search for similar names takes too long.
"""

_LONGEST: Final = 100
"""Names longer than this, in characters, get no similar name, because the search takes too long."""


def suggestion(name: str, known: Iterable[str], listed: str | None = None) -> str:
    """Return a hint for an unknown name: a similar name, or else all ``known`` names.

    If ``listed`` is given, the hint has this text in place of the list of all names.
    """
    names = list(known)
    close = get_close_matches(name, names, n=1) if len(name) <= _LONGEST else []
    close = close or [candidate for candidate in names if candidate.lower() == name.lower()]
    if close:
        return f"did you mean `{close[0]}`?"
    if listed is not None:
        return f"there are: {listed}"
    return "there are: " + ", ".join(f"`{candidate}`" for candidate in names) if names else "there are none"
