"""Keep the effect of ``allow`` comments when a text is laid out.

A comment such as ``// tltlc: allow TLT0421`` applies to what is on its line, so the layout must not
change what shares a line with it.
"""

from __future__ import annotations

from collections.abc import Container, Iterable, Iterator
from typing import Final

from tltlc.core.record import record
from tltlc.core.source import SourceFile, Span
from tltlc.grammar.allow_comments import commented_spans, statements
from tltlc.grammar.parser import parse
from tltlc.grammar.tree import Comment, EntityDecl, Module


@record
class Kept:
    """The offsets where the layout must keep the source as it is.

    No line begins at an offset in ``joints``. A declaration that starts at an offset in
    ``declarations`` is copied as it is written.
    """

    joints: frozenset[int]
    declarations: frozenset[int]


NOTHING: Final = Kept(frozenset(), frozenset())


def keeping(module: Module, text: str, kept: Kept) -> Kept:
    """Return what the layout must keep for comments to allow the same as before.

    ``text`` is the layout of the module with ``kept``. The result extends ``kept``. First,
    statements that share a line with a comment keep sharing it. If that is not enough, their
    declarations are kept as they are written.
    """
    before = commented_spans(module)
    lists = [
        declaration
        for declaration in module.declarations
        if isinstance(declaration, EntityDecl) and len(declaration.names) > 1
    ]
    listed = {span for list_ in lists for span in (list_.span, *(name.span for name in list_.names))}
    if not any(_may_change(comment, places or (), module.source.text, listed) for comment, places in before):
        return kept
    laid_out, _ = parse(SourceFile("<layout>", text))
    back = dict(zip(statements(laid_out), statements(module), strict=True))
    wrong: set[Span] = set()
    after = commented_spans(laid_out)
    # Comments on the same line share one tuple of places, before and after.
    pairs = {
        (id(places), id(new_places)): (places, new_places)
        for (_, places), (_, new_places) in zip(before, after, strict=True)
    }
    for places, new_places in pairs.values():
        places_now = {back[place] for place in new_places or ()}
        if places is not None and _outer(places) != _outer(places_now):
            wrong.update(places_now.union(places))
    joints = kept.joints.union(*(_joints(module.source.text, place) for place in wrong))
    if joints != kept.joints:
        return Kept(joints, kept.declarations)
    starts = {
        declaration.span.start
        for declaration in module.declarations
        if any(declaration.span.covers(place) for place in wrong)
    }
    return Kept(joints, kept.declarations | starts)


def _may_change(comment: Comment, places: tuple[Span, ...], text: str, listed: Container[Span]) -> bool:
    """Whether a comment could apply to something else after layout.

    It could if it applies to several statements, to an entry of a list, or to the block that
    contains it. Other comments stay above, after or within their one statement and need no check.
    """
    if len(places) > 1 or any(place.covers(comment.span) and text[place.end - 1] == "}" for place in places):
        return True
    return any(place in listed for place in places)


def _outer(places: Iterable[Span]) -> set[Span]:
    """Return the places that are not inside another one."""
    outer: list[Span] = []
    for place in sorted(places, key=lambda place: (place.start, -place.end)):
        if not outer or place.end > outer[-1].end:
            outer.append(place)
    return set(outer)


def _joints(text: str, place: Span) -> Iterator[int]:
    """Yield the offsets where a statement or its closing brace follows something on its line."""
    for offset in (place.start, *((place.end - 1,) if text[place.end - 1] == "}" else ())):
        if text[text.rfind("\n", 0, offset) + 1 : offset].strip():
            yield offset
