"""Convert edits to the Language Server Protocol, apply edits, and compute the edit between two texts."""

from __future__ import annotations

from lsprotocol import types

from tltlc.core.source import SourceFile, Span
from tltlc.diagnostics.diagnostic import Edit
from tltlc.interfaces.lsp.positions import range_of


def text_edit(source: SourceFile, edit: Edit, encoding: str) -> types.TextEdit:
    """Convert an edit of a source text to an edit of the Language Server Protocol.

    Columns are counted in units of ``encoding``, such as ``utf-16``.
    """
    return types.TextEdit(range_of(source, edit.span, encoding), edit.text)


def apply_edits(text: str, edits: list[Edit]) -> str:
    """Return the text after the edits, which must not overlap."""
    pieces, end = [], 0
    for edit in sorted(edits, key=lambda edit: edit.span.start):
        pieces += [text[end : edit.span.start], edit.text]
        end = edit.span.end
    return "".join((*pieces, text[end:]))


def difference(source: SourceFile, after: str) -> list[Edit]:
    """Return the shortest single edit that turns the text of ``source`` into ``after``, in a list.

    The list is empty if both texts are equal. If the text of ``source`` contains CRLF line ends,
    the line ends of ``after`` are first converted to CRLF.
    """
    before = source.text
    if "\r\n" in before:
        after = after.replace("\r\n", "\n").replace("\n", "\r\n")
    if before == after:
        return []
    shorter = min(len(before), len(after))
    start = next((i for i in range(shorter) if before[i] != after[i]), shorter)
    end = next((i for i in range(shorter - start) if before[-1 - i] != after[-1 - i]), shorter - start)
    # Do not split a carriage return from its line feed.
    if start and before[start - 1] == "\r":
        start -= 1
    if end and before[len(before) - end] == "\n":
        end -= 1
    return [Edit(Span(start, len(before) - end), after[start : len(after) - end])]
