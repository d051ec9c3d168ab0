"""Apply the fixes of lint findings to a text until no finding has a fix any more."""

from __future__ import annotations

from bisect import bisect, insort
from collections.abc import Container, Iterable, Mapping, Sequence

from tltlc.core.record import EMPTY, record, replace
from tltlc.core.source import SourceFile
from tltlc.diagnostics.diagnostic import Diagnostic, Edit, TltlError
from tltlc.grammar.allow_comments import commented_spans
from tltlc.grammar.module import Module
from tltlc.io.limits import WORK
from tltlc.pipeline import CompileOptions
from tltlc.tools.lint.rule import LintFinding
from tltlc.tools.lint.run import findings, view_of
from tltlc.tools.lint.scopes import apply_edits, preserve_scopes

_MOST_ROUNDS = 100
"""The most rounds of fixing. No real file needs so many, because each round removes something."""


@record
class FixedFile:
    """A text after all fixes.

    ``source`` is the new text, and ``remaining`` are the findings in it. ``fixed`` are the diagnostics
    that were fixed. The labels of each point into the text in which it was found.
    """

    source: SourceFile
    fixed: tuple[Diagnostic, ...]
    remaining: tuple[LintFinding, ...]


def fix(
    source: SourceFile,
    options: CompileOptions | None = None,
    levels: Mapping[str, str] = EMPTY,
    used_elsewhere: Container[str] = frozenset(),
) -> FixedFile:
    """Lint a file and apply the safe fixes; repeat this until nothing changes.

    ``levels`` maps codes to severities: a finding gets the severity to which its code is mapped, and
    is left out if this is ``allow``. ``used_elsewhere`` contains the names of this file that other
    files may use.

    Raises:
        TltlError: all diagnostics, if the file does not compile.
    """

    def lint_text(text: SourceFile) -> tuple[Module, tuple[LintFinding, ...]]:
        view = replace(view_of(text, options or CompileOptions()), used_elsewhere=used_elsewhere)
        return view.module, findings(view, levels)

    module, remaining = lint_text(source)
    fixed: list[Diagnostic] = []
    for _ in range(_MOST_ROUNDS):
        edited, applied = _apply_once(module, remaining)
        if not applied:
            break
        try:
            module, remaining = lint_text(edited)
        except TltlError:
            # These fixes break the file, so discard them and keep the text before them.
            break
        fixed += applied
    return FixedFile(module.source, tuple(fixed), remaining)


def _apply_once(module: Module, remaining: tuple[LintFinding, ...]) -> tuple[SourceFile, list[Diagnostic]]:
    """Apply the fixes of the findings ``remaining`` to the text of a module.

    Return the new text and the diagnostics that were fixed. A fix is left out if it overlaps with
    the fix of an earlier finding, or if it would change which statements an ``allow`` comment
    silences.
    """
    fixable = _without_overlaps([finding for finding in remaining if finding.fix])
    if not fixable:
        return module.source, []
    if commented_spans(module):
        applied, edits = _fixable_together(module, fixable)
    else:
        applied, edits = fixable, _edits(fixable)
    return apply_edits(module.source, edits), [finding.diagnostic for finding in applied]


def _without_overlaps(findings: Iterable[LintFinding]) -> list[LintFinding]:
    """Return the findings without those whose edits overlap with the edits of an earlier finding.

    If two findings have an edit in common, this does not count as an overlap.
    """
    accepted: list[LintFinding] = []
    spans: list[tuple[int, int]] = []
    known: set[Edit] = set()
    for finding in findings:
        new = [(edit.span.start, edit.span.end) for edit in finding.fix if edit not in known]
        if not any(_overlaps(span, spans) for span in new):
            accepted.append(finding)
            known.update(finding.fix)
            for span in new:
                insort(spans, span)
    return accepted


def _overlaps(span: tuple[int, int], spans: list[tuple[int, int]]) -> bool:
    """Whether a span overlaps with one of ``spans``, which are sorted and do not overlap."""
    place = bisect(spans, span)
    start, end = span
    return any(other < end and start < stop for other, stop in spans[max(0, place - 1) : place + 1])


def _edits(findings: Iterable[LintFinding]) -> tuple[Edit, ...]:
    return tuple(dict.fromkeys(edit for finding in findings for edit in finding.fix))


def _fixable_together(module: Module, findings: Sequence[LintFinding]) -> tuple[list[LintFinding], tuple[Edit, ...]]:
    """Return findings that can be fixed together, and the edits of these fixes.

    Together, the fixes must not change which statements the ``allow`` comments silence. The search
    tries all findings at once; if that fails, it tries each half, and so on. It stops after
    ``WORK["fixes tried"]`` attempts.
    """
    applied: list[LintFinding] = []
    edits: tuple[Edit, ...] = ()
    pending = [list(findings)]
    for _ in range(WORK["fixes tried"]):
        if not pending:
            break
        part = pending.pop()
        together = preserve_scopes(module, _edits([*applied, *part]))
        if together is not None:
            applied += part
            edits = together
        elif len(part) > 1:
            half = len(part) // 2
            pending += [part[half:], part[:half]]
    return applied, edits
