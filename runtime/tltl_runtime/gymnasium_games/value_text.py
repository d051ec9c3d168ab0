"""Texts for values of games in messages."""

from __future__ import annotations


def type_text(value: object) -> str:
    """Return the type of a value with an article: ``a list``, ``an int``; ``None`` for None."""
    name = type(value).__name__
    return "None" if value is None else f"an {name}" if name[0].lower() in "aeiou" else f"a {name}"
