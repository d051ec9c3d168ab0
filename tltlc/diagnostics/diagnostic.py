"""The one type for everything that tltlc has to say about a source text."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Literal

from tltlc.record import record
from tltlc.source import SourceFile, Span

Severity = Literal["error", "warning", "note"]


@record
class Label:
    """A place in a source, with an optional short remark printed under its caret."""

    source: SourceFile
    span: Span
    message: str = ""


@record
class Diagnostic:
    """A message: what happened (title), where (labels, the first is the main one), one way out (help).

    ``code`` is one of the closed list in :mod:`tltlc.diagnostics.codes`.
    """

    code: str
    title: str
    labels: tuple[Label, ...] = ()
    help: str | None = None
    severity: Severity = "error"


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
