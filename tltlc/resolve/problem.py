"""The one exception inside resolution: it ends the clause or declaration at hand, never the whole run."""

from __future__ import annotations

from typing import Final

from tltlc.core.record import replace
from tltlc.core.source import SourceFile, Span
from tltlc.diagnostics.diagnostic import Diagnostic, Fix, Label


class ResolutionError(Exception):
    """Carries a diagnostic; ``diagnostic`` is None where the cause has been reported already."""

    def __init__(self, diagnostic: Diagnostic | None) -> None:
        self.diagnostic = diagnostic
        super().__init__(diagnostic.title if diagnostic else "reported before")

    def used_at(self, use: Label, source: SourceFile, body: Span) -> None:
        """Adds the place that uses a definition to a problem in its body that the arguments may have caused."""
        found = self.diagnostic
        if found is None or found.code not in _OF_ARGUMENTS or len(found.labels) >= _MOST_PLACES:
            return
        last = found.labels[-1]
        if last.source is source and body.start <= last.span.start <= last.span.end <= body.end:
            # Other uses of the definition may be right: what mends it for this one does not mend it.
            self.diagnostic = replace(found, labels=(*found.labels, replace(use, message="used here")), fixes=())


_OF_ARGUMENTS: Final = {"TLT0301", "TLT0302", "TLT0305", "TLT0307", "TLT0309", "TLT0310", "TLT0311"}
"""The codes of problems that a definition may have with some arguments and not with others."""

_MOST_PLACES: Final = 4
"""How many places a problem shows, its own included, where definitions use each other."""


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
    """A problem whose main place is ``span``, with a short remark under its caret and further places behind it."""
    labels = (Label(source, span, message), *other)
    return ResolutionError(Diagnostic(code, title, labels, advice, fixes=fixes))


class Log:
    """The diagnostics found so far, each place and code once."""

    def __init__(self) -> None:
        self._found: dict[object, Diagnostic] = {}

    def __len__(self) -> int:
        return len(self._found)

    def add(self, diagnostic: Diagnostic | None) -> None:
        """Keep a diagnostic; None and repetitions are ignored."""
        if diagnostic is None:
            return
        main = diagnostic.labels[0] if diagnostic.labels else None
        place = (main.source.name, main.span) if main else diagnostic.title
        self._found.setdefault((diagnostic.code, place), diagnostic)

    def all(self) -> tuple[Diagnostic, ...]:
        """Every diagnostic: those of a file in the order of its text, files in the order in which they came up."""
        files: dict[str, int] = {}

        def place(diagnostic: Diagnostic) -> tuple[int, int]:
            main = diagnostic.labels[0] if diagnostic.labels else None
            name, start = (main.source.name, main.span.start) if main else ("", 0)
            return files.setdefault(name, len(files)), start

        return tuple(sorted(self._found.values(), key=place))
