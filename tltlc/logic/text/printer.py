"""Formulas as text, in three notations of the language and as one English sentence."""

from __future__ import annotations

from tltlc.logic.formula import Formula
from tltlc.logic.text.english import english_text
from tltlc.logic.text.notation import ASCII, OPERAND, UNICODE, WORDS, write

__all__ = ["ascii_text", "english_text", "operand_text", "unicode_text", "words_text"]


def ascii_text(formula: Formula) -> str:
    """Return the formula in letters and ASCII symbols, ``F(a & X F b) & G !c``.

    Only the necessary brackets are printed.
    """
    return write(formula, ASCII)


def operand_text(formula: Formula) -> str:
    """Return the formula like :func:`ascii_text`, in brackets if an operand of ``!`` or ``&`` needs them."""
    return write(formula, ASCII, OPERAND)


def unicode_text(formula: Formula) -> str:
    """Return the formula in symbols, ``◇(a ∧ ○◇b) ∧ □¬c``.

    ``N W R M`` have no symbols and stay letters.
    """
    return write(formula, UNICODE)


def words_text(formula: Formula) -> str:
    """Return the formula in words, ``eventually (a and next eventually b) and always not c``."""
    return write(formula, WORDS)
