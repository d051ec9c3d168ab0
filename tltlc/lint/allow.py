"""Findings less those that comments silence (:mod:`tltlc.grammar.allowed`), and the comments that silence nothing."""

from __future__ import annotations

import re
from collections.abc import Iterable
from typing import Final

from tltlc.diagnostics.diagnostic import Diagnostic, Label, Severity
from tltlc.grammar.allowed import Allowed, allowed, codes, is_allowing
from tltlc.grammar.tree import Comment
from tltlc.lint.removal import without
from tltlc.lint.rule import Finding, removal
from tltlc.lint.view import View
from tltlc.source import SourceFile, Span

CODE: Final = "TLT0427"
SEVERITY: Final[Severity] = "warning"
_MEANT: Final = re.compile(r"//+\s*tltlc\s*:\s*(?:allow\b|\w+\s+TLT[0-9]{4}\b)")


def silenced(view: View, found: Iterable[Finding]) -> list[Finding]:
    """The findings that no comment silences, of the file where they are; and one for each code that the file itself
    allows in vain.
    """
    comments = [each for loaded in view.modules for each in allowed(loaded.module)]
    used: set[Allowed] = set()
    left: list[Finding] = []
    for finding in found:
        silencing = [each for each in comments if each.silences(finding.diagnostic)]
        used.update(silencing)
        if not silencing:
            left.append(finding)
    own = [each for each in comments if each.source is view.source]
    undecided = _undecided(view)
    judged = [each for each in own if each not in used and not _speaks_of_any(undecided, each)]
    needless = dict.fromkeys(each for each in judged if CODE not in codes(each.comment))
    kept = {each.comment for each in own if each not in needless}
    left += [_in_vain(each, each.comment in kept) for each in needless]
    bare = [each for each in view.module.comments if is_allowing(each) and not codes(each)]
    left += [_without_code(each, view.source) for each in bare]
    return left + [_misspelt(each, view.source) for each in view.module.comments if _is_misspelt(each)]


def _undecided(view: View) -> list[Span]:
    """The specs that no trace satisfies, or every one: until they are mended, most rules say nothing."""
    return [spec.declaration.span for spec in view.specs if spec.is_settled]


def _speaks_of_any(specs: Iterable[Span], each: Allowed) -> bool:
    return any(each.places is None or any(spec.covers(place) for place in each.places) for spec in specs)


def _in_vain(each: Allowed, is_kept: bool) -> Finding:
    """``is_kept``: the comment still allows something else, and is left to the author."""
    where = "in this file" if each.places is None else "here"
    title = f"this allows {each.code}, which is not found {where}"
    label = Label(each.source, each.span)
    fixes = () if is_kept else (removal("Remove it", (without(each.source, each.comment.span),)),)
    return Finding(Diagnostic(CODE, title, (label,), "remove it", SEVERITY, fixes))


def _without_code(comment: Comment, source: SourceFile) -> Finding:
    title, way_out = "this comment allows nothing", "name a code, e.g. `// tltlc: allow TLT0419`"
    return Finding(Diagnostic(CODE, title, (Label(source, comment.span),), way_out, SEVERITY))


def _is_misspelt(comment: Comment) -> bool:
    return bool(_MEANT.match(comment.text)) and not is_allowing(comment)


def _misspelt(comment: Comment, source: SourceFile) -> Finding:
    title, way_out = "this comment allows nothing", "write `// tltlc: allow`, with two slashes, and the code behind it"
    return Finding(Diagnostic(CODE, title, (Label(source, comment.span),), way_out, SEVERITY))
