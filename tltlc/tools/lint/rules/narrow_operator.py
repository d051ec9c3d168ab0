"""TLT0446: a word that applies to less than it seems to, as in `eventually a or b`, read as `(eventually a) or b`."""

from __future__ import annotations

from collections.abc import Container, Iterator, Sequence
from itertools import takewhile
from typing import Final

from tltlc.core.source import SourceFile, Span
from tltlc.diagnostics.diagnostic import Label
from tltlc.grammar import walk
from tltlc.grammar.tree import BinaryExpr, Constant, Expr, GroupExpr, LetDecl, Quantified, SpecDecl, Unary
from tltlc.tools.lint.file_view import FileView, without_brackets
from tltlc.tools.lint.rule import LintRule, RuleFinding
from tltlc.tools.lint.rules.idle_until import is_until

_CHAINS: Final = ("and", "or")
_ORDERED: Final = ("U", "W", "since")
_INFIX_WORDS: Final = ("until", "weak_until", "since")
_FUTURE_WORDS: Final = ("eventually", "always")
_NEXT_WORDS: Final = ("next", "weak_next")
_PAST_WORDS: Final = ("once", "historically")
_FUTURE: Final = ("F", "G", "X", "N", "U", "W", "R", "M", "then", "within")
_TEMPORAL: Final = (*_FUTURE, "since", "previously", *_PAST_WORDS)


def check(view: FileView) -> Iterator[RuleFinding]:
    """Yield a finding for each word that ends before an infix operator, although the operand after it has no such word.

    Also yield one for `until`, `weak_until` and `since` beside `and` and `or`, as in `a until b or c`.
    The words are `eventually` and `always` before `and`, `or`, `until`, `weak_until` and `since`; `next`, `once` and
    `historically` before the last three, and with a bound before `or`; `previously` before `or`. The letters F and G
    are left out, and so are operands in brackets, which show how far the word applies; but not `(a and b)` before `or`,
    nor `always (a)` before `until` and `weak_until`: in a sentence, "always a until b" is a until b.
    """
    avoided = {id(value.tree) for spec in view.specs for _, value in spec.clauses("avoid")}
    for declaration in view.module.declarations:
        if isinstance(declaration, (LetDecl, SpecDecl)):
            for expression in walk.expressions(declaration):
                # Of `avoid a until b and c`, another finding says that the first half has no effect.
                if id(expression) not in avoided or not any(map(is_until, walk.operands(expression, "and"))):
                    yield from _findings(expression, _anew(declaration, expression), view.source)


def _anew(declaration: LetDecl | SpecDecl, expression: Expr) -> set[int]:
    """Return the ids of the parts of a clause that no `until` alone may replace.

    These are all parts of an `avoid` clause, and the conjuncts of a `keep` clause, which begin anew at each step.
    """
    if isinstance(declaration, SpecDecl):
        kinds = {clause.kind for clause in declaration.clauses if clause.value is expression}
        if "avoid" in kinds:
            return {id(part) for part in walk.parts(expression)}
        if "keep" in kinds:
            return {id(without_brackets(part)) for part in walk.conjuncts(expression)}
    return set()


def _findings(expression: Expr, anew: Container[int], source: SourceFile) -> Iterator[RuleFinding]:
    """Yield the findings in an expression; ``anew`` has the ids of :func:`_anew`."""
    inner: set[int] = set()
    chained: set[int] = set()
    for part in walk.parts(expression):
        if not isinstance(part, BinaryExpr) or part.op not in (*_CHAINS, *_ORDERED):
            continue
        operands = [part.left, part.right]
        if part.op in _CHAINS:
            chained |= {*map(id, operands)}
            inner |= {id(link) for link in operands if isinstance(link, BinaryExpr) and link.op == part.op}
            operands = walk.operands(part, part.op) if id(part) not in inner else []
        for place, operand in enumerate(operands):
            is_lasting = _is_always_until(operand, part.op, source) and id(part) not in anew
            if isinstance(operand, Unary) and (is_lasting or _is_narrow(operand, part.op, source)):
                is_timed = operand.op == "F" and operand.bound is not None
                is_beside = _is_in_time if is_timed else _is_about_one_step
                following = [*takewhile(is_beside, operands[place + 1 :])]
                if following:
                    is_past = operand.op in (*_PAST_WORDS, "previously")
                    one_reading = is_past and _has_future(part)
                    until = _until_text(part, source, is_chained=id(part) in chained) if is_lasting else ""
                    yield _finding(operand, part.op, following, source, one_reading=one_reading, until=until)
            if isinstance(operand, BinaryExpr) and source.slice(operand.op_span) in _INFIX_WORDS and operands[1:]:
                before = [] if isinstance(operand.left, GroupExpr) else _states_before(operands[:place])
                after = [] if isinstance(operand.right, GroupExpr) else operands[place + 1 :]
                beside = before, [*takewhile(_is_about_one_step, after)]
                if any(beside):
                    yield _infix_finding(operand, *beside, source)


def _is_always_until(operand: Expr, op: str, source: SourceFile) -> bool:
    """Whether an operand of ``op`` is `always a`, without a bound, before `until` or `weak_until`."""
    is_always = isinstance(operand, Unary) and operand.bound is None and source.slice(operand.op_span) == "always"
    return is_always and op in ("U", "W")


