"""Say of what kind words are: the name of a bool, of a number or an enum, a quantity, or arithmetic."""

from __future__ import annotations

from typing import Final

from tltlc.grammar.mistakes.english_rewrite import REAL_TIME
from tltlc.grammar.mistakes.sentences.words import Words

_NUMERIC: Final = ("number", "int", "ratio", "length", "time", "speed", "angle")
_FUNCTIONS: Final = ("times", "time_since", "time_holding", "previous(", "initial(")


def is_event(words: Words) -> bool:
    """Whether words are the name of a signal or predicate that is true or false, perhaps with arguments."""
    return bool(words) and is_bool(words, 0) and call_end(words, 0) == len(words)


def is_value(words: Words) -> bool:
    """Whether words are the name of a number or of an enum, perhaps with arguments."""
    declared = words.declared(0) if words else None
    is_known = declared is not None and declared.type in (*_NUMERIC, "enum")
    return is_known and call_end(words, 0) == len(words)


def call_end(words: Words, at: int) -> int:
    """Return the index after the name at an index and its arguments."""
    if at + 1 >= len(words) or words[at + 1].text != "(":
        return min(at + 1, len(words))
    depth = 0
    for index in range(at + 1, len(words)):
        depth += (words[index].text == "(") - (words[index].text == ")")
        if depth == 0:
            return index + 1
    return len(words)


def is_bool(words: Words, at: int) -> bool:
    """Whether the word at an index is the name of a bool, with arguments behind it if it needs some."""
    declared = words.declared(at)
    if declared is None:
        return at < len(words) and words[at].is_name and words[at].text not in ("times", "time_since", "time_holding")
    is_called = at + 1 < len(words) and words[at + 1].text == "("
    if bool(declared.parameters) != is_called:
        return False
    return declared.type == "bool" or declared.keyword in ("predicate", "let")


def is_number(words: Words, at: int) -> bool:
    """Whether the word at an index is the name of a number, or of a function with one."""
    declared = words.declared(at)
    is_function = at < len(words) and words[at].text.startswith(_FUNCTIONS)
    return is_function or (declared is not None and declared.type in _NUMERIC)


def is_quantity(words: Words) -> bool:
    """Whether words are a number, perhaps with a unit, or the name of a number."""
    if len(words) == 1 and is_number(words, 0):
        return True
    return bool(words) and bool(words.number(0)) and all(word.type in ("UNIT", "DIVIDE", "NAME") for word in words[1:])


def is_arithmetic(words: Words) -> bool:
    """Whether words are numbers, names of numbers, signs and brackets alone."""
    known = ("NUMBER", "UNIT", "PLUS", "MINUS", "TIMES_SIGN", "DIVIDE", "LPAR", "RPAR", "COMMA")
    return bool(words) and all(
        word.type in known
        or is_number(words, at)
        or word.text in words.names.names
        or (word.text in REAL_TIME and at > 0 and words[at - 1].type == "DIVIDE")
        for at, word in enumerate(words)
    )
