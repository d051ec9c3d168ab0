"""Find the fixes of diagnostics that can be applied without further edits.

Fixes are tried before they are offered, except those of findings in a module without ``allow``
comments.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterable, Iterator, Sequence
from itertools import islice
from typing import Final

from tltlc.core.record import record, replace
from tltlc.core.source import SourceFile
from tltlc.diagnostics.diagnostic import Diagnostic, Edit, Fix
from tltlc.grammar.allow_comments import commented_spans
from tltlc.grammar.tree import Module
from tltlc.io.limits import WORK
from tltlc.tools.lint.rule import LintFinding
from tltlc.tools.lint.scopes import apply_edits, preserve_scopes

_MOST_ERRORS: Final = 8
"""The most errors whose fixes are tried."""

ErrorFinder = Callable[[SourceFile], tuple[Sequence[Diagnostic], Iterable[Diagnostic]]]
"""A function that returns a text's syntax errors, and all diagnostics of its syntax and names."""


@record
class OfferedFix:
    """A fix that can be applied without further edits, with its diagnostic."""

    diagnostic: Diagnostic
    fix: Fix


def fixes_of_findings(findings: Iterable[LintFinding], module: Module) -> Iterator[OfferedFix]:
    """Yield the fixes of lint findings in a module, as ``tltlc lint --fix`` applies them.

    A fix must not change what the ``allow`` comments of the module apply to. If the module has such
    comments, each fix is tried once. At most ``WORK["fixes tried"]`` fixes are tried, and the
    others are left out.
    """
    has_comments = bool(commented_spans(module))
    tried: dict[tuple[Edit, ...], tuple[Edit, ...] | None] = {}
    for finding in findings:
        for fix in finding.diagnostic.fixes:
            edits: tuple[Edit, ...] | None = fix.edits
            if has_comments:
                if fix.edits not in tried and len(tried) < WORK["fixes tried"]:
                    tried[fix.edits] = preserve_scopes(module, fix.edits)
                edits = tried.get(fix.edits)
            if edits:
                yield OfferedFix(finding.diagnostic, replace(fix, edits=edits))


def fixes_of_errors(diagnostics: Iterable[Diagnostic], source: SourceFile, errors: ErrorFinder) -> Iterator[OfferedFix]:
    """Yield each fix that leaves fewer errors in the text ``source``.

    Only fixes of the first ``_MOST_ERRORS`` diagnostics are tried, and only if the diagnostic is
    about ``source``. ``errors`` finds the errors of the text before and after each fix.
    """
    candidates = [
        OfferedFix(diagnostic, fix)
        for diagnostic in islice(diagnostics, _MOST_ERRORS)
        if _is_in(source, diagnostic)
        for fix in diagnostic.fixes
    ]
    if not candidates:
        return
    before = _count_errors(source, errors)
    for offer in candidates:
        if _is_fewer(_count_errors(apply_edits(source, offer.fix.edits), errors), before):
            yield offer


def _is_in(source: SourceFile, diagnostic: Diagnostic) -> bool:
    return bool(diagnostic.labels) and diagnostic.labels[0].source == source


def _count_errors(source: SourceFile, errors: ErrorFinder) -> tuple[int, Counter[str]]:
    """Return the number of syntax errors, and a count of all errors by code."""
    syntax_errors, diagnostics = errors(source)
    return len(syntax_errors), Counter(error.code for error in diagnostics if error.severity == "error")


def _is_fewer(now: tuple[int, Counter[str]], before: tuple[int, Counter[str]]) -> bool:
    """Whether there are fewer errors ``now`` than ``before``.

    If the number of syntax errors is the same, no code may have more errors than before. If there
    are fewer syntax errors, more of the text is parsed, so new errors of other kinds may appear.
    """
    return now[0] < before[0] or (now[0] == before[0] and now[1] < before[1])
