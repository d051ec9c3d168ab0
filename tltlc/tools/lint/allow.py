"""Findings less those that comments silence (:mod:`tltlc.grammar.allow_comments`), and the comments that silence
nothing.
"""

from __future__ import annotations

import re
from bisect import bisect_right
from collections.abc import Iterable
from typing import Final

from tltlc.core.source import SourceFile, Span
from tltlc.diagnostics.diagnostic import Diagnostic, Fix, Label, Severity
from tltlc.grammar.allow_comments import Allowed, codes, is_allowing
from tltlc.grammar.allow_index import Silencing
from tltlc.grammar.tree import Comment
from tltlc.tools.lint.file_view import View
from tltlc.tools.lint.removal import without
from tltlc.tools.lint.rule import Finding, removal

CODE: Final = "TLT0427"
SEVERITY: Final[Severity] = "warning"
_MEANT: Final = re.compile(r"//+\s*tltlc\s*:\s*(?:allow\b|\w+\s+TLT[0-9]{4}\b)")


def silenced(view: View, found: Iterable[Finding]) -> list[Finding]:
    """The findings that no comment silences, of the file where they are; and one for each code that the file itself
    allows in vain.
    """
    comments = Silencing(loaded.module for loaded in view.modules)
    left = [finding for finding in found if not comments.silences(finding.diagnostic)]
    own = comments.allowed(view.source)
    asked_for = {each.comment for each in own if each.code == CODE}
    undecided = _Undecided(view)
    needless = [
        each
        for each in own
        if each.comment not in asked_for and not comments.has_silenced(each) and not undecided.touch(each)
    ]
    in_vain = set(map(id, needless))
    kept = {each.comment for each in own if id(each) not in in_vain}
    fixes = {
        comment: removal("Remove it", (without(view.source, comment.span),))
        for comment in dict.fromkeys(each.comment for each in needless)
        if comment not in kept
    }
    left += [_in_vain(each, fixes.get(each.comment)) for each in needless]
    bare = [each for each in view.module.comments if is_allowing(each) and not codes(each)]
    left += [_without_code(each, view.source) for each in bare]
    return left + [_misspelt(each, view.source) for each in view.module.comments if _is_misspelt(each)]


class _Undecided:
    """The specs that no trace satisfies, or every one: until they are mended, most rules say nothing."""

    def __init__(self, view: View) -> None:
        self._specs = sorted(
            (spec.declaration.span for spec in view.specs if spec.is_settled), key=lambda span: span.start
        )
        self._starts = [span.start for span in self._specs]
        self._known: dict[int, bool] = {}

    def touch(self, each: Allowed) -> bool:
        """Whether a comment speaks of any of them."""
        if each.places is None:
            return bool(self._specs)
        # Comments that speak of the same line share its places.
        if id(each.places) not in self._known:
            self._known[id(each.places)] = any(map(self._covers, each.places))
        return self._known[id(each.places)]

    def _covers(self, place: Span) -> bool:
        index = bisect_right(self._starts, place.start) - 1
        return index >= 0 and self._specs[index].covers(place)


def _in_vain(each: Allowed, fix: Fix | None) -> Finding:
    """``fix`` removes the comment; there is none where it still allows something else, and is left to the author."""
    where = "in this file" if each.places is None else "here"
    title = f"this allows {each.code}, which is not found {where}"
    label = Label(each.source, each.span)
    return Finding(Diagnostic(CODE, title, (label,), "remove it", SEVERITY, (fix,) if fix else ()))


def _without_code(comment: Comment, source: SourceFile) -> Finding:
    title, way_out = "this comment allows nothing", "name a code, e.g. `// tltlc: allow TLT0419`"
    return Finding(Diagnostic(CODE, title, (Label(source, comment.span),), way_out, SEVERITY))


def _is_misspelt(comment: Comment) -> bool:
    return bool(_MEANT.match(comment.text)) and not is_allowing(comment)


def _misspelt(comment: Comment, source: SourceFile) -> Finding:
    title, way_out = "this comment allows nothing", "write `// tltlc: allow`, with two slashes, and the code behind it"
    return Finding(Diagnostic(CODE, title, (Label(source, comment.span),), way_out, SEVERITY))
