"""Write expressions on one line."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Final

from tltlc.core.source import SourceFile
from tltlc.grammar import tree
from tltlc.grammar.tree import Expr
from tltlc.logic.text.source_bounds import Number, bound_forms
from tltlc.logic.text.style import Style

ENDLESS: Final = 1 << 30
"""The room for a text that may be of any length."""

_LEVEL: Final = {"-": "+", "/": "*", "W": "U", "R": "U", "M": "U", "since": "U"}
"""Maps each operator to one that represents all operators of the same precedence."""

_PER: Final = ("s", "h", "ms", "min")
"""Units that may follow the slash in a speed, as in ``20 m/s``."""

_LETTERS: Final = "abcdefghijklmnopqrstuvwxyzHz%"


class OneLinePrinter:
    """Prints the expressions of a source on one line, in one style."""

    def __init__(self, source: SourceFile, style: Style) -> None:
        self._source = source
        self._style = style

    def text(self, node: Expr, room: int = ENDLESS) -> str | None:
        """Return an expression as text on one line, or None if it takes more than ``room`` columns.

        Comments inside the expression are left out. The printer stops as soon as the room is used
        up, so even a very long expression takes little time.
        """
        if room <= 0:
            return None
        match node:
            case tree.NameExpr():
                text: str | None = node.name
            case tree.NumberExpr():
                text = str(self.number(node))
            case tree.CallExpr():
                inner = self._arguments(node, room - len(node.name) - 2)
                text = None if inner is None else f"{node.name}({inner})"
            case tree.BinaryExpr(op="within"):
                text = self._response(node, room)
            case tree.BinaryExpr():
                text = self._chain(node, room)
            case tree.IsExpr():
                tail = self.is_tail(node)
                operand = self.text(node.operand, room - len(tail))
                text = None if operand is None else operand + tail
            case tree.Unary():
                head = self.prefix(node)
                operand = self.text(node.operand, room - len(head))
                text = None if operand is None else head + operand
            case tree.GroupExpr():
                inner = self.text(node.inner, room - 2)
                text = None if inner is None else f"({inner})"
            case tree.Constant():
                text = self._style.constants["true" if node.value else "false"]
            case tree.Quantified():
                entities = ", ".join(entity.name for entity in node.entities)
                head = f"{self.quantifier(node)} {f'({entities})' if node.brackets else entities}: "
                operand = self.text(node.body, room - len(head))
                text = None if operand is None else head + operand
            case tree.WhenExpr():
                text = self._when(node, room)
        return text if text is not None and len(text) <= room else None

    def number(self, node: tree.NumberExpr) -> Number:
        """Return a number as it is written in the source."""
        source_text = self._source.slice(node.span)
        if node.unit is None:
            return Number(source_text)
        digits = source_text.rstrip(_LETTERS)
        return Number(digits.rstrip(), source_text[len(digits) :])

    def prefix(self, node: tree.Unary) -> str:
        """Return a prefix operator as text, with its bound, and with a space at the end if needed."""
        return self._style.prefix_text(node, bound_forms(node, self.number))

    def infix(self, node: tree.BinaryExpr) -> str:
        """Return an operator between two operands, with its bound and its spaces."""
        text = self._style.infix[node.op]
        return text if node.bound is None else f"{text}within {self.number(node.bound.high)} "

    def _response(self, node: tree.BinaryExpr, room: int) -> str | None:
        assert node.bound is not None
        request, answer = self.text(node.left, room), self.text(node.right, room)
        if request is None or answer is None:
            return None
        return f"within {self.number(node.bound.high)} of {request}, {answer}"

    def quantifier(self, node: tree.Quantified) -> str:
        """Return the beginning of a quantifier: ``all x in``."""
        return f"{'all' if node.all else 'any'} {node.variable} in"

    def is_tail(self, node: tree.IsExpr) -> str:
        """Return the end of a test for a value of an enum: `` is alert`` or `` is not alert``."""
        return f" is {'not ' * node.negated}{node.value}"

    def _arguments(self, node: tree.CallExpr, room: int) -> str | None:
        texts: list[str] = []
        for argument in node.arguments:
            head = f"{argument.name} = " if argument.name else ""
            text = self.text(argument.value, room - len(head))
            if text is None:
                return None
            texts.append(head + text)
            room -= len(head) + len(text) + 2
        return ", ".join(texts)

    def _chain(self, node: tree.BinaryExpr, room: int) -> str | None:
        texts: list[str] = []
        for operator, operand in chain(node):
            head = self.infix(operator) if operator else ""
            text = self._speed(operand, room) if is_speed(operand) else self.text(operand, room - len(head))
            if text is None:
                return None
            texts += (head, text)
            room -= len(head) + len(text)
        return "".join(texts)

    def _speed(self, node: Expr, room: int) -> str | None:
        """Return the text of a quotient with units such as ``20 m/s``.

        Returns None if the text takes more than ``room`` columns.
        """
        assert isinstance(node, tree.BinaryExpr)
        denominator = self.text(node.right, room)
        return None if denominator is None else f"{self.text(node.left)}/{denominator}"

    def _when(self, node: tree.WhenExpr, room: int) -> str | None:
        texts: list[str] = []
        for case in node.cases:
            condition, value = self.text(case.condition, room), self.text(case.value, room)
            if condition is None or value is None:
                return None
            texts.append(f"when {condition}: {value} ")
            room -= len(texts[-1])
        value = self.text(node.otherwise, room)
        return None if value is None else f"{''.join(texts)}otherwise: {value}"


def chain(node: tree.BinaryExpr) -> Iterator[tuple[tree.BinaryExpr | None, Expr]]:
    """Yield the operands of a chain of operators with the same precedence, in order.

    Each operand comes with the node of the operator before it, or None for the first operand. For
    ``a + b - c``, the pairs are None and ``a``, ``+`` and ``b``, ``-`` and ``c``.
    """
    if is_speed(node):
        yield None, node
        return
    level = _LEVEL.get(node.op, node.op)
    pending: list[tuple[tree.BinaryExpr | None, Expr]] = [(None, node)]
    while pending:
        operator, part = pending.pop()
        if isinstance(part, tree.BinaryExpr) and _LEVEL.get(part.op, part.op) == level and not is_speed(part):
            pending += ((part, part.right), (operator, part.left))
        else:
            yield operator, part


def is_speed(node: Expr) -> bool:
    """Whether this is a quotient with units, such as ``20 m/s``, which is never broken."""
    if not isinstance(node, tree.BinaryExpr) or node.op != "/":
        return False
    denominator = node.right.left if isinstance(node.right, tree.BinaryExpr) else node.right
    return (
        isinstance(node.left, tree.NumberExpr)
        and node.left.unit is not None
        and isinstance(denominator, tree.NameExpr)
        and denominator.name in _PER
    )
