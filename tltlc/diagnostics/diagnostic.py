"""The type of all messages of tltlc, and the exception that contains them."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Literal

from tltlc.core.record import record
from tltlc.core.source import SourceFile, Span

Severity = Literal["error", "warning", "note"]
Applicability = Literal["safe", "maybe"]
"""A ``safe`` fix keeps the meaning of the text; a ``maybe`` fix is a guess, and may change the meaning."""


@record
class Label:
    """A place in a source text that a diagnostic points at, and a short message to print under its caret."""

    source: SourceFile
    span: Span
    message: str = ""


@record
class Edit:
    """One change of a source text: ``text`` replaces the span."""

    span: Span
    text: str


@record
class Fix:
    """One way to fix a source text: a short title, and edits that do not overlap."""

    title: str
    edits: tuple[Edit, ...]
    applicability: Applicability = "maybe"


@record
class Diagnostic:
    """An error, warning or note: what happened (``title``), where (``labels``), and a suggestion (``help``).

    ``code`` is one of the codes of :mod:`tltlc.diagnostics.code_pages`. The first label is the main
    one. ``fixes`` are alternatives, the likeliest first; a program can apply one of them to the source
    of the first label.
    """

    code: str
    title: str
    labels: tuple[Label, ...] = ()
    help: str | None = None
    severity: Severity = "error"
    fixes: tuple[Fix, ...] = ()


def replacement_fix(source: SourceFile, span: Span, text: str, applicability: Applicability = "maybe") -> Fix:
    """Return the fix that replaces a span by a text.

    If the text would touch a word before or after the span, a space separates them.
    """
    before, after = source.text[max(0, span.start - 1) : span.start], source.text[span.end : span.end + 1]
    start = " " if _is_word(before) and _is_word(text[:1]) else ""
    end = " " if _is_word(after) and _is_word(text[-1:]) else ""
    return Fix(f"Write `{text}`", (Edit(span, f"{start}{text}{end}"),), applicability)


def bracket_edits(span: Span, opening: str = "(", closing: str = ")") -> tuple[Edit, ...]:
    """Return the edits that put brackets around a span."""
    return Edit(Span(span.start, span.start), opening), Edit(Span(span.end, span.end), closing)


def _is_word(character: str) -> bool:
    return character.isalnum() or character == "_"


class TltlError(Exception):
    """Raised for errors that a user can fix, such as a mistake in a source text.

    ``diagnostics`` contains at least one error, and the warnings that were found before it.
    """

    def __init__(self, diagnostics: Iterable[Diagnostic]) -> None:
        self.diagnostics: tuple[Diagnostic, ...] = tuple(diagnostics)
        super().__init__("; ".join(f"{d.code}: {d.title}" for d in self.diagnostics))

    def __reduce__(self) -> tuple[type[TltlError], tuple[tuple[Diagnostic, ...]]]:
        # Processes send these errors to each other. By default, only the text would be pickled.
        return type(self), (self.diagnostics,)


def stop_at_errors(diagnostics: Iterable[Diagnostic]) -> None:
    """Raise a TltlError with all diagnostics if one of them is an error."""
    diagnostics = tuple(diagnostics)
    if any(diagnostic.severity == "error" for diagnostic in diagnostics):
        raise TltlError(diagnostics)
