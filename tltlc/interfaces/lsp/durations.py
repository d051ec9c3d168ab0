"""Show the number of steps after each limit or bound that is written as a time: ``limit 4 s = 40 steps``.

The number depends on the length of a step, which a ``clock`` declaration sets, perhaps in another
file.
"""

from __future__ import annotations

from collections.abc import Iterator

from lsprotocol import types

from tltlc.core.source import Span
from tltlc.grammar.tree import Declaration, NumberExpr, SpecDecl, Unary
from tltlc.grammar.walk import expressions, parts
from tltlc.interfaces.lsp.document import Document
from tltlc.interfaces.lsp.positions import position
from tltlc.resolve.constants import samples
from tltlc.resolve.problem import ResolutionError


def hints(document: Document, span: Span, encoding: str) -> list[types.InlayHint]:
    """Return hints such as ``= 40 steps`` for the times that end within a span of a document.

    Columns are counted in units of ``encoding``, such as ``utf-16``.
    """
    visible = [duration for duration in durations(document) if span.start <= duration[0].span.end <= span.end]
    return [
        types.InlayHint(
            position(document.source, number.span.end, encoding), f"= {steps_text(steps)}", padding_left=True
        )
        for number, steps in visible
    ]


def steps_text(steps: int) -> str:
    """Return a number of steps in words: ``1 step``, ``40 steps``."""
    return f"{steps} step{'' if steps == 1 else 's'}"


def durations(document: Document) -> Iterator[tuple[NumberExpr, int]]:
    """Yield each limit of a spec and each temporal bound that is written as a time, with its number of steps.

    Times that cannot be converted, for example without a ``clock`` declaration, are left out.
    """
    for declaration in document.module.declarations:
        for number in _counts(declaration):
            if number.unit not in (None, "step", "steps"):
                try:
                    steps = samples(number, document.resolution.env)
                except ResolutionError:
                    # There is no clock, or the unit is not a time; a diagnostic reports that.
                    continue
                yield number, steps


def _counts(declaration: Declaration) -> Iterator[NumberExpr]:
    if isinstance(declaration, SpecDecl):
        yield from (clause.value for clause in declaration.clauses if isinstance(clause.value, NumberExpr))
    for expression in expressions(declaration):
        for part in parts(expression):
            if isinstance(part, Unary) and part.bound is not None:
                yield from (limit for limit in (part.bound.low, part.bound.high) if limit is not None)
