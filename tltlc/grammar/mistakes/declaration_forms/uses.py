"""How the rest of a file uses a signal whose declaration does not say its type."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

from tltlc.grammar.lexer import Token

_NUMBERS: Final = frozenset(("<", "<=", "≤", ">", ">=", "≥", "+", "-", "*", "/", "^"))
_EQUALITIES: Final = frozenset(("==", "!="))
_WORDS: Final = frozenset("reach avoid keep require not and or implies then until ! & | && || -> F G X U".split())
"""Words and signs beside which a name is an atom."""


def used_as(name: str, text: Sequence[Token]) -> str:
    """Return ``bool``, ``int`` or ``number`` if all uses of a name in a file agree; else "".

    ``text`` are the tokens of the file. A use between words of the logic is one as a bool.
    """
    kinds = set()
    for at, token in enumerate(text):
        if token.type != "NAME" or token.text != name:
            continue
        before, after = text[at - 1] if at else None, text[at + 1] if at + 1 < len(text) else None
        around = {other.text for other in (before, after) if other is not None}
        if around & _NUMBERS:
            kinds.add("number")
        elif around & _EQUALITIES:
            kinds.add("int")
        elif before is not None and before.text in _WORDS and (after is None or _ends_atom(after)):
            kinds.add("bool")
        elif after is not None and after.text == "is":
            kinds.add("")
    if kinds == {"int", "number"}:
        return "int"
    return kinds.pop() if len(kinds) == 1 else ""


def _ends_atom(token: Token) -> bool:
    """Whether a token can follow an atom."""
    return token.text in _WORDS or (token.type != "NAME" and token.text != "(")
