"""Strings in quotes; the language has no escapes."""

from __future__ import annotations


def quote(text: str) -> str | None:
    """Return a text as a string of the language, in quotes, or None if it cannot be written as one.

    A text cannot be written if it contains a quote, a line break or NUL. It also cannot be written
    if it is not valid Unicode: some file names are not.
    """
    if any(character in text for character in '"\n\r\0'):
        return None
    try:
        text.encode()
    except UnicodeEncodeError:
        return None
    return f'"{text}"'
