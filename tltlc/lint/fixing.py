"""Applying fixes to a text, again and again until there is none."""

from __future__ import annotations

from collections.abc import Mapping

from tltlc.diagnostics.diagnostic import Diagnostic, TltlError
from tltlc.lint.rule import Edit, Finding
from tltlc.lint.run import levelled, lint
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
    """The text with all fixes that do not touch each other, and what they mend."""
    edits: list[Edit] = []
    applied: list[Diagnostic] = []
    for finding in found:
        if not finding.fix:
            continue
        if all(edit in edits or not any(_meet(edit, other) for other in edits) for edit in finding.fix):
            edits += [edit for edit in finding.fix if edit not in edits]
            applied.append(finding.diagnostic)
    text = source.text
    for edit in sorted(edits, key=lambda edit: edit.span.start, reverse=True):
        text = text[: edit.span.start] + edit.text + text[edit.span.end :]
    return SourceFile(source.name, text), applied


def _meet(one: Edit, other: Edit) -> bool:
    return one.span.start < other.span.end and other.span.start < one.span.end
