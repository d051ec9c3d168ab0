"""The slow part of an analysis, run in its own process: automata, lint findings and tests of a text."""

from __future__ import annotations

import os
from collections.abc import Container, Mapping
from pathlib import Path
from typing import Final

from tltlc.core.record import record, replace
from tltlc.core.source import SourceFile
from tltlc.diagnostics.diagnostic import Diagnostic, TltlError
from tltlc.io.files import unsaved_texts
from tltlc.monitor.spec_tests import run_tests
from tltlc.pipeline import CompileOptions
from tltlc.tools.lint.file_view import FileView
from tltlc.tools.lint.importers import importer_names, names_used_elsewhere
from tltlc.tools.lint.neighbours import neighbours
from tltlc.tools.lint.rule import LintFinding
from tltlc.tools.lint.rules import rules
from tltlc.tools.lint.run import apply_levels, findings, view_of

_USE_RULES: Final = ("TLT0421", "TLT0422")
"""The codes of the lint rules about unused declarations and imports, which depend on other files."""


@record
class Request:
    """A text to analyse with the settings of its project.

    ``libraries`` are the folders that are searched for imports. ``levels`` maps codes of lint rules
    to their levels in the project, such as ``{"TLT0421": "error"}``. ``texts`` has the texts of open
    documents by path; they replace the files on disk.
    """

    source: SourceFile
    libraries: tuple[Path, ...]
    levels: Mapping[str, str]
    texts: Mapping[str, str]


@record
class SpecFigures:
    """The size of a spec's automaton, and how many tests of the spec pass and fail.

    ``spec`` is the name of the spec, and ``states`` the number of states. ``distance`` is the least
    number of transitions from the initial state to an accepting state; None if no trace satisfies
    the spec.
    """

    spec: str
    states: int
    distance: int | None
    passed: int
    failed: int


@record
class DocumentAnalysis:
    """The result of a slow analysis.

    ``findings`` are those of the compiler and the linter. ``failures`` has a diagnostic for each
    failed test. ``figures`` has the numbers of each spec.
    """

    findings: tuple[LintFinding, ...]
    failures: tuple[Diagnostic, ...] = ()
    figures: tuple[SpecFigures, ...] = ()

    @property
    def diagnostics(self) -> tuple[Diagnostic, ...]:
        """The diagnostics of all findings, then those of the failed tests."""
        return (*(finding.diagnostic for finding in self.findings), *self.failures)


def analyse(request: Request) -> DocumentAnalysis:
    """Compile, lint and test a text.

    If the text has errors, the analysis contains only the diagnostics of the compiler.
    """
    with unsaved_texts(request.texts):
        try:
            view = view_of(request.source, CompileOptions(library_dirs=request.libraries))
        except TltlError as error:
            return DocumentAnalysis(apply_levels(map(LintFinding, error.diagnostics), request.levels))
        if _seems_unused(view):
            # Reading the neighbouring files is slow, so do it only if it matters which names they use.
            view = replace(view, used_elsewhere=_elsewhere(request))
        file_findings = findings(view, request.levels)
        return _with_tests(view, file_findings)


def _seems_unused(view: FileView) -> bool:
    """Whether a file has a declaration or an import that it does not use itself."""
    return any(True for rule in rules() if rule.code in _USE_RULES for _ in rule.check(view))


def _elsewhere(request: Request) -> Container[str]:
    """Return the names of the analysed file that the files which import it may use; none for a text without a file.

    For files that are open in the editor, the text in the editor counts.
    """
    if request.source.kind == "text":
        return frozenset()
    name = request.source.name
    neighbour_texts = {str(path): text for path, text in neighbours([name]).items()}
    for path, text in request.texts.items():
        place = os.path.realpath(path)
        # Skip files of other projects. Keep new files, which may not be saved yet.
        if place in neighbour_texts or not os.path.lexists(place):
            neighbour_texts[place] = text
    return names_used_elsewhere(name, [importer_names(path, text) for path, text in neighbour_texts.items()])


def _with_tests(view: FileView, file_findings: tuple[LintFinding, ...]) -> DocumentAnalysis:
    results = run_tests(view.program, (compiled.fspa for compiled in view.specs))
    figures = []
    for compiled in view.specs:
        passed = [result.passed for result in results if result.test.spec == compiled.spec.name]
        fspa = compiled.fspa
        figures.append(
            SpecFigures(fspa.name, len(fspa.states), fspa.states[0].distance, sum(passed), len(passed) - sum(passed))
        )
    failures = tuple(result.failure for result in results if result.failure is not None)
    return DocumentAnalysis(file_findings, failures, tuple(figures))
