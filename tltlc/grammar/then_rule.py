"""The rule on the operands of ``then``: what could be read in two ways must have brackets (TLT0102).

Outside ``reach`` an operand is an atom, a negated atom or in brackets.  In ``reach``, where ``then`` is
plainly the loosest operator, only an operand that begins with a bare temporal operator is refused.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Final

from tltlc.core.source import SourceFile, Span
from tltlc.diagnostics.diagnostic import Diagnostic, Fix, Label, around
from tltlc.grammar import tree
from tltlc.grammar.tree import Expr
from tltlc.grammar.walk import children, operands

_TEMPORAL: Final = "FGXN"
_COMPARISONS: Final = ("<", "<=", ">", ">=")
_SHORT: Final = 60


def check_then(source: SourceFile, formula: Expr, *, in_reach: bool) -> Iterator[Diagnostic]:
    """An error for each operand of a ``then`` in ``formula`` that lacks brackets."""
    waiting = [(formula, in_reach)]
    while waiting:
        part, lenient = waiting.pop()
        if isinstance(part, tree.Binary) and part.op == "then":
            sequence = operands(part, "then")
            for place in range(len(sequence)):
                yield from _check_operand(source, sequence, place, lenient)
            waiting += [(operand, False) for operand in reversed(sequence)]
        else:
            waiting += [(child, False) for child in reversed([*children(part)])]


def _check_operand(source: SourceFile, sequence: list[Expr], place: int, lenient: bool) -> Iterator[Diagnostic]:
    operand = sequence[place]
    leading = _leading(operand)
    if not _lacks_brackets(operand, lenient):
        return
    last = place == len(sequence) - 1
    other = sequence[place - 1] if last else sequence[place + 1]
    if leading is None:
        title, span = "this operand of `then` needs brackets", operand.span
        help_ = _readings(source, operand, other, last)
    else:
        word = source.slice(leading.op_span)
        span = leading.op_span
        title = f"a bare `{word}` cannot follow `then`" if last else f"`then` cannot follow a bare `{word}`"
        help_ = _readings(source, operand, other, last)
        if leading is operand and leading.op == "F" and leading.bound is None:
            before, after = (other, leading.operand) if last else (leading.operand, other)
            first, second = _text(source, before), _text(source, after)
            if len(first) + len(second) <= _SHORT:
                help_ = f"`reach {first} then {second}` means: {second} after {first}\n{help_}"
        elif leading is operand and leading.op != "F" and leading.bound is None and last:
            first, second = _text(source, other), _text(source, leading.operand)
            behind, when = ("next always", "from the next one on") if leading.op == "G" else ("next", "at the next one")
            if len(first) + len(second) <= _SHORT:
                help_ += f", which begins at some later step; {when}, `{first} and {behind} {second}`"
    yield Diagnostic("TLT0102", title, (Label(source, span),), help_, fixes=_fixes(source, sequence, place, lenient))


def _leading(operand: Expr) -> tree.Unary | None:
    """The temporal operator with which an operand begins, without brackets."""
    while isinstance(operand, tree.Binary):
        operand = operand.left
    while isinstance(operand, tree.Unary) and operand.op == "not":
        operand = operand.operand
    return operand if isinstance(operand, tree.Unary) and operand.op in _TEMPORAL else None


def _is_plain(operand: Expr) -> bool:
    """Whether an operand is an atom, a negated atom, a constant or in brackets."""
    if isinstance(operand, tree.Unary) and operand.op == "not":
        operand = operand.operand
    if isinstance(operand, tree.Binary):
        return operand.op in _COMPARISONS
    return isinstance(operand, (tree.Name, tree.Call, tree.Group, tree.Constant, tree.Number))


def _readings(source: SourceFile, operand: Expr, other: Expr, last: bool) -> str:
    """Both ways to put the brackets, as a help."""
    whole, neighbour = _text(source, operand), _text(source, other)
    inner: Expr
    if isinstance(operand, tree.Unary):
        operator = source.slice(Span(operand.span.start, operand.operand.span.start)).strip()
        inner, head, tail = operand.operand, f"{operator} ", ""
    elif isinstance(operand, tree.Binary):
        operator = source.slice(operand.op_span)
        left, right = _text(source, operand.left), _text(source, operand.right)
        inner = operand.left if last else operand.right
        head, tail = ("", f" {operator} {right}") if last else (f"{left} {operator} ", "")
    else:
        inner, head, tail = operand, "", ""
    if len(whole) + len(neighbour) > _SHORT:
        return "put the operand, or the whole sequence, in brackets"
    if last:
        return f"write `{neighbour} then ({whole})`" + (
            f" or `({neighbour} then {_text(source, inner)}){tail}`" if tail else ""
        )
    return f"write `({whole}) then {neighbour}` or `{head}({_text(source, inner)} then {neighbour})`"


def _fixes(source: SourceFile, sequence: list[Expr], place: int, lenient: bool) -> tuple[Fix, ...]:
    """Brackets around the operand, and around its half with what follows or precedes it; none that lose the order."""
    operand = sequence[place]
    bare = [each for each in sequence if _lacks_brackets(each, lenient)]
    whole = _text(source, operand)
    title = f"Write `({whole})`" if len(whole) <= _SHORT else "Put the operand in brackets"
    title = title if len(bare) == 1 else "Put each operand in brackets"
    fixes = [Fix(title, tuple(edit for each in bare for edit in around(each.span)))]
    half = _half(operand, last=place == 1)
    if len(sequence) == 2 and bare == [operand] and half and not _lacks_brackets(half, lenient=False):
        first, second = (sequence[0], half) if place else (half, sequence[1])
        text = f"{_text(source, first)} then {_text(source, second)}"
        if len(text) <= _SHORT:
            fixes.append(Fix(f"Write `({text})`", around(first.span.to(second.span))))
    # `(F a) then b` says nothing of the order: it is met by `b` before `a`.
    loses_order = any(_begins_with_f(each) for each in bare if each is not sequence[-1])
    if any(_is_of_another_step(later) for later in bare if later is not sequence[0]):
        return ()
    return () if loses_order and len(fixes) == 1 else tuple(fixes)


def _is_of_another_step(operand: Expr) -> bool:
    """Whether an operand behind `then`, which means "later", says when by itself: `next a`, `always a`."""
    leading = _leading(operand)
    return leading is not None and (leading.op != "F" or leading is not operand)


def _begins_with_f(operand: Expr) -> bool:
    leading = _leading(operand)
    return leading is not None and leading.op == "F"


def _lacks_brackets(operand: Expr, lenient: bool) -> bool:
    return _leading(operand) is not None or not (lenient or _is_plain(operand))


def _half(operand: Expr, last: bool) -> Expr | None:
    """The operand of an operator that stands beside the `then`."""
    if isinstance(operand, tree.Binary):
        return operand.left if last else operand.right
    return operand.operand if isinstance(operand, tree.Unary) and not last else None


def _text(source: SourceFile, part: Expr) -> str:
    """A part as it stands in the text, on one line."""
    return " ".join(source.slice(Span(part.span.start, part.span.end)).split())
