"""Which diagnostics the comments of modules silence (:mod:`tltlc.grammar.allow_comments`), and which comments silence
any.
"""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Iterable, Iterator, Sequence

from tltlc.core.source import SourceFile, Span
from tltlc.diagnostics.diagnostic import Diagnostic
from tltlc.grammar.allow_comments import Allowed, allowed
from tltlc.grammar.tree import Module


def unsilenced(modules: Iterable[Module], found: Iterable[Diagnostic]) -> tuple[Diagnostic, ...]:
    """What the compiler has to say, less the remarks that comments allow in the file where they are."""
    said = tuple(found)
    if not said:
        return said
    comments = Silencing(modules)
    return tuple(one for one in said if one.severity == "error" or not comments.silences(one))


class Silencing:
    """What the comments of modules allow, in order, and what of it has silenced something.

    The comments are sorted by the statements of which they speak, so that none is looked at again for each diagnostic.
    """

    def __init__(self, modules: Iterable[Module]) -> None:
        self._files: dict[SourceFile, _File] = {}
        for module in modules:
            found = tuple(allowed(module))
            if found:
                self._files[module.source] = _File(found)

    def allowed(self, source: SourceFile) -> Sequence[Allowed]:
        """The codes that the comments of one file allow."""
        file = self._files.get(source)
        return file.allowed if file else ()

    def silences(self, diagnostic: Diagnostic) -> bool:
        """Whether a comment allows a diagnostic; every comment that allows it counts as used from then on."""
        label = diagnostic.labels[0] if diagnostic.labels else None
        file = self._files.get(label.source) if label else None
        return label is not None and file is not None and file.silences(diagnostic.code, label.span.start)

    def has_silenced(self, each: Allowed) -> bool:
        """Whether a code that a comment allows has silenced something."""
        return id(each) in self._files[each.source].used


class _File:
    """The comments of one file."""

    def __init__(self, found: tuple[Allowed, ...]) -> None:
        self.allowed = found
        self.used: set[int] = set()
        self._known: dict[tuple[str, Span | None], bool] = {}
        self._of_place: dict[Span | None, list[dict[str, list[Allowed]]]] = {}
        # Comments that speak of the same line share its statements.
        lines: dict[int, dict[str, list[Allowed]]] = {}
        for each in found:
            codes = lines.get(id(each.places))
            if codes is None:
                codes = lines[id(each.places)] = {}
                for place in (None,) if each.places is None else each.places:
                    self._of_place.setdefault(place, []).append(codes)
            codes.setdefault(each.code, []).append(each)
        self._places = _Places(place for place in self._of_place if place is not None)

    def silences(self, code: str, offset: int) -> bool:
        """Whether comments allow a code where an offset lies; those that do are used."""
        # A place reaches up to its end, and with that.
        places = {None, *self._places.around(offset), *self._places.around(offset - 1)}
        known = [self._allow(code, place) for place in places]
        return any(known)

    def _allow(self, code: str, place: Span | None) -> bool:
        """Whether comments allow a code at a place, None for the whole file; those that do are used."""
        if (code, place) not in self._known:
            found = [each for codes in self._of_place.get(place, ()) for each in codes.get(code, ())]
            self.used.update(map(id, found))
            self._known[code, place] = bool(found)
        return self._known[code, place]


class _Places:
    """Spans that do not overlap but where one lies in another."""

    def __init__(self, spans: Iterable[Span]) -> None:
        self._spans = sorted(spans, key=lambda span: (span.start, -span.end))
        self._starts = [span.start for span in self._spans]
        self._outer: list[int] = []
        """For each span the index of the one around it, -1 where there is none."""
        open_: list[int] = []
        for index, span in enumerate(self._spans):
            while open_ and self._spans[open_[-1]].end <= span.start:
                open_.pop()
            self._outer.append(open_[-1] if open_ else -1)
            open_.append(index)

    def around(self, offset: int) -> Iterator[Span]:
        """The spans in which an offset lies."""
        index = bisect_right(self._starts, offset) - 1
        while index >= 0:
            if offset < self._spans[index].end:
                yield self._spans[index]
            index = self._outer[index]
