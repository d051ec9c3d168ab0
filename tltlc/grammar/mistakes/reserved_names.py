"""Read words of the language that a file declares as names, so that only their declarations have errors."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Final

from tltlc.core.source import SourceFile
from tltlc.diagnostics.diagnostic import Diagnostic, Edit, Fix, Label
from tltlc.grammar.keywords import CLAUSES, DECLARATIONS, TEST_ITEMS
from tltlc.grammar.lexer import Token
from tltlc.grammar.mistakes.fragments import is_first_on_line

_WORDS: Final = frozenset((*CLAUSES, *DECLARATIONS, *TEST_ITEMS))
"""The words that begin a clause, a declaration or a line of a test; behind such a beginning, they may be names."""
_BETWEEN: Final = ("release", "strong_release")
"""The operators that may be names where they do not stand between two formulas."""
_ENDS: Final = ("NAME", "RPAR", "NUMBER", "UNIT", "TRUE", "FALSE")
_STARTS: Final = ("NAME", "LPAR", "NOT", "TRUE", "FALSE", "ONCE", "PREVIOUSLY", "BEGINS", "ENDS")
_DECLARING: Final = ("SIGNAL", "PREDICATE", "PARAM", "ENTITY", "LET")
_BEHIND: Final = ("COLON", "IN", "LPAR", "COMMA", "EQUAL")
_AROUND: Final = ("LPAR", "COMMA", "RPAR")


class ReservedNames:
    """The reserved words that the tokens of a text declare as names of signals or other things, or of values."""

    def __init__(self, source: SourceFile, tokens: Sequence[Token]) -> None:
        self._source = source
        self._first = {token.text: token for token in reversed([*_declared(tokens)])}
        self.tokens = [self._as_name(index, token, tokens) for index, token in enumerate(tokens)]
        """The tokens of the text, in which these words are names."""

    def _as_name(self, index: int, token: Token, tokens: Sequence[Token]) -> Token:
        first = self._first.get(token.text)
        if first is None or (token is not first and self._is_word(index, tokens)):
            return token
        return Token("NAME", token.text, token.start, token.end)

    def _is_word(self, index: int, tokens: Sequence[Token]) -> bool:
        """Whether a word begins a clause, or stands between two formulas."""
        before, after = tokens[index - 1], tokens[index + 1]
        if tokens[index].text in _BETWEEN:
            return before.type in _ENDS and after.type in _STARTS
        return is_first_on_line(self._source, tokens, index) or before.type == "LBRACE"

    def errors(self) -> Iterator[Diagnostic]:
        """Yield an error for each of these words, at its declaration, with a fix that renames it in the whole text."""
        taken = {token.text for token in self.tokens}
        for word, token in self._first.items():
            new = f"{word}_"
            while new in taken:
                new += "_"
            edits = tuple(Edit(use.span, new) for use in self.tokens if use.text == word and use.type == "NAME")
            title, help_ = f"`{word}` is a reserved word, not a name", f"choose another name, for example `{new}`"
            fix = Fix(f"Rename `{word}` to `{new}` in this file", edits)
            yield Diagnostic("TLT0106", title, (Label(self._source, token.span),), help_, fixes=(fix,))


def _declared(tokens: Sequence[Token]) -> Iterator[Token]:
    """Yield the reserved words that are declared: `level` in `signal level: bool` and in `(home, level)`."""
    is_values = False
    for before, token, after in zip(tokens, tokens[1:], tokens[2:], strict=False):
        if token.type == "LPAR":
            is_values = before.type == "COLON"
        elif token.type == "RPAR":
            is_values = False
        elif token.text in (*_WORDS, *_BETWEEN) and token.type != "NAME":
            is_name = before.type in _DECLARING and after.type in _BEHIND
            if is_name or (is_values and before.type in _AROUND and after.type in _AROUND):
                yield token
