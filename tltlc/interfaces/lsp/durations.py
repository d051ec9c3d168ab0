"""Times in steps, behind limits and bounds that are written in seconds: the clock often stands in another file."""

from __future__ import annotations

from collections.abc import Iterator

from lsprotocol import types

from tltlc.core.source import Span
from tltlc.grammar.tree import Declaration, Number, SpecDecl, Unary
from tltlc.grammar.walk import expressions, parts
from tltlc.interfaces.lsp.analysed_text import Document
from tltlc.interfaces.lsp.positions import position
from tltlc.resolve.constants import samples
from tltlc.resolve.problem import ResolutionError


def hints(document: Document, span: Span, encoding: str) -> list[types.InlayHint]:
    """``= 40 steps`` behind each time that ends within a part of a document."""
    found = [each for each in durations(document) if span.start <= each[0].span.end <= span.end]
    return [
        types.InlayHint(
            position(document.source, number.span.end, encoding), f"= {steps_text(steps)}", padding_left=True
        )
        for number, steps in found
    ]


def steps_text(steps: int) -> str:
    """``1 step``, ``40 steps``."""
    return f"{steps} step{'' if steps == 1 else 's'}"


def durations(document: Document) -> Iterator[tuple[Number, int]]:
    """The limits and bounds that are written as times, in steps."""
    for declaration in document.module.declarations:
        for number in _counts(declaration):
            if number.unit not in (None, "step", "steps"):
                try:
                    steps = samples(number, document.resolution.env)
                except ResolutionError:
                    # There is no clock, or it is no time: a message says so.
                    continue
                yield number, steps


def _counts(declaration: Declaration) -> Iterator[Number]:
    if isinstance(declaration, SpecDecl):
        yield from (each.value for each in declaration.clauses if isinstance(each.value, Number))
    for expression in expressions(declaration):
        for part in parts(expression):
            if isinstance(part, Unary) and part.bound is not None:
                yield from (each for each in (part.bound.low, part.bound.high) if each is not None)
