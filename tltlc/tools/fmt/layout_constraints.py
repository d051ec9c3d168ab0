"""Keep the effect of ``allow`` comments when a text is laid out.

A comment such as ``// tltlc: allow TLT0421`` applies to the statements on its line. So the layout
must not change which statements share a line with the comment.
"""

from __future__ import annotations

from collections.abc import Container, Iterable, Iterator
from typing import Final

from tltlc.core.record import record
from tltlc.core.source import SourceFile, Span
from tltlc.grammar.allow_comments import commented_spans, statements
from tltlc.grammar.module import Comment, Module
from tltlc.grammar.parser import parse
from tltlc.grammar.tree import EntityDecl


@record
class LayoutConstraints:
    """What the layout must keep as it is in the source; both fields are offsets in the source.

    The layout does not begin a new line with the text at an offset in ``joints``. It copies each
    declaration that begins at an offset in ``declarations``.
    """

    joints: frozenset[int]
    declarations: frozenset[int]


NO_CONSTRAINTS: Final = LayoutConstraints(frozenset(), frozenset())


def required_constraints(module: Module, text: str, constraints: LayoutConstraints) -> LayoutConstraints:
    """Return ``constraints``, extended if an ``allow`` comment would apply to other statements.

    ``text`` is the layout of the module under ``constraints``. The function compares the statements
    to which each ``allow`` comment applies in ``text`` and in the source. If they differ, it adds
    joints that keep these statements on their lines. If these joints are in ``constraints`` already,
    it adds the declarations that contain the statements, which are then copied from the source.

    Make a new layout with the result and call the function again, until the result equals
    ``constraints``.
    """
    before = commented_spans(module)
    lists = [
        declaration
        for declaration in module.declarations
        if isinstance(declaration, EntityDecl) and len(declaration.names) > 1
    ]
    list_spans = {span for list_ in lists for span in (list_.span, *(name.span for name in list_.names))}
    if not any(_may_change(comment, places or (), module.source.text, list_spans) for comment, places in before):
        return constraints
    new_module, _ = parse(SourceFile("<layout>", text, "text"))
    old_spans = dict(zip(statements(new_module), statements(module), strict=True))
    affected: set[Span] = set()
    after = commented_spans(new_module)
    # Comments that apply to the same line share one tuple of spans, before and after.
    pairs = {
        (id(places), id(new_places)): (places, new_places)
        for (_, places), (_, new_places) in zip(before, after, strict=True)
    }
    for places, new_places in pairs.values():
        places_now = {old_spans[place] for place in new_places or ()}
        if places is not None and _outermost(places) != _outermost(places_now):
            affected.update(places_now.union(places))
    joints = constraints.joints.union(*(_joints(module.source.text, place) for place in affected))
    if joints != constraints.joints:
        return LayoutConstraints(joints, constraints.declarations)
    starts = {
        declaration.span.start
        for declaration in module.declarations
        if any(declaration.span.covers(place) for place in affected)
    }
    return LayoutConstraints(joints, constraints.declarations | starts)


def _may_change(comment: Comment, places: tuple[Span, ...], text: str, list_spans: Container[Span]) -> bool:
    """Whether the layout could make a comment apply to other statements.

    This is possible if the comment applies to several statements, to an entry of a list, or to the
    block that contains the comment. Any other comment stays above, after or within its only
    statement. ``places`` are the spans of the statements, and ``list_spans`` the spans of lists and
    of their entries.
    """
    if len(places) > 1 or any(place.covers(comment.span) and text[place.end - 1] == "}" for place in places):
        return True
    return any(place in list_spans for place in places)


def _outermost(places: Iterable[Span]) -> set[Span]:
    """Return those of ``places`` that are not inside another of them."""
    outer: list[Span] = []
    for place in sorted(places, key=lambda place: (place.start, -place.end)):
        if not outer or place.end > outer[-1].end:
            outer.append(place)
    return set(outer)


def _joints(text: str, place: Span) -> Iterator[int]:
    """Yield the joints that keep a statement on its lines; ``place`` is the span of the statement.

    They are the offset of its start, and of its closing brace if it has one. Each is left out if
    nothing precedes it on its line.
    """
    for offset in (place.start, *((place.end - 1,) if text[place.end - 1] == "}" else ())):
        if text[text.rfind("\n", 0, offset) + 1 : offset].strip():
            yield offset
