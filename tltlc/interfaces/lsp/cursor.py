"""Find out which terminal symbols the grammar allows at the cursor of an incomplete text."""

from __future__ import annotations

import string
from collections.abc import Sequence
from typing import Final

from tltlc.core.record import record
from tltlc.core.source import SourceFile, Span
from tltlc.grammar import lalr
from tltlc.grammar.keywords import CLAUSES, TEST_ITEMS
from tltlc.grammar.lexer import BAD, END, Token, tokenize
from tltlc.grammar.mistakes.fragments import block_kind, declarations, lines
from tltlc.grammar.tables import load

_BEGINS_WORD: Final = frozenset(f"{string.ascii_letters}_")
_IN_WORD: Final = _BEGINS_WORD.union(string.digits, ".")
_LINES: Final = {"spec": (CLAUSES, "clause"), "test": (TEST_ITEMS, "test_item")}


@record
class Cursor:
    """The cursor in a text, and what may be written there.

    ``word`` is the span of the unfinished word that ends at the cursor. ``piece`` contains the
    tokens before that word, from the start of the declaration, clause or test line. ``start`` is
    the grammar symbol of that part: ``declaration``, ``clause`` or ``test_item``. ``around`` contains
    the tokens of the enclosing block up to the word; it is empty outside blocks. ``allowed`` are
    the terminal symbols that may follow ``piece``; None if ``piece`` contains a syntax error.
    """

    word: Span
    start: str
    piece: tuple[Token, ...]
    around: tuple[Token, ...]
    allowed: frozenset[str] | None

    @property
    def last(self) -> str:
        """The type of the last token in ``piece``, just before the unfinished word; empty without tokens."""
        return self.piece[-1].type if self.piece else ""

    @property
    def first(self) -> str:
        """The text of the first token in ``piece``, often a keyword; empty without tokens."""
        return self.piece[0].text if self.piece else ""


def cursor(source: SourceFile, offset: int) -> Cursor | None:
    """Return the cursor at a character offset; None inside a comment or a quoted text."""
    before = source.text[:offset]
    start = _word_start(before)
    lexed = tokenize(before[:start])
    tokens = lexed.tokens[:-1]
    if lexed.comments and "\n" not in before[lexed.comments[-1].span.start :]:
        return None
    if tokens and tokens[-1].type == BAD and tokens[-1].text.startswith('"'):
        return None
    return _cursor_after(source.with_text(before[:start]), tokens, Span(start, offset))


def _word_start(text: str) -> int:
    """Return the offset at which the last word of a text starts.

    If the text does not end with a word, return the length of the text.
    """
    start = end = len(text)
    while start and text[start - 1] in _IN_WORD:
        start -= 1
    while start < end and text[start] not in _BEGINS_WORD:
        start += 1
    return start


def quoted_text(source: SourceFile, offset: int) -> tuple[str, Span] | None:
    """Return the word before the quoted text at ``offset``, and the span of this text up to ``offset``.

    For ``import "lib`` with ``offset`` at its end, the word is ``import``, and the span covers
    ``lib``. The word is empty if nothing precedes the quotation mark. Return None if ``offset`` is
    not in a quoted text.
    """
    tokens = tokenize(source.text[:offset]).tokens[:-1]
    if not tokens or tokens[-1].type != BAD or not tokens[-1].text.startswith('"'):
        return None
    return (tokens[-2].text if len(tokens) > 1 else ""), Span(tokens[-1].start + 1, offset)


def _cursor_after(source: SourceFile, tokens: Sequence[Token], word: Span) -> Cursor:
    pieces = list(declarations(source, tokens))
    piece = pieces[-1] if pieces else []
    kind = block_kind(piece) if piece else None
    if kind and piece[-1].type != "RBRACE":
        brace = next(index for index, token in enumerate(piece) if token.type == "LBRACE")
        keywords, start = _LINES[kind]
        body = list(lines(source, piece[brace + 1 :], keywords))
        line = body[-1] if body else []
        allowed = _accepted_terminals(start, line)
        if allowed is not None and (not line or END in allowed):
            allowed = allowed | (_accepted_terminals(start, []) or set()) | {"RBRACE"}
        return Cursor(word, start, tuple(line), tuple(piece), _frozen(allowed))
    allowed = _accepted_terminals("declaration", piece)
    if allowed is not None and END in allowed:
        allowed = allowed | (_accepted_terminals("declaration", []) or set())
    return Cursor(word, "declaration", tuple(piece), (), _frozen(allowed))


def _frozen(allowed: set[str] | None) -> frozenset[str] | None:
    return None if allowed is None else frozenset(allowed)


def _accepted_terminals(start: str, tokens: Sequence[Token]) -> set[str] | None:
    """Parse ``tokens`` as the grammar symbol ``start``, and return the terminal symbols that may follow.

    Return None if the tokens contain a syntax error.
    """
    end = tokens[-1].end if tokens else 0
    try:
        lalr.run(load(), start, [*tokens, Token(BAD, "", end, end), Token(END, "", end, end)], object())
    except lalr.UnexpectedTokenError as error:
        return lalr.allowed_terminals(load(), error.states) if error.index == len(tokens) else None
    return None
