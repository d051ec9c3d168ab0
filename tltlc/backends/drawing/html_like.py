"""Texts in Graphviz syntax: HTML-like labels, and plain strings."""

from __future__ import annotations

from collections.abc import Iterable

from tltlc.backends.drawing.texts import escape_invisible

CENTRED, LEFT, BACKED = "<TD>", '<TD ALIGN="LEFT">', '<TD BGCOLOR="white">'
"""Table cells; a white background keeps text readable over edges that pass behind it."""

LONGEST_TEXT = 2000
"""The most characters of a text. Graphviz reads strings of at most 16 KiB, and a character may take seven bytes."""


def table(rows: Iterable[str], cell: str = CENTRED, spacing: int = 0) -> str:
    """Return a table with one cell in each row.

    As lines of a single cell, texts in different fonts would be too close to each other.
    """
    inside = "".join(f"<TR>{cell}{row}</TD></TR>" for row in rows)
    return f'<TABLE BORDER="0" CELLBORDER="0" CELLPADDING="0" CELLSPACING="{spacing}">{inside}</TABLE>'


def escape_html(text: str) -> str:
    """Return text escaped for an HTML-like label."""
    text = escape_invisible(text).replace("&", "&amp;").replace("<", "&lt;").replace(">", "&gt;")
    return text.replace('"', "&quot;").replace("[", "&#91;").replace("]", "&#93;")


def literal_text(text: str) -> str:
    """Return a text that Graphviz takes literally, without escapes or markup; a long one is cut."""
    from graphviz import escape

    # `escape` returns a subclass of str that marks the text as literal. As a bare str, "<b>" would become markup.
    text = escape_invisible(text)
    literal: str = escape(text if len(text) <= LONGEST_TEXT else f"{text[:LONGEST_TEXT]} …")
    return literal
