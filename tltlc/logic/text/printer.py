"""Formulas as text, in three notations of the language and as one English sentence."""

from __future__ import annotations

from tltlc.logic.formula import Formula
from tltlc.logic.text.english import english_text
from tltlc.logic.text.notation import ASCII, OPERAND, UNICODE, WORDS, write

__all__ = ["ascii_text", "english_text", "operand_text", "unicode_text", "words_text"]


def ascii_text(formula: Formula) -> str:
    """The formula in letters and ASCII symbols, ``F(a & X F b) & G !c``, with only the brackets that it needs."""
    return write(formula, ASCII)


def operand_text(formula: Formula) -> str:
    """The formula in the notation of :func:`ascii_text`, as it stands behind ``!`` or beside ``&`` and ``|``."""
    return write(formula, ASCII, OPERAND)


def unicode_text(formula: Formula) -> str:
    """The formula in symbols, ``◇(a ∧ ○◇b) ∧ □¬c``; ``N W R M`` have no symbol and stay letters."""
    return write(formula, UNICODE)


def words_text(formula: Formula) -> str:
    """The formula in words, ``eventually (a and next eventually b) and always not c``."""
    return write(formula, WORDS)
