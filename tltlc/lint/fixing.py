"""Applying fixes to a text, again and again until there is none."""

from __future__ import annotations

from collections.abc import Mapping

from tltlc.diagnostics.diagnostic import Diagnostic, TltlError
from tltlc.grammar.allowed import spoken_of
from tltlc.grammar.parser import parse
from tltlc.lint.rule import Edit, Finding
from tltlc.lint.run import levelled, lint
from tltlc.lint.scopes import after, keeping_scopes
from tltlc.pipeline import CompileOptions
from tltlc.record import EMPTY, record
from tltlc.source import SourceFile

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
    elsewhere: frozenset[str] = frozenset(),
) -> Fixed:
    """A file with every fix applied, until nothing changes.

    ``levels`` are as of :func:`tltlc.lint.run.levelled`, ``elsewhere`` as of :func:`tltlc.lint.run.lint`.

    Errors: as of :func:`tltlc.lint.run.lint`.
    """
    found = levelled(lint(source, options, elsewhere), levels)
    fixed: list[Diagnostic] = []
    for _ in range(_MOST_ROUNDS):
        edited, applied = _applied(source, found)
        if not applied:
            break
        try:
            left = levelled(lint(edited, options, elsewhere), levels)
        except TltlError:
            # A fix that breaks a file is none: the file stays as it was before.
            break
        source, found = edited, left
        fixed += applied
    return Fixed(source, tuple(fixed), found)


def _applied(source: SourceFile, found: tuple[Finding, ...]) -> tuple[SourceFile, list[Diagnostic]]:
    """The text with all fixes that do not overlap and keep the scopes of comments, and what they mend."""
    fixable = [finding for finding in found if finding.fix]
    if not fixable:
        return source, []
    module, _ = parse(source)
    has_scopes = bool(spoken_of(module))
    edits: tuple[Edit, ...] = ()
    applied: list[Diagnostic] = []
    for finding in fixable:
        new = tuple(edit for edit in finding.fix if edit not in edits)
        if any(_meet(edit, other) for edit in new for other in edits):
            continue
        together = keeping_scopes(module, edits + new) if has_scopes else edits + new
        if together is not None:
            edits = together
            applied.append(finding.diagnostic)
    return after(source, edits), applied


def _meet(one: Edit, other: Edit) -> bool:
    return one.span.start < other.span.end and other.span.start < one.span.end
