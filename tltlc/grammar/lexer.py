"""Split a .tltl text into tokens, the terminals of the grammar."""

from __future__ import annotations

import re
from functools import lru_cache
from typing import Final, NamedTuple

from tltlc.core.source import Span
from tltlc.grammar.module import Comment
from tltlc.grammar.tables import ParserTables, load

MAX_TOKENS: Final = 1 << 17
"""The most tokens of a file, with ``$END``. The parser refuses larger files, so that its time is bounded."""

END: Final = "$END"
BAD: Final = "BAD"
"""The type of a token that the language does not know: an unknown character, an unterminated string."""


class Token(NamedTuple):
    """A word, number or sign of the text. ``type`` is its terminal in the grammar, such as ``NAME``.

    ``start`` and ``end`` are a half-open range of character offsets.
    """

    type: str
    text: str
    start: int
    end: int

    @property
    def span(self) -> Span:
        """The range of character offsets that the token covers."""
        return Span(self.start, self.end)


class Tokens(NamedTuple):
    """The tokens of a text, which end with a token of type ``$END``, and the comments of the text.

    ``docs`` maps the offset of a token to the documentation comment directly before it.
    """

    tokens: list[Token]
    comments: list[Comment]
    docs: dict[int, str]


def tokenize(text: str) -> Tokens:
    """Split a text into tokens; parts that the language does not know become tokens of type ``BAD``.

    Stops after :data:`MAX_TOKENS` tokens and then adds ``$END``. So a result with more than
    :data:`MAX_TOKENS` tokens means that the text is too long.
    """
    tables = load()
    words, signs = tables.words, tables.signs
    tokens: list[Token] = []
    comments: list[Comment] = []
    docs: dict[int, str] = {}
    doc: list[str] = []
    for match in _pattern().finditer(text):
        kind = match.lastgroup or BAD
        if kind == "SPACE":
            continue
        if len(tokens) >= MAX_TOKENS:
            break
        start, end = match.span()
        piece = match.group()
        if kind == "COMMENT":
            comments.append(Comment(piece.rstrip(), Span(start, start + len(piece.rstrip()))))
            if piece.startswith("///"):
                doc.append(piece[3:].strip())
            continue
        if doc:
            docs[start] = "\n".join(doc)
            doc = []
        if kind == "NAME":
            tokens.append(Token(words.get(piece, kind), piece, start, end))
        elif kind == "SIGN":
            tokens.append(Token(signs[piece], piece, start, end))
        elif kind == "UNIT":
            number_end, unit_start = match.end("NUMBER"), match.start("UNIT")
            tokens.append(Token("NUMBER", match["NUMBER"], start, number_end))
            tokens.append(Token("UNIT", match["UNIT"], unit_start, end))
        else:
            tokens.append(Token(kind, piece, start, end))
    tokens.append(Token(END, "", len(text), len(text)))
    return Tokens(tokens, comments, docs)


@lru_cache(maxsize=1)
def _pattern() -> re.Pattern[str]:
    """Return one regular expression for all tokens.

    The last group that matched has the name of the token's type, ``SIGN`` for a sign. A character that
    matches no group is ``BAD``.
    """
    tables: ParserTables = load()
    patterns = tables.patterns
    signs = "|".join(re.escape(sign) for sign in sorted(tables.signs, key=len, reverse=True))
    # Signs that Unicode counts as letters (𝒰) end a name. Any other letter beyond ASCII makes the whole word bad.
    letters = "".join(sign for sign in tables.signs if sign.isalnum())
    units = "|".join(re.escape(unit) + ("" if unit == "%" else r"(?![\w]|\.[A-Za-z_])") for unit in tables.units)
    return re.compile(
        rf"(?P<SPACE>{patterns['SPACE']}|\A\ufeff)"
        rf"|(?P<NAME>{patterns['NAME']}(?![^\W{letters}]))"
        rf"|(?P<NUMBER>{patterns['NUMBER']})(?:\s*(?P<UNIT>{units}))?"
        rf"|(?P<COMMENT>{patterns['COMMENT']})"
        rf"|(?P<STRING>{patterns['STRING']})"
        rf"|(?P<BAD>/\*.*?(?:\*/|\Z)|\"[^\"\n]*|[^\W0-9{letters}]\w*)"
        rf"|(?P<SIGN>{signs})"
        r"|.",
        re.DOTALL,
    )
