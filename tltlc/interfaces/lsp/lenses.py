"""Specs in numbers, above their declarations: states, distance, and how their tests ended."""

from __future__ import annotations

from typing import Final

from lsprotocol import types

from tltlc.grammar.tree import SpecDecl
from tltlc.interfaces.lsp.analysed_text import Document
from tltlc.interfaces.lsp.analysis import Analysis, Figures
from tltlc.interfaces.lsp.positions import range_of

RUN_TESTS: Final = "tltlc.runTests"
"""The command behind the lens of tests; its arguments are the URI and the name of the spec."""


def lenses(document: Document, uri: str, analysis: Analysis, encoding: str) -> list[types.CodeLens]:
    """Two lenses for each spec: its size, and its tests where it has some."""
    figures = {each.spec: each for each in analysis.figures}
    found = []
    for declaration in document.module.declarations:
        if not isinstance(declaration, SpecDecl) or declaration.name not in figures:
            continue
        own = figures[declaration.name]
        at = range_of(document.source, declaration.name_span, encoding)
        found.append(types.CodeLens(at, command=types.Command(figures_text(own), "")))
        if own.passed or own.failed:
            command = types.Command(tests_text(own), RUN_TESTS, arguments=[uri, declaration.name])
            found.append(types.CodeLens(at, command=command))
    return found


def figures_text(figures: Figures) -> str:
    """``7 states, distance 3``."""
    states = f"{figures.states} state{'' if figures.states == 1 else 's'}"
    return f"{states}, " + ("cannot be met" if figures.distance is None else f"distance {figures.distance}")


def tests_text(figures: Figures) -> str:
    """``3 tests pass``, ``1 of 3 tests fails``."""
    count = figures.passed + figures.failed
    tests = f"{count} test{'' if count == 1 else 's'}"
    if figures.failed:
        return f"{figures.failed} of {tests} fail{'s' if figures.failed == 1 else ''}"
    return f"{tests} pass{'es' if count == 1 else ''}"
