"""The one type for everything that tltlc has to say about a source text."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Literal

from tltlc.core.record import record
from tltlc.core.source import SourceFile, Span

Severity = Literal["error", "warning", "note"]
Applicability = Literal["safe", "maybe"]
"""A ``safe`` fix keeps what the text asks of the game; one that is ``maybe`` right is a guess, and may change that."""


@record
class Label:
    """A place in a source, with an optional short remark printed under its caret."""

    source: SourceFile
    span: Span
    message: str = ""


@record
class Edit:
    """Another text in place of what a span covers."""

    span: Span
    text: str


@record
class Fix:
    """One way to mend the text that a message is about: a short title, and edits that do not overlap."""

    title: str
    edits: tuple[Edit, ...]
    applicability: Applicability = "maybe"


@record
class Diagnostic:
    """A message: what happened (title), where (labels, the first is the main one), one way out (help).

    ``code`` is one of the closed list in :mod:`tltlc.diagnostics.codes`.  ``fixes`` are the ways out that a program can
    take, the likeliest first, as edits of the source of the first label.
    """

    code: str
    title: str
    labels: tuple[Label, ...] = ()
    help: str | None = None
    severity: Severity = "error"
    fixes: tuple[Fix, ...] = ()


def instead(source: SourceFile, span: Span, text: str, applicability: Applicability = "maybe") -> Fix:
    """Return the fix that writes a text in place of a span, with a space wherever two words would touch."""
    before, behind = source.text[max(0, span.start - 1) : span.start], source.text[span.end : span.end + 1]
    start = " " if _is_word(before) and _is_word(text[:1]) else ""
    end = " " if _is_word(behind) and _is_word(text[-1:]) else ""
    return Fix(f"Write `{text}`", (Edit(span, f"{start}{text}{end}"),), applicability)


def around(span: Span, opening: str = "(", closing: str = ")") -> tuple[Edit, ...]:
    """Return the edits that put brackets around a span."""
    return Edit(Span(span.start, span.start), opening), Edit(Span(span.end, span.end), closing)


def _is_word(sign: str) -> bool:
    return sign.isalnum() or sign == "_"


class TltlError(Exception):
    """Raised where a stage cannot go on; carries every diagnostic found so far.

    ``diagnostics`` is never empty and holds at least one error.
    """

    def __init__(self, diagnostics: Iterable[Diagnostic]) -> None:
        self.diagnostics: tuple[Diagnostic, ...] = tuple(diagnostics)
        super().__init__("; ".join(f"{d.code}: {d.title}" for d in self.diagnostics))

    def __reduce__(self) -> tuple[type[TltlError], tuple[tuple[Diagnostic, ...]]]:
        # Its text is not what it is made of; processes send it to each other.
        return type(self), (self.diagnostics,)


def stop_at_errors(found: Iterable[Diagnostic]) -> None:
    """Raise what was found where an error is among it."""
    found = tuple(found)
    if any(each.severity == "error" for each in found):
        raise TltlError(found)
