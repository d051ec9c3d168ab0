"""Comments that silence remarks: ``// tltlc: allow TLT0421``, with a reason behind the codes where there is one.

One at the end of a line, or on lines of its own above it, speaks of each clause and each declaration that has a part
on that line; of a block, its head and its last line.  Before the first declaration it speaks of the whole file.
"""

from __future__ import annotations

import re
from bisect import bisect_right
from collections.abc import Iterator
from typing import Final

from tltlc.core.record import record
from tltlc.core.source import SourceFile, Span
from tltlc.grammar.tree import Comment, EntityDecl, Module, SpecDecl

_COMMENT: Final = re.compile(r"//(?!/)\s*tltlc\s*:\s*allow\b")
_CODES: Final = re.compile(r"[\s,]*(TLT[0-9]{4})\b")
_BRACE: Final = re.compile(r"(?:\s|//[^\n]*\n)*\{")


@record
class Allowed:
    """A code that a comment allows, and where it says so; ``places`` are as of :func:`spoken_of`."""

    code: str
    source: SourceFile
    span: Span
    comment: Comment
    places: tuple[Span, ...] | None


def allowed(module: Module) -> Iterator[Allowed]:
    """Every code that a comment of the module allows, in order."""
    for comment, places in spoken_of(module):
        for match in _codes(comment):
            start = comment.span.start
            span = Span(start + match.start(1), start + match.end(1))
            yield Allowed(match[1], module.source, span, comment, places)


def codes(comment: Comment) -> list[str]:
    """The codes right behind ``allow``; what follows them is the reason."""
    return [match[1] for match in _codes(comment)]


def is_allowing(comment: Comment) -> bool:
    """Whether a comment begins with ``// tltlc: allow``."""
    return bool(_COMMENT.match(comment.text))


def spoken_of(module: Module) -> list[tuple[Comment, tuple[Span, ...] | None]]:
    """The comments that allow something, and the clauses and declarations of which each speaks; None is the file.

    Comments that speak of the same line share one tuple.
    """
    comments = [comment for comment in module.comments if is_allowing(comment)]
    if not comments:
        return []
    first = module.declarations[0].span.start if module.declarations else len(module.source.text)
    by_line = _by_line(module)
    lines = sorted(by_line)
    of_line: dict[int, tuple[Span, ...]] = {}
    found: list[tuple[Comment, tuple[Span, ...] | None]] = []
    for comment in comments:
        line, _ = module.source.position(comment.span.start)
        if line not in by_line:
            # It stands between two of them, above the next one.
            below = bisect_right(lines, line)
            line = lines[below] if below < len(lines) else line
        if line not in of_line:
            of_line[line] = tuple(by_line.get(line, ()))
        found.append((comment, None if comment.span.start < first else of_line[line]))
    return found


def statements(module: Module) -> list[Span]:
    """The clauses and declarations of which comments can speak, in order."""
    return list(dict.fromkeys(whole for whole, _ in _parts(module)))


def _by_line(module: Module) -> dict[int, dict[Span, None]]:
    """The clauses and declarations that have a part on each line, in order."""
    found: dict[int, dict[Span, None]] = {}
    for whole, part in _parts(module):
        first, _ = module.source.position(part.start)
        last, _ = module.source.position(part.end)
        for line in range(first, last + 1):
            found.setdefault(line, {})[whole] = None
    return found


def _parts(module: Module) -> Iterator[tuple[Span, Span]]:
    """Each clause and declaration, and the part of it that counts: of a block its head, and its closing brace.

    Of a list of entities the first stands for the whole declaration, and each other one for itself.
    """
    for declaration in module.declarations:
        span = declaration.span
        if isinstance(declaration, EntityDecl):
            yield span, Span(span.start, declaration.names[0].span.end)
            yield from ((name.span, name.span) for name in declaration.names[1:])
            continue
        if not isinstance(declaration, SpecDecl) or not declaration.block:
            yield span, span
            continue
        brace = _BRACE.match(module.source.text, declaration.name_span.end)
        yield span, Span(span.start, brace.end() if brace else declaration.name_span.end)
        for clause in declaration.clauses:
            yield clause.span, clause.span
        yield span, Span(span.end, span.end)


def _codes(comment: Comment) -> Iterator[re.Match[str]]:
    head = _COMMENT.match(comment.text)
    place = head.end() if head else len(comment.text)
    while match := _CODES.match(comment.text, place):
        yield match
        place = match.end()
