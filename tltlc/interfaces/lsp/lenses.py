"""Show numbers above each spec: the states of its automaton, the distance to the goal, and its test results."""

from __future__ import annotations

from typing import Final

from lsprotocol import types

from tltlc.grammar.tree import SpecDecl
from tltlc.interfaces.lsp.document import Document
from tltlc.interfaces.lsp.positions import range_of
from tltlc.interfaces.lsp.slow_analysis import DocumentAnalysis, SpecFigures

RUN_TESTS: Final = "tltlc.runTests"
"""The command of the lens with the test results; its arguments are the document's URI and the spec's name."""


def lenses(document: Document, uri: str, analysis: DocumentAnalysis, encoding: str) -> list[types.CodeLens]:
    """Return one or two lenses for each analysed spec: the size of its automaton and, if it has tests, their results.

    ``uri`` is the URI of the document. Columns are counted in units of ``encoding``, such as
    ``utf-16``.
    """
    figures = {entry.spec: entry for entry in analysis.figures}
    result = []
    for declaration in document.module.declarations:
        if not isinstance(declaration, SpecDecl) or declaration.name not in figures:
            continue
        spec_figures = figures[declaration.name]
        at = range_of(document.source, declaration.name_span, encoding)
        result.append(types.CodeLens(at, command=types.Command(figures_text(spec_figures), "")))
        if spec_figures.passed or spec_figures.failed:
            command = types.Command(tests_text(spec_figures), RUN_TESTS, arguments=[uri, declaration.name])
            result.append(types.CodeLens(at, command=command))
    return result


def figures_text(figures: SpecFigures) -> str:
    """Return the size of a spec's automaton as a text: ``7 states, distance 3`` or ``2 states, cannot be met``."""
    states = f"{figures.states} state{'' if figures.states == 1 else 's'}"
    return f"{states}, " + ("cannot be met" if figures.distance is None else f"distance {figures.distance}")


def tests_text(figures: SpecFigures) -> str:
    """Return the test results of a spec as a text: ``3 tests pass`` or ``1 of 3 tests fails``."""
    count = figures.passed + figures.failed
    tests = f"{count} test{'' if count == 1 else 's'}"
    if figures.failed:
        return f"{figures.failed} of {tests} fail{'s' if figures.failed == 1 else ''}"
    return f"{tests} pass{'es' if count == 1 else ''}"
