"""Texts as Graphviz reads them: its HTML-like labels, and strings that are no labels."""

from __future__ import annotations

from collections.abc import Iterable

from tltlc.backends.drawing.texts import visible

CENTRED, LEFT, BACKED = "<TD>", '<TD ALIGN="LEFT">', '<TD BGCOLOR="white">'
"""Cells; what is in one with a white back can be read where edges pass behind it."""

LONGEST_TEXT = 2000
"""In characters: Graphviz reads no string of more than 16 KiB, in which one may take seven."""


def table(rows: Iterable[str], cell: str = CENTRED, spacing: int = 0) -> str:
    """Rows of one cell: as lines of a single one, those in different fonts would be too close to each other."""
    inside = "".join(f"<TR>{cell}{row}</TD></TR>" for row in rows)
    return f'<TABLE BORDER="0" CELLBORDER="0" CELLPADDING="0" CELLSPACING="{spacing}">{inside}</TABLE>'


def escaped(text: str) -> str:
    """Text inside an HTML-like label."""
    text = visible(text).replace("&", "&amp;").replace("<", "&lt;").replace(">", "&gt;")
    return text.replace('"', "&quot;").replace("[", "&#91;").replace("]", "&#93;")


def plain(text: str) -> str:
    """A text that means itself: no escapes, and no markup though it may look like it; of a long one the beginning."""
    from graphviz import escape

    # A subclass of str says so: made a bare str again, "<b>" would be markup.
    text = visible(text)
    found: str = escape(text if len(text) <= LONGEST_TEXT else f"{text[:LONGEST_TEXT]} …")
    return found
