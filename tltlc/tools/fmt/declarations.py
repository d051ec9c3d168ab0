"""Lay out declarations: heads, bodies after ``=``, and blocks with a clause on each line."""

from __future__ import annotations

from collections.abc import Sequence, Set

from tltlc.core.source import SourceFile, Span
from tltlc.grammar import tree
from tltlc.grammar.tree import Expr
from tltlc.logic.text.one_line import OneLinePrinter
from tltlc.tools.fmt.expressions import Expressions, Item, head_end, name_item
from tltlc.tools.fmt.page import STEP, WIDTH, Page


class DeclarationPrinter:
    """Writes the declarations of a source on a page.

    ``joints`` are offsets in the source. Text that begins at such an offset in the source does not
    begin a new line of the page, but follows on the line before.
    """

    def __init__(self, source: SourceFile, page: Page, one_line: OneLinePrinter, joints: Set[int]) -> None:
        self._source = source
        self._page = page
        self._one_line = one_line
        self._joints = joints
        self._expressions = Expressions(page, one_line)

    def put(self, node: tree.Declaration) -> None:
        """Write a declaration on lines of its own.

        Comments inside the declaration are written before its last word. If a ``///`` comment came
        after that word, it would document the next declaration.
        """
        match node:
            case tree.Import():
                self._put_import(node)
            case tree.SignalDecl() if node.values:
                self._put_head("signal", node, "", None, node.span.end - 1)
                self._page.put(": ")
                self._expressions.put_in_brackets([*map(name_item, node.values)], node.span.end)
            case tree.SignalDecl():
                self._put_head("signal", node, node.type, node.interval, node.span.end - 1)
            case tree.EntityDecl():
                self._page.put("entity ")
                self._expressions.put_list([*map(name_item, node.names)], STEP)
            case tree.GroupDecl():
                self._page.put(f"entity {node.name} = ")
                self._expressions.put_list([*map(name_item, node.members)], STEP)
            case tree.ParamDecl():
                self._put_head("param", node, node.type, node.interval, node.value.span.start)
                self._put_body(node.value)
            case tree.ClockDecl():
                self._page.put("clock " if node.value else "clock varies")
                if node.value:
                    self._expressions.put(node.value, STEP)
            case tree.PredicateDecl():
                self._put_head("predicate", node, None, node.interval, node.body.span.start)
                self._put_body(node.body)
            case tree.LetDecl():
                self._put_head("let", node, None, None, node.body.span.start)
                self._put_body(node.body)
            case tree.ExclusiveDecl():
                self._page.put("exclusive ")
                self._expressions.put_list([Item("", atom, atom.span) for atom in node.atoms], STEP)
            case tree.SpecDecl() if not node.block:
                (clause,) = node.clauses
                assert not isinstance(clause.value, tuple)
                self._put_words("spec", node.name, node.name_span.end)
                self._put_body(clause.value)
            case tree.SpecDecl():
                self._put_words("spec", node.name, node.name_span.end)
                self._put_block(node.span, node.name_span.end, node.clauses)
            case tree.TestDecl():
                self._put_words("test", f'"{node.title}" for {node.spec.name}', node.spec.span.end)
                self._put_block(node.span, node.spec.span.end, node.items)

    # --- heads ----------------------------------------------------------------------------------

    def _put_words(self, keyword: str, rest: str, end: int) -> None:
        """Write ``keyword``, a space and ``rest`` on one line.

        In the source, ``rest`` ends at the offset ``end``. Comments before this offset are written
        after the keyword.
        """
        self._page.put(keyword)
        self._page.put_comments(end, STEP)
        self._page.put(f" {rest}")

    def _put_import(self, node: tree.Import) -> None:
        target = f'"{node.target}"' if node.is_path else node.target
        self._put_words("import", target, node.target_span.end)
        if node.names is not None:
            self._page.put(" ")
            self._expressions.put_in_brackets([*map(name_item, node.names)])
        elif node.alias is not None:
            self._page.put_comments(node.span.end, STEP)
            self._page.put(f" as {node.alias}")

    def _put_head(
        self,
        keyword: str,
        node: tree.SignalDecl | tree.ParamDecl | tree.PredicateDecl | tree.LetDecl,
        type_: str | None,
        interval: tree.Interval | None,
        end: int,
    ) -> None:
        """Write the head of a declaration: ``keyword NAME(parameters): type in [low, high]``.

        Each part but the keyword and the name may be missing. Comments inside the head in the source
        are written inside the head, too. If there is a type but no range, the head ends at the
        offset ``end``.
        """
        self._put_words(keyword, node.name, node.name_span.end)
        rest = (f": {type_}" if type_ else "") + (f" {self._range(interval)}" if interval else "")
        if not isinstance(node, tree.ParamDecl) and node.parameters:
            items = [self._parameter(parameter) for parameter in node.parameters]
            reserved = len(rest) + (0 if isinstance(node, tree.SignalDecl) else 2)
            self._expressions.put_in_brackets(items, None, reserved)
        if rest:
            self._page.put_comments(interval.span.end if interval else end, STEP)
            self._page.put(rest)

    def _range(self, interval: tree.Interval) -> str:
        low, high = (self._one_line.text(limit, 1 << 30) for limit in (interval.low, interval.high))
        return f"in [{low}, {high}]"

    def _parameter(self, node: tree.Parameter) -> Item:
        head = node.name + (f": {node.type}" if node.type else "") + (" = " if node.default else "")
        return Item(head, node.default, node.span)

    def _put_body(self, body: Expr) -> None:
        self._page.put(" =")
        self._expressions.put_value(body, STEP)

    # --- blocks ---------------------------------------------------------------------------------

    def _put_block(self, span: Span, head: int, items: Sequence[tree.Clause | tree.TestStep | tree.TestExpect]) -> None:
        """Write a block, ``{ … }``, with its items.

        The block stays on one line if it is on one line in the source and fits. Otherwise, each item
        begins a line. ``span`` is the span of the whole declaration in the source, and ``head`` the
        offset at which the text before the block ends.
        """
        page = self._page
        brace = page.find("{", head)
        if page.has_comment(brace) and "///" in self._source.text[head:brace]:
            page.put_comments(brace, STEP)
        if not page.has_comment(span.end) and "\n" not in self._source.slice(span):
            texts = [self._one_line_item(item) for item in items]
            whole = " ".join(["{", *(text for text in texts if text is not None), "}"])
            if None not in texts and len(whole) < page.room:
                page.put(f" {whole}" if items else " {}")
                return
        page.put(" {")
        page.open_block()
        for item in items:
            page.put_comments(item.span.start, STEP, gaps=True)
            page.put_gap(item.span.start)
            page.begin(item.span.start in self._joints, STEP)
            self._put_item(item)
        page.put_comments(span.end - 1, STEP, gaps=True)
        if items or page.is_at_line_start or span.end - 1 not in self._joints:
            page.begin(span.end - 1 in self._joints, 0)
        page.put("}")

    def _one_line_item(self, item: tree.Clause | tree.TestStep | tree.TestExpect) -> str | None:
        """Return an item of a block as text on one line, or None if the text would be too long."""
        if isinstance(item, tree.TestExpect):
            return f"expect {self._expectation(item)}"
        if isinstance(item, tree.TestStep):
            head, values = f"step{self._repetitions(item)}", [*item.atoms]
        elif isinstance(item.value, tuple):
            return f"{item.kind} {', '.join(part.name for part in item.value)}"
        else:
            head, values = _keyword(item), [item.value]
        texts = [self._one_line.text(value, WIDTH) for value in values]
        return None if None in texts else f"{head} {', '.join(text for text in texts if text)}"

    def _put_item(self, item: tree.Clause | tree.TestStep | tree.TestExpect) -> None:
        page, indent = self._page, 2 * STEP
        if isinstance(item, tree.TestExpect):
            page.put("expect")
            page.put_comments(item.span.end, indent)
            page.put(f" {self._expectation(item)}")
        elif isinstance(item, tree.TestStep):
            page.put("step")
            page.put_comments(head_end(item.atoms[0]), indent)
            page.put(f"{self._repetitions(item)} ")
            self._expressions.put_list([Item("", atom, atom.span) for atom in item.atoms], indent)
        elif isinstance(item.value, tuple):
            page.put(f"{item.kind} ")
            self._expressions.put_list([*map(name_item, item.value)], indent)
        else:
            page.put(item.kind)
            page.put_comments(item.value.span.start, indent)
            page.put(" at " if item.kind == "judge" else " ")
            self._expressions.put_after_keyword(item.value, indent)

    def _repetitions(self, item: tree.TestStep) -> str:
        """Return the repetitions and the length of a step, such as `` 3x`` and `` for 2 s``, if the source has them."""
        times = f" {self._source.slice(item.times_span)}x" if item.times_span else ""
        return times if item.length is None else f"{times} for {self._one_line.number(item.length)}"

    def _expectation(self, item: tree.TestExpect) -> str:
        if item.number is not None and item.comparison is not None:
            return f"progress {item.comparison} {self._one_line.number(item.number)}"
        return f'state "{item.value}"' if item.kind == "state" else str(item.value)


def _keyword(clause: tree.Clause) -> str:
    return "judge at" if clause.kind == "judge" else clause.kind
