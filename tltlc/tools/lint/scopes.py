"""Check that a fix does not change which statements each ``allow`` comment applies to."""

from __future__ import annotations

from bisect import bisect_left, bisect_right
from collections.abc import Callable, Iterable, Iterator, Sequence
from itertools import accumulate
from typing import TypeVar

from tltlc.core.source import SourceFile, Span
from tltlc.diagnostics.diagnostic import Edit
from tltlc.grammar.allow_comments import commented_spans
from tltlc.grammar.parser import parse
from tltlc.grammar.tree import Comment, Module
from tltlc.tools.lint.removal import without

T = TypeVar("T")
_Places = tuple[Span, ...] | None
"""The statements that a comment applies to. None is the whole file."""


def after(source: SourceFile, edits: Iterable[Edit]) -> SourceFile:
    """Return the text after edits that do not overlap."""
    pieces: list[str] = []
    place = 0
    for edit in sorted(edits, key=lambda edit: edit.span.start):
        pieces += [source.text[place : edit.span.start], edit.text]
        place = edit.span.end
    return SourceFile(source.name, "".join([*pieces, source.text[place:]]))


def keeping_scopes(module: Module, edits: Sequence[Edit]) -> tuple[Edit, ...] | None:
    """Return the edits, adjusted so that comments that stay apply to the same statements.

    An edit leaves out comments that still apply to something: to the whole file, or to another
    statement of the line. Comments that apply only to removed statements are removed, too.

    Returns None if a comment that stays would apply to other statements than before. For example,
    when the first declaration of a file is removed, a comment on the next one can become a comment
    on the whole file.
    """
    scopes = commented_spans(module)
    known, changes = frozenset(edits), _Changes(edits)
    kept = [
        comment.span
        for comment, applies in _of_each(scopes, lambda places: places is None or any(map(changes.keep, places)))
        # An edit may intend to remove the comment itself.
        if applies and Edit(without(module.source, comment.span), "") not in known
    ]
    edits = tuple(part for edit in edits for part in _around(module.source.text, edit, kept))
    known, changes = frozenset(edits), _Changes(edits)
    orphans = _of_each(scopes, lambda places: bool(places) and not any(map(changes.keep, places or ())))
    spans = [comment.span for comment, is_orphan in orphans if is_orphan]
    removals = [Edit(without(module.source, span), "") for span in spans if changes.keep(span)]
    all_edits = (*edits, *(removal for removal in removals if removal not in known))
    all_changes = _Changes(all_edits)
    fixed, _ = parse(after(module.source, all_edits))
    # Equal sets get equal numbers, so that the scopes of many comments on one line compare fast.
    numbers: dict[frozenset[int] | None, int] = {}
    starts_before = _of_each(scopes, lambda places: _number(all_changes.starts(places), numbers))
    starts_now = _of_each(commented_spans(fixed), lambda places: _number(_starts(places), numbers))
    before = {
        all_changes.moved(comment.span.start): starts
        for comment, starts in starts_before
        if all_changes.keep(comment.span)
    }
    now = {comment.span.start: starts for comment, starts in starts_now}
    return all_edits if now == before else None


class _Changes:
    """Maps offsets through edits that do not overlap."""

    def __init__(self, edits: Sequence[Edit]) -> None:
        by_start = sorted((edit.span.start, edit.span.end) for edit in edits)
        self._starts = [start for start, _ in by_start]
        self._reach = list(accumulate((end for _, end in by_start), max))
        by_end = sorted((edit.span.end, len(edit.text) - (edit.span.end - edit.span.start)) for edit in edits)
        self._ends = [end for end, _ in by_end]
        self._shifts = [0, *accumulate(shift for _, shift in by_end)]

    def keep(self, span: Span) -> bool:
        """Whether the start of a span is kept."""
        place = bisect_right(self._starts, span.start)
        return not place or self._reach[place - 1] <= span.start

    def moved(self, offset: int) -> int:
        """Return where an offset outside all edits is after them."""
        return offset + self._shifts[bisect_right(self._ends, offset)]

    def starts(self, places: Iterable[Span] | None) -> frozenset[int] | None:
        """Return where the kept statements begin after the edits; None for the whole file."""
        if places is None:
            return None
        return frozenset(self.moved(place.start) for place in places if self.keep(place))


def _of_each(scopes: Sequence[tuple[Comment, _Places]], of: Callable[[_Places], T]) -> list[tuple[Comment, T]]:
    """Return each comment with the result of a function on its places.

    Comments on one line share their places, so the function runs only once for each line.
    """
    results: dict[int, T] = {}
    for _, places in scopes:
        if id(places) not in results:
            results[id(places)] = of(places)
    return [(comment, results[id(places)]) for comment, places in scopes]


def _number(starts: frozenset[int] | None, numbers: dict[frozenset[int] | None, int]) -> int:
    return numbers.setdefault(starts, len(numbers))


def _around(text: str, edit: Edit, kept: Sequence[Span]) -> Iterator[Edit]:
    """Yield an edit in parts that leave out the lines of ``kept`` comments.

    ``kept`` is in order.
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
