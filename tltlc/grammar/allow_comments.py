"""Comments that silence warnings and notes, such as ``// tltlc: allow TLT0421``.

A reason may follow the codes. The place of a comment says what it applies to:

- at the end of a line, to this line;
- on a line of its own, to the next line with a clause or declaration;
- before the first declaration, to the whole file.

A comment that applies to a line silences diagnostics of every clause and declaration that has a
part on the line. The parts of a block are its head and its closing brace.
"""

from __future__ import annotations

import re
from bisect import bisect_right
from collections.abc import Iterator
from typing import Final

from tltlc.core.record import record
from tltlc.core.source import SourceFile, Span
from tltlc.grammar.module import Comment, Module
from tltlc.grammar.tree import EntityDecl, SpecDecl

_COMMENT: Final = re.compile(r"//(?!/)\s*tltlc\s*:\s*allow\b")
_CODES: Final = re.compile(r"[\s,]*(TLT[0-9]{4})\b")
_BRACE: Final = re.compile(r"(?:\s|//[^\n]*\n)*\{")


@record
class Allowance:
    """A diagnostic code that a comment allows. A comment with two codes gives two allowances.

    ``span`` is the place of the code in the source text. ``statements`` are the spans of the
    clauses and declarations that the comment applies to; None means the whole file.
    """

    code: str
    source: SourceFile
    span: Span
    comment: Comment
    statements: tuple[Span, ...] | None


def allowances(module: Module) -> Iterator[Allowance]:
    """Yield an allowance for each code in the comments of a module, in the order of the text."""
    for comment, spans in commented_spans(module):
        for match in _code_matches(comment):
            start = comment.span.start
            span = Span(start + match.start(1), start + match.end(1))
            yield Allowance(match[1], module.source, span, comment, spans)


def codes(comment: Comment) -> list[str]:
    """Return the diagnostic codes after ``allow`` in a comment, without the reason after them."""
    return [match[1] for match in _code_matches(comment)]


def is_allowing(comment: Comment) -> bool:
    """Whether a comment begins with ``// tltlc: allow``."""
    return bool(_COMMENT.match(comment.text))


def commented_spans(module: Module) -> list[tuple[Comment, tuple[Span, ...] | None]]:
    """Return the comments that allow codes, each with the spans of the statements that it applies to.

    Statements are clauses and declarations. None in place of the spans means the whole file.
    Comments that apply to the same line share one tuple object, so callers can group the comments
    by the ``id()`` of their tuples.
    """
    comments = [comment for comment in module.comments if is_allowing(comment)]
    if not comments:
        return []
    first_declaration = module.declarations[0].span.start if module.declarations else len(module.source.text)
    statements_by_line = _statements_by_line(module)
    lines = sorted(statements_by_line)
    spans_of_line: dict[int, tuple[Span, ...]] = {}
    comments_with_statements: list[tuple[Comment, tuple[Span, ...] | None]] = []
    for comment in comments:
        line, _ = module.source.position(comment.span.start)
        if line not in statements_by_line:
            # The comment stands between two lines with statements: it applies to the next one.
            below = bisect_right(lines, line)
            line = lines[below] if below < len(lines) else line
        if line not in spans_of_line:
            spans_of_line[line] = tuple(statements_by_line.get(line, ()))
        comments_with_statements.append(
            (comment, None if comment.span.start < first_declaration else spans_of_line[line])
        )
    return comments_with_statements


def statements(module: Module) -> list[Span]:
    """Return the spans of the clauses and declarations that comments can apply to, in order."""
    return list(dict.fromkeys(whole for whole, _ in _statement_parts(module)))


def _statements_by_line(module: Module) -> dict[int, dict[Span, None]]:
    """Map each line number to the spans of the clauses and declarations with a part on the line.

    The inner dict is an ordered set; its values have no meaning.
    """
    statements_by_line: dict[int, dict[Span, None]] = {}
    for whole, part in _statement_parts(module):
        first, _ = module.source.position(part.start)
        last, _ = module.source.position(part.end)
        for line in range(first, last + 1):
            statements_by_line.setdefault(line, {})[whole] = None
    return statements_by_line


def _statement_parts(module: Module) -> Iterator[tuple[Span, Span]]:
    """Yield pairs of spans: a statement, and a part of the statement.

    A statement is a clause or a declaration. A comment beside any part applies to the statement.

    A spec in braces has two parts, its head and its closing brace; its clauses are statements of their
    own. ``entity a, b`` is two statements: ``entity a`` and ``b``. Any other statement is its only
    part.
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


def _code_matches(comment: Comment) -> Iterator[re.Match[str]]:
    head = _COMMENT.match(comment.text)
    place = head.end() if head else len(comment.text)
    while match := _CODES.match(comment.text, place):
        yield match
        place = match.end()
