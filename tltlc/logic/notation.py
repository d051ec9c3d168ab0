"""How a formula becomes text: operators, spaces and brackets by a table of spellings."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Final, NamedTuple

from tltlc.logic.formula import Formula, Op

_OPERAND: Final = 6
"""What an operator needs at least to stand behind a unary operator without brackets."""

_STRENGTH: Final[Mapping[Op, int]] = {
    "iff": 1,
    "implies": 2,
    "or": 3,
    "and": 4,
    **dict.fromkeys(("U", "W", "R", "M"), 5),
    **dict.fromkeys(("not", "X", "N", "F", "G"), _OPERAND),
    **dict.fromkeys(("true", "false", "atom"), 7),
}


class Notation(NamedTuple):
    """How operators and constants are written: ``prefix`` before an operand, ``infix`` between two.

    ``brackets_between_infix`` asks for brackets wherever one infix operator stands in another.
    """

    prefix: Mapping[Op, str]
    infix: Mapping[Op, str]
    constants: Mapping[Op, str]
    space_before_bracket: bool
    brackets_between_infix: bool = False


LETTERS: Final[Mapping[Op, str]] = {"U": " U ", "W": " W ", "R": " R ", "M": " M "}

ASCII: Final = Notation(
    {"not": "!", "X": "X ", "N": "N ", "F": "F ", "G": "G "},
    {"and": " & ", "or": " | ", "implies": " -> ", "iff": " <-> ", **LETTERS},
    {"true": "true", "false": "false"},
    space_before_bracket=False,
)


def write(formula: Formula, notation: Notation) -> str:
    """The formula in a notation, with only the brackets that it needs.

    Works on an explicit stack of texts and of (formula, least strength that needs no brackets).
    """
    pieces: list[str] = []
    stack: list[str | tuple[Formula, int]] = [(formula, 0)]
    while stack:
        item = stack.pop()
        if isinstance(item, str):
            pieces.append(item)
            continue
        node, least = item
        if _needs_brackets(node, least):
            pieces.append("(")
            stack += [")", (node, 0)]
        elif node.op == "atom":
            pieces.append(node.name)
        elif node.op in notation.constants:
            pieces.append(notation.constants[node.op])
        elif len(node.args) == 1:
            prefix = notation.prefix[node.op]
            bracket = _needs_brackets(node.args[0], _OPERAND) and not notation.space_before_bracket
            pieces.append(prefix.rstrip() if bracket else prefix)
            stack.append((node.args[0], _OPERAND))
        else:
            _push_infix(stack, node, notation)
    return "".join(pieces)


def _push_infix(stack: list[str | tuple[Formula, int]], node: Formula, notation: Notation) -> None:
    """Push the operands of an infix operator, the last one first, with its symbol between them."""
    strength, inner = _STRENGTH[node.op], _OPERAND if notation.brackets_between_infix else 0
    # All infix operators but <-> group to the right, and operands of & and | are never of the same operator.
    last = strength + 1 if node.op == "iff" else strength
    for index in range(len(node.args) - 1, -1, -1):
        is_last = index == len(node.args) - 1
        stack.append((node.args[index], max(inner, last if is_last else strength + 1)))
        if index:
            stack.append(notation.infix[node.op])


def _needs_brackets(node: Formula, least: int) -> bool:
    """Whether a node needs brackets where its operator must bind at least as tightly as ``least``."""
    if node.op == "atom" and least and ("<" in node.name or ">" in node.name):
        return True  # a comparison: the grammar reads F a > 0 as F(a > 0), a person might not
    return _STRENGTH[node.op] < least
