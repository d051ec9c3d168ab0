"""The exception that stops the resolution of one clause or declaration, and the log of all diagnostics.

The exception never stops the whole run: the next clause or declaration is resolved.
"""

from __future__ import annotations

from typing import Final

from tltlc.core.record import replace
from tltlc.core.source import SourceFile, Span
from tltlc.diagnostics.diagnostic import Diagnostic, Fix, Label


class ResolutionError(Exception):
    """Raised when a clause or declaration cannot be resolved.

    ``diagnostic`` is the error to report; None if its cause has already been reported.
    """

    def __init__(self, diagnostic: Diagnostic | None) -> None:
        self.diagnostic = diagnostic
        super().__init__(diagnostic.title if diagnostic else "reported before")

    def add_use(self, use: Label, source: SourceFile, body: Span) -> None:
        """Add a label that shows where a definition is used, if the error is in the body of the definition.

        ``use`` is the place of the use, and ``body`` the span of the body in ``source``. Does nothing
        if the error is elsewhere, or if the arguments of the use cannot have caused it.
        """
        diagnostic = self.diagnostic
        if diagnostic is None or diagnostic.code not in _OF_ARGUMENTS or len(diagnostic.labels) >= _MOST_PLACES:
            return
        last = diagnostic.labels[-1]
        if last.source is source and body.start <= last.span.start <= last.span.end <= body.end:
            # Other uses of the definition may be correct, so a fix for this use must not change the definition.
            self.diagnostic = replace(
                diagnostic, labels=(*diagnostic.labels, replace(use, message="used here")), fixes=()
            )


_OF_ARGUMENTS: Final = {"TLT0110", "TLT0301", "TLT0302", "TLT0305", "TLT0307", "TLT0309", "TLT0310", "TLT0311"}
"""The codes of problems that a definition may have with some arguments but not with others."""

_MOST_PLACES: Final = 4
"""The most places that one problem shows, including its own."""


def problem(
    code: str,
    title: str,
    source: SourceFile,
    span: Span,
    message: str = "",
    *,
    advice: str | None = None,
    related: tuple[Label, ...] = (),
    fixes: tuple[Fix, ...] = (),
) -> ResolutionError:
    """Return a ResolutionError with a diagnostic at ``span``, which shows ``message`` under the caret.

    ``advice`` becomes the help of the diagnostic. The labels ``related`` follow the main label.
    """
    labels = (Label(source, span, message), *related)
    return ResolutionError(Diagnostic(code, title, labels, advice, fixes=fixes))


class Log:
    """The diagnostics of a run of resolution; at most one per code and place."""

    def __init__(self) -> None:
        self._diagnostics: dict[object, Diagnostic] = {}

    def __len__(self) -> int:
        return len(self._diagnostics)

    def add(self, diagnostic: Diagnostic | None) -> None:
        """Store a diagnostic; ignore None and repetitions."""
        if diagnostic is None:
            return
        main = diagnostic.labels[0] if diagnostic.labels else None
        place = (main.source.name, main.span) if main else diagnostic.title
        self._diagnostics.setdefault((diagnostic.code, place), diagnostic)

    def diagnostics(self) -> tuple[Diagnostic, ...]:
        """Return all diagnostics, sorted by file and then by position in the file.

        Files are in the order in which they had their first diagnostic.
        """
        files: dict[str, int] = {}

        def place(diagnostic: Diagnostic) -> tuple[int, int]:
            main = diagnostic.labels[0] if diagnostic.labels else None
            name, start = (main.source.name, main.span.start) if main else ("", 0)
            return files.setdefault(name, len(files)), start

        return tuple(sorted(self._diagnostics.values(), key=place))
