"""Explain an operator that the grammar accepts, but not between these operands.

``==`` compares integers, ``is`` compares an enum with the name of a value, and ``until`` stands before a
formula, not a time. Other operands get the errors that the rules of
:mod:`tltlc.grammar.mistakes.messages` give for signs and words of other languages, as if the grammar
did not have the operator.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

from tltlc.core.source import SourceFile, Span
from tltlc.diagnostics.diagnostic import Diagnostic
from tltlc.grammar import lalr
from tltlc.grammar.keywords import CLAUSES, DECLARATIONS, TEST_ITEMS
from tltlc.grammar.lexer import END, Token, tokenize
from tltlc.grammar.mistakes.declared_names import declared_names
from tltlc.grammar.mistakes.fragments import block_kind, declarations, lines
from tltlc.grammar.mistakes.rephrasing import operand_start
from tltlc.grammar.tables import load

EQUALITIES: Final = ("EQUALS", "UNEQUAL")


def misused_operator(source: SourceFile, operator: Span) -> Diagnostic:
    """Return the error for an operator whose operands have other types.

    ``operator`` is the span of an ``==``, ``!=`` or ``is``, or of the time after an ``until``.
    """
    from tltlc.grammar.mistakes.messages import unexpected_token

    start, piece = _piece(source, operator.start)
    index = next(index for index, token in enumerate(piece) if token.start == operator.start)
    end = Token(END, "", piece[-1].end, piece[-1].end)
    return unexpected_token(source, [*piece, end], stop_at(piece, index, start), start)


def stop_at(tokens: Sequence[Token], index: int, start: str) -> lalr.UnexpectedTokenError:
    """Return the error of a parser that does not accept the token with this index."""
    return lalr.UnexpectedTokenError(index, lalr.stack_after(load(), start, tokens[:index]))


def misread_index(source: SourceFile, tokens: Sequence[Token], index: int, start: str) -> int:
    """Return where a text with a syntax error at ``index`` is wrong already.

    This is the index of an ``==`` directly before the error, or of an ``is`` before it with at most
    ``not`` and a name between them, as in ``health is at least 3``; otherwise ``index``. An ``is`` between an
    enum and one of its values is right.
    """
    if index and tokens[index - 1].type in EQUALITIES:
        return index - 1
    at = index - 1
    at -= at > 0 and tokens[at].type == "NAME" and tokens[at].text != "is"
    at -= at > 0 and tokens[at].type == "NOT"
    if at <= 0 or tokens[at].text != "is":
        return index
    first, value = operand_start(tokens, at), tokens[index - 1]
    known = None if first is None else declared_names(source).names.get(tokens[first].text)
    if known is not None and value.text in known.values:
        return index
    return at if "IS" in lalr.allowed_terminals(load(), stop_at(tokens, at, start).states) else index


def _piece(source: SourceFile, offset: int) -> tuple[str, list[Token]]:
    """Return the declaration, clause, line of a test or formula with a token at ``offset``, and its nonterminal."""
    tokens = tokenize(source.text).tokens[:-1]
    for piece in declarations(source, tokens):
        if not piece[0].start <= offset < piece[-1].end:
            continue
        kind = block_kind(piece)
        if kind:
            brace = next(index for index, token in enumerate(piece) if token.type == "LBRACE")
            keywords, start = (CLAUSES, "clause") if kind == "spec" else (TEST_ITEMS, "test_item")
            for line in lines(source, piece[brace + 1 : -1], keywords):
                if line[0].start <= offset < line[-1].end:
                    return start, line
        if piece[0].text in DECLARATIONS:
            return "declaration", piece
    return "expression", tokens
