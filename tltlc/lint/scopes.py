"""Which statements each ``allow`` comment speaks of, before and after a fix: a fix must not change it."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence

from tltlc.diagnostics.diagnostic import Edit
from tltlc.grammar.allowed import spoken_of
from tltlc.grammar.parser import parse
from tltlc.grammar.tree import Module
from tltlc.lint.removal import without
from tltlc.source import SourceFile, Span


def after(source: SourceFile, edits: Iterable[Edit]) -> SourceFile:
    """The text after edits that do not overlap."""
    pieces: list[str] = []
    place = 0
    for edit in sorted(edits, key=lambda edit: edit.span.start):
        pieces += [source.text[place : edit.span.start], edit.text]
        place = edit.span.end
    return SourceFile(source.name, "".join([*pieces, source.text[place:]]))


def keeping_scopes(module: Module, edits: Sequence[Edit]) -> tuple[Edit, ...] | None:
    """The edits, and those that remove comments which spoke only of what they remove.

    An edit leaves out comments that still speak of something: of the whole file, or of another statement of the line.
    None where a comment that stays would speak of other statements than before: removing the first declaration
    of a file, for one, can turn a comment on the next one into a comment on the whole file.
    """
    scopes = spoken_of(module)
    kept = [
        comment.span
        for comment, places in scopes
        # An edit may be there to remove the comment itself.
        if (places is None or any(_stays(each, edits) for each in places))
        and Edit(without(module.source, comment.span), "") not in edits
    ]
    edits = tuple(part for edit in edits for part in _around(module.source.text, edit, kept))
    orphans = [comment for comment, places in scopes if places and not any(_stays(place, edits) for place in places)]
    removals = [Edit(without(module.source, comment.span), "") for comment in orphans if _stays(comment.span, edits)]
    all_edits = (*edits, *(removal for removal in removals if removal not in edits))
    before = {
        _moved(comment.span.start, all_edits): _starts_after(places, all_edits)
        for comment, places in scopes
        if _stays(comment.span, all_edits)
    }
    fixed, _ = parse(after(module.source, all_edits))
    now = {comment.span.start: _starts(places) for comment, places in spoken_of(fixed)}
    return all_edits if now == before else None


def _around(text: str, edit: Edit, kept: Iterable[Span]) -> Iterator[Edit]:
    """An edit in parts, between the lines of comments that are to be kept."""
    start = edit.span.start
    for comment in kept:
        if not start <= comment.start < edit.span.end:
            continue
        line = text.rfind("\n", 0, comment.start) + 1
        begin = comment.start if text[line : comment.start].strip() else max(start, line)
        if start < begin:
            yield Edit(Span(start, begin), "")
        # With the end of its line.
        start = min(comment.end + 1, edit.span.end)
    if start < edit.span.end or edit.text:
        yield Edit(Span(start, edit.span.end), edit.text)


def _starts(places: Iterable[Span] | None) -> frozenset[int] | None:
    return None if places is None else frozenset(place.start for place in places)


def _starts_after(places: Iterable[Span] | None, edits: Sequence[Edit]) -> frozenset[int] | None:
    """Where the statements that stay begin after the edits; None for the whole file."""
    if places is None:
        return None
    return frozenset(_moved(place.start, edits) for place in places if _stays(place, edits))


def _stays(span: Span, edits: Iterable[Edit]) -> bool:
    return not any(edit.span.start <= span.start < edit.span.end for edit in edits)


def _moved(offset: int, edits: Iterable[Edit]) -> int:
    """Where an offset outside all edits is after them."""
    passed = (edit for edit in edits if edit.span.end <= offset)
    return offset + sum(len(edit.text) - (edit.span.end - edit.span.start) for edit in passed)
