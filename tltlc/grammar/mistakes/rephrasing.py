"""Suggest another text for tokens that cannot be parsed.

Only a text that can be parsed is suggested.
"""

from __future__ import annotations

from collections.abc import Collection, Iterable, Sequence
from typing import Any, Final

from tltlc.core.source import SourceFile, Span
from tltlc.diagnostics.diagnostic import Diagnostic
from tltlc.grammar import lalr, tree_checks
from tltlc.grammar.builder import Builder
from tltlc.grammar.keywords import OPERATORS
from tltlc.grammar.lexer import END, Token, tokenize
from tltlc.grammar.mistakes.parse_failure import CLOSING, INFIX, OPENING, ParseFailure, outer_indices
from tltlc.grammar.tables import load
from tltlc.grammar.tree import Clause

LOOSE: Final = INFIX | {"EVENTUALLY", "ALWAYS", "NEXT", "WEAK_NEXT", "ALL", "ANY", "WHEN"}
"""Operators that bind loosely: a text that contains one needs brackets to become an operand."""
_LONGEST: Final = 90
"""The most characters of a rewrite; longer texts do not help."""


def suggest_rewrite(
    failure: ParseFailure, start: int, stop: int, text: str, title: str, reason: str = "", code: str = "TLT0101"
) -> Diagnostic | None:
    """Return an error at the tokens from ``start`` up to ``stop`` that suggests to write ``text`` instead.

    Return None if the text is too long or needs a fixed clock that the file does not have, or if the piece
    cannot be parsed with it.
    """
    if len(text) > _LONGEST or failure.lacks_fixed_clock(text) or not _can_be_read(failure, start, stop, text):
        return None
    span = span_of(failure.tokens[start:stop])
    return failure.error(code, title, f"write `{text}`{reason}", span=span, write=text)


def span_of(tokens: Sequence[Token]) -> Span:
    """Return the span from the first to the last of the tokens."""
    return tokens[0].span.to(tokens[-1].span)


def text_of(failure: ParseFailure, start: int, stop: int) -> str:
    """Return the text of the tokens from ``start`` up to ``stop`` on one line, without comments."""
    tokens = failure.tokens[start:stop]
    # A comment would swallow the rest of the line.
    lines = failure.source.slice(span_of(tokens)).splitlines() if tokens else []
    return " ".join(" ".join(line.split("//")[0] for line in lines).split())


def operand_text(failure: ParseFailure, start: int, stop: int) -> str:
    """Return the text of the tokens from ``start`` up to ``stop``, written so that it can be an operand.

    A clause keyword at the start becomes the operator of the same meaning: ``keep a or b`` gives
    ``always (a or b)``. The rest gets brackets if it has one of the operators :data:`LOOSE` outside
    brackets.
    """
    operator = ""
    if start < stop and failure.tokens[start].text in OPERATORS:
        operator = OPERATORS[failure.tokens[start].text]
        start += 1
    text = text_of(failure, start, stop)
    outer = [failure.tokens[index] for index in outer_indices(failure.tokens, start, stop)]
    # The token of `since` is a name, because it is not reserved.
    is_compound = any(token.type in LOOSE or token.text == "since" for token in outer)
    return f"{operator} {f'({text})' if is_compound else text}".strip()


def formula_start(failure: ParseFailure) -> int:
    """Return the index of the first token of the formula in which parsing failed.

    The formula begins after an open bracket, the keyword of a clause, or `=`.
    """
    if failure.open_brackets:
        return next(index for index, token in enumerate(failure.tokens) if token is failure.open_brackets[-1]) + 1
    if failure.start == "declaration":
        return next((index + 1 for index, token in enumerate(failure.tokens) if token.type == "EQUAL"), 0)
    return 1 if failure.start == "clause" else 0


def formula_stop(failure: ParseFailure) -> int:
    """Return the index after the last token of the formula in which parsing failed."""
    depth = 0
    for index in range(failure.stop.index, len(failure.tokens)):
        depth += (failure.tokens[index].type in OPENING) - (failure.tokens[index].type in CLOSING)
        if depth < 0 or failure.tokens[index].type == END:
            return index
    return len(failure.tokens) - 1


def last_index_of(failure: ParseFailure, kinds: Collection[str], start: int) -> int | None:
    """Return the index of the last token of ``kinds`` between ``start`` and the place where parsing failed.

    Tokens in brackets do not count. Return None if there is no such token.
    """
    indices = [
        index
        for index in outer_indices(failure.tokens, start, failure.stop.index)
        if failure.tokens[index].type in kinds
    ]
    return indices[-1] if indices else None


def operand_end(tokens: Sequence[Token], start: int) -> int | None:
    """Return the index after the name or call that begins at an index, perhaps after `not`; None if there is none."""
    if start < len(tokens) and tokens[start].type == "NOT":
        start += 1
    if start >= len(tokens) or tokens[start].type != "NAME":
        return None
    if start + 1 >= len(tokens) or tokens[start + 1].type != "LPAR":
        return start + 1
    depth = 0
    for index in range(start + 1, len(tokens)):
        depth += (tokens[index].type in OPENING) - (tokens[index].type in CLOSING)
        if depth == 0:
            return index + 1
    return None


def operand_start(tokens: Sequence[Token], stop: int) -> int | None:
    """Return the index of the first token of the name or call that ends before an index; None if there is none."""
    index, depth = stop - 1, 0
    while (index >= 0 and tokens[index].type in CLOSING | set(OPENING)) or depth:
        depth += (tokens[index].type in CLOSING) - (tokens[index].type in OPENING)
        index -= 1
        if depth == 0:
            break
    return index if index >= 0 and tokens[index].type == "NAME" else None


def phrase_at(tokens: Sequence[Token], at: int, phrases: Iterable[tuple[str, ...]]) -> tuple[str, ...]:
    """Return the first of some phrases whose words stand at an index; empty if there is none."""
    return next(
        (words for words in phrases if tuple(token.text for token in tokens[at : at + len(words)]) == words), ()
    )


def without_brackets(failure: ParseFailure, begin: int, end: int) -> tuple[int, int]:
    """Return the range of the tokens without brackets around all of them."""
    while begin < end and failure.tokens[begin].type == "LPAR":
        depth = 0
        for index in range(begin, end):
            depth += (failure.tokens[index].type in OPENING) - (failure.tokens[index].type in CLOSING)
            if depth == 0:
                break
        if index + 1 < end:
            break
        begin, end = begin + 1, end - 1
    return begin, end


def _can_be_read(failure: ParseFailure, start: int, stop: int, text: str) -> bool:
    """Whether the piece has no error if ``text`` replaces the tokens from ``start`` up to ``stop``."""
    tokens = failure.tokens
    source_text = failure.source.text
    before, after = (
        source_text[tokens[0].start : tokens[start].start],
        source_text[tokens[stop - 1].end : tokens[-1].end],
    )
    source = SourceFile("", f"{before}{text}{after}", "text")
    lexed = tokenize(source.text)
    builder = Builder(source, lexed.docs)
    try:
        node: Any = lalr.run(load(), failure.start, lexed.tokens, builder)
    except lalr.UnexpectedTokenError:
        return False
    if isinstance(node, Clause):
        return not [*builder.diagnostics, *tree_checks.check_clause(source, node)]
    if failure.start == "declaration":
        return not [*builder.diagnostics, *tree_checks.check(source, (node,))]
    return not builder.diagnostics and (failure.start != "expression" or not [*tree_checks.check_formula(source, node)])