def _is_narrow(operand: Unary, op: str, source: SourceFile) -> bool:
    """Whether an operand of an infix operator begins with a word that seems to apply to the whole."""
    word = source.slice(operand.op_span)
    if isinstance(operand.operand, GroupExpr):
        inside = without_brackets(operand.operand)
        if word == "once" and op == "since":
            return True
        # The brackets of `eventually (a and b) or (c and d)` may be there because of `and` alone.
        if op != "or" or not isinstance(inside, BinaryExpr) or inside.op != "and":
            return False
    if word in _FUTURE_WORDS or (word in _NEXT_WORDS and op in _ORDERED):
        return True
    if word == "previously":
        return op == "or"
    return word in _PAST_WORDS and (op in _ORDERED or (op == "or" and operand.bound is not None))


def _is_about_one_step(tree: Expr) -> bool:
    """Whether an operand has no word for other steps as its outermost operator, apart from `not` and quantifiers.

    The constants do not count as operands: with them, all readings are the same.
    """
    tree = without_brackets(tree)
    while isinstance(tree, Quantified) or (isinstance(tree, Unary) and tree.op == "not"):
        tree = without_brackets(tree.body if isinstance(tree, Quantified) else tree.operand)
    return not (isinstance(tree, Constant) or (isinstance(tree, (Unary, BinaryExpr)) and tree.op in _TEMPORAL))


def _is_in_time(tree: Expr) -> bool:
    """Whether an operand may be what must come in time, too: one about one step, or `(a until b)`."""
    inside = without_brackets(tree)
    return _is_about_one_step(tree) or (
        isinstance(tree, GroupExpr) and isinstance(inside, BinaryExpr) and inside.op in ("U", "W")
    )


def _has_future(tree: Expr) -> bool:
    """Whether an expression has an operator about later steps, which no operator about the past may contain."""
    return any(isinstance(part, (Unary, BinaryExpr)) and part.op in _FUTURE for part in walk.parts(tree))


def _finding(
    operator: Unary, op: str, following: Sequence[Expr], source: SourceFile, *, one_reading: bool, until: str
) -> RuleFinding:
    """Return the finding for an operator that ends before an infix operator ``op`` and its operands ``following``.

    If ``one_reading``, the operator cannot apply to all of them. ``until`` is the text without the operator, if this is
    what people mean.
    """
    word, operand, end = source.slice(operator.op_span), operator.operand, following[-1].span.end

    def text(start: int, end: int) -> str:
        return " ".join(source.text[start:end].split())

    first = text(operand.span.start, operand.span.end)
    wide = f"{text(operator.span.start, operand.span.start)} ({text(operand.span.start, end)})"
    narrow = f"({text(operator.span.start, operator.span.end)}) {text(operator.span.end, end)}"
    label = Label(source, Span(operator.span.start, end), f"read as `{narrow}`")
    together = "both" if len(following) == 1 else "all of them"
    readings = f"`{wide}` if it applies to {together}, `{narrow}` if it does not"
    help_ = f"write `{until}` if it must hold up to then, {readings}" if until else f"write {readings}"
    if word == "once" and op == "since" and len(following) == 1:
        event, start = _in_brackets(first), _in_brackets(text(following[0].span.start, end))
        help_ = f"write `(not {start}) since {event}` if it must have come since the last `{start}`, {readings}"
    if one_reading:
        help_ = f"write `{narrow}` if you mean this; `{word}` cannot apply to what comes later"
    return RuleFinding(f"`{word}` applies to `{first}` alone", (label,), help_)


def _until_text(part: BinaryExpr, source: SourceFile, *, is_chained: bool) -> str:
    """Return `a until b` for `always a until b`, in brackets if it is an operand of `and` or `or`."""
    assert isinstance(part.left, Unary)
    lasting, inside = part.left.operand, without_brackets(part.left.operand)
    if not isinstance(inside, (BinaryExpr, Quantified)):
        lasting = inside
    until = " ".join(f"{source.slice(lasting.span)} {source.text[part.left.span.end : part.span.end]}".split())
    return f"({until})" if is_chained else until


def _states_before(operands: Sequence[Expr]) -> list[Expr]:
    """Return the last of these operands that are about one step, in their order."""
    return [*takewhile(_is_about_one_step, reversed(operands))][::-1]


def _infix_finding(
    operator: BinaryExpr, before: Sequence[Expr], after: Sequence[Expr], source: SourceFile
) -> RuleFinding:
    """Return the finding for ``a until b`` between operands of ``and`` or ``or``, which it does not apply to."""
    start, end = operator.span.start, operator.span.end
    if before:
        start = before[0].span.start
    if after:
        end = after[-1].span.end

    def text(first: int, last: int) -> str:
        return " ".join(source.text[first:last].split())

    word = source.slice(operator.op_span)
    left, right = text(start, operator.left.span.end), text(operator.right.span.start, end)
    wide = f"{f'({left})' if before else left} {word} {f'({right})' if after else right}"
    parts = text(start, operator.span.start), text(operator.span.start, operator.span.end), text(operator.span.end, end)
    narrow = " ".join(filter(None, (parts[0], f"({parts[1]})", parts[2])))
    operands = [
        f"`{text(side.span.start, side.span.end)}`"
        for side, beside in ((operator.left, before), (operator.right, after))
        if beside
    ]
    label = Label(source, Span(start, end), f"read as `{narrow}`")
    together = "all of them" if before or len(after) > 1 else "both"
    help_ = f"write `{wide}` if it applies to {together}, `{narrow}` if it does not"
    return RuleFinding(f"`{word}` applies to {' and '.join(operands)} alone", (label,), help_)


def _in_brackets(text: str) -> str:
    return text if text.isidentifier() else f"({text})"


RULE = LintRule("TLT0446", "warning", check, supersedes=("TLT0448",))
