"""Compute the spans to delete when a declaration, a clause or a list item is removed.

The spans include the spaces and empty lines that would be left over.
"""

from __future__ import annotations

from collections.abc import Sequence

from tltlc.core.source import SourceFile, Span
from tltlc.grammar.mistakes.insertion import documentation_start
from tltlc.grammar.module import Comment


def removal_span(source: SourceFile, span: Span, comments: Sequence[Comment] = ()) -> Span:
    """Return the span to delete in order to remove a declaration, clause or comment.

    The result covers ``span`` and the documentation above it. If nothing but a comment at the end
    shares their lines, the result covers these lines as a whole. If there is also an empty line
    above and an empty line below, the result covers the empty line below, too. ``comments`` are the
    comments of the module.
    """
    text = source.text
    start, end = documentation_start(source, span.start, comments), span.end
    line = text.rfind("\n", 0, start) + 1
    after = text.find("\n", end)
    after = len(text) if after < 0 else after
    if text[end:after].strip() and not _is_comment(text, end, after):
        # Something else follows on the line and moves up.
        return Span(start, end + len(text[end:after]) - len(text[end:after].lstrip()))
    if text[line:start].strip():
        return Span(line + len(text[line:start].rstrip()), end if text[end:after].strip() else after)
    end = min(after + 1, len(text))
    below = text.find("\n", end) + 1
    if below and not text[end:below].strip() and not text[text.rfind("\n", 0, max(0, line - 1)) + 1 : line].strip():
        # Keep only one of the empty lines above and below.
        end = below
    return Span(line, end)


def item_removal_spans(spans: Sequence[Span], index: int, comments: Sequence[Comment]) -> tuple[Span, ...]:
    """Return the spans to delete in order to remove the item at ``index`` from a list.

    ``spans`` are the spans of the items, of which there must be at least two. The result has one
    span, with the item and one comma. It is empty if the deletion would remove one of ``comments``.
    """
    removed = Span(spans[index - 1].end, spans[index].end) if index else Span(spans[0].start, spans[1].start)
    return () if any(removed.start <= comment.span.start < removed.end for comment in comments) else (removed,)


def _is_comment(text: str, start: int, end: int) -> bool:
    return text[start:end].lstrip().startswith("//")
