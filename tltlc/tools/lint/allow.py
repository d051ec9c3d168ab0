"""Apply ``allow`` comments to findings, and report comments that have no effect.

A comment such as ``// tltlc: allow TLT0419`` silences the findings with this code on its line.
:mod:`tltlc.grammar.allow_comments` defines the form of these comments.
"""

from __future__ import annotations

import re
from bisect import bisect_right
from collections.abc import Iterable
from typing import Final

from tltlc.core.source import SourceFile, Span
from tltlc.diagnostics.diagnostic import Diagnostic, Fix, Label, Severity
from tltlc.grammar.allow_comments import Allowance, codes, is_allowing
from tltlc.grammar.allow_index import AllowIndex
from tltlc.grammar.module import Comment
from tltlc.tools.lint.file_view import FileView
from tltlc.tools.lint.removal import removal_span
from tltlc.tools.lint.rule import LintFinding, removal_fix

CODE: Final = "TLT0427"
SEVERITY: Final[Severity] = "warning"
_LIKE_ALLOW: Final = re.compile(r"//+\s*tltlc\s*:\s*(?:allow\b|\w+\s+TLT[0-9]{4}\b)")
"""Matches ``allow`` comments, and comments that are probably misspelt ``allow`` comments."""


def apply_allow_comments(view: FileView, findings: Iterable[LintFinding]) -> list[LintFinding]:
    """Return the findings that no comment silences, plus findings about the comments themselves.

    A comment such as ``// tltlc: allow TLT0419`` silences findings in its own file. The findings
    about comments, TLT0427, are about

    - each code in a comment that silences nothing;
    - each ``allow`` comment without a code;
    - each comment that is probably a misspelt ``allow`` comment.

    A code that silences nothing is not reported if its comment also allows TLT0427, or if the
    comment applies to a spec that every trace or no trace satisfies, or to a clause of such a spec.
    """
    comments = AllowIndex(loaded.module for loaded in view.modules)
    remaining = [finding for finding in findings if not comments.silences(finding.diagnostic)]
    allowances = comments.allowances(view.source)
    excused = {allowance.comment for allowance in allowances if allowance.code == CODE}
    settled_specs = _SettledSpecs(view)
    unused = [
        allowance
        for allowance in allowances
        if allowance.comment not in excused
        and not comments.has_silenced(allowance)
        and not settled_specs.overlap(allowance)
    ]
    unused_ids = set(map(id, unused))
    used_comments = {allowance.comment for allowance in allowances if id(allowance) not in unused_ids}
    fixes = {
        comment: removal_fix("Remove it", (removal_span(view.source, comment.span),))
        for comment in dict.fromkeys(allowance.comment for allowance in unused)
        if comment not in used_comments
    }
    remaining += [_unused_code(allowance, fixes.get(allowance.comment)) for allowance in unused]
    without_code = [comment for comment in view.module.comments if is_allowing(comment) and not codes(comment)]
    remaining += [_missing_code(comment, view.source) for comment in without_code]
    return remaining + [
        _misspelt_comment(comment, view.source) for comment in view.module.comments if _is_misspelt(comment)
    ]


class _SettledSpecs:
    """The settled specs of a file: those that every trace satisfies, or no trace.

    Most rules skip settled specs. So a comment on such a spec may silence nothing now, but silence
    a finding once the spec is corrected.
    """

    def __init__(self, view: FileView) -> None:
        self._specs = sorted(
            (spec.declaration.span for spec in view.specs if spec.is_settled), key=lambda span: span.start
        )
        self._starts = [span.start for span in self._specs]
        self._results: dict[int, bool] = {}

    def overlap(self, allowance: Allowance) -> bool:
        """Whether the comment of ``allowance`` applies to a settled spec or to a clause of such a spec."""
        if allowance.statements is None:
            return bool(self._specs)
        # Comments that apply to the same line share one tuple of spans, so its identity can be the key.
        if id(allowance.statements) not in self._results:
            self._results[id(allowance.statements)] = any(map(self._covers, allowance.statements))
        return self._results[id(allowance.statements)]

    def _covers(self, place: Span) -> bool:
        index = bisect_right(self._starts, place.start) - 1
        return index >= 0 and self._specs[index].covers(place)


def _unused_code(allowance: Allowance, fix: Fix | None) -> LintFinding:
    """Return the finding for a code in an ``allow`` comment that silences nothing.

    ``fix`` removes the whole comment. It is None if another code in the comment silences something;
    then the author has to edit the comment.
    """
    where = "in this file" if allowance.statements is None else "here"
    title = f"this allows {allowance.code}, which is not found {where}"
    label = Label(allowance.source, allowance.span)
    return LintFinding(Diagnostic(CODE, title, (label,), "remove it", SEVERITY, (fix,) if fix else ()))


def _missing_code(comment: Comment, source: SourceFile) -> LintFinding:
    """Return the finding for an ``allow`` comment that names no code."""
    title, help_ = "this comment allows nothing", "write a code, e.g. `// tltlc: allow TLT0419`"
    return LintFinding(Diagnostic(CODE, title, (Label(source, comment.span),), help_, SEVERITY))


def _is_misspelt(comment: Comment) -> bool:
    return bool(_LIKE_ALLOW.match(comment.text)) and not is_allowing(comment)


def _misspelt_comment(comment: Comment, source: SourceFile) -> LintFinding:
    """Return the finding for a comment that is probably meant as an ``allow`` comment."""
    title, help_ = (
        "this comment allows nothing",
        "write `// tltlc: allow`, with two slashes, and the code after it",
    )
    return LintFinding(Diagnostic(CODE, title, (Label(source, comment.span),), help_, SEVERITY))
