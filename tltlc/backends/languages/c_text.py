"""The texts of a C header: only ASCII characters, so that all compilers read them alike."""

from __future__ import annotations

import re

from tltlc.program import snippets


def escape(match: re.Match[str]) -> str:
    """Return the escape of the character that a pattern matched."""
    return f"\\u{ord(match[0]):04x}"


def bytes_of(text: str) -> bytes:
    """Return the text as a C string stores it: UTF-8, without NUL."""
    return text.replace("\0", "").encode("utf-8", "replace")


def string_literal(text: str) -> str:
    """Return a string literal that has only ASCII characters.

    Question marks are escaped, since two of them would begin a trigraph.
    """
    return snippets.string_literal(text, _octal, snippets.is_plain_ascii).replace("?", "\\?")


def _octal(character: str) -> str:
    return "".join(f"\\{byte:03o}" for byte in bytes_of(character))
