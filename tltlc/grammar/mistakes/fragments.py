"""Split the tokens of a text with errors into pieces: declarations, and the lines of a block.

A piece is a declaration, a clause of a spec, or a line of a test. It begins at a keyword, with few
exceptions. Within a line, a keyword begins a piece only after a token that can end a piece. So
``reach level`` is one clause, although ``level`` is a keyword, too. At the start of a line, a word that
seems to be a misspelt keyword can begin a piece, too.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Final

from tltlc.core.source import SourceFile
from tltlc.grammar.keywords import CLAUSES, DECLARATIONS, SYNONYMS, TEST_ITEMS, closest_word
from tltlc.grammar.lexer import BAD, Token
from tltlc.grammar.mistakes.declaration_forms.clocks import CLOCK_WORDS
from tltlc.grammar.mistakes.declaration_forms.heads import SPEC_WORDS
from tltlc.grammar.mistakes.declaration_forms.signals import ENTITY_WORDS, ENUM_WORDS, SIGNAL_WORDS, TYPE_WORDS
from tltlc.grammar.tables import load

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
_BEFORE_VERBS: Final = ("must", "should", "shall", "will", "may", "can", "cannot", "to")
"""Words before a verb: `coins must reach 50` is one clause."""
_PREFIXES: Final = (_STARTS - {"NAME", "STRING"}) | {"WHEN"}
"""Tokens that can begin a formula but not continue one."""
_OPENING_WORDS: Final = frozenset(
    (
        "after once if when whenever while given within the player you must each every as following during unless "
        "between"
    ).split()
)
"""Words that begin a sentence which may go on with the keyword of a clause on the same line."""
_SCENARIO: Final = ("given", "when")
_STEPS: Final = ("then", "and", "but")
"""Words that begin the lines of a scenario."""
_SEPARATORS: Final = (";", ",")
"""Marks that other languages write after a declaration."""
_OTHERS: Final = DECLARATIONS.keys() - {"spec", "test"}


def declarations(source: SourceFile, tokens: Sequence[Token]) -> Iterator[list[Token]]:
    """Yield the tokens of each declaration, split at keywords and after the brace that closes a block."""
    piece: list[Token] = []
    depth = 0
    for index, token in enumerate(tokens):
        is_inside = depth > 0 and _is_declared_inside(source, tokens, index)
        if piece and not is_inside and _begins_piece(source, tokens, index, DECLARATIONS, depth == 0):
            yield piece
            piece, depth = [], 0
        piece.append(token)
        if token.type == "LBRACE":
            depth += 1
        is_enum = piece[0].text in ENUM_WORDS
        is_last = (token.type == "RBRACE" and depth > 0) or (is_enum and token.text == ";")
        depth -= token.type == "RBRACE" and depth > 0
        is_marked = is_enum and index + 1 < len(tokens) and tokens[index + 1].text == ";"
        if is_last and depth == 0 and not is_marked:
            yield piece
            piece = []
    if piece:
        yield piece


def lines(source: SourceFile, tokens: Sequence[Token], keywords: dict[str, str]) -> Iterator[list[Token]]:
    """Yield the tokens of each clause of a spec, or of each line of a test.

    ``tokens`` are those between the braces. ``keywords`` are the words that begin clauses, or lines of
    a test.
    """
    piece: list[Token] = []
    for index, token in enumerate(tokens):
        is_declaration = _begins_other(source, tokens, index)
        is_first = is_first_on_line(source, tokens, index)
        opens = piece[0].text.lower() if piece and keywords is CLAUSES else ""
        # `after seen keep hidden for 3 s` is one sentence, and so are the lines of a scenario.
        is_inside = opens in _OPENING_WORDS and not is_first
        is_inside |= opens in _SCENARIO and is_first and token.text.lower() in (*_SCENARIO, *_STEPS)
        is_inside |= bool(opens) and opens not in keywords and is_first and token.text.lower() == "but"
        begins = is_declaration or (not is_inside and _begins_piece(source, tokens, index, keywords, True))
        if piece and begins:
            yield piece
            piece = []
        piece.append(token)
    if piece:
        yield piece


def block_kind(piece: Sequence[Token]) -> str | None:
    """Return ``"spec"`` or ``"test"`` if the piece is a spec or a test in braces, else None.

    The keyword may be misspelt. ``spec NAME = …`` has no braces, so the result is None.
    """
    head = next((token.type for token in piece if token.type in ("LBRACE", "EQUAL")), None)
    return closest_word(piece[0].text, ("spec", "test")) if head == "LBRACE" and piece[0].text not in _OTHERS else None


def is_first_on_line(source: SourceFile, tokens: Sequence[Token], index: int) -> bool:
    """Whether a token is the first one on its line."""
    return index == 0 or "\n" in source.text[tokens[index - 1].end : tokens[index].start]


def _begins_other(source: SourceFile, tokens: Sequence[Token], index: int) -> bool:
    """Whether the token with this index begins a line, and a declaration that is no spec and no test."""
    token = tokens[index]
    return token.text in _OTHERS and token.type != "NAME" and is_first_on_line(source, tokens, index)


def _is_declared_inside(source: SourceFile, tokens: Sequence[Token], index: int) -> bool:
    """Whether a declaration begins at the token with this index, by mistake inside the braces of a spec or test.

    It does if these braces are closed after it, and nothing else is opened before that.
    """
    if not _begins_other(source, tokens, index):
        return False
    following = next((token for token in tokens[index:] if token.type in ("LBRACE", "RBRACE", "SPEC", "TEST")), None)
    return following is not None and following.type == "RBRACE"


def _begins_piece(
    source: SourceFile, tokens: Sequence[Token], index: int, keywords: dict[str, str], within_lines: bool
) -> bool:
    """Whether a declaration, clause or line of a test begins at the token with this index, which is not 0.

    ``keywords`` are the words that can begin it. If ``within_lines`` is false, they can do so only at
    the start of a line.
    """
    token, before = tokens[index], tokens[index - 1]
    first = is_first_on_line(source, tokens, index)
    if token.text in keywords and (token.type != "NAME" or keywords is TEST_ITEMS):
        if not first and before.text in _BEFORE_VERBS:
            return False
        if token.type == "ENTITY" and before.type == "COLON":
            return False
        if token.type == "LIMIT" and before.text == "at" and not (first and tokens[index - 2].type != "JUDGE"):
            return False
        if token.type == "LIMIT" and _is_behind_number(source, tokens, index):
            return False
        return first or (within_lines and before.type in _ENDS)
    if keywords is DECLARATIONS and first and within_lines and _is_declared(tokens, index):
        return True
    if keywords is CLAUSES and first and before.type in _ENDS - {"LIMIT"} and token.type in _PREFIXES:
        return True
    if first and _is_list_mark(source, tokens, index, keywords):
        return True
    # A word at the start of a line that is no keyword and comes before another word is a misspelt keyword.
    if not first or not within_lines or token.type not in ("NAME", BAD) or not token.text[0].isalpha():
        return False
    if index + 1 == len(tokens):
        return False
    following = tokens[index + 1]
    if following.type == "COLON" and _is_like_keyword(token.text, keywords):
        return True
    is_end = before.type in _ENDS or token.text in _BEFORE_VERBS
    if following.text in keywords and following.type != "NAME" and is_end:
        return True
    if following.type not in _STARTS or following.text in load().soft or is_first_on_line(source, tokens, index + 1):
        return False
    return before.type in _ENDS or closest_word(token.text, tuple(keywords)) is not None


def _is_declared(tokens: Sequence[Token], index: int) -> bool:
    """Whether a line begins with a declaration in another form: ``dt = 0.1``, ``seen: bool``, ``int lap``, ``bool a;``.

    ``index`` is that of its first token.
    """
    word, before, after = tokens[index].text.lower(), tokens[index - 1], tokens[index + 1 : index + 3]
    if tokens[index].type != "NAME" or not after or (before.type not in _ENDS and before.text not in _SEPARATORS):
        return False
    if before.text == ";" and after[0].type == "NAME":
        return True
    if word in CLOCK_WORDS:
        return after[0].text in ("=", ":") or after[0].type == "NUMBER"
    if word in SPEC_WORDS:
        return after[0].type in ("NAME", "STRING") or after[0].text in ("{", ":")
    if after[0].text in (":", "=") and word in SIGNAL_WORDS | ENTITY_WORDS:
        return after[0].text == ":"
    if after[0].text == ":":
        return after[1:] != [] and after[1].text.lower() in TYPE_WORDS
    return after[0].type == "NAME" and word in SIGNAL_WORDS | ENTITY_WORDS | TYPE_WORDS | {*ENUM_WORDS}


def _is_like_keyword(word: str, keywords: dict[str, str]) -> bool:
    """Whether a word is most likely meant as a keyword."""
    elsewhere = {synonym for words in SYNONYMS.values() for synonym, keyword in words.items() if keyword in keywords}
    return word.lower() in elsewhere or closest_word(word, tuple(keywords)) is not None


def _is_behind_number(source: SourceFile, tokens: Sequence[Token], index: int) -> bool:
    """Whether the keyword `limit` comes after its number, as in ``400 steps limit``."""
    number = index - 1 - (tokens[index - 1].type == "UNIT")
    has_number_after = index + 1 < len(tokens) and tokens[index + 1].type == "NUMBER"
    return tokens[number].type == "NUMBER" and is_first_on_line(source, tokens, number) and not has_number_after


def _is_list_mark(source: SourceFile, tokens: Sequence[Token], index: int, keywords: dict[str, str]) -> bool:
    """Whether a line begins like a line of a list, as in ``- reach a`` and ``1. reach a``."""
    for position in (index, index + 1):
        following = position + 1
        if (
            tokens[position].text[0].isalpha()
            or following == len(tokens)
            or is_first_on_line(source, tokens, following)
        ):
            return False
        if tokens[following].text in keywords:
            return True
    return False
