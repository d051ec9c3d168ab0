"""Comments such as ``// tltlc: allow TLT0421`` speak of what is on their line, and of the same after layout."""

from __future__ import annotations

from collections.abc import Container, Iterable, Iterator
from typing import Final

from tltlc.core.record import record
from tltlc.core.source import SourceFile, Span
from tltlc.grammar.allow_comments import spoken_of, statements
from tltlc.grammar.parser import parse
from tltlc.grammar.tree import Comment, EntityDecl, Module


@record
class Kept:
    """What the layout leaves as it is, by offsets: no line begins at ``joints``, ``declarations`` stay as written."""

    joints: frozenset[int]
    declarations: frozenset[int]


NOTHING: Final = Kept(frozenset(), frozenset())


def keeping(module: Module, text: str, kept: Kept) -> Kept:
    """What is to be kept beside ``kept``, with which ``text`` was laid out, for comments to allow the same as before.

    First that the statements of a line share one, and where that is not enough their declarations as they are.
    """
    before = spoken_of(module)
    lists = [each for each in module.declarations if isinstance(each, EntityDecl) and len(each.names) > 1]
    listed = {span for list_ in lists for span in (list_.span, *(name.span for name in list_.names))}
    if not any(_may_change(comment, places or (), module.source.text, listed) for comment, places in before):
        return kept
    laid_out, _ = parse(SourceFile("<layout>", text))
    back = dict(zip(statements(laid_out), statements(module), strict=True))
    wrong: set[Span] = set()
    after = spoken_of(laid_out)
    # Comments that speak of the same line share its statements, before and after.
    pairs = {(id(places), id(others)): (places, others) for (_, places), (_, others) in zip(before, after, strict=True)}
    for places, others in pairs.values():
        now = {back[place] for place in others or ()}
        if places is not None and _outer(places) != _outer(now):
            wrong.update(now.union(places))
    joints = kept.joints.union(*(_joints(module.source.text, place) for place in wrong))
    if joints != kept.joints:
        return Kept(joints, kept.declarations)
    starts = {each.span.start for each in module.declarations if any(each.span.covers(place) for place in wrong)}
    return Kept(joints, kept.declarations | starts)


def _may_change(comment: Comment, places: tuple[Span, ...], text: str, listed: Container[Span]) -> bool:
    """Whether a comment speaks of several statements, of one in a list, or stands in the block of which it speaks.

    Others stay above, behind or within the one that they speak of, and need no second look.
    """
    if len(places) > 1 or any(place.covers(comment.span) and text[place.end - 1] == "}" for place in places):
        return True
    return any(place in listed for place in places)


def _outer(places: Iterable[Span]) -> set[Span]:
    """The places that lie in no other one."""
    outer: list[Span] = []
    for place in sorted(places, key=lambda place: (place.start, -place.end)):
        if not outer or place.end > outer[-1].end:
            outer.append(place)
    return set(outer)


def _joints(text: str, place: Span) -> Iterator[int]:
    """The offsets where a statement, or its closing brace, stands behind others on a line."""
    for offset in (place.start, *((place.end - 1,) if text[place.end - 1] == "}" else ())):
        if text[text.rfind("\n", 0, offset) + 1 : offset].strip():
            yield offset
