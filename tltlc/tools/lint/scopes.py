"""Check that a fix does not change which statements each ``allow`` comment applies to.

A comment such as ``// tltlc: allow TLT0421`` applies to the clauses and declarations on its line, or
to the whole file. A fix that removes lines could make it apply to others.
"""

from __future__ import annotations

from bisect import bisect_left, bisect_right
from collections.abc import Callable, Iterable, Iterator, Sequence
from itertools import accumulate
from typing import TypeVar

from tltlc.core.source import SourceFile, Span
from tltlc.diagnostics.diagnostic import Edit
from tltlc.grammar.allow_comments import commented_spans
from tltlc.grammar.module import Comment, Module
from tltlc.grammar.parser import parse
from tltlc.tools.lint.removal import removal_span

T = TypeVar("T")
_Places = tuple[Span, ...] | None
"""The spans of the clauses and declarations that a comment applies to; None is the whole file."""


def apply_edits(source: SourceFile, edits: Iterable[Edit]) -> SourceFile:
    """Return the text with the edits applied. The edits must not overlap."""
    pieces: list[str] = []
    place = 0
    for edit in sorted(edits, key=lambda edit: edit.span.start):
        pieces += [source.text[place : edit.span.start], edit.text]
        place = edit.span.end
    return source.with_text("".join([*pieces, source.text[place:]]))


def preserve_scopes(module: Module, edits: Sequence[Edit]) -> tuple[Edit, ...] | None:
    """Adjust edits so that each ``allow`` comment that is left applies to the same statements as before.

    - A comment that applies only to removed statements is removed, too.
    - A comment that applies to the whole file, or also to a statement that stays, is kept: an edit
      that would delete the comment is split into the parts before and after it.

    Return None if a comment would still apply to other statements than before. For example, if the
    first declaration of a file is removed, the comment above the second declaration may become a
    comment on the whole file.
    """
    scopes = commented_spans(module)
    known_edits, offsets = frozenset(edits), _Offsets(edits)
    kept = [
        comment.span
        for comment, applies in _map_places(scopes, lambda places: places is None or any(map(offsets.keeps, places)))
        # An edit may intend to remove the comment itself.
        if applies and Edit(removal_span(module.source, comment.span), "") not in known_edits
    ]
    edits = tuple(part for edit in edits for part in _without_comments(module.source.text, edit, kept))
    known_edits, offsets = frozenset(edits), _Offsets(edits)
    orphans = _map_places(scopes, lambda places: bool(places) and not any(map(offsets.keeps, places or ())))
    spans = [comment.span for comment, is_orphan in orphans if is_orphan]
    removals = [Edit(removal_span(module.source, span), "") for span in spans if offsets.keeps(span)]
    all_edits = (*edits, *(removal for removal in removals if removal not in known_edits))
    final_offsets = _Offsets(all_edits)
    fixed, _ = parse(apply_edits(module.source, all_edits))
    # Equal sets get equal numbers, so that the scopes of many comments on one line compare fast.
    numbers: dict[frozenset[int] | None, int] = {}
    starts_before = _map_places(scopes, lambda places: _number(final_offsets.starts(places), numbers))
    starts_now = _map_places(commented_spans(fixed), lambda places: _number(_starts(places), numbers))
    before = {
        final_offsets.new_offset(comment.span.start): starts
        for comment, starts in starts_before
        if final_offsets.keeps(comment.span)
    }
    now = {comment.span.start: starts for comment, starts in starts_now}
    return all_edits if now == before else None


class _Offsets:
    """Maps offsets in the old text to offsets in the text after edits that do not overlap."""

    def __init__(self, edits: Sequence[Edit]) -> None:
        by_start = sorted((edit.span.start, edit.span.end) for edit in edits)
        self._starts = [start for start, _ in by_start]
        self._reach = list(accumulate((end for _, end in by_start), max))
        by_end = sorted((edit.span.end, len(edit.text) - (edit.span.end - edit.span.start)) for edit in edits)
        self._ends = [end for end, _ in by_end]
        self._shifts = [0, *accumulate(shift for _, shift in by_end)]

    def keeps(self, span: Span) -> bool:
        """Whether no edit removes the start of a span."""
        place = bisect_right(self._starts, span.start)
        return not place or self._reach[place - 1] <= span.start

    def new_offset(self, offset: int) -> int:
        """Return the offset in the new text for an offset in the old text that is outside all edits."""
        return offset + self._shifts[bisect_right(self._ends, offset)]

    def starts(self, places: Iterable[Span] | None) -> frozenset[int] | None:
        """Return the offsets in the new text at which these places start.

        Places whose start an edit removes are left out. None, which stands for the whole file,
        stays None.
        """
        if places is None:
            return None
        return frozenset(self.new_offset(place.start) for place in places if self.keeps(place))


def _map_places(scopes: Sequence[tuple[Comment, _Places]], function: Callable[[_Places], T]) -> list[tuple[Comment, T]]:
    """Call ``function`` with the spans that each comment applies to; return each comment with its result.

    Comments on one line share one tuple of spans, so ``function`` is called only once for each line.
    """
    results: dict[int, T] = {}
    for _, places in scopes:
        if id(places) not in results:
            results[id(places)] = function(places)
    return [(comment, results[id(places)]) for comment, places in scopes]


def _number(starts: frozenset[int] | None, numbers: dict[frozenset[int] | None, int]) -> int:
    """Return the number of a set in ``numbers``. A set that is not there is added, with the next number."""
    return numbers.setdefault(starts, len(numbers))


def _without_comments(text: str, edit: Edit, kept: Sequence[Span]) -> Iterator[Edit]:
    """Split an edit so that it leaves some comments alone, and yield the parts.

    ``kept`` are the spans of these comments, sorted. A comment alone on its line keeps the whole line.
    """
    start = edit.span.start
    for index in range(bisect_left(kept, start, key=lambda span: span.start), len(kept)):
        comment = kept[index]
        if comment.start >= edit.span.end:
            break
        if comment.start < start:
            continue
        line = text.rfind("\n", 0, comment.start) + 1
        begin = comment.start if text[line : comment.start].strip() else max(start, line)
        if start < begin:
            yield Edit(Span(start, begin), "")
        # Keep the end of the comment's line, too.
        start = min(comment.end + 1, edit.span.end)
    if start < edit.span.end or edit.text:
        yield Edit(Span(start, edit.span.end), edit.text)


def _starts(places: Iterable[Span] | None) -> frozenset[int] | None:
    return None if places is None else frozenset(place.start for place in places)
