"""Print formulas in a notation: ASCII, Unicode symbols or words."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Final, NamedTuple

from tltlc.core.names import ComparisonName
from tltlc.logic.bounded_operators import LEAST, Bounded, bounded_operator, operands_with_bounds
from tltlc.logic.formula import Formula, FormulaOp, bound_of
from tltlc.logic.text.counts import NUMBERS, CountPrinter

OPERAND: Final = 6
"""The strength of unary operators in ``STRENGTH``.

The operand of a unary operator needs brackets if the operand's own operator is weaker.
"""

STRENGTH: Final[Mapping[FormulaOp, int]] = {
    "iff": 1,
    "implies": 2,
    "or": 3,
    "and": 4,
    **dict.fromkeys(("U", "W", "R", "M"), 5),
    **dict.fromkeys(("not", "X", "N", "F", "G", "F[]", "G[]"), OPERAND),
    **dict.fromkeys(("true", "false", "atom"), 7),
}
"""How tightly operators bind; a greater number binds more tightly."""


_SIGNS: Final = frozenset("<>")
"""A name with one of these characters, which operators have too, is printed in brackets."""


class Spelling(NamedTuple):
    """A notation: how operators and constants are written.

    ``prefix`` has the texts of unary operators, ``infix`` of binary operators. ``within`` and
    ``during`` are the texts of ``F[0,n]`` and ``G[0,n]``, with ``{}`` in place of n. If
    ``during_counts_samples``, the number in ``during`` is n + 1, the number of samples.
    ``space_before_bracket`` keeps the space between a unary operator and an opening bracket.
    ``brackets_between_infix`` puts brackets around each binary operator inside another binary
    operator. ``brackets_around_comparisons`` puts brackets around comparisons, such as ``a > 0``,
    that are operands.
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
"""A text; or a formula to be written, and the least strength (as in ``STRENGTH``) that needs no brackets."""


def write(formula: Formula, spelling: Spelling, least: int = 0, counts: CountPrinter = NUMBERS) -> str:
    """Return the text of the formula, with only the brackets that it needs.

    The whole text is in brackets if the outermost operator has a strength below ``least`` in
    :data:`STRENGTH`; 0 means no brackets. ``counts`` prints the bounds.
    """
    return "".join(_pieces(formula, spelling, least, counts))


def is_written_as(formula: Formula, text: str, spelling: Spelling) -> bool:
    """Whether :func:`write` returns this text for the formula.

    Takes time proportional to the length of ``text``, even if the formula has a far longer text.
    This can happen because formulas share equal operands in memory.
    """
    position = 0
    for piece in _pieces(formula, spelling, 0, NUMBERS):
        if not text.startswith(piece, position):
            return False
        position += len(piece)
    return position == len(text)


def _pieces(formula: Formula, spelling: Spelling, least: int, counts: CountPrinter) -> Iterator[str]:
    """Yield the text of the formula in pieces, from left to right.

    The arguments are those of :func:`write`. An explicit stack replaces recursion, since formulas
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
        elif bound_of(node) is not None:
            _push_operand(stack, f"{node.op[0]}{node.name} ", node.args[0], spelling)
        elif node.op in spelling.constants:
            yield spelling.constants[node.op]
        elif len(node.args) == 1:
            _push_operand(stack, spelling.prefix[node.op], node.args[0], spelling)
        else:
            _push_infix(stack, node, spelling)


def _bound(node: Formula) -> Bounded | None:
    """Return the bounded operator as which ``node`` is printed: ``F[0,2] p`` for ``p | X(p | X p)``.

    Returns None if ``node`` is not the expansion of a bounded operator, or if the bound has less
    than :data:`~tltlc.logic.bounded_operators.LEAST` steps.
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
    """Push the operands of ``node``, and the text of its operator between them, onto ``stack``.

    The last operand is pushed first, so that the first operand is printed first.
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
    """Whether a formula needs brackets in a place where operators below the strength ``least`` need them."""
    is_comparison = node.op == "atom" and (isinstance(node.name, ComparisonName) or not _SIGNS.isdisjoint(node.name))
    if spelling.brackets_around_comparisons and is_comparison and least:
        return True  # The grammar reads F a > 0 as F(a > 0), but a person might not.
    if STRENGTH[node.op] >= least:
        return False
    return _bound(node) is None
