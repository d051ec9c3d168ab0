"""The one exception of resolution: it ends the current clause or declaration, never the whole run."""

from __future__ import annotations

from typing import Final

from tltlc.core.record import replace
from tltlc.core.source import SourceFile, Span
from tltlc.diagnostics.diagnostic import Diagnostic, Fix, Label


class ResolutionError(Exception):
    """Carries a diagnostic, or None if the cause has already been reported."""

    def __init__(self, diagnostic: Diagnostic | None) -> None:
        self.diagnostic = diagnostic
        super().__init__(diagnostic.title if diagnostic else "reported before")

    def used_at(self, use: Label, source: SourceFile, body: Span) -> None:
        """Add the place of a use to a problem in the body of a definition.

        Only for problems that the arguments may have caused.
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


_OF_ARGUMENTS: Final = {"TLT0301", "TLT0302", "TLT0305", "TLT0307", "TLT0309", "TLT0310", "TLT0311"}
"""The codes of problems that a definition may have with some arguments and not with others."""

_MOST_PLACES: Final = 4
"""The most places that one problem shows, its own included, where definitions use each other."""


def problem(
    code: str,
    title: str,
    source: SourceFile,
    span: Span,
    message: str = "",
    *,
    advice: str | None = None,
    other: tuple[Label, ...] = (),
    fixes: tuple[Fix, ...] = (),
) -> ResolutionError:
    """Return a problem at ``span``, with a short message under the caret and optional further labels."""
    labels = (Label(source, span, message), *other)
    return ResolutionError(Diagnostic(code, title, labels, advice, fixes=fixes))


class Log:
    """The diagnostics so far; one per code and place."""

    def __init__(self) -> None:
        self._found: dict[object, Diagnostic] = {}

    def __len__(self) -> int:
        return len(self._found)

    def add(self, diagnostic: Diagnostic | None) -> None:
        """Store a diagnostic; ignore None and repetitions."""
        if diagnostic is None:
            return
        main = diagnostic.labels[0] if diagnostic.labels else None
        place = (main.source.name, main.span) if main else diagnostic.title
        self._found.setdefault((diagnostic.code, place), diagnostic)

    def all(self) -> tuple[Diagnostic, ...]:
        """Return every diagnostic, by file in order of first report, and within a file by position."""
        files: dict[str, int] = {}

        def place(diagnostic: Diagnostic) -> tuple[int, int]:
            main = diagnostic.labels[0] if diagnostic.labels else None
            name, start = (main.source.name, main.span.start) if main else ("", 0)
            return files.setdefault(name, len(files)), start

        return tuple(sorted(self._found.values(), key=place))
