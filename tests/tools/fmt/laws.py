"""Properties of the layout that hold for every text without errors."""

from __future__ import annotations

from collections.abc import Iterator

from tltlc.core.source import SourceFile, Span
from tltlc.grammar import allow_comments as allowed
from tltlc.grammar import tree
from tltlc.grammar.module import Module
from tltlc.grammar.parser import parse
from tltlc.tools.fmt import format_text

STEPS = (None, "step", "steps")


def check(text: str, style: str) -> str:
    """Assert all properties for a text, which must have no errors, and return the formatted text."""
    before = read(text)
    formatted = format_text(text, style)
    after = read(formatted)
    assert shape(after.declarations) == shape(before.declarations)
    assert [comment.text for comment in after.comments] == [comment.text for comment in before.comments]
    assert comment_targets(after) == comment_targets(before)
    assert format_text(formatted, style) == formatted
    lines = formatted.split("\n")
    assert lines[-1] == ""
    assert not formatted or (lines[0] and lines[-2])
    assert all(line == line.rstrip() for line in lines)
    # A line is too long only if it has a comment or a very long word.
    if not any(places for _, places in allowed.commented_spans(before)):
        assert all(len(line) <= 100 or "//" in line or len(max(line.split(), key=len)) > 40 for line in lines)
    assert "\n\n\n" not in formatted
    assert "\ufeff" not in formatted[:1]
    return formatted


def read(text: str) -> Module:
    module, diagnostics = parse(SourceFile("a.tltl", text))
    assert diagnostics == ()
    return module


def comment_targets(module: Module) -> list[set[int] | None]:
    """Return, for each allow comment, the numbers of the outermost statements that it applies to.

    None stands for the whole file.
    """
    numbers = {span: number for number, span in enumerate(allowed.statements(module))}
    # A comment on a whole block or list applies to all that is in it.
    kinds = (tree.SpecDecl, tree.EntityDecl)
    blocks = [declaration.span for declaration in module.declarations if isinstance(declaration, kinds)]
    targets: list[set[int] | None] = []
    for _, places in allowed.commented_spans(module):
        whole = [place for place in places or () if place in blocks]
        outer = [
            place
            for place in places or ()
            if place in whole or not any(block.start <= place.start < block.end for block in whole)
        ]
        targets.append(None if places is None else {numbers[place] for place in outer})
    return targets


def shape(node: object) -> object:
    """Return a tree without spans, in which a bound is replaced by the samples that it covers."""
    if isinstance(node, tuple):
        return tuple(shape(item) for item in node)
    if not hasattr(node, "__match_args__"):
        return node
    fields = {name: getattr(node, name) for name in node.__match_args__}
    if isinstance(node, tree.Unary) and node.bound:
        fields["bound"] = tuple(_covered_samples(node.op, node.bound))
    return type(node).__name__, {name: shape(value) for name, value in fields.items() if not isinstance(value, Span)}


def _covered_samples(op: str, bound: tree.TemporalInterval) -> Iterator[object]:
    high = bound.high
    steps = high.unit in STEPS
    if bound.low is not None and (bound.low.value or bound.low.unit not in STEPS):
        yield bound.low.value, bound.low.unit
    if bound.words and op == "G":
        yield high.value - 1 if steps else ("rounded up, less one", high.value, high.unit)
    elif bound.words and op in ("X", "N"):
        yield "after", high.value, high.unit
    else:
        yield high.value if steps else (high.value, high.unit)
