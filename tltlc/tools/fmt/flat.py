"""An expression on one line."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Final

from tltlc.core.source import SourceFile
from tltlc.grammar import tree
from tltlc.grammar.tree import Expr
from tltlc.tools.fmt import bounds
from tltlc.tools.fmt.page import WIDTH
from tltlc.tools.fmt.style import Style

_LEVEL: Final = {"-": "+", "/": "*", "W": "U", "R": "U", "M": "U"}
"""Operators of the same strength, under one of their names."""

_PER: Final = ("s", "h", "ms", "min")
"""Units behind the stroke of ``20 m/s``."""

_LETTERS: Final = "abcdefghijklmnopqrstuvwxyzHz%"


class Flat:
    """Writes expressions of one source on one line, in one style."""

    def __init__(self, source: SourceFile, style: Style) -> None:
        self._source = source
        self._style = style

    def text(self, node: Expr, room: int = WIDTH) -> str | None:
        """The expression, or None where it takes more than ``room`` columns; comments in it are not looked at.

        It gives up early, so that a long expression costs no more than a line of it.
        """
        if room <= 0:
            return None
        match node:
            case tree.Name():
                text: str | None = node.name
            case tree.Number():
                text = self.number(node)
            case tree.Call():
                inner = self._arguments(node, room - len(node.name) - 2)
                text = None if inner is None else f"{node.name}({inner})"
            case tree.Binary():
                text = self._chain(node, room)
            case tree.Unary():
                head = self.prefix(node)
                operand = self.text(node.operand, room - len(head))
                text = None if operand is None else head + operand
            case tree.Group():
                inner = self.text(node.inner, room - 2)
                text = None if inner is None else f"({inner})"
            case tree.Constant():
                text = self._style.constants["true" if node.value else "false"]
            case tree.Quantified():
                entities = ", ".join(entity.name for entity in node.entities)
                head = f"{self.quantifier(node)} ({entities}): "
                operand = self.text(node.body, room - len(head))
                text = None if operand is None else head + operand
            case tree.When():
                text = self._when(node, room)
        return text if text is not None and len(text) <= room else None

    def number(self, node: tree.Number) -> str:
        """A number as it is written, with a space before its unit."""
        written = self._source.slice(node.span)
        if node.unit is None:
            return written
        count = written.rstrip(_LETTERS)
        return f"{count.rstrip()} {written[len(count) :]}"

    def prefix(self, node: tree.Unary) -> str:
        """The operator before an operand, with its bound and its space."""
        return self._style.before(node, bounds.forms(node, self.number))

    def infix(self, op: str) -> str:
        """An operator between two operands, with its spaces."""
        return self._style.infix[op]

    def quantifier(self, node: tree.Quantified) -> str:
        """``all x in``."""
        return f"{'all' if node.all else 'any'} {node.variable} in"

    def _arguments(self, node: tree.Call, room: int) -> str | None:
        found: list[str] = []
        for argument in node.arguments:
            head = f"{argument.name} = " if argument.name else ""
            text = self.text(argument.value, room - len(head))
            if text is None:
                return None
            found.append(head + text)
            room -= len(head) + len(text) + 2
        return ", ".join(found)

    def _chain(self, node: tree.Binary, room: int) -> str | None:
        found: list[str] = []
        for operator, operand in chain(node):
            head = self.infix(operator.op) if operator else ""
            text = self._speed(operand, room) if is_speed(operand) else self.text(operand, room - len(head))
            if text is None:
                return None
            found += (head, text)
            room -= len(head) + len(text)
        return "".join(found)

    def _speed(self, node: Expr, room: int) -> str | None:
        """``20 m/s``."""
        assert isinstance(node, tree.Binary)
        under = self.text(node.right, room)
        return None if under is None else f"{self.text(node.left)}/{under}"

    def _when(self, node: tree.When, room: int) -> str | None:
        found: list[str] = []
        for case in node.cases:
            condition, value = self.text(case.condition, room), self.text(case.value, room)
            if condition is None or value is None:
                return None
            found.append(f"when {condition}: {value} ")
            room -= len(found[-1])
        value = self.text(node.otherwise, room)
        return None if value is None else f"{''.join(found)}otherwise: {value}"


def chain(node: tree.Binary) -> Iterator[tuple[tree.Binary | None, Expr]]:
    """The operands of operators of the same strength, in order, each with the operator before it."""
    if is_speed(node):
        yield None, node
        return
    level = _LEVEL.get(node.op, node.op)
    waiting: list[tuple[tree.Binary | None, Expr]] = [(None, node)]
    while waiting:
        operator, part = waiting.pop()
        if isinstance(part, tree.Binary) and _LEVEL.get(part.op, part.op) == level and not is_speed(part):
            waiting += ((part, part.right), (operator, part.left))
        else:
            yield operator, part


def is_speed(node: Expr) -> bool:
    """Whether this is a quotient of units, such as ``20 m/s``, which stands together."""
    if not isinstance(node, tree.Binary) or node.op != "/":
        return False
    under = node.right.left if isinstance(node.right, tree.Binary) else node.right
    return (
        isinstance(node.left, tree.Number)
        and node.left.unit is not None
        and isinstance(under, tree.Name)
        and under.name in _PER
    )
