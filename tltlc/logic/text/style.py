"""The four styles of the formatter, each with a spelling for every operator."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Final

from tltlc.core.record import EMPTY, record
from tltlc.grammar import tree
from tltlc.logic.formula import FormulaOp
from tltlc.logic.text.notation import ASCII, UNICODE, WORDS, Spelling

_PAST: Final = ("once", "historically", "previously", "begins", "ends")
"""The operators about the past, which have no letters or symbols."""

_INFIX: Final = {
    **{op: f" {op} " for op in ("=", "then", "since", "<", "<=", ">", ">=", "==", "!=", "+", "-", "*", "/")},
    "^": "^",
}


@record
class Style:
    """The spellings of operators, with their spaces.

    ``prefix`` has operators before an operand, and ``infix`` operators between two operands.
    ``constants`` has the spellings of ``true`` and ``false``. ``space_before_bracket`` says whether
    a space separates a prefix operator from an operand in brackets.

    ``letters`` spells the prefix operators as letters, for bounds that words cannot express, as in
    ``F[2,3]``. It is None for styles that do not write bounds in words.
    """

    prefix: Mapping[str, str]
    infix: Mapping[str, str]
    constants: Mapping[str, str]
    space_before_bracket: bool
    letters: Mapping[str, str] | None

    def prefix_text(self, node: tree.Unary, bound: Mapping[str, str]) -> str:
        """Return the text of a prefix operator, with its bound and the space after it.

        ``bound`` has the forms in which the bound can be written, as
        :func:`tltlc.logic.text.source_bounds.bound_forms` returns them.
        """
        if "words" in bound and (self.letters or "brackets" not in bound):
            return f"{self.prefix[node.op].rstrip()} {bound['words']} "
        spelling = self.prefix[node.op]
        if bound:
            # With a bound in brackets, a letter (`F[2,3]`) is easier to read than a word.
            spelling = f"{(self.letters or self.prefix)[node.op].rstrip()}{bound['brackets']} "
        return (
            spelling.rstrip()
            if isinstance(node.operand, tree.GroupExpr) and not self.space_before_bracket and node.op not in _PAST
            else spelling
        )


def _style(
    notation: Spelling, extra_infix: Mapping[str, str] = EMPTY, letters: Mapping[str, str] | None = None
) -> Style:
    """Return a style with the spellings of ``notation``.

    ``extra_infix`` adds or replaces spellings of infix operators. ``letters`` becomes the field of
    that name in :class:`Style`.
    """
    prefix, infix, constants = (_by_text(table) for table in (notation.prefix, notation.infix, notation.constants))
    return Style(
        {"-": "-", **{op: f"{op} " for op in _PAST}, **prefix},
        {**_INFIX, **infix, **extra_infix},
        constants,
        notation.space_before_bracket,
        letters,
    )


def _by_text(table: Mapping[FormulaOp, str]) -> dict[str, str]:
    return {str(op): spelling for op, spelling in table.items()}


STYLES: Final[Mapping[str, Style]] = {
    "words": _style(WORDS, letters=_by_text(ASCII.prefix)),
    "letters": _style(ASCII),
    "symbols": _style(ASCII._replace(prefix={**ASCII.prefix, "F": "<>", "G": "[]"})),
    "unicode": _style(UNICODE, {"<=": " ≤ ", ">=": " ≥ "}),
}
"""The styles by name. In the last two, an operator without a symbol keeps its letter."""

DEFAULT: Final = "words"
"""The default style."""
