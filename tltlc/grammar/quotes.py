"""Texts in quotes, which the language has without any escapes."""

from __future__ import annotations


def quoted(text: str) -> str | None:
    """A text as a source writes it, in quotes; None for one that no source can hold.

    That is one with a quote or a line break, and one that is not Unicode, as names of files can be.
    """
    if any(sign in text for sign in '"\n\r\0'):
        return None
    try:
        text.encode()
    except UnicodeEncodeError:
        return None
    return f'"{text}"'
