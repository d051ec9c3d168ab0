"""Applying fixes to a text, again and again until there is none."""

from __future__ import annotations

from bisect import bisect, insort
from collections.abc import Container, Iterable, Mapping, Sequence

from tltlc.core.record import EMPTY, record
from tltlc.core.source import SourceFile
from tltlc.diagnostics.diagnostic import Diagnostic, Edit, TltlError
from tltlc.grammar.allow_comments import spoken_of
from tltlc.grammar.parser import parse
from tltlc.grammar.tree import Module
from tltlc.io.limits import WORK
from tltlc.pipeline import CompileOptions
from tltlc.tools.lint.rule import Finding
from tltlc.tools.lint.run import lint
from tltlc.tools.lint.scopes import after, keeping_scopes

_MOST_ROUNDS = 100
"""Every round removes something; this many would be needed by no file that a person has written."""


@record
class Fixed:
    """A text after all fixes, what they were, each in the text in which it was found, and what is left to say."""

    source: SourceFile
    fixed: tuple[Diagnostic, ...]
    left: tuple[Finding, ...]


def fix(
    source: SourceFile,
    options: CompileOptions | None = None,
    levels: Mapping[str, str] = EMPTY,
    elsewhere: Container[str] = frozenset(),
) -> Fixed:
    """A file with every fix applied, until nothing changes.

    ``levels`` are as of :func:`tltlc.tools.lint.run.levelled`, ``elsewhere`` as of :func:`tltlc.tools.lint.run.lint`.

    Errors: as of :func:`tltlc.tools.lint.run.lint`.
    """
    found = lint(source, options, elsewhere, levels)
    fixed: list[Diagnostic] = []
    for _ in range(_MOST_ROUNDS):
        edited, applied = _applied(source, found)
        if not applied:
            break
        try:
            left = lint(edited, options, elsewhere, levels)
        except TltlError:
            # A fix that breaks a file is none: the file stays as it was before.
            break
        source, found = edited, left
        fixed += applied
    return Fixed(source, tuple(fixed), found)


def _applied(source: SourceFile, found: tuple[Finding, ...]) -> tuple[SourceFile, list[Diagnostic]]:
    """The text with all fixes that do not overlap and keep the scopes of comments, and what they mend."""
    fixable = _apart([finding for finding in found if finding.fix])
    if not fixable:
        return source, []
    module, _ = parse(source)
    if spoken_of(module):
        applied, edits = _keeping_scopes(module, fixable)
    else:
        applied, edits = fixable, _edits(fixable)
    return after(source, edits), [finding.diagnostic for finding in applied]


def _apart(findings: Iterable[Finding]) -> list[Finding]:
    """The findings whose edits overlap none of an earlier one; two may share an edit."""
    apart: list[Finding] = []
    spans: list[tuple[int, int]] = []
    known: set[Edit] = set()
    for finding in findings:
        new = [(edit.span.start, edit.span.end) for edit in finding.fix if edit not in known]
        if not any(_meets(span, spans) for span in new):
            apart.append(finding)
            known.update(finding.fix)
            for span in new:
                insort(spans, span)
    return apart


def _meets(span: tuple[int, int], spans: list[tuple[int, int]]) -> bool:
    """Whether a span overlaps one of the sorted ones, which do not overlap each other."""
    place = bisect(spans, span)
    start, end = span
    return any(other < end and start < stop for other, stop in spans[max(0, place - 1) : place + 1])


def _edits(findings: Iterable[Finding]) -> tuple[Edit, ...]:
    return tuple(dict.fromkeys(edit for finding in findings for edit in finding.fix))


def _keeping_scopes(module: Module, findings: Sequence[Finding]) -> tuple[list[Finding], tuple[Edit, ...]]:
    """The findings that can be fixed together without a change of what a comment speaks of, and their edits.

    All are tried at once, then halves: a file has few that cannot be fixed. After some attempts, the rest is left.
    """
    applied: list[Finding] = []
    edits: tuple[Edit, ...] = ()
    waiting = [list(findings)]
    for _ in range(WORK["fixes tried"]):
        if not waiting:
            break
        part = waiting.pop()
        together = keeping_scopes(module, _edits([*applied, *part]))
        if together is not None:
            applied += part
            edits = together
        elif len(part) > 1:
            half = len(part) // 2
            waiting += [part[half:], part[:half]]
    return applied, edits
