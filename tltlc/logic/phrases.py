"""Formulas without temporal operators as phrases of an English sentence."""

from __future__ import annotations

from typing import Final

from tltlc.logic.formula import Formula
from tltlc.logic.notation import Notation, write

_PHRASE: Final = Notation(
    {"not": "not "},
    {"and": " and ", "or": " or ", "implies": " implies ", "iff": " exactly when "},
    {},
    space_before_bracket=True,
    brackets_between_infix=True,
)


def phrase(state: Formula) -> str:
    """The formula in words: ``near(exit) and not seen``."""
    return write(state, _PHRASE)


def bracketed(state: Formula) -> str:
    """The formula as a phrase that reads as one thing."""
    return phrase(state) if is_literal(state) else f"({phrase(state)})"


def imperative(state: Formula, keep: str, avoid: str) -> str:
    """What to do about it, with one verb for what is to hold and another one for what is not to."""
    return f"{avoid} {bracketed(state.args[0])}" if state.op == "not" else f"{keep} {bracketed(state)}"


def is_state(formula: Formula) -> bool:
    """Whether the formula has no temporal operator."""
    return not any(part.is_temporal for part in formula.walk())


def is_literal(formula: Formula) -> bool:
    """Whether the formula is an atom, a constant, or the negation of one."""
    return not formula.args or (formula.op == "not" and not formula.args[0].args)
