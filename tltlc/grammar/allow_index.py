"""Find the diagnostics that comments silence (:mod:`tltlc.grammar.allow_comments`), and the comments that
silence any.
"""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Iterable, Iterator, Sequence

from tltlc.core.source import SourceFile, Span
from tltlc.diagnostics.diagnostic import Diagnostic
from tltlc.grammar.allow_comments import Allowed, allowed
from tltlc.grammar.tree import Module


def unsilenced(modules: Iterable[Module], reported: Iterable[Diagnostic]) -> tuple[Diagnostic, ...]:
    """Return the diagnostics without the warnings and notes that a comment in their file allows."""
    diagnostics = tuple(reported)
    if not diagnostics:
        return diagnostics
    comments = Silencing(modules)
    return tuple(
        diagnostic for diagnostic in diagnostics if diagnostic.severity == "error" or not comments.silences(diagnostic)
    )


class Silencing:
    """All codes that the comments of modules allow, in order, and which of them have silenced a diagnostic.

    The comments are indexed by the statements that they apply to, so that a diagnostic does not need
    a pass over all comments.
    """

    def __init__(self, modules: Iterable[Module]) -> None:
        self._files: dict[SourceFile, _File] = {}
        for module in modules:
            allowances = tuple(allowed(module))
            if allowances:
                self._files[module.source] = _File(allowances)

    def allowed(self, source: SourceFile) -> Sequence[Allowed]:
        """Return the codes that the comments of one file allow."""
        file = self._files.get(source)
        return file.allowed if file else ()

    def silences(self, diagnostic: Diagnostic) -> bool:
        """Whether a comment allows a diagnostic; from then on, each comment that allows it counts as used."""
        label = diagnostic.labels[0] if diagnostic.labels else None
        file = self._files.get(label.source) if label else None
        return label is not None and file is not None and file.silences(diagnostic.code, label.span.start)

    def has_silenced(self, allowance: Allowed) -> bool:
        """Whether an allowed code has silenced a diagnostic."""
        return id(allowance) in self._files[allowance.source].used


class _File:
    """The comments of one file that allow codes."""

    def __init__(self, allowances: tuple[Allowed, ...]) -> None:
        self.allowed = allowances
        self.used: set[int] = set()
        self._known: dict[tuple[str, Span | None], bool] = {}
        self._of_place: dict[Span | None, list[dict[str, list[Allowed]]]] = {}
        # Comments that apply to the same line share its statements.
        codes_by_line: dict[int, dict[str, list[Allowed]]] = {}
        for allowance in allowances:
            codes = codes_by_line.get(id(allowance.places))
            if codes is None:
                codes = codes_by_line[id(allowance.places)] = {}
                for place in (None,) if allowance.places is None else allowance.places:
                    self._of_place.setdefault(place, []).append(codes)
            codes.setdefault(allowance.code, []).append(allowance)
        self._places = _Places(place for place in self._of_place if place is not None)

    def silences(self, code: str, offset: int) -> bool:
        """Whether comments allow a code at an offset; those that do count as used."""
        # The end of a statement is inclusive: an offset right after its last character belongs to it, too.
        places = {None, *self._places.around(offset), *self._places.around(offset - 1)}
        # A list, not a generator: every comment that allows the code counts as used.
        is_allowed = [self._allow(code, place) for place in places]
        return any(is_allowed)

    def _allow(self, code: str, place: Span | None) -> bool:
        """Whether comments allow a code at a place, or in the whole file for None; those that do count as used."""
        if (code, place) not in self._known:
            allowances = [allowance for codes in self._of_place.get(place, ()) for allowance in codes.get(code, ())]
            self.used.update(map(id, allowances))
            self._known[code, place] = bool(allowances)
        return self._known[code, place]


class _Places:
    """Spans that do not overlap, except that one may contain another."""

    def __init__(self, spans: Iterable[Span]) -> None:
        self._spans = sorted(spans, key=lambda span: (span.start, -span.end))
        self._starts = [span.start for span in self._spans]
        self._outer: list[int] = []
        """For each span, the index of the span around it, or -1."""
        open_: list[int] = []
        for index, span in enumerate(self._spans):
            while open_ and self._spans[open_[-1]].end <= span.start:
                open_.pop()
            self._outer.append(open_[-1] if open_ else -1)
            open_.append(index)

    def around(self, offset: int) -> Iterator[Span]:
        """Yield the spans that contain an offset, innermost first."""
        index = bisect_right(self._starts, offset) - 1
        while index >= 0:
            if offset < self._spans[index].end:
                yield self._spans[index]
            index = self._outer[index]
