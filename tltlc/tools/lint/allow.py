"""Apply ``allow`` comments to findings, and report comments that have no effect.

:mod:`tltlc.grammar.allow_comments` defines these comments.
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
from tltlc.grammar.tree import Comment
from tltlc.tools.lint.file_view import View
from tltlc.tools.lint.removal import without
from tltlc.tools.lint.rule import LintFinding, removal

CODE: Final = "TLT0427"
SEVERITY: Final[Severity] = "warning"
_INTENDED: Final = re.compile(r"//+\s*tltlc\s*:\s*(?:allow\b|\w+\s+TLT[0-9]{4}\b)")


def silenced(view: View, findings: Iterable[LintFinding]) -> list[LintFinding]:
    """Return the findings that no comment silences, plus findings about the comments themselves.

    A comment silences findings in its own file. Each code that the linted file allows in vain gets
    a finding, unless the comment also allows TLT0427. Each comment that names no code or is
    misspelt gets a finding, too.
    """
    comments = AllowIndex(loaded.module for loaded in view.modules)
    left = [finding for finding in findings if not comments.silences(finding.diagnostic)]
    own = comments.allowances(view.source)
    asked_for = {allowance.comment for allowance in own if allowance.code == CODE}
    undecided = _Undecided(view)
    needless = [
        allowance
        for allowance in own
        if allowance.comment not in asked_for
        and not comments.has_silenced(allowance)
        and not undecided.touch(allowance)
    ]
    in_vain = set(map(id, needless))
    kept = {allowance.comment for allowance in own if id(allowance) not in in_vain}
    fixes = {
        comment: removal("Remove it", (without(view.source, comment.span),))
        for comment in dict.fromkeys(allowance.comment for allowance in needless)
        if comment not in kept
    }
    left += [_in_vain(allowance, fixes.get(allowance.comment)) for allowance in needless]
    bare = [comment for comment in view.module.comments if is_allowing(comment) and not codes(comment)]
    left += [_without_code(comment, view.source) for comment in bare]
    return left + [_misspelt(comment, view.source) for comment in view.module.comments if _is_misspelt(comment)]


class _Undecided:
    """The specs that every trace satisfies, or none. Most rules skip them until they are fixed."""

    def __init__(self, view: View) -> None:
        self._specs = sorted(
            (spec.declaration.span for spec in view.specs if spec.is_settled), key=lambda span: span.start
        )
        self._starts = [span.start for span in self._specs]
        self._known: dict[int, bool] = {}

    def touch(self, allowance: Allowance) -> bool:
        """Whether a comment applies to any of these specs."""
        if allowance.statements is None:
            return bool(self._specs)
        # Comments on the same line share one tuple of places.
        if id(allowance.statements) not in self._known:
            self._known[id(allowance.statements)] = any(map(self._covers, allowance.statements))
        return self._known[id(allowance.statements)]

    def _covers(self, place: Span) -> bool:
        index = bisect_right(self._starts, place.start) - 1
        return index >= 0 and self._specs[index].covers(place)


def _in_vain(allowance: Allowance, fix: Fix | None) -> LintFinding:
    """Return the finding for an allowed code that silences nothing.

    ``fix`` removes the comment. It is None if the comment allows other codes with effect; then the
    author has to edit the comment.
    """
    where = "in this file" if allowance.statements is None else "here"
    title = f"this allows {allowance.code}, which is not found {where}"
    label = Label(allowance.source, allowance.span)
    return LintFinding(Diagnostic(CODE, title, (label,), "remove it", SEVERITY, (fix,) if fix else ()))


def _without_code(comment: Comment, source: SourceFile) -> LintFinding:
    title, suggestion = "this comment allows nothing", "name a code, e.g. `// tltlc: allow TLT0419`"
    return LintFinding(Diagnostic(CODE, title, (Label(source, comment.span),), suggestion, SEVERITY))


def _is_misspelt(comment: Comment) -> bool:
    return bool(_INTENDED.match(comment.text)) and not is_allowing(comment)


def _misspelt(comment: Comment, source: SourceFile) -> LintFinding:
    title, suggestion = (
        "this comment allows nothing",
        "write `// tltlc: allow`, with two slashes, and the code behind it",
    )
    return LintFinding(Diagnostic(CODE, title, (Label(source, comment.span),), suggestion, SEVERITY))
