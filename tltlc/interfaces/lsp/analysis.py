"""What takes longer than a keystroke: automata, the remarks of the linter, the tests of a text."""

from __future__ import annotations

import os
from collections.abc import Container, Mapping
from pathlib import Path
from typing import Final

from tltlc.core.record import record, replace
from tltlc.core.source import SourceFile
from tltlc.diagnostics.diagnostic import Diagnostic, TltlError
from tltlc.grammar.parser import parse
from tltlc.io.files import unsaved
from tltlc.monitor.tests import run_tests
from tltlc.pipeline import CompileOptions
from tltlc.resolve.options import ResolveOptions
from tltlc.resolve.program import resolve
from tltlc.tools.lint.file_view import View
from tltlc.tools.lint.importers import used_elsewhere, words
from tltlc.tools.lint.neighbours import neighbours
from tltlc.tools.lint.rule import Finding
from tltlc.tools.lint.rules import rules
from tltlc.tools.lint.run import findings, levelled, view_of

_OF_USE: Final = ("TLT0421", "TLT0422")
"""The rules that ask which names other files use."""


@record
class Request:
    """A text to be looked at with the settings of its project; ``texts`` stand in place of the files at their paths."""

    source: SourceFile
    libraries: tuple[Path, ...]
    levels: Mapping[str, str]
    texts: Mapping[str, str]


@record
class Figures:
    """The automaton of a spec in numbers; ``distance`` is that of its first state, None where no trace satisfies it."""

    spec: str
    states: int
    distance: int | None
    passed: int
    failed: int


@record
class Analysis:
    """What was found: what is to be said of the text, the failures of its tests, and its specs in numbers."""

    findings: tuple[Finding, ...]
    failures: tuple[Diagnostic, ...] = ()
    figures: tuple[Figures, ...] = ()

    @property
    def said(self) -> tuple[Diagnostic, ...]:
        """The messages of all of it."""
        return (*(each.diagnostic for each in self.findings), *self.failures)


def analyse(request: Request) -> Analysis:
    """Compile, lint and test a text."""
    options = CompileOptions(library_dirs=request.libraries)
    with unsaved(request.texts):
        try:
            view = view_of(request.source, options)
        except TltlError as error:
            return Analysis(levelled(map(Finding, error.diagnostics), request.levels))
        if _seems_unused(view):
            # Only now is it worth while to read the files around.
            view = replace(view, elsewhere=_elsewhere(request))
        found = findings(view, request.levels)
        return _with_tests(view, found, options)


def _seems_unused(view: View) -> bool:
    """Whether a declaration or an import is used by nothing in its own file."""
    return any(True for rule in rules() if rule.code in _OF_USE for _ in rule.check(view))


def _elsewhere(request: Request) -> Container[str]:
    """The names that other files use of the text, as they stand in the editor."""
    name = request.source.name
    if name.startswith("<"):
        return frozenset()
    others = {str(path): text for path, text in neighbours([name]).items()}
    for path, text in request.texts.items():
        place = os.path.realpath(path)
        # Another project's files are none of those around, and new ones may not be saved yet.
        if place in others or not os.path.lexists(place):
            others[place] = text
    return used_elsewhere(name, [words(path, text) for path, text in others.items()])


def _with_tests(view: View, found: tuple[Finding, ...], options: CompileOptions) -> Analysis:
    module, _ = parse(view.source)
    program, _ = resolve(module, ResolveOptions(library_dirs=options.library_dirs, proofs=False))
    results = run_tests(program, (each.fspa for each in view.specs))
    figures = []
    for each in view.specs:
        own = [result.passed for result in results if result.test.spec == each.spec.name]
        fspa = each.fspa
        figures.append(Figures(fspa.name, len(fspa.states), fspa.states[0].distance, sum(own), len(own) - sum(own)))
    failures = tuple(result.failure for result in results if result.failure is not None)
    return Analysis(found, failures, tuple(figures))
