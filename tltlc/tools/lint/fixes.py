"""Find the fixes of diagnostics that an editor can offer, because they need no further edits.

A fix is tried on the text before it is offered. Only the fixes of lint findings in a module without
``allow`` comments need no trial.
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
from tltlc.grammar.module import Module
from tltlc.io.limits import WORK
from tltlc.tools.lint.rule import LintFinding
from tltlc.tools.lint.scopes import apply_edits, preserve_scopes

_MOST_ERRORS: Final = 8
"""The most errors whose fixes are tried."""

ErrorFinder = Callable[[SourceFile], tuple[Sequence[Diagnostic], Iterable[Diagnostic]]]
"""A function that returns the syntax errors of a text, and all diagnostics about its syntax and names."""


@record
class OfferedFix:
    """A fix that needs no further edits, with the diagnostic that it belongs to."""

    diagnostic: Diagnostic
    fix: Fix


def fixes_of_findings(findings: Iterable[LintFinding], module: Module) -> Iterator[OfferedFix]:
    """Yield the fixes of lint findings in a module, as ``tltlc lint --fix`` applies them.

    A fix must not change which statements the ``allow`` comments of the module silence. So if the
    module has such comments, each fix is tried first: its edits are adjusted, or it is left out, as
    :func:`~tltlc.tools.lint.scopes.preserve_scopes` says. After ``WORK["fixes tried"]`` trials, all
    further fixes are left out.
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

    Only the first ``_MOST_ERRORS`` diagnostics are considered, and of these only the ones about
    ``source``. ``errors`` finds the errors of a text; it is called before and after each fix.
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
    """Whether there are fewer errors ``now`` than ``before``; both come from :func:`_count_errors`.

    Fewer syntax errors are enough: then more of the text is parsed, so new errors of other kinds may
    appear. If the number of syntax errors is the same, some code must have fewer errors than before,
    and none may have more.
    """
    return now[0] < before[0] or (now[0] == before[0] and now[1] < before[1])
