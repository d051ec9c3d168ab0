"""Lay out expressions.

An expression that does not fit on one line is broken at its loosest operators and in brackets.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

from tltlc.core.source import Span
from tltlc.grammar import tree
from tltlc.grammar.tree import Expr
from tltlc.logic.text.one_line import ENDLESS, OneLinePrinter, chain, is_speed
from tltlc.tools.fmt.page import STEP, WIDTH, Page


class Item(NamedTuple):
    """An element of a list: the text ``head``, then the expression ``value`` if it is not None."""

    head: str
    value: Expr | None
    span: Span

    @property
    def is_name(self) -> bool:
        """Whether the item is only a name. Names share lines; other items may get a line each."""
        return self.value is None and ":" not in self.head


def head_end(value: Expr) -> int:
    """Return the offset up to which comments come before an item: its end if it stays whole, else its start."""
    is_setting = isinstance(value, tree.BinaryExpr) and value.op == "="
    return value.span.end if is_setting or is_speed(value) or isinstance(value, tree.IsExpr) else value.span.start


class Expressions:
    """Writes expressions of a source on a page.

    In the methods, ``indent`` is the column at which each line after the first begins, and
    ``reserved`` is the number of columns to leave free at the end of the last line.
    """

    def __init__(self, page: Page, one_line: OneLinePrinter) -> None:
        self._page = page
        self._one_line = one_line

    def put(self, node: Expr, indent: int, reserved: int = 0) -> None:
        """Write an expression on the current line if it fits, else broken into several lines."""
        self._page.put_comments(node.span.start, indent)
        text = self.one_line_text(node, reserved)
        if text is None:
            self._put_broken(node, indent, reserved)
        else:
            self._page.put(text)

    def put_value(self, node: Expr, indent: int) -> None:
        """Write an expression after ``=`` or ``:``.

        It begins on the current line if all of it fits there, else on a new line. A ``when``
        expression always begins on a new line.
        """
        # Cases are easiest to read on lines of their own, even if they are short.
        has_cases = isinstance(node, tree.WhenExpr)
        text = None if has_cases else self.one_line_text(node, 1)
        if text is not None:
            self._page.put(f" {text}")
            return
        self._page.put_comments(node.span.start, indent)
        self._page.end_line(indent)
        if has_cases:
            self._put_broken(node, indent, 0)
        else:
            self.put(node, indent)

    def put_after_keyword(self, node: Expr, indent: int) -> None:
        """Write an expression after a keyword.

        It begins on a new line only if its first operand does not fit on the current line.
        """
        self._page.put_comments(node.span.start, indent)
        if isinstance(node, tree.BinaryExpr) and self.one_line_text(next(chain(node))[1]) is None:
            self._page.end_line(indent)
        self.put(node, indent)

    def one_line_text(self, node: Expr, reserved: int = 0) -> str | None:
        """Return an expression as text on one line.

        Return None if the text does not fit on the current line, or if the expression has a comment.
        """
        if self._page.has_comment(node.span.end):
            return None
        return self._one_line.text(node, self._page.room - reserved)

    def put_list(self, items: Sequence[Item], indent: int) -> None:
        """Write items with commas between them, as many on each line as fit."""
        for place, item in enumerate(items):
            comma = "," if place < len(items) - 1 else ""
            self._page.put_comments(item.span.start if item.value is None else head_end(item.value), indent)
            if place and not self._page.is_at_line_start:
                text = self._item_text(item)
                if text is not None and 1 + len(text) + len(comma) <= self._page.room:
                    self._page.put(" ")
                else:
                    self._page.end_line(indent)
            self._put_item(item, indent + STEP, comma)

    def put_in_brackets(self, items: Sequence[Item], end: int | None = None, reserved: int = 0) -> None:
        """Write items in ``(…)``.

        If they fit, they stay on this line. Otherwise they share a line of their own, or get a line
        each, or only one large item is broken (:meth:`_is_hugged`). ``end`` is the offset after the
        closing bracket in the source; for None, the method searches for this offset.
        """
        page, outer = self._page, self._page.indent
        if end is None:
            end = page.find(")", items[-1].span.end) + 1
        whole = self._joined_text(items, end)
        if whole is not None and len(whole) + 2 + reserved <= page.room:
            page.put(f"({whole})")
            return
        page.put("(")
        is_short = whole is not None and len(whole) <= WIDTH - outer - STEP
        if not is_short and self._is_hugged(items, end, page.room - reserved):
            self._put_hugging(items, outer + STEP)
        else:
            page.end_line(outer + STEP)
            if is_short and whole is not None:
                page.put(whole)
            elif all(item.is_name for item in items):
                self.put_list(items, outer + STEP)
            else:
                self._put_lines(items, outer + STEP)
            page.put_comments(end - 1, outer + STEP)
            page.end_line(outer)
        page.put(")")

    # --- broken expressions ---------------------------------------------------------------------

    def _put_broken(self, node: Expr, indent: int, reserved: int) -> None:
        match node:
            case tree.Unary():
                self._page.put(self._one_line.prefix(node))
                self.put(node.operand, indent, reserved)
            case tree.Quantified():
                self._page.put(f"{self._one_line.quantifier(node)} ")
                if node.brackets:
                    self.put_in_brackets([*map(name_item, node.entities)], None, 1)
                else:
                    self._page.put(node.entities[0].name)
                self._page.put(":")
                inner = self._page.indent + STEP
                self._page.put_comments(node.body.span.start, inner)
                self._page.end_line(inner)
                self.put(node.body, inner, reserved)
            case tree.GroupExpr():
                self.put_in_brackets([Item("", node.inner, node.inner.span)], node.span.end, reserved)
            case tree.CallExpr():
                self._page.put(node.name)
                self.put_in_brackets([*map(argument_item, node.arguments)], node.span.end, reserved)
            case tree.IsExpr():
                tail = self._one_line.is_tail(node)
                self._page.put_comments(node.span.end, indent)
                self.put(node.operand, indent, reserved + len(tail))
                self._page.put(tail)
            case tree.WhenExpr():
                self._put_when(node, indent)
            case tree.BinaryExpr() if not is_speed(node) and node.op not in ("within", "="):
                self._put_chain(node, indent, reserved)
            case _:
                self._page.put_comments(node.span.end, indent)
                self._page.put(self._one_line.text(node, ENDLESS) or "")

    def _put_chain(self, node: tree.BinaryExpr, indent: int, reserved: int) -> None:
        """Write the operands of a chain such as ``a and b and c``, each on its own line.

        Each line but the first begins with the operator before its operand. A comment between an
        operator and its operand moves before the operator.
        """
        operands = [*chain(node)]
        for place, (operator, operand) in enumerate(operands):
            operand_reserved = reserved if place == len(operands) - 1 else 0
            if operator is not None:
                is_whole = is_speed(operand) or isinstance(operand, tree.IsExpr)
                self._page.put_comments(operand.span.end if is_whole else operand.span.start, indent)
                self._page.end_line(indent)
                self._page.put(self._one_line.infix(operator))
            self.put(operand, indent + STEP, operand_reserved)

    def _put_when(self, node: tree.WhenExpr, indent: int) -> None:
        """Write each case ``when CONDITION: VALUE`` on a line, then ``otherwise: VALUE``.

        If all of these lines fit, their values begin in one column.
        """
        column = self._value_column(node, indent)
        for case in node.cases:
            self._page.put_comments(case.span.start, indent)
            self._page.end_line(indent)
            self._page.put("when ")
            self.put(case.condition, indent + 2 * STEP, 1)
            self._page.put(":".ljust(column - WIDTH + self._page.room))
            self.put_value(case.value, indent + STEP)
        otherwise = self._page.find("otherwise", node.cases[-1].span.end)
        self._page.put_comments(otherwise, indent)
        self._page.end_line(indent)
        self._page.put("otherwise:".ljust(column - indent))
        self.put_value(node.otherwise, indent + STEP)

    def _value_column(self, node: tree.WhenExpr, indent: int) -> int:
        """Return the column after the colon of the longest ``when CONDITION:``.

        If all values begin one column further, they are aligned. Return 0 if a line would then be
        too long.
        """
        heads = [self._one_line.text(case.condition, WIDTH) for case in node.cases]
        values = [self._one_line.text(value, WIDTH) for value in (*(case.value for case in node.cases), node.otherwise)]
        column = indent + max(len(f"when {head}:") for head in heads)
        fits = None not in heads and all(text is not None and column + 1 + len(text) < WIDTH for text in values)
        return column if fits else 0

    # --- items of lists -------------------------------------------------------------------------

    def _put_lines(self, items: Sequence[Item], indent: int) -> None:
        """Write each item on a new line. If there are several items, indent the continuation lines of each."""
        for place, item in enumerate(items):
            self._page.put_comments(item.span.start, indent)
            self._page.end_line(indent)
            self._put_item(item, indent + STEP if len(items) > 1 else indent, "," if place < len(items) - 1 else "")

    def _put_hugging(self, items: Sequence[Item], indent: int) -> None:
        """Write the items one after another on this line, and break the large item inside its brackets.

        :meth:`_is_hugged` says which item is large.
        """
        for place, item in enumerate(items):
            comma = ", " if place < len(items) - 1 else ""
            # Reserve a whole line, so that the large item is broken even if it fits.
            self._put_item(item, indent, comma, 0 if _is_simple(item.value) else WIDTH)

    def _put_item(self, item: Item, indent: int, comma: str, reserved: int = 0) -> None:
        if item.head:
            self._page.put(item.head)
        if item.value is not None:
            self.put(item.value, indent, len(comma) + reserved)
        if comma:
            self._page.put(comma)

    def _item_text(self, item: Item) -> str | None:
        """Return an item as text on one line, or None if the text is too long or the item has a comment."""
        if self._page.has_comment(item.span.end):
            return None
        text = "" if item.value is None else self._one_line.text(item.value)
        return None if text is None else item.head + text

    def _joined_text(self, items: Sequence[Item], end: int) -> str | None:
        """Return all items as text on one line, with commas between them.

        Return None if the text would be too long, or if there is a comment before the offset ``end``.
        """
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
        """Whether a call may be laid out as ``f(1, g(`` on one line, with the arguments of ``g`` below it.

        Three things must be true:

        - exactly one of ``items`` is large, that is, more than a name, a number or a constant;
        - this item is a call or an expression in brackets;
        - the text up to its opening bracket, and the other items, fit into ``room`` columns.

        ``end`` is the offset after the closing bracket of the whole call in the source.
        """
        large = [item.value for item in items if not _is_simple(item.value)]
        if len(large) != 1 or not isinstance(large[0], (tree.CallExpr, tree.GroupExpr)):
            return False
        inner = large[0].span
        if self._page.has_comment(inner.start) or self._page.has_comment(end, inner.end):
            return False
        opening = large[0].name if isinstance(large[0], tree.CallExpr) else ""
        small = [self._one_line.text(item.value) or "" for item in items if item.value and item.value is not large[0]]
        return sum(len(item.head) + 2 for item in items) + len("".join(small)) + len(opening) <= room


def argument_item(node: tree.Argument) -> Item:
    """Return the item for an argument of a call."""
    return Item(f"{node.name} = " if node.name else "", node.value, node.span)


def name_item(node: tree.NameExpr) -> Item:
    """Return the item for a name in a list of names."""
    return Item(node.name, None, node.span)


def _is_simple(node: Expr | None) -> bool:
    while isinstance(node, tree.Unary) and node.op == "-":
        node = node.operand
    return isinstance(node, (tree.NameExpr, tree.NumberExpr, tree.Constant))
