"""Formulas as text, in three notations of the language and as one English sentence."""

from __future__ import annotations

from typing import Final

from tltlc.logic.english import english_text
from tltlc.logic.formula import Formula
from tltlc.logic.notation import ASCII, LETTERS, OPERAND, Notation, write

__all__ = ["ascii_text", "english_text", "operand_text", "unicode_text", "words_text"]


_UNICODE: Final = Notation(
    {"not": "¬", "X": "○", "N": "N ", "F": "◇", "G": "□"},
    {"and": " ∧ ", "or": " ∨ ", "implies": " ⇒ ", "iff": " ⇔ ", **LETTERS, "U": " 𝒰 "},
    {"true": "⊤", "false": "⊥"},
    space_before_bracket=False,
    within="◇[0,{last}] ",
    during="□[0,{last}] ",
)
_WORDS: Final = Notation(
    {"not": "not ", "X": "next ", "N": "weak_next ", "F": "eventually ", "G": "always "},
    {
        "and": " and ",
        "or": " or ",
        "implies": " implies ",
        "iff": " iff ",
        "U": " until ",
        "W": " weak_until ",
        "R": " release ",
        "M": " strong_release ",
    },
    {"true": "true", "false": "false"},
    space_before_bracket=True,
    within="eventually within {last} steps ",
    during="always for {count} steps ",
)


def ascii_text(formula: Formula) -> str:
    """The formula in letters and ASCII symbols, ``F(a & X F b) & G !c``, with only the brackets that it needs."""
    return write(formula, ASCII)


def operand_text(formula: Formula) -> str:
    """The formula in the notation of :func:`ascii_text`, as it stands behind ``!`` or beside ``&`` and ``|``."""
    return write(formula, ASCII, OPERAND)


def unicode_text(formula: Formula) -> str:
    """The formula in symbols, ``◇(a ∧ ○◇b) ∧ □¬c``; ``N W R M`` have no symbol and stay letters."""
    return write(formula, _UNICODE)


def words_text(formula: Formula) -> str:
    """The formula in words, ``eventually (a and next eventually b) and always not c``."""
    return write(formula, _WORDS)
