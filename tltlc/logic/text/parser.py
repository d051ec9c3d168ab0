"""Parse the formulas in artefacts, the files ``NAME.fspa.json`` with compiled automata.

:func:`tltlc.logic.text.printer.ascii_text` printed these formulas. The parser of source texts reads
many more notations, and needs the declarations of the atoms. This parser needs only their names.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Mapping
from typing import Final

from tltlc.io.limits import WORK
from tltlc.logic import formula as build
from tltlc.logic.formula import Formula
from tltlc.logic.text.notation import ASCII, OPERAND, STRENGTH

_TOKEN: Final = re.compile(
    r"(?P<op><->|->|[!&|()]|[XNFGUWRM](?![\w.\[]))|(?P<bound>[FG])\[0,(?P<steps>[0-9]{1,7})\]"
    r"|(?P<constant>true|false)(?![\w.])"
)
_BLANK: Final = re.compile(r"[ \t\r\n]*")
_PLAIN_NAME: Final = re.compile(r"[^\W\d][\w.]*(?:\([^()]*\))?(?![\w.])")

_UNARY: Final[Mapping[str, Callable[[Formula], Formula]]] = {
    "!": build.not_,
    "X": build.next_,
    "N": build.weak_next,
    "F": build.eventually,
    "G": build.always,
}
_NARY: Final = {"&": build.and_, "|": build.or_}
_BINARY: Final[Mapping[str, Callable[[Formula, Formula], Formula]]] = {
    "U": build.until,
    "W": build.weak_until,
    "R": build.release,
    "M": build.strong_release,
    "->": build.implies,
    "<->": build.iff,
}
_STRENGTH: Final = {"(": 0, **{symbol.strip(): STRENGTH[op] for op, symbol in ASCII.infix.items()}}
"""How tightly each infix operator binds: a greater number binds more tightly, and an open bracket binds least."""

_Operator = str | tuple[str, int]
"""An operator or an open bracket; or a pair of ``F`` or ``G`` and its bound in steps."""


class _NoFormulaError(Exception):
    """Raised inside the parser for a text that is no formula, or whose bounds are too large to expand."""


class FormulaParser:
    """Parses formulas over atoms with the given names; results are cached.

    ``F[0,2] p`` is parsed as ``p | X(p | X p)``. The expansions of ``F[0,2] p`` and ``F[0,9] p``
    share their subformulas.
    """

    def __init__(self, names: Iterable[str]) -> None:
        known = [name for name in dict.fromkeys(names) if name]
        self._atoms = {name: build.atom(name) for name in known}
        plain = {name for name in known if _PLAIN_NAME.fullmatch(name)}
        # If a name is the beginning of another name, as `a` is of `a > 0`, the longer name must be tried first.
        beginnings = {match.group() for name in set(known) - plain if (match := _PLAIN_NAME.match(name))}
        self._plain = plain - beginnings
        others = sorted(set(known) - self._plain, key=len, reverse=True)
        self._others = re.compile(rf"(?:{'|'.join(map(re.escape, others))})(?![\w.])") if others else None
        self._expansions: dict[tuple[str, Formula], list[Formula]] = {}
        self._remaining = WORK["expanded bounds"]
        self._parsed: dict[str, Formula | None] = {}

    def formula(self, text: str) -> Formula | None:
        """Return the formula that ``text`` stands for, or None if ``text`` is no formula over the names.

        Also returns None if the expansions of all bounds that were parsed so far are larger than
        ``WORK["expanded bounds"]``. Takes linear time and no recursion.
        """
        if text not in self._parsed:
            try:
                self._parsed[text] = self._formula(text)
            except _NoFormulaError:
                self._parsed[text] = None
        return self._parsed[text]

    def _formula(self, text: str) -> Formula:
        operands: list[Formula] = []
        operators: list[_Operator] = []
        position, wants_operand = _after_blanks(text, 0), True
        while position < len(text):
            atom = self._name(text, position) if wants_operand else ""
            if atom:
                operands.append(self._atoms[atom])
                position, wants_operand = _after_blanks(text, position + len(atom)), False
                continue
            match = _TOKEN.match(text, position)
            if match is None:
                raise _NoFormulaError
            position = _after_blanks(text, match.end())
            operator, constant = match["op"], match["constant"]
            if match["bound"] or constant or operator == "(" or operator in _UNARY:
                if not wants_operand:
                    raise _NoFormulaError
                if constant:
                    operands.append(build.TRUE if constant == "true" else build.FALSE)
                    wants_operand = False
                else:
                    operators.append(operator or (match["bound"], int(match["steps"])))
                continue
            if wants_operand:
                raise _NoFormulaError
            if operator == ")":
                self._apply(operands, operators, 1)
                if not operators:
                    raise _NoFormulaError
                operators.pop()
                continue
            # `<->` groups to the left, all other operators between two operands to the right.
            self._apply(operands, operators, _STRENGTH[operator] + (operator != "<->"))
            operators.append(operator)
            wants_operand = True
        if wants_operand:
            raise _NoFormulaError
        self._apply(operands, operators, 1)
        if operators:
            raise _NoFormulaError
        return operands[0]

    def _name(self, text: str, position: int) -> str:
        """Return the longest name of an atom that begins at ``position``, or an empty text."""
        match = _PLAIN_NAME.match(text, position)
        if match is not None and match.group() in self._plain:
            return match.group()
        match = self._others.match(text, position) if self._others else None
        return match.group() if match else ""

    def _apply(self, operands: list[Formula], operators: list[_Operator], least: int) -> None:
        """Pop operators, and replace their operands on top of ``operands`` by the formulas that they make.

        Both lists are stacks. Stops at an open bracket, and at an operator that binds less tightly
        than ``least``.
        """
        while operators and _strength(operators[-1]) >= least:
            operator = operators.pop()
            if isinstance(operator, tuple):
                operands.append(self._bounded(*operator, operands.pop()))
            elif operator in _UNARY:
                operands.append(_UNARY[operator](operands.pop()))
            elif operator in _BINARY:
                right = operands.pop()
                operands.append(_BINARY[operator](operands.pop(), right))
            else:
                count = 2
                while operators and operators[-1] == operator:
                    operators.pop()
                    count += 1
                operands[-count:] = [_NARY[operator](*operands[-count:])]

    def _bounded(self, op: str, steps: int, body: Formula) -> Formula:
        """Return ``F[0,steps] body`` or ``G[0,steps] body``, expanded into ``X`` or ``N``."""
        expansions = self._expansions.setdefault((op, body), [body])
        while len(expansions) <= steps:
            self._remaining -= 1 + len(body.args)
            if self._remaining < 0:
                raise _NoFormulaError
            inner = expansions[-1]
            expansions.append(
                build.or_(body, build.next_(inner)) if op == "F" else build.and_(body, build.weak_next(inner))
            )
        return expansions[steps]


def _strength(operator: _Operator) -> int:
    """Return how tightly an operator binds, as in ``_STRENGTH``; all prefix operators bind equally."""
    return _STRENGTH.get(operator, OPERAND) if isinstance(operator, str) else OPERAND


def _after_blanks(text: str, position: int) -> int:
    match = _BLANK.match(text, position)
    return match.end() if match else position
