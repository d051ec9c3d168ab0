"""Changes of a text as edits of the protocol."""

from __future__ import annotations

from lsprotocol import types

from tltlc.core.source import SourceFile, Span
from tltlc.diagnostics.diagnostic import Edit
from tltlc.interfaces.lsp.positions import range_of


def text_edit(source: SourceFile, edit: Edit, encoding: str) -> types.TextEdit:
    """An edit of the linter."""
    return types.TextEdit(range_of(source, edit.span, encoding), edit.text)


def applied(text: str, edits: list[Edit]) -> str:
    """A text after edits that do not meet."""
    pieces, end = [], 0
    for edit in sorted(edits, key=lambda each: each.span.start):
        pieces += [text[end : edit.span.start], edit.text]
        end = edit.span.end
    return "".join((*pieces, text[end:]))


def difference(source: SourceFile, after: str) -> list[Edit]:
    """The one edit that makes ``after`` of a text, as short as its unchanged beginning and end allow."""
    before = source.text
    if "\r\n" in before:
        after = after.replace("\r\n", "\n").replace("\n", "\r\n")
    if before == after:
        return []
    shorter = min(len(before), len(after))
    start = next((at for at in range(shorter) if before[at] != after[at]), shorter)
    end = next((at for at in range(shorter - start) if before[-1 - at] != after[-1 - at]), shorter - start)
    # A carriage return and its line feed are one line end.
    if start and before[start - 1] == "\r":
        start -= 1
    if end and before[len(before) - end] == "\n":
        end -= 1
    return [Edit(Span(start, len(before) - end), after[start : len(after) - end])]
