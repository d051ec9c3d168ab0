"""Read a text with errors piece by piece: one error for each broken declaration, clause or line of a test.

A piece begins at a keyword.  A keyword at the start of a line always begins one; within a line only
behind something that can end a piece, so that ``reach level`` is one clause with a reserved word.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Any, Final

from tltlc.diagnostics.diagnostic import Diagnostic
from tltlc.grammar import checks, lalr, messages, nesting, tree
from tltlc.grammar.builder import Builder
from tltlc.grammar.lexer import BAD, END, Token, Tokens
from tltlc.grammar.tables import load
from tltlc.grammar.words import CLAUSES, DECLARATIONS, TEST_ITEMS, closest
from tltlc.record import replace
from tltlc.source import SourceFile

MAX_ERRORS: Final = 200
"""How many errors are enough: a text with more is no specification."""

_ENDS: Final = {"NAME", "NUMBER", "UNIT", "STRING", "TRUE", "FALSE", "RPAR", "RSQB", "RBRACE", "LBRACE", "LIMIT"}
_STARTS: Final = {
    "NAME",
    "NUMBER",
    "STRING",
    "TRUE",
    "FALSE",
    "NOT",
    "EVENTUALLY",
    "ALWAYS",
    "NEXT",
    "WEAK_NEXT",
    "ALL",
    "ANY",
}


def recover(source: SourceFile, lexed: Tokens) -> tuple[tuple[tree.Declaration, ...], tuple[Diagnostic, ...]]:
    """What can be read of a text, and an error for each piece that cannot."""
    reader = _Reader(source, lexed)
    for piece in _declarations(source, lexed.tokens[:-1]):
        reader.read_declaration(piece)
        if len(reader.diagnostics) >= MAX_ERRORS:
            break
    return tuple(reader.declarations), tuple(reader.diagnostics)


class _Reader:
    """Reads pieces one after the other and keeps what comes out."""

    def __init__(self, source: SourceFile, lexed: Tokens) -> None:
        self.declarations: list[tree.Declaration] = []
        self.diagnostics: list[Diagnostic] = []
        self._source = source
        self._docs = lexed.docs

    def read_declaration(self, piece: list[Token]) -> None:
        """Read the tokens of one declaration; a broken block still gives its good clauses."""
        before = len(self.diagnostics)
        if not _is_block(piece) and self._refuse_deep(piece):
            return
        declaration = self._read_block(piece) if _is_block(piece) else self._read("declaration", piece)
        if declaration is None:
            return
        kept, found = nesting.drop_deep(self._source, [declaration])
        self.diagnostics += found
        self.declarations += kept
        if len(self.diagnostics) == before:
            self.diagnostics += checks.check(self._source, kept)
        else:
            self.diagnostics += checks.check_clauses(self._source, kept)

    def _read_block(self, piece: list[Token]) -> tree.Declaration | None:
        """A spec or a test in braces: its head, then each line of its body for itself."""
        brace = next(index for index, token in enumerate(piece) if token.type == "LBRACE")
        closed = piece[-1].type == "RBRACE"
        closing = Token("RBRACE", "}", piece[-1].end, piece[-1].end)
        if not closed:
            self.diagnostics.append(messages.never_closed(self._source, piece[brace]))
        head = self._read("declaration", [*piece[: brace + 1], closing])
        keywords, start = (CLAUSES, "clause") if piece[0].type == "SPEC" else (TEST_ITEMS, "test_item")
        items: list[Any] = []
        for line in _split(self._source, piece[brace + 1 : len(piece) - closed], keywords):
            items += self._read_line(line, start)
            if len(self.diagnostics) >= MAX_ERRORS:
                break
        span = piece[0].span.to(piece[-1].span)
        if isinstance(head, tree.SpecDecl):
            return replace(head, clauses=tuple(items), span=span)
        if isinstance(head, tree.TestDecl):
            return replace(head, items=tuple(items), span=span)
        return None

    def _read_line(self, line: list[Token], start: str) -> list[Any]:
        """The clauses in one piece of a block: mostly one, two where an unknown word follows a whole clause."""
        if self._refuse_deep(line):
            return []
        error = self._attempt(start, line)
        if not isinstance(error, lalr.UnexpectedTokenError):
            return [error]
        at = error.index
        whole = 0 < at < len(line) and END in lalr.accepted(load(), error.states)
        if whole and line[at].type == "NAME" and _first_on_line(self._source, line, at):
            good = self._attempt(start, line[:at])
            self._refuse(line[at:], start, None)
            return [good]
        self._refuse(line, start, error)
        return []

    def _read(self, start: str, piece: list[Token]) -> Any:
        """What the builder makes of a piece, or None after an error."""
        result = self._attempt(start, piece)
        if isinstance(result, lalr.UnexpectedTokenError):
            self._refuse(piece, start, result)
            return None
        return result

    def _attempt(self, start: str, piece: list[Token]) -> Any:
        """What the builder makes of a piece, or the UnexpectedTokenError that it ends with."""
        builder = Builder(self._source, self._docs)
        try:
            node = lalr.run(load(), start, _ended(piece), builder)
        except lalr.UnexpectedTokenError as error:
            return error
        self.diagnostics += builder.diagnostics
        return node

    def _refuse(self, piece: list[Token], start: str, error: lalr.UnexpectedTokenError | None) -> None:
        """Report a broken piece; without an error, its first token is what nobody expected."""
        if error is None:
            error = lalr.UnexpectedTokenError(0, [load().starts[start]])
        self.diagnostics.append(messages.unexpected(self._source, _ended(piece), error, start))

    def _refuse_deep(self, piece: list[Token]) -> bool:
        """Report a piece whose brackets nest too deep; whether it is one."""
        deep = nesting.deep_brackets(self._source, piece)
        if deep:
            self.diagnostics.append(deep)
        return deep is not None


def _ended(piece: list[Token]) -> list[Token]:
    end = piece[-1].end
    return [*piece, Token(END, "", end, end)]


def _is_block(piece: list[Token]) -> bool:
    """Whether a piece is a spec or test in braces: ``spec NAME = …`` is none, braces or not."""
    head = next((token.type for token in piece if token.type in ("LBRACE", "EQUAL")), None)
    return piece[0].type in ("SPEC", "TEST") and head == "LBRACE"


def _declarations(source: SourceFile, tokens: Sequence[Token]) -> Iterator[list[Token]]:
    """The tokens cut into declarations: at their keywords, and behind the brace that closes a block."""
    piece: list[Token] = []
    depth = 0
    for index, token in enumerate(tokens):
        if piece and _begins(source, tokens, index, DECLARATIONS, depth == 0):
            yield piece
            piece, depth = [], 0
        piece.append(token)
        if token.type == "LBRACE":
            depth += 1
        elif token.type == "RBRACE" and depth > 0:
            depth -= 1
            if depth == 0:
                yield piece
                piece = []
    if piece:
        yield piece


def _split(source: SourceFile, tokens: Sequence[Token], keywords: dict[str, str]) -> Iterator[list[Token]]:
    """The body of a block cut into its lines."""
    piece: list[Token] = []
    for index, token in enumerate(tokens):
        if piece and _begins(source, tokens, index, keywords, True):
            yield piece
            piece = []
        piece.append(token)
    if piece:
        yield piece


def _begins(
    source: SourceFile, tokens: Sequence[Token], index: int, keywords: dict[str, str], within_lines: bool
) -> bool:
    """Whether a piece begins at this token, which is not the first."""
    token, before = tokens[index], tokens[index - 1]
    first = _first_on_line(source, tokens, index)
    if token.text in keywords and (token.type != "NAME" or keywords is TEST_ITEMS):
        if token.type == "ENTITY" and before.type == "COLON":
            return False
        if token.type == "LIMIT" and before.text == "at" and not (first and tokens[index - 2].type != "JUDGE"):
            return False
        return first or (within_lines and before.type in _ENDS)
    # A word that is no keyword, at the start of a line and with another word behind it: a misspelt keyword.
    if not first or not within_lines or token.type not in ("NAME", BAD) or not token.text[0].isalpha():
        return False
    if index + 1 == len(tokens):
        return False
    following = tokens[index + 1]
    if following.type not in _STARTS or following.text in load().soft or _first_on_line(source, tokens, index + 1):
        return False
    return before.type in _ENDS or closest(token.text, tuple(keywords)) is not None


def _first_on_line(source: SourceFile, tokens: Sequence[Token], index: int) -> bool:
    return index == 0 or "\n" in source.text[tokens[index - 1].end : tokens[index].start]
