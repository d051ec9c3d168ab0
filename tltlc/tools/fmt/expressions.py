"""Lay out expressions.

An expression is on one line if it fits, else it is broken at its loosest operators and in brackets.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final, NamedTuple

from tltlc.core.source import Span
from tltlc.grammar import tree
from tltlc.grammar.tree import Expr
from tltlc.tools.fmt.flat import Flat, chain, is_speed
from tltlc.tools.fmt.page import STEP, WIDTH, Page

_ENDLESS: Final = 1 << 30
"""The room for a text that cannot be broken."""


class Item(NamedTuple):
    """An element of a list: ``head`` and then a value."""

    head: str
    value: Expr | None
    span: Span

    @property
    def is_name(self) -> bool:
        """Whether the item is only a name. Several names share a line."""
        return self.value is None and ":" not in self.head


class Expressions:
    """Writes expressions of one source on a page."""

    def __init__(self, page: Page, flat: Flat) -> None:
        self._page = page
        self._flat = flat

    def put(self, node: Expr, indent: int, behind: int = 0) -> None:
        """Write an expression. Its further lines begin at ``indent``.

        ``behind`` is the number of columns to leave free at the end of its last line.
        """
        self._page.comments(node.span.start, indent)
        text = self.fitting(node, behind)
        if text is None:
            self._put_broken(node, indent, behind)
        else:
            self._page.put(text)

    def put_value(self, node: Expr, indent: int) -> None:
        """Write an expression after ``=`` or ``:``.

        If it does not fit there, it gets lines of its own at ``indent``.
        """
        # Cases are easiest to read below each other, even if they are short.
        has_cases = isinstance(node, tree.WhenExpr)
        text = None if has_cases else self.fitting(node, 1)
        if text is not None:
            self._page.put(f" {text}")
            return
        self._page.comments(node.span.start, indent)
        self._page.end_line(indent)
        if has_cases:
            self._put_broken(node, indent, 0)
        else:
            self.put(node, indent)

    def put_behind_word(self, node: Expr, indent: int) -> None:
        """Write an expression after a keyword.

        It starts on a new line if its first operand takes several lines.
        """
        self._page.comments(node.span.start, indent)
        if isinstance(node, tree.BinaryExpr) and self.fitting(next(chain(node))[1]) is None:
            self._page.end_line(indent)
        self.put(node, indent)

    def fitting(self, node: Expr, behind: int = 0) -> str | None:
        """Return the expression on one line, or None.

        It is None if the current line is too short or a comment is inside the expression.
        """
        if self._page.has_comment(node.span.end):
            return None
        return self._flat.text(node, self._page.room - behind)

    def put_list(self, items: Sequence[Item], indent: int) -> None:
        """Write elements with commas, as many on a line as fit.

        Further lines begin at ``indent``.
        """
        for place, item in enumerate(items):
            comma = "," if place < len(items) - 1 else ""
            self._page.comments(item.span.start, indent)
            if place and not self._page.is_fresh:
                text = self._item_text(item)
                if text is not None and 1 + len(text) + len(comma) <= self._page.room:
                    self._page.put(" ")
                else:
                    self._page.end_line(indent)
            self._put_item(item, indent + STEP, comma)

    def put_in_brackets(self, items: Sequence[Item], end: int | None = None, behind: int = 0) -> None:
        """Write elements in ``(…)``.

        They stay on this line if they fit, else they share one line of their own or get one line
        each. ``end`` is the offset after the closing bracket. If it is None, the next bracket is
        found.
        """
        page, outer = self._page, self._page.indent
        if end is None:
            end = page.find(")", items[-1].span.end) + 1
        whole = self._joined(items, end)
        if whole is not None and len(whole) + 2 + behind <= page.room:
            page.put(f"({whole})")
            return
        page.put("(")
        is_short = whole is not None and len(whole) <= WIDTH - outer - STEP
        if not is_short and self._is_hugged(items, end, page.room - behind):
            self._put_hugging(items, outer + STEP)
        else:
            page.end_line(outer + STEP)
            if is_short and whole is not None:
                page.put(whole)
            elif all(item.is_name for item in items):
                self.put_list(items, outer + STEP)
            else:
                self._put_lines(items, outer + STEP)
            page.comments(end - 1, outer + STEP)
            page.end_line(outer)
        page.put(")")

    # --- what is broken -------------------------------------------------------------------------

    def _put_broken(self, node: Expr, indent: int, behind: int) -> None:
        match node:
            case tree.Unary():
                self._page.put(self._flat.prefix(node))
                self.put(node.operand, indent, behind)
            case tree.Quantified():
                self._page.put(f"{self._flat.quantifier(node)} ")
                self.put_in_brackets([*map(name, node.entities)], None, 1)
                self._page.put(":")
                inner = self._page.indent + STEP
                self._page.comments(node.body.span.start, inner)
                self._page.end_line(inner)
                self.put(node.body, inner, behind)
            case tree.GroupExpr():
                self.put_in_brackets([Item("", node.inner, node.inner.span)], node.span.end, behind)
            case tree.CallExpr():
                self._page.put(node.name)
                self.put_in_brackets([*map(argument, node.arguments)], node.span.end, behind)
            case tree.WhenExpr():
                self._put_when(node, indent)
            case tree.BinaryExpr() if not is_speed(node):
                self._put_chain(node, indent, behind)
            case _:
                self._page.comments(node.span.end, indent)
                self._page.put(self._flat.text(node, _ENDLESS) or "")

    def _put_chain(self, node: tree.BinaryExpr, indent: int, behind: int) -> None:
        """Write operands on lines that begin with their operators.

        Comments move in front of the operators.
        """
        operands = [*chain(node)]
        for place, (operator, operand) in enumerate(operands):
            last = behind if place == len(operands) - 1 else 0
            if operator is not None:
                self._page.comments(operand.span.end if is_speed(operand) else operand.span.start, indent)
                self._page.end_line(indent)
                self._page.put(self._flat.infix(operator.op))
            self.put(operand, indent + STEP, last)

    def _put_when(self, node: tree.WhenExpr, indent: int) -> None:
        """Write each case on a line, with the values in one column if they fit."""
        column = self._value_column(node, indent)
        for case in node.cases:
            self._page.comments(case.span.start, indent)
            self._page.end_line(indent)
            self._page.put("when ")
            self.put(case.condition, indent + 2 * STEP, 1)
            self._page.put(":".ljust(column - WIDTH + self._page.room))
            self.put_value(case.value, indent + STEP)
        otherwise = self._page.find("otherwise", node.cases[-1].span.end)
        self._page.comments(otherwise, indent)
        self._page.end_line(indent)
        self._page.put("otherwise:".ljust(column - indent))
        self.put_value(node.otherwise, indent + STEP)

    def _value_column(self, node: tree.WhenExpr, indent: int) -> int:
        """Return the column where the values of all cases can begin, or 0 if there is none.

        It is one blank after the end of the widest condition.
        """
        heads = [self._flat.text(case.condition, WIDTH) for case in node.cases]
        values = [self._flat.text(value, WIDTH) for value in (*(case.value for case in node.cases), node.otherwise)]
        column = indent + max(len(f"when {head}:") for head in heads)
        fits = None not in heads and all(text is not None and column + 1 + len(text) < WIDTH for text in values)
        return column if fits else 0

    # --- elements of lists ----------------------------------------------------------------------

    def _put_lines(self, items: Sequence[Item], indent: int) -> None:
        """Write each element on a line. A single element is not indented further."""
        for place, item in enumerate(items):
            self._page.comments(item.span.start, indent)
            self._page.end_line(indent)
            self._put_item(item, indent + STEP if len(items) > 1 else indent, "," if place < len(items) - 1 else "")

    def _put_hugging(self, items: Sequence[Item], indent: int) -> None:
        """Write elements after each other. The large one is broken inside its brackets."""
        for place, item in enumerate(items):
            comma = ", " if place < len(items) - 1 else ""
            # The brackets are broken even if they would fit on their own.
            self._put_item(item, indent, comma, 0 if _is_simple(item.value) else WIDTH)

    def _put_item(self, item: Item, indent: int, comma: str, behind: int = 0) -> None:
        if item.head:
            self._page.put(item.head)
        if item.value is not None:
            self.put(item.value, indent, len(comma) + behind)
        if comma:
            self._page.put(comma)

    def _item_text(self, item: Item) -> str | None:
        """Return an element on one line, or None if it is too long or contains a comment."""
        if self._page.has_comment(item.span.end):
            return None
        text = "" if item.value is None else self._flat.text(item.value)
        return None if text is None else item.head + text

    def _joined(self, items: Sequence[Item], end: int) -> str | None:
        """Return all elements on one line, or None if they are too long or contain a comment."""
        if self._page.has_comment(end):
            return None
        texts: list[str] = []
        room = WIDTH
        for item in items:
            text = self._item_text(item) if room > 0 else None
            if text is None:
                return None
            texts.append(text)
            room -= len(text)
        return ", ".join(texts)

    def _is_hugged(self, items: Sequence[Item], end: int, room: int) -> bool:
        """Whether the only large element shares lines with the brackets, as in ``clamp(min(``."""
        large = [item.value for item in items if not _is_simple(item.value)]
        if len(large) != 1 or not isinstance(large[0], (tree.CallExpr, tree.GroupExpr)):
            return False
        inner = large[0].span
        if self._page.has_comment(inner.start) or self._page.has_comment(end, inner.end):
            return False
        opening = large[0].name if isinstance(large[0], tree.CallExpr) else ""
        small = [self._flat.text(item.value) or "" for item in items if item.value and item.value is not large[0]]
        return sum(len(item.head) + 2 for item in items) + len("".join(small)) + len(opening) <= room


def argument(node: tree.Argument) -> Item:
    """Return the item for an argument of a call."""
    return Item(f"{node.name} = " if node.name else "", node.value, node.span)


def name(node: tree.NameExpr) -> Item:
    """Return the item for a name in a list of names."""
    return Item(node.name, None, node.span)


def _is_simple(node: Expr | None) -> bool:
    while isinstance(node, tree.Unary) and node.op == "-":
        node = node.operand
    return isinstance(node, (tree.NameExpr, tree.NumberExpr, tree.Constant))
