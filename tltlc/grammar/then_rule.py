"""Require brackets around an operand of ``then`` that could be read in two ways (TLT0102).

An example is ``F a then b``, which may mean ``(F a) then b`` or ``F (a then b)``.

Outside ``reach``, an operand must be an atom, a negated atom or in brackets. In ``reach``, ``then``
binds loosest, so only an operand that begins with a temporal operator needs brackets.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Final

from tltlc.core.source import SourceFile, Span
from tltlc.diagnostics.diagnostic import Diagnostic, Edit, Fix, Label, bracket_edits
from tltlc.grammar import tree
from tltlc.grammar.tree import Expr
from tltlc.grammar.walk import children, operands

_TEMPORAL: Final = "FGXN"
_COMPARISONS: Final = ("<", "<=", ">", ">=", "==", "!=")
_PAST: Final = ("once", "historically", "previously", "begins", "ends")
"""Operators whose operand cannot be a sequence, which looks at later steps."""
_SHORT: Final = 60
_NEXT_STEP: Final = {
    "G": ("next always", "from the next step on"),
    "X": ("next", "at the next step"),
    "N": ("weak_next", "at the next step, if there is one"),
}
"""Maps a temporal operator after ``then`` to the operator that begins at the next step, and to its meaning."""


def check_then(source: SourceFile, formula: Expr, *, in_reach: bool) -> Iterator[Diagnostic]:
    """Yield an error for each operand of a ``then`` in ``formula`` that lacks brackets.

    ``in_reach`` is True for the formula of a ``reach`` clause.
    """
    pending = [(formula, in_reach)]
    while pending:
        part, lenient = pending.pop()
        if isinstance(part, tree.BinaryExpr) and part.op == "then":
            sequence = operands(part, "then")
            bounds = _bounds(part)
            for position in range(len(sequence)):
                # The bound of the `then` after an operand, or before the last one.
                timed = _bound_of_goal(source, sequence, position, lenient, bounds)
                if timed is not None:
                    yield timed
                    continue
                yield from _check_operand(source, sequence, position, lenient, bounds[min(position, len(bounds) - 1)])
            pending += [(operand, False) for operand in reversed(sequence)]
        else:
            pending += [(child, False) for child in reversed([*children(part)])]


def _bounds(chain: Expr) -> list[tree.TemporalInterval | None]:
    """Return the bound of each ``then`` of a sequence, in order; None for one without a bound."""
    bounds: dict[int, tree.TemporalInterval | None] = {}
    pending = [chain]
    while pending:
        part = pending.pop()
        if isinstance(part, tree.BinaryExpr) and part.op == "then":
            bounds[part.op_span.start] = part.bound
            pending += (part.left, part.right)
    return [bounds[start] for start in sorted(bounds)]


def _bound_of_goal(
    source: SourceFile,
    sequence: list[Expr],
    position: int,
    lenient: bool,
    bounds: list[tree.TemporalInterval | None],
) -> Diagnostic | None:
    """Return the error for a goal such as ``then eventually within 5 s b``, whose bound `then` takes, else None."""
    operand = sequence[position]
    if not position or bounds[position - 1] is not None or not isinstance(operand, tree.Unary) or operand.op != "F":
        return None
    bound = operand.bound
    if bound is None or (bound.low is not None and bound.low.value) or not bound.high.value:
        return None
    if _leading_operator(operand.operand) is not None or not _is_plain(operand.operand):
        return None
    high = f"{_slice(source, bound.high.span)}{'' if bound.high.unit else ' steps'}"
    before, after = _text(source, sequence[position - 1]), _text(source, operand.operand)
    if len(before) + len(after) > _SHORT or _lacks_brackets(sequence[position - 1], lenient):
        before = "a"
    text = f"{before} then within {high} {after}"
    edit = Edit(Span(operand.span.start, operand.operand.span.start), f"within {high} ")
    is_alone = sum(_lacks_brackets(element, lenient) for element in sequence) == 1
    return Diagnostic(
        "TLT0102",
        f"`then` takes the bound itself, without `{source.slice(operand.op_span)}`",
        (Label(source, operand.op_span),),
        f"write `{text}`: the time counts from `{before}` on",
        fixes=(Fix(f"Write `{text}`", (edit,)),) if is_alone else (),
    )


def _check_operand(
    source: SourceFile, sequence: list[Expr], position: int, lenient: bool, bound: tree.TemporalInterval | None
) -> Iterator[Diagnostic]:
    operand = sequence[position]
    leading = _leading_operator(operand)
    if not _lacks_brackets(operand, lenient):
        return
    last = position == len(sequence) - 1
    then = f"then {_slice(source, bound.span)}" if bound else "then"
    neighbour = sequence[position - 1] if last else sequence[position + 1]
    if leading is None:
        title, span = "this operand of `then` needs brackets", operand.span
        help_ = _readings_help(source, operand, neighbour, last, then)
    else:
        word = source.slice(leading.op_span)
        span = leading.op_span
        title = f"`{word}` {'after' if last else 'before'} `then` needs brackets"
        help_ = _readings_help(source, operand, neighbour, last, then)
        if leading is operand and leading.op == "F" and leading.bound is None:
            before, after = (neighbour, leading.operand) if last else (leading.operand, neighbour)
            first, second = _text(source, before), _text(source, after)
            if len(first) + len(second) <= _SHORT:
                when = f", {_slice(source, bound.span)}" if bound else ""
                help_ = f"`reach {first} {then} {second}` means: {second} after {first}{when}\n{help_}"
        elif leading is operand and leading.op != "F" and leading.bound is None and bound is None and last:
            second = _text(source, leading.operand)
            if len(_text(source, neighbour)) + len(second) <= _SHORT:
                operator, when = _NEXT_STEP[leading.op]
                text = f"{_conjunct_text(source, neighbour)} and {operator} {second}"
                if not lenient:
                    # `then` looks for its operands at later steps, too. Without it, only `eventually` does.
                    text = f"eventually ({text})" if len(sequence) == 2 else f"({text})"
                help_ += f", which begins at some later step; for `{second}` {when}, write `{text}`"
    yield Diagnostic(
        "TLT0102", title, (Label(source, span),), help_, fixes=_fixes(source, sequence, position, lenient, then)
    )


def _leading_operator(operand: Expr) -> tree.Unary | None:
    """Return the temporal operator at the beginning of an operand, also after ``not``; None without one.

    An operator in brackets does not count.
    """
    while isinstance(operand, tree.BinaryExpr):
        operand = operand.left
    while isinstance(operand, tree.Unary) and operand.op == "not":
        operand = operand.operand
    return operand if isinstance(operand, tree.Unary) and operand.op in _TEMPORAL else None


def _is_plain(operand: Expr) -> bool:
    """Whether an operand is an atom, a negated atom, a constant or in brackets."""
    if isinstance(operand, tree.Unary) and operand.op == "not":
        operand = operand.operand
    if isinstance(operand, tree.BinaryExpr):
        return operand.op in _COMPARISONS
    return isinstance(
        operand, (tree.NameExpr, tree.CallExpr, tree.GroupExpr, tree.Constant, tree.NumberExpr, tree.IsExpr)
    )


def _readings_help(source: SourceFile, operand: Expr, neighbour: Expr, last: bool, then: str) -> str:
    """Return a help text that shows where brackets can be put.

    Brackets can go around ``operand``, or around ``then`` and the two formulas beside it.
    ``neighbour`` is the operand on the other side of ``then``. ``last`` says whether ``operand``
    comes after ``then``. The text ``then`` is the operator, with its bound.
    """
    text, neighbour_text = _text(source, operand), _text(source, neighbour)
    if isinstance(neighbour, tree.Unary) and neighbour.op in _PAST:
        neighbour_text = f"({neighbour_text})"
    inner: Expr
    if isinstance(operand, tree.Unary):
        operator = source.slice(Span(operand.span.start, operand.operand.span.start)).strip()
        inner, head, tail = operand.operand, f"{operator} ", ""
    elif isinstance(operand, tree.BinaryExpr):
        operator = source.slice(operand.op_span)
        left, right = _text(source, operand.left), _text(source, operand.right)
        inner = operand.left if last else operand.right
        head, tail = ("", f" {operator} {right}") if last else (f"{left} {operator} ", "")
    else:
        inner, head, tail = operand, "", ""
    if len(text) + len(neighbour_text) > _SHORT:
        return "put the operand, or the whole sequence, in brackets"
    if last:
        return f"write `{neighbour_text} {then} ({text})`" + (
            f" or `({neighbour_text} {then} {_text(source, inner)}){tail}`" if tail else ""
        )
    if isinstance(operand, tree.Unary) and operand.op in _PAST:
        return f"write `({text}) {then} {neighbour_text}`"
    return f"write `({text}) {then} {neighbour_text}` or `{head}({_text(source, inner)} {then} {neighbour_text})`"


def _fixes(source: SourceFile, sequence: list[Expr], position: int, lenient: bool, then: str) -> tuple[Fix, ...]:
    """Return fixes for the operand at ``position``, which lacks brackets.

    Brackets go around the operand, or around ``then`` and the two formulas beside it: for
    ``F a then b``, the fixes give ``(F a) then b`` and ``F (a then b)``. If other operands of the
    sequence lack brackets, the first fix puts brackets around them, too.

    In two cases there is no fix. First, an operand without brackets after ``then`` says by itself at
    which step it holds, as ``next a`` does. Second, brackets around the operand are the only possible
    fix, but would lose the order: ``b`` before ``a`` satisfies ``(F a) then b``.
    """
    operand = sequence[position]
    bare = [element for element in sequence if _lacks_brackets(element, lenient)]
    whole = _text(source, operand)
    title = f"Write `({whole})`" if len(whole) <= _SHORT else "Put the operand in brackets"
    title = title if len(bare) == 1 else "Put each operand in brackets"
    fixes = [Fix(title, tuple(edit for element in bare for edit in bracket_edits(element.span)))]
    half = _operand_beside_then(operand, last=position == 1)
    if len(sequence) == 2 and bare == [operand] and half and not _lacks_brackets(half, lenient=False):
        first, second = (sequence[0], half) if position else (half, sequence[1])
        text = f"{_text(source, first)} {then} {_text(source, second)}"
        if len(text) <= _SHORT:
            fixes.append(Fix(f"Write `({text})`", bracket_edits(first.span.to(second.span))))
    # `(F a) then b` loses the order: `b` before `a` satisfies it.
    loses_order = any(_begins_with_f(element) for element in bare if element is not sequence[-1])
    if any(_names_its_step(element) for element in bare if element is not sequence[0]):
        return ()
    return () if loses_order and len(fixes) == 1 else tuple(fixes)


def _names_its_step(operand: Expr) -> bool:
    """Whether an operand begins with a temporal operator, perhaps after `not`, and is more than `F a`.

    Examples are `next a`, `always a` and `F a & b`. Such an operand says by itself at which step it
    holds.
    """
    leading = _leading_operator(operand)
    return leading is not None and (leading.op != "F" or leading is not operand)


def _begins_with_f(operand: Expr) -> bool:
    leading = _leading_operator(operand)
    return leading is not None and leading.op == "F"


def _lacks_brackets(operand: Expr, lenient: bool) -> bool:
    return _leading_operator(operand) is not None or not (lenient or _is_plain(operand))


def _operand_beside_then(operand: Expr, last: bool) -> Expr | None:
    """Return the part of an operand that stands directly beside `then`, as ``a`` in ``F a then b``.

    ``last`` says whether the operand comes after `then`. Returns None if no such part can be split
    off.
    """
    if isinstance(operand, tree.BinaryExpr):
        return operand.left if last else operand.right
    return operand.operand if isinstance(operand, tree.Unary) and operand.op not in _PAST and not last else None


def _conjunct_text(source: SourceFile, part: Expr) -> str:
    """Return the source text of an expression, in brackets if it binds more loosely than ``and``."""
    is_loose = isinstance(part, tree.BinaryExpr) and part.op in ("or", "implies", "iff")
    return f"({_text(source, part)})" if is_loose else _text(source, part)


def _text(source: SourceFile, part: Expr) -> str:
    """Return the source text of an expression, on one line."""
    return _slice(source, part.span)


def _slice(source: SourceFile, span: Span) -> str:
    """Return the source text at a span, on one line."""
    return " ".join(source.slice(span).split())
