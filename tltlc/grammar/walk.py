"""Walk the syntax tree: the expressions of a declaration, and the parts of an expression."""

from __future__ import annotations

from collections.abc import Iterator

from tltlc.grammar import tree
from tltlc.grammar.tree import Declaration, Expr


def expressions(declaration: Declaration) -> Iterator[Expr]:
    """Yield the outermost expressions of a declaration, in the order of the text.

    These are the ends of ranges, defaults, values and bodies; in a spec, the formulas and values of its
    clauses, without tags; in a test, the atoms of its steps; in an ``exclusive`` declaration, its atoms.
    """
    match declaration:
        case tree.SignalDecl():
            yield from _range_ends(declaration.interval)
        case tree.ParamDecl():
            yield from _range_ends(declaration.interval)
            yield declaration.value
        case tree.PredicateDecl():
            yield from (item.default for item in declaration.parameters if item.default)
            yield from _range_ends(declaration.interval)
            yield declaration.body
        case tree.LetDecl():
            yield from (item.default for item in declaration.parameters if item.default)
            yield declaration.body
        case tree.ExclusiveDecl():
            yield from declaration.atoms
        case tree.SpecDecl():
            yield from (item.value for item in declaration.clauses if not isinstance(item.value, tuple))
        case tree.TestDecl():
            for item in declaration.items:
                if isinstance(item, tree.TestStep):
                    yield from item.atoms


def parts(expression: Expr) -> Iterator[Expr]:
    """Yield the expression and all its subexpressions, outer before inner and left before right.

    Works without recursion, so that deep expressions are no problem.
    """
    pending = [expression]
    while pending:
        part = pending.pop()
        yield part
        pending += reversed([*children(part)])


def operands(expression: Expr, op: str, *, through_brackets: bool = False) -> list[Expr]:
    """Return the operands of a chain such as ``a & b & c`` or ``a then b then c``, in order.

    If the outermost operator is not ``op``, the list has only the expression itself. With
    ``through_brackets``, ``a & (b & c)`` has three operands.
    """
    chain: list[Expr] = []
    pending = [expression]
    while pending:
        part = pending.pop()
        inner = part
        while through_brackets and isinstance(inner, tree.GroupExpr):
            inner = inner.inner
        if isinstance(inner, tree.BinaryExpr) and inner.op == op:
            pending += (inner.right, inner.left)
        else:
            chain.append(part)
    return chain


def conjuncts(expression: Expr) -> list[Expr]:
    """Return the operands of the outermost chain of ``and``, in order: three for ``a and (b and c)``.

    If the outermost operator is not ``and``, the list has only the expression itself.
    """
    return operands(expression, "and", through_brackets=True)


def children(expression: Expr) -> Iterator[Expr]:
    """Yield the direct operands of an expression, in order; nothing for a name, number or constant."""
    match expression:
        case tree.Unary():
            yield expression.operand
        case tree.BinaryExpr():
            yield expression.left
            yield expression.right
        case tree.GroupExpr():
            yield expression.inner
        case tree.IsExpr():
            yield expression.operand
        case tree.CallExpr():
            yield from (argument.value for argument in expression.arguments)
        case tree.Quantified():
            yield expression.body
        case tree.WhenExpr():
            for case in expression.cases:
                yield case.condition
                yield case.value
            yield expression.otherwise


def _range_ends(interval: tree.Interval | None) -> Iterator[Expr]:
    if interval:
        yield interval.low
        yield interval.high
