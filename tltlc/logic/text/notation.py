"""Print formulas: a table of spellings gives the operators, spaces and brackets."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Final, NamedTuple

from tltlc.logic.bounded import LEAST, Bounded, bounded, with_bounds
from tltlc.logic.formula import Formula, Op

OPERAND: Final = 6
"""The least strength that an operator needs after a unary operator without brackets."""

_STRENGTH: Final[Mapping[Op, int]] = {
    "iff": 1,
    "implies": 2,
    "or": 3,
    "and": 4,
    **dict.fromkeys(("U", "W", "R", "M"), 5),
    **dict.fromkeys(("not", "X", "N", "F", "G"), OPERAND),
    **dict.fromkeys(("true", "false", "atom"), 7),
}


class Notation(NamedTuple):
    """The spelling of operators and constants: ``prefix`` before an operand, ``infix`` between two.

    ``brackets_between_infix`` puts brackets around every infix operator inside another one, and
    ``brackets_around_comparisons`` around comparisons that are operands. ``within`` and ``during``
    are the prefixes of ``F[0,n]`` and ``G[0,n]``, with ``{last}`` for n and ``{count}`` for the n +
    1 samples.
    """

    prefix: Mapping[Op, str]
    infix: Mapping[Op, str]
    constants: Mapping[Op, str]
    space_before_bracket: bool
    brackets_between_infix: bool = False
    brackets_around_comparisons: bool = True
    within: str = ""
    during: str = ""


LETTERS: Final[Mapping[Op, str]] = {"U": " U ", "W": " W ", "R": " R ", "M": " M "}

ASCII: Final = Notation(
    {"not": "!", "X": "X ", "N": "N ", "F": "F ", "G": "G "},
    {"and": " & ", "or": " | ", "implies": " -> ", "iff": " <-> ", **LETTERS},
    {"true": "true", "false": "false"},
    space_before_bracket=False,
    within="F[0,{last}] ",
    during="G[0,{last}] ",
)
UNICODE: Final = Notation(
    {"not": "¬", "X": "○", "N": "N ", "F": "◇", "G": "□"},
    {"and": " ∧ ", "or": " ∨ ", "implies": " ⇒ ", "iff": " ⇔ ", **LETTERS, "U": " 𝒰 "},
    {"true": "⊤", "false": "⊥"},
    space_before_bracket=False,
    within="◇[0,{last}] ",
    during="□[0,{last}] ",
)
WORDS: Final = Notation(
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


_Item = str | tuple[Formula, int]
"""A text, or a formula to write and the least strength at which it needs no brackets."""


def write(formula: Formula, notation: Notation, least: int = 0) -> str:
    """Return the formula in a notation, with only the brackets that it needs.

    If the formula is an operand, ``least`` is the least strength at which it needs no brackets.
    Works on an explicit stack.
    """
    pieces: list[str] = []
    stack: list[_Item] = [(formula, least)]
    while stack:
        item = stack.pop()
        if isinstance(item, str):
            pieces.append(item)
            continue
        node, least = item
        bound = _bound(node)
        if bound is not None:
            prefix = notation.within if bound.op == "F" else notation.during
            _push_operand(stack, prefix.format(last=bound.steps, count=bound.steps + 1), bound.body, notation)
        elif _needs_brackets(node, least, notation):
            stack += [")", (node, 0), "("]
        elif node.op == "atom":
            pieces.append(node.name)
        elif node.op in notation.constants:
            pieces.append(notation.constants[node.op])
        elif len(node.args) == 1:
            _push_operand(stack, notation.prefix[node.op], node.args[0], notation)
        else:
            _push_infix(stack, node, notation)
    return "".join(pieces)


def _bound(node: Formula) -> Bounded | None:
    """Return the bounded operator that a node expands, if it is long enough to be printed that way."""
    operator = bounded(node) if node.op in ("or", "and") else None
    return operator if operator is not None and operator.steps >= LEAST else None


def _push_operand(stack: list[_Item], prefix: str, operand: Formula, notation: Notation) -> None:
    bracket = _needs_brackets(operand, OPERAND, notation) and not notation.space_before_bracket
    stack += [(operand, OPERAND), prefix.rstrip() if bracket else prefix]


def _push_infix(stack: list[_Item], node: Formula, notation: Notation) -> None:
    """Push the operands of an infix operator, the last one first, with its symbol between them."""
    strength, inner = _STRENGTH[node.op], OPERAND if notation.brackets_between_infix else 0
    operands = with_bounds(node) if node.op in ("or", "and") else node.args
    # All infix operators except <-> group to the right, and operands of & and | never have the same operator.
    last = strength + 1 if node.op == "iff" else strength
    for index in range(len(operands) - 1, -1, -1):
        is_last = index == len(operands) - 1
        stack.append((operands[index], max(inner, last if is_last else strength + 1)))
        if index:
            stack.append(notation.infix[node.op])


def _needs_brackets(node: Formula, least: int, notation: Notation) -> bool:
    """Whether a node needs brackets where its operator must bind at least as tightly as ``least``."""
    if notation.brackets_around_comparisons and node.op == "atom" and least and ("<" in node.name or ">" in node.name):
        return True  # a comparison: the grammar reads F a > 0 as F(a > 0), but a person might not
    if _STRENGTH[node.op] >= least:
        return False
    return _bound(node) is None
