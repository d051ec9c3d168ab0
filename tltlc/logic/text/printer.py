"""Formulas as text, in three notations of the language and as one English sentence."""

from __future__ import annotations

from tltlc.logic.formula import Formula
from tltlc.logic.text.counts import NUMBERS, CountPrinter
from tltlc.logic.text.english import english_text
from tltlc.logic.text.notation import ASCII, OPERAND, UNICODE, WORDS, is_written_as, write

__all__ = ["ascii_text", "english_text", "is_ascii_text", "operand_text", "unicode_text", "words_text"]


def ascii_text(formula: Formula, counts: CountPrinter = NUMBERS) -> str:
    """Return the formula in letters and ASCII symbols, ``F(a & X F b) & G !c``.

    Only the necessary brackets are printed. ``counts`` prints the bounds.
    """
    return write(formula, ASCII, counts=counts)


def is_ascii_text(formula: Formula, text: str) -> bool:
    """Whether ``text`` is the :func:`ascii_text` of the formula, in time proportional to the length of ``text``."""
    return is_written_as(formula, text, ASCII)


def operand_text(formula: Formula) -> str:
    """Return the :func:`ascii_text` of the formula, in brackets if it needs them as the operand of ``!``."""
    return write(formula, ASCII, OPERAND)


def unicode_text(formula: Formula, counts: CountPrinter = NUMBERS) -> str:
    """Return the formula in symbols, ``◇(a ∧ ○◇b) ∧ □¬c``.

    ``N W R M`` have no symbols and stay letters. ``counts`` prints the bounds.
    """
    return write(formula, UNICODE, counts=counts)


def words_text(formula: Formula) -> str:
    """Return the formula in words, ``eventually (a and next eventually b) and always not c``."""
    return write(formula, WORDS)
