"""The spans that go where a declaration, a clause or an item of a list is removed, so that no odd gap is left."""

from __future__ import annotations

from collections.abc import Sequence

from tltlc.core.source import SourceFile, Span
from tltlc.grammar.mistakes.insertion import documented
from tltlc.grammar.tree import Comment


def without(source: SourceFile, span: Span, comments: Sequence[Comment] = ()) -> Span:
    """The span of what stands there, with its documentation and the end of its line where nothing else is on it."""
    text = source.text
    start, end = documented(source, span.start, comments), span.end
    line = text.rfind("\n", 0, start) + 1
    after = text.find("\n", end)
    after = len(text) if after < 0 else after
    if text[end:after].strip() and not _is_comment(text, end, after):
        # Something else follows on the line: it moves up.
        return Span(start, end + len(text[end:after]) - len(text[end:after].lstrip()))
    if text[line:start].strip():
        return Span(line + len(text[line:start].rstrip()), end if text[end:after].strip() else after)
    end = min(after + 1, len(text))
    below = text.find("\n", end) + 1
    if below and not text[end:below].strip() and not text[text.rfind("\n", 0, max(0, line - 1)) + 1 : line].strip():
        # Of the empty lines above and below, one is enough.
        end = below
    return Span(line, end)


def item(spans: Sequence[Span], index: int, comments: Sequence[Comment]) -> tuple[Span, ...]:
    """The span of an item of a list, of two at least, with one of its commas; none where a comment would go with it."""
    gone = Span(spans[index - 1].end, spans[index].end) if index else Span(spans[0].start, spans[1].start)
    return () if any(gone.start <= each.span.start < gone.end for each in comments) else (gone,)


def _is_comment(text: str, start: int, end: int) -> bool:
    return text[start:end].lstrip().startswith("//")
