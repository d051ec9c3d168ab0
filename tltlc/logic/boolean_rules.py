"""Rewrites of ``not``, ``and``, ``or``, ``implies`` and ``iff``.

The laws are listed in :mod:`tltlc.logic.rewrite`. Each rule takes a formula and returns an
equivalent formula that is not larger. If the rule does not apply, it returns the same object.
Operands keep their order.
"""

from __future__ import annotations

from collections.abc import Iterable
from typing import Final

from tltlc.logic import formula as build
from tltlc.logic.formula import FALSE, TRUE, Formula
from tltlc.logic.implication import complement, syntactically_implies

_MOST_OPERANDS: Final = 40
"""Rules that compare operands pairwise skip an ``and`` or ``or`` with more operands than this."""


def join(op: str, operands: Iterable[Formula]) -> Formula:
    """Return the ``and`` or ``or`` of the operands."""
    return build.and_(*operands) if op == "and" else build.or_(*operands)


def drop_constants(node: Formula) -> Formula:
    """Remove constants from an ``and`` or ``or``: ``a & true`` becomes ``a``, and ``a & false`` becomes ``false``."""
    neutral, zero = (TRUE, FALSE) if node.op == "and" else (FALSE, TRUE)
    if zero in node.args:
        return zero
    return join(node.op, (part for part in node.args if part is not neutral)) if neutral in node.args else node


def drop_repeated(node: Formula) -> Formula:
    """Keep only the first of equal operands of an ``and`` or ``or``."""
    distinct = dict.fromkeys(node.args)
    return node if len(distinct) == len(node.args) else join(node.op, distinct)


def decide_complementary(node: Formula) -> Formula:
    """Replace an ``and`` that has an operand and its negation by ``false``: ``a & b & !a`` becomes ``false``.

    Replace an ``or`` that has an operand and its negation by ``true``.
    """
    operands = set(node.args)
    if any(complement(part) in operands for part in node.args):
        return FALSE if node.op == "and" else TRUE
    return node


def absorb(node: Formula) -> Formula:
    """Drop redundant operands of an ``and`` or ``or``: ``a & (a | b)`` becomes ``a``.

    In an ``and``, an operand is redundant if another operand implies it; in an ``or``, if it
    implies another operand. Of two equivalent operands, the later one is dropped.
    """
    if len(node.args) > _MOST_OPERANDS:
        return node
    remaining = list(node.args)
    for part in reversed(node.args):
        rest = [operand for operand in remaining if operand is not part]
        if any(_makes_redundant(node.op, operand, part) for operand in rest):
            remaining = rest
    return node if len(remaining) == len(node.args) else join(node.op, remaining)


def _makes_redundant(op: str, operand: Formula, part: Formula) -> bool:
    """Whether the operand ``part`` is redundant beside ``operand`` in an ``and`` or ``or``."""
    return syntactically_implies(operand, part) if op == "and" else syntactically_implies(part, operand)


def resolve(node: Formula) -> Formula:
    """Drop parts of an operand that have no effect, because of the other operands.

    ``a & (!a | b)`` becomes ``a & b``: beside ``a``, the part ``!a`` is false.
    """
    if len(node.args) > _MOST_OPERANDS:
        return node
    inner_op = "or" if node.op == "and" else "and"
    for index, part in enumerate(node.args):
        rest = node.args[:index] + node.args[index + 1 :]
        if part.op == inner_op:
            remaining = [
                inner for inner in part.args if not any(_rules_out(node.op, operand, inner) for operand in rest)
            ]
            if len(remaining) < len(part.args):
                return join(node.op, (*node.args[:index], join(inner_op, remaining), *node.args[index + 1 :]))
        elif part.op == "implies" and node.op == "and" and any(syntactically_implies(x, part.args[0]) for x in rest):
            return join("and", (*node.args[:index], part.args[1], *node.args[index + 1 :]))
    return node


def _rules_out(op: str, operand: Formula, inner: Formula) -> bool:
    """Whether ``inner``, a part of one operand, has no effect because of ``operand``, another operand.

    In ``a & (!a | b)``, the operand ``a`` rules out ``!a``.
    """
    if op == "and":
        return syntactically_implies(operand, complement(inner))
    return syntactically_implies(complement(operand), inner)


def factor(node: Formula) -> Formula:
    """Factor out the parts that all operands share: ``(a | b) & (a | c)`` becomes ``a | b & c``."""
    inner_op = "or" if node.op == "and" else "and"
    if any(part.op != inner_op for part in node.args):
        return node
    shared = set(node.args[0].args).intersection(*(part.args for part in node.args[1:]))
    if not shared:
        return node
    rests = join(node.op, [join(inner_op, (x for x in part.args if x not in shared)) for part in node.args])
    # The combined rest takes the place of the first unshared part of the first operand.
    first = dict.fromkeys(x if x in shared else rests for x in node.args[0].args)
    return join(inner_op, first if rests in first else (*first, rests))


def push_not(node: Formula) -> Formula:
    """Push ``not`` inwards if this does not make the formula larger."""
    (inner,) = node.args
    match inner.op:
        case "true" | "false" | "not":
            return complement(inner)
        case "implies":
            return build.and_(inner.args[0], _opposite(inner.args[1]))
        case "iff" if "not" in (inner.args[0].op, inner.args[1].op):
            left, right = inner.args
            return build.iff(left.args[0], right) if left.op == "not" else build.iff(left, right.args[0])
        case "and" | "or" if 2 * sum(part.op == "not" for part in inner.args) >= len(inner.args):
            return join("or" if inner.op == "and" else "and", map(_opposite, inner.args))
        case _:
            return node


def shorten_implication(node: Formula) -> Formula:
    """Shorten an implication: ``true -> a`` becomes ``a``, and ``a -> false`` becomes ``!a``."""
    left, right = node.args
    if left is TRUE:
        return right
    if right is FALSE:
        return _opposite(left)
    if syntactically_implies(left, right):
        return TRUE
    return build.or_(left.args[0], right) if left.op == "not" else node


def shorten_equivalence(node: Formula) -> Formula:
    """Shorten an equivalence: ``true <-> a`` becomes ``a``, and ``a <-> !a`` becomes ``false``."""
    left, right = node.args
    if left is right:
        return TRUE
    if complement(left) is right or complement(right) is left:
        return FALSE
    for constant, operand in ((left, right), (right, left)):
        if constant is TRUE:
            return operand
        if constant is FALSE:
            return _opposite(operand)
    if left.op == "not" and right.op == "not":
        return build.iff(left.args[0], right.args[0])
    return node


def _opposite(node: Formula) -> Formula:
    """Return the negation of a formula: ``a`` for ``!a``, and ``!a`` for ``a``."""
    return node.args[0] if node.op == "not" else build.not_(node)
