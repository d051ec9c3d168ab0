"""Texts in the syntax of Graphviz: HTML-like labels, and plain strings."""

from __future__ import annotations

from collections.abc import Iterable

from tltlc.backends.drawing.texts import escape_invisible

CENTRED, LEFT, BACKED = "<TD>", '<TD ALIGN="LEFT">', '<TD BGCOLOR="white">'
"""Tags that begin a table cell.

A white background keeps text readable over edges that pass behind it.
"""

LONGEST_TEXT = 2000
"""The most characters of a plain string: Graphviz reads at most 16 KiB, and a character may take seven bytes."""


def table(rows: Iterable[str], cell: str = CENTRED, spacing: int = 0) -> str:
    """Return an HTML-like table for Graphviz with one column, and a row for each of ``rows``.

    ``rows`` are escaped texts, which may contain tags. ``cell`` is the tag that begins each cell.
    Each row has its own cell, because lines of different fonts would be too close in a single cell.
    """
    inside = "".join(f"<TR>{cell}{row}</TD></TR>" for row in rows)
    return f'<TABLE BORDER="0" CELLBORDER="0" CELLPADDING="0" CELLSPACING="{spacing}">{inside}</TABLE>'


def escape_html(text: str) -> str:
    """Return text escaped for an HTML-like label."""
    text = escape_invisible(text).replace("&", "&amp;").replace("<", "&lt;").replace(">", "&gt;")
    return text.replace('"', "&quot;").replace("[", "&#91;").replace("]", "&#93;")


def literal_text(text: str) -> str:
    """Return a string for which Graphviz shows ``text`` literally, even if it looks like escapes or markup.

    A text with more than :data:`LONGEST_TEXT` characters is cut.
    """
    from graphviz import escape

    # `escape` returns a subclass of str, which graphviz does not read as markup; "<b>" as a plain str would be.
    text = escape_invisible(text)
    literal: str = escape(text if len(text) <= LONGEST_TEXT else f"{text[:LONGEST_TEXT]} …")
    return literal
