"""Formulas without temporal operators as phrases of an English sentence."""

from __future__ import annotations

import re
from typing import Final

from tltlc.logic.formula import Formula, atom, rebuild
from tltlc.logic.text.notation import Notation, write

_PHRASE: Final = Notation(
    {"not": "not "},
    {"and": " and ", "or": " or ", "implies": " implies ", "iff": " exactly when "},
    {},
    space_before_bracket=True,
    brackets_between_infix=True,
    brackets_around_comparisons=False,
)
_COMPARISON: Final = re.compile(r"([^<>]+) ([<>]) ([^<>]+)")
_OPPOSITE: Final = {"<": ">=", ">": "<="}


def phrase(state: Formula) -> str:
    """The formula in words: ``near(exit) and not seen``; ``fuel <= 5`` where ``fuel > 5`` does not hold."""
    done: dict[Formula, Formula] = {}
    for node in state.bottom_up():
        done[node] = _opposite(node) or rebuild(node, tuple(done[argument] for argument in node.args))
    return write(done[state], _PHRASE)


def _opposite(node: Formula) -> Formula | None:
    """The negation of a comparison as a comparison."""
    found = _COMPARISON.fullmatch(node.args[0].name) if node.op == "not" and node.args[0].op == "atom" else None
    return found and atom(f"{found[1]} {_OPPOSITE[found[2]]} {found[3]}")


def bracketed(state: Formula) -> str:
    """The formula as a phrase that reads as one thing."""
    return phrase(state) if is_literal(state) else f"({phrase(state)})"


def object_phrase(state: Formula) -> str:
    """The formula as a phrase behind a verb: literals joined by one `and` or `or` need no brackets there."""
    is_row = state.op in ("and", "or") and all(map(is_literal, state.args))
    return phrase(state) if is_row else bracketed(state)


def imperative(state: Formula, keep: str, avoid: str) -> str:
    """What to do about it, with one verb for what is to hold and another one for what is not to."""
    if state.op != "not":
        return f"{keep} {object_phrase(state)}"
    (avoided,) = state.args
    # "Avoid a and b" would be said of each of them.
    return f"{avoid} {bracketed(avoided) if avoided.op == 'and' else object_phrase(avoided)}"


def is_state(formula: Formula) -> bool:
    """Whether the formula has no temporal operator."""
    return not any(part.is_temporal for part in formula.walk())


def is_literal(formula: Formula) -> bool:
    """Whether the formula is an atom, a constant, or the negation of one."""
    return not formula.args or (formula.op == "not" and not formula.args[0].args)
