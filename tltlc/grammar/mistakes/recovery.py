"""Parse a text with errors piece by piece, and report one error for each broken piece.

A piece is a declaration, a clause of a spec, or a line of a test.
"""

from __future__ import annotations

from typing import Any, Final

from tltlc.core.record import replace
from tltlc.core.source import SourceFile
from tltlc.diagnostics.diagnostic import Diagnostic
from tltlc.grammar import lalr, nesting, tree, tree_checks
from tltlc.grammar.builder import Builder
from tltlc.grammar.keywords import CLAUSES, TEST_ITEMS
from tltlc.grammar.lexer import END, Token, Tokens
from tltlc.grammar.mistakes import messages
from tltlc.grammar.mistakes.declaration_forms.enums import NamedEnums, enum_error
from tltlc.grammar.mistakes.declaration_forms.heads import SpecHead, read_head
from tltlc.grammar.mistakes.declaration_forms.meant import MeantDeclaration
from tltlc.grammar.mistakes.declaration_forms.reading import (
    declaration_error,
    head_error,
    meant_declaration,
    tokens_as_meant,
)
from tltlc.grammar.mistakes.fragments import block_kind, declarations, is_first_on_line, lines
from tltlc.grammar.mistakes.reserved_names import ReservedNames
from tltlc.grammar.tables import load

_FIRST: Final = ("NAME", "LPAR", "ONCE", "HISTORICALLY", "PREVIOUSLY", "BEGINS", "ENDS", "UNTIL")
"""The tokens with which a formula without its keyword begins, and which continue no clause of the line before."""
_MOST_SENTENCES: Final = 20
"""The most errors of a text of which the clause is read as a sentence, so that a bad text is checked in time."""
MAX_ERRORS: Final = 200
"""After this many errors, the rest of the text is not read, because it is hardly a specification."""


def recover(source: SourceFile, lexed: Tokens) -> tuple[tuple[tree.Declaration, ...], tuple[Diagnostic, ...]]:
    """Return the declarations that can be read, and an error for each piece of the text that cannot be read."""
    reserved = ReservedNames(source, lexed.tokens)
    pieces = list(declarations(source, reserved.tokens[:-1]))
    reader = _Reader(source, lexed, NamedEnums(pieces, reserved.tokens))
    reader.diagnostics += reserved.errors()
    for piece in pieces:
        reader.read_declaration(reader.enums.with_short_values(piece))
        if len(reader.diagnostics) >= MAX_ERRORS:
            break
    return tuple(reader.declarations), tuple(reader.diagnostics)


