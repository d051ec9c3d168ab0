"""A Pygments lexer for the language, for documentation: ``pygmentize -l tltl FILE``.

It uses the tokens of :mod:`tltlc.grammar.lexer`, and maps each terminal of the grammar to a token
type of Pygments.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import pairwise
from typing import Any, ClassVar, Final, TypeAlias

from pygments import token as pygments
from pygments.lexer import Lexer

from tltlc.grammar.lexer import Token, tokenize
from tltlc.grammar.tables import load

__all__ = ["TltlLexer"]

Class: TypeAlias = Any
"""A token type of Pygments. It is ``Any`` because Pygments has no type annotations."""

_DECLARATIONS: Final = "IMPORT SIGNAL ENTITY PARAM CLOCK PREDICATE LET EXCLUSIVE SPEC TEST".split()
_CLAUSES: Final = "REACH KEEP AVOID REQUIRE LEVEL LIMIT JUDGE SEMANTICS TAG".split()
_SMALL: Final = "AS IN IS AT FOR OF WITHIN AFTER STEP EXPECT TIMES VARIES ALL ANY WHEN OTHERWISE".split()
_LOGIC: Final = "NOT AND OR IMPLIES IFF THEN EVENTUALLY ALWAYS NEXT WEAK_NEXT".split()
_PAST: Final = "ONCE HISTORICALLY PREVIOUSLY BEGINS ENDS SINCE".split()
_UNTIL: Final = "UNTIL WEAK_UNTIL RELEASE STRONG_RELEASE".split()
_ARITHMETIC: Final = "LESS AT_MOST MORE AT_LEAST EQUALS UNEQUAL PLUS MINUS TIMES_SIGN DIVIDE POWER".split()
_BRACKETS: Final = "LPAR RPAR LBRACE RBRACE LSQB RSQB COLON COMMA EQUAL".split()

CLASSES: Final[dict[str, Class]] = {
    **dict.fromkeys(_DECLARATIONS, pygments.Keyword.Declaration),
    **dict.fromkeys([*_CLAUSES, *_SMALL], pygments.Keyword),
    **dict.fromkeys([*_LOGIC, *_PAST, *_UNTIL, *_ARITHMETIC], pygments.Operator),
    **dict.fromkeys(_BRACKETS, pygments.Punctuation),
    "TRUE": pygments.Keyword.Constant,
    "FALSE": pygments.Keyword.Constant,
    "NAME": pygments.Name,
    "NUMBER": pygments.Number,
    "UNIT": pygments.Keyword.Type,
    "STRING": pygments.String,
    "COMMENT": pygments.Comment.Single,
    "BAD": pygments.Error,
}
"""The Pygments type of each terminal. ``_pygments_type`` refines it for operators and names."""

_HEADS: Final = frozenset({"SIGNAL", "PARAM", "PREDICATE", "LET"})
"""Declarations whose head may have a colon before a type."""
_CHOOSING: Final = frozenset({"EXPECT", "SEMANTICS", "AT"})
"""Keywords after which a name is one of a fixed set: a verdict, `infinite`, `goal`."""

# An unreserved word is a keyword after the terminals of the first table, and before those of the second.
_KEYWORD_AFTER: Final = {
    "AT": {"JUDGE"},
    "FOR": {"STRING"},
    "TIMES": {"NUMBER"},
    "VARIES": {"CLOCK"},
    "AS": {"NAME", "STRING"},
    "OF": {"UNIT"},
    "SINCE": {"NAME", "RPAR", "NUMBER", "UNIT", "TRUE", "FALSE"},
    "IS": {"NAME", "RPAR"},
}
_KEYWORD_BEFORE: Final = {"FOR": {"NUMBER"}, "WITHIN": {"NUMBER"}, "AFTER": {"NUMBER"}, "IN": {"LPAR", "LSQB"}}


class TltlLexer(Lexer):  # type: ignore[misc]
    """A Pygments lexer for specs in truncated linear temporal logic."""

    name = "TLTL"
    aliases: ClassVar = ["tltl"]
    filenames: ClassVar = ["*.tltl"]
    mimetypes: ClassVar = ["text/x-tltl"]

    def get_tokens_unprocessed(self, text: str) -> Iterator[tuple[int, Class, str]]:
        """Yield the offset, type and text of each piece of the source text, without gaps."""
        lexed = tokenize(text)
        pieces = [*_classify(lexed.tokens)]
        for comment in lexed.comments:
            kind = pygments.String.Doc if comment.text.startswith("///") else CLASSES["COMMENT"]
            pieces.append((comment.span.start, kind, comment.text))
        end = 0
        for start, kind, piece in sorted(pieces):
            if start > end:
                yield end, pygments.Whitespace, text[end:start]
            yield start, kind, piece
            end = start + len(piece)
        # The lexer stops at its limit of tokens; the rest of the text has no colours.
        if end < len(text):
            yield end, pygments.Text, text[end:]


def _classify(tokens: Sequence[Token]) -> Iterator[tuple[int, Class, str]]:
    """Yield the tokens with their Pygments types, which depend on the tokens around them."""
    soft = load().soft
    declaration, depth, in_head = "", 0, False
    before = ""
    for token, following in pairwise(tokens):
        kind = token.type
        if kind == "NAME" and _is_keyword(keyword := soft.get(token.text, ""), before, following.type, declaration):
            kind = keyword
        if kind in _DECLARATIONS and before != "COLON":
            declaration, depth, in_head = kind, 0, kind in _HEADS
        depth += (kind in ("LPAR", "LSQB")) - (kind in ("RPAR", "RSQB"))
        in_head &= not (kind == "EQUAL" and depth == 0)
        is_type = before == "COLON" and in_head and kind in ("NAME", "ENTITY")
        yield (
            token.start,
            pygments.Keyword.Type if is_type else _pygments_type(token.text, kind, before, following),
            token.text,
        )
        before = kind


def _is_keyword(soft: str, before: str, after: str, declaration: str) -> bool:
    if soft in ("STEP", "EXPECT"):
        return declaration == "TEST"
    return before in _KEYWORD_AFTER.get(soft, ()) or after in _KEYWORD_BEFORE.get(soft, ())


def _pygments_type(text: str, kind: str, before: str, following: Token) -> Class:
    type_ = CLASSES[kind]
    if type_ is pygments.Operator and text.isascii() and text[0].isalpha():
        return pygments.Operator.Word
    if kind != "NAME":
        return type_
    if before in _CHOOSING:
        return pygments.Name.Constant
    if before == "SPEC":
        return pygments.Name.Class
    return pygments.Name.Function if before in _HEADS or following.type == "LPAR" else type_
