"""The fixes of diagnostics that can be taken at once: each is tried before it is offered."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterable, Iterator
from itertools import islice
from typing import Final

from tltlc.core.record import record, replace
from tltlc.core.source import SourceFile
from tltlc.diagnostics.diagnostic import Diagnostic, Edit, Fix
from tltlc.grammar.allow_comments import spoken_of
from tltlc.grammar.parser import parse
from tltlc.grammar.tree import Module
from tltlc.io.limits import WORK
from tltlc.tools.lint.rule import Finding
from tltlc.tools.lint.scopes import after, keeping_scopes

_MOST: Final = 8
"""Of more errors, fixes are not tried."""

Errors = Callable[[SourceFile], Iterable[Diagnostic]]
"""What is wrong with a text."""


@record
class Offer:
    """A fix of a diagnostic that can be taken as it is."""

    diagnostic: Diagnostic
    fix: Fix


def of_findings(found: Iterable[Finding], module: Module) -> Iterator[Offer]:
    """The fixes of rules in a module, as ``tltlc lint --fix`` applies them: comments keep what they allow.

    If the module has comments, this tries each fix once, and stops after ``WORK["fixes tried"]`` fixes.
    """
    has_comments = bool(spoken_of(module))
    tried: dict[tuple[Edit, ...], tuple[Edit, ...] | None] = {}
    for finding in found:
        for fix in finding.diagnostic.fixes:
            edits: tuple[Edit, ...] | None = fix.edits
            if has_comments:
                if fix.edits not in tried and len(tried) < WORK["fixes tried"]:
                    tried[fix.edits] = keeping_scopes(module, fix.edits)
                edits = tried.get(fix.edits)
            if edits:
                yield Offer(finding.diagnostic, replace(fix, edits=edits))


def of_errors(told: Iterable[Diagnostic], source: SourceFile, errors: Errors) -> Iterator[Offer]:
    """The fixes of these messages about a text that leave less to be mended."""
    candidates = [Offer(each, fix) for each in islice(told, _MOST) if _is_in(source, each) for fix in each.fixes]
    if not candidates:
        return
    before = _wrong(source, errors)
    for offer in candidates:
        if _is_less(_wrong(after(source, offer.fix.edits), errors), before):
            yield offer


def _is_in(source: SourceFile, diagnostic: Diagnostic) -> bool:
    return bool(diagnostic.labels) and diagnostic.labels[0].source == source


def _wrong(source: SourceFile, errors: Errors) -> tuple[int, Counter[str]]:
    """How many errors of syntax there are, and all errors by their codes."""
    return len(parse(source)[1]), Counter(each.code for each in errors(source) if each.severity == "error")


def _is_less(left: tuple[int, Counter[str]], before: tuple[int, Counter[str]]) -> bool:
    """Whether fewer errors are left, and none of a new kind; what could be read again may be wrong in itself."""
    return left[0] < before[0] or (left[0] == before[0] and left[1] < before[1])
