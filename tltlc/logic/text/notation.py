"""Print formulas in a notation, which a table of spellings describes."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Final, NamedTuple

from tltlc.core.names import ComparisonName
from tltlc.logic.bounded_operators import LEAST, Bounded, bounded_operator, operands_with_bounds
from tltlc.logic.formula import Formula, FormulaOp
from tltlc.logic.text.counts import NUMBERS, CountPrinter

OPERAND: Final = 6
"""The strength of unary operators, as in ``STRENGTH``.

An operand of a unary operator needs brackets if its own operator is weaker.
"""

STRENGTH: Final[Mapping[FormulaOp, int]] = {
    "iff": 1,
    "implies": 2,
    "or": 3,
    "and": 4,
    **dict.fromkeys(("U", "W", "R", "M"), 5),
    **dict.fromkeys(("not", "X", "N", "F", "G"), OPERAND),
    **dict.fromkeys(("true", "false", "atom"), 7),
}
"""How tightly operators bind; a greater number binds more tightly."""


class Spelling(NamedTuple):
    """A notation: the spellings of operators before an operand (``prefix``) and between two
    (``infix``).

    ``space_before_bracket`` keeps the space between a prefix and an opening bracket.
    ``brackets_between_infix`` puts brackets around every infix operator inside another infix
    operator, and ``brackets_around_comparisons`` around comparisons that are operands. ``within``
    and ``during`` are the prefixes of ``F[0,n]`` and ``G[0,n]``, with ``{}`` for n; in ``during``,
    ``{}`` is the number n + 1 of samples if ``during_counts_samples``.
    """

    prefix: Mapping[FormulaOp, str]
    infix: Mapping[FormulaOp, str]
    constants: Mapping[FormulaOp, str]
    space_before_bracket: bool
    brackets_between_infix: bool = False
    brackets_around_comparisons: bool = True
    within: str = ""
    during: str = ""
    during_counts_samples: bool = False


LETTERS: Final[Mapping[FormulaOp, str]] = {"U": " U ", "W": " W ", "R": " R ", "M": " M "}

ASCII: Final = Spelling(
    {"not": "!", "X": "X ", "N": "N ", "F": "F ", "G": "G "},
    {"and": " & ", "or": " | ", "implies": " -> ", "iff": " <-> ", **LETTERS},
    {"true": "true", "false": "false"},
    space_before_bracket=False,
    within="F[0,{}] ",
    during="G[0,{}] ",
)
UNICODE: Final = Spelling(
    {"not": "¬", "X": "○", "N": "N ", "F": "◇", "G": "□"},
    {"and": " ∧ ", "or": " ∨ ", "implies": " ⇒ ", "iff": " ⇔ ", **LETTERS, "U": " 𝒰 "},
    {"true": "⊤", "false": "⊥"},
    space_before_bracket=False,
    within="◇[0,{}] ",
    during="□[0,{}] ",
)
WORDS: Final = Spelling(
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
    within="eventually within {} steps ",
    during="always for {} steps ",
    during_counts_samples=True,
)


_TextItem = str | tuple[Formula, int]
"""A text; or a formula to be written, with the least strength at which it needs no brackets."""


def write(formula: Formula, spelling: Spelling, least: int = 0, counts: CountPrinter = NUMBERS) -> str:
    """Return the text of the formula, with only the brackets that it needs.

    If the text is to be an operand, ``least`` says how tightly the formula must bind to need no
    brackets: a number as in :data:`STRENGTH`. ``counts`` prints the bounds.
    """
    return "".join(_pieces(formula, spelling, least, counts))


def is_written_as(formula: Formula, text: str, spelling: Spelling) -> bool:
    """Whether :func:`write` returns this text for the formula.

    The time is at most proportional to the length of ``text``. The text of the formula may be far
    longer than the formula is in memory, since a formula shares equal operands.
    """
    position = 0
    for piece in _pieces(formula, spelling, 0, NUMBERS):
        if not text.startswith(piece, position):
            return False
        position += len(piece)
    return position == len(text)


def _pieces(formula: Formula, spelling: Spelling, least: int, counts: CountPrinter) -> Iterator[str]:
    """Yield the text of the formula, from left to right.

    If the text is to be an operand, ``least`` says how tightly the formula must bind to need no
    brackets: a number as in :data:`STRENGTH`. An explicit stack replaces recursion, since formulas
    nest deep.
    """
    stack: list[_TextItem] = [(formula, least)]
    while stack:
        item = stack.pop()
        if isinstance(item, str):
            yield item
            continue
        node, least = item
        bound = _bound(node)
        if bound is not None:
            _push_operand(stack, _bounded_prefix(bound, spelling, counts), bound.body, spelling)
        elif _needs_brackets(node, least, spelling):
            stack += [")", (node, 0), "("]
        elif node.op == "atom":
            yield node.name
        elif node.op in spelling.constants:
            yield spelling.constants[node.op]
        elif len(node.args) == 1:
            _push_operand(stack, spelling.prefix[node.op], node.args[0], spelling)
        else:
            _push_infix(stack, node, spelling)


def _bound(node: Formula) -> Bounded | None:
    """Return the bounded operator that is printed in place of its expansion ``node``; None if
    ``node`` is printed as it is.
    """
    operator = bounded_operator(node) if node.op in ("or", "and") else None
    return operator if operator is not None and operator.steps >= LEAST else None


def _bounded_prefix(bound: Bounded, spelling: Spelling, counts: CountPrinter) -> str:
    if bound.op == "F":
        return spelling.within.format(counts.number(bound.steps))
    count = bound.steps + 1 if spelling.during_counts_samples else bound.steps
    return spelling.during.format(counts.number(count))


def _push_operand(stack: list[_TextItem], prefix: str, operand: Formula, spelling: Spelling) -> None:
    bracket = _needs_brackets(operand, OPERAND, spelling) and not spelling.space_before_bracket
    stack += [(operand, OPERAND), prefix.rstrip() if bracket else prefix]


def _push_infix(stack: list[_TextItem], node: Formula, spelling: Spelling) -> None:
    """Push onto ``stack`` what remains to be printed for ``node``, a formula with an infix operator.

    This is the operands, the last one first, with the symbol of the operator between them.
    """
    strength, inner = STRENGTH[node.op], OPERAND if spelling.brackets_between_infix else 0
    operands = operands_with_bounds(node) if node.op in ("or", "and") else node.args
    # All infix operators except <-> group to the right, and operands of & and | never have the same operator.
    last = strength + 1 if node.op == "iff" else strength
    for index in range(len(operands) - 1, -1, -1):
        is_last = index == len(operands) - 1
        stack.append((operands[index], max(inner, last if is_last else strength + 1)))
        if index:
            stack.append(spelling.infix[node.op])


def _needs_brackets(node: Formula, least: int, spelling: Spelling) -> bool:
    """Whether a node needs brackets where its operator must bind at least as tightly as ``least``."""
    if spelling.brackets_around_comparisons and least and isinstance(node.name, ComparisonName):
        return True  # The grammar reads F a > 0 as F(a > 0), but a person might not.
    if STRENGTH[node.op] >= least:
        return False
    return _bound(node) is None