class _Reader:
    """Parses the pieces of a text one by one, and collects their declarations and diagnostics."""

    def __init__(self, source: SourceFile, lexed: Tokens, enums: NamedEnums) -> None:
        self.declarations: list[tree.Declaration] = []
        self.diagnostics: list[Diagnostic] = []
        self._source = source
        self._docs = lexed.docs
        self.enums = enums

    def read_declaration(self, piece: list[Token]) -> None:
        """Parse the tokens of one declaration, and add the declaration and its errors to the results.

        If only some clauses of a spec, or lines of a test, are broken, keep the others.
        """
        if self._read_enum(piece):
            return
        before = len(self.diagnostics)
        head = read_head(piece)
        if head:
            self.diagnostics.append(head_error(self._source, piece, head))
            piece = _with_head(piece, head)
        kind = block_kind(piece)
        declarations: list[tree.Declaration | None] = []
        if kind:
            declarations = [self._read_block(piece, kind)]
        else:
            declarations += () if self._refuse_deep(piece) else self._read_one(piece, is_refused=head is not None)
        kept, errors = nesting.drop_deep_declarations(self._source, [item for item in declarations if item is not None])
        self.diagnostics += errors
        self.declarations += kept
        if len(self.diagnostics) == before:
            self.diagnostics += tree_checks.check(self._source, kept)
        else:
            self.diagnostics += tree_checks.check_clauses(self._source, kept)

    def _read_one(self, piece: list[Token], *, is_refused: bool) -> list[tree.Declaration]:
        """Parse the tokens of a declaration without braces.

        A declaration in the form of another language is reported, and read as what it is meant to be. If
        ``is_refused``, the beginning of the piece has an error already, so another one is not reported.
        """
        result = self._attempt("declaration", piece)
        if not isinstance(result, lalr.UnexpectedTokenError):
            return [result]
        meant = meant_declaration(piece, self.enums.text)
        if meant is None:
            if not is_refused:
                self._refuse(piece, "declaration", result)
            return []
        self.diagnostics.append(declaration_error(self._source, piece, meant))
        return self._as_meant(piece, meant)

    def _as_meant(self, piece: list[Token], meant: MeantDeclaration) -> list[tree.Declaration]:
        """Return the declarations with which the rest of the text is checked in place of a piece."""
        read = (self._attempt("declaration", tokens) for tokens in tokens_as_meant(piece, meant.read_as))
        return [item for item in read if not isinstance(item, lalr.UnexpectedTokenError)]

    def _read_enum(self, piece: list[Token]) -> bool:
        """Read an enum with a name, or signals of one; return whether the piece is such a one.

        The enums and their signals get one error together, at the first enum.
        """
        enums = self.enums.starting_at(piece)
        if enums:
            self.diagnostics.append(enum_error(self._source, enums, self.enums.short_values(enums)))
        signals = self.enums.signals_of(piece)
        if signals:
            self.declarations += self._as_meant(piece, signals)
        return signals is not None or self.enums.declares(piece)

    def _read_block(self, piece: list[Token], kind: str) -> tree.Declaration | None:
        """Parse a spec or a test in braces: its head, then each line of its body separately.

        Return None if the head is broken.
        """
        brace = next(index for index, token in enumerate(piece) if token.type == "LBRACE")
        closed = piece[-1].type == "RBRACE"
        closing = Token("RBRACE", "}", piece[-1].end, piece[-1].end)
        if not closed:
            self.diagnostics.append(messages.unclosed_bracket(self._source, piece[brace]))
        head = self._read("declaration", [*piece[: brace + 1], closing])
        keywords, start = (CLAUSES, "clause") if kind == "spec" else (TEST_ITEMS, "test_item")
        items: list[Any] = []
        for line in lines(self._source, piece[brace + 1 : len(piece) - closed], keywords):
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
        """Parse one clause of a spec or line of a test; return it in a list, which is empty if it is broken.

        Errors are added to ``diagnostics``. If a word that begins no clause begins a new line after a
        complete clause, return the clause and report the word.
        """
        if self._refuse_deep(line):
            return []
        result = self._attempt(start, line)
        if not isinstance(result, lalr.UnexpectedTokenError):
            return [result]
        at = result.index
        is_whole = 0 < at < len(line) and END in lalr.allowed_terminals(load(), result.states)
        if is_whole and line[at].type in _FIRST and is_first_on_line(self._source, line, at):
            whole = self._attempt(start, line[:at])
            # The first token of the remainder is the unexpected one.
            self._refuse(line[at:], start, lalr.UnexpectedTokenError(0, [load().starts[start]]))
            return [whole]
        self._refuse(line, start, result)
        return []

    def _read(self, start: str, piece: list[Token]) -> Any:
        """Parse a piece as the nonterminal ``start``, and return its syntax tree.

        If the piece is broken, add the error to ``diagnostics`` and return None.
        """
        result = self._attempt(start, piece)
        if isinstance(result, lalr.UnexpectedTokenError):
            self._refuse(piece, start, result)
            return None
        return result

    def _attempt(self, start: str, piece: list[Token]) -> Any:
        """Parse a piece as the nonterminal ``start``; return its syntax tree, or the error that stopped the parser."""
        builder = Builder(self._source, self._docs)
        try:
            node = lalr.run(load(), start, _with_end(piece), builder)
        except lalr.UnexpectedTokenError as error:
            return error
        self.diagnostics += builder.diagnostics
        return node

    def _refuse(self, piece: list[Token], start: str, error: lalr.UnexpectedTokenError) -> None:
        """Add the error for a piece that cannot be parsed to ``diagnostics``."""
        few = len(self.diagnostics) < _MOST_SENTENCES
        self.diagnostics.append(
            messages.unexpected_token(self._source, _with_end(piece), error, start, reads_sentences=few)
        )

    def _refuse_deep(self, piece: list[Token]) -> bool:
        """Return whether the brackets of a piece nest too deep; if so, add an error to ``diagnostics``."""
        deep = nesting.bracket_depth_error(self._source, piece)
        if deep:
            self.diagnostics.append(deep)
        return deep is not None


def _with_head(piece: list[Token], head: SpecHead) -> list[Token]:
    """Return the tokens of a spec that begins as it should."""
    first, last = piece[0], piece[head.length - 1]
    name = next((token for token in piece[1 : head.length] if token.type in ("NAME", "STRING")), first)
    sign = ("LBRACE", "{") if head.text.endswith("{") else ("EQUAL", "=")
    tokens = [
        Token("SPEC", "spec", first.start, first.end),
        Token("NAME", head.name, name.start, name.end),
        Token(*sign, last.start, last.end),
        *piece[head.length :],
    ]
    return [*tokens, Token("RBRACE", "}", piece[-1].end, piece[-1].end)] if head.closes else tokens


def _with_end(piece: list[Token]) -> list[Token]:
    end = piece[-1].end
    return [*piece, Token(END, "", end, end)]
