"""Negation normal form: only the operators ``and or X N F G U W R M``, and ``not`` before atoms."""

from __future__ import annotations

from itertools import chain

from tltlc.logic import formula as build
from tltlc.logic.formula import FALSE, TRUE, Formula, FormulaOp
from tltlc.logic.implication import DUAL

_Signed = tuple[Formula, bool]
"""A formula and its sign: True for the formula itself, False for its negation."""


def negation_normal_form(formula: Formula) -> Formula:
    """Return an equivalent formula over literals, constants, ``and``, ``or`` and temporal operators.

    The two formulas have the same truth value on every finite trace. ``a -> b`` becomes ``!a | b``,
    and ``a <-> b`` becomes ``a & b | !a & !b``. Negation turns each operator into its dual:
    ``!X a`` becomes ``N !a``. Operands keep their order, and repeated operands of one ``and`` or
    ``or`` are dropped. Takes no recursion, and converts each subformula and its negation at most
    once, so shared subformulas stay shared.
    """
    if all(map(_is_normal, formula.walk())):
        return formula
    done: dict[_Signed, Formula] = {}
    root = _strip((formula, True))
    stack = [root]
    while stack:
        signed = stack[-1]
        if signed in done:
            stack.pop()
            continue
        op, operands = _expand(signed)
        if op in ("and", "or"):
            operands = _gather(op, operands)
        missing = [operand for operand in operands if operand not in done]
        if missing:
            stack.extend(reversed(missing))
            continue
        stack.pop()
        done[signed] = _combine(signed, op, tuple(done[operand] for operand in operands))
    return done[root]


def outermost_operators(formula: Formula, *, negated: bool) -> tuple[FormulaOp, list[tuple[FormulaOp, Formula]]]:
    """Return the outermost operator of the normal form of a formula, or of its negation, and those of its operands.

    Each operand has its operator in the normal form, and the part of ``formula`` that it comes from, without
    leading negations. This takes time for the outermost operators alone.
    """
    op, operands = _expand(_strip((formula, not negated)))
    gathered = _gather(op, operands) if op in ("and", "or") else operands
    return op, [(_expand(signed)[0], signed[0]) for signed in gathered]


def _is_normal(node: Formula) -> bool:
    op, args = node.op, node.args
    if op == "and" or op == "or":
        return len(set(args)) == len(args)
    return op not in ("implies", "iff") and (op != "not" or args[0].op == "atom")


def _strip(signed: _Signed) -> _Signed:
    """Remove the leading negations of a signed formula, and invert its sign for each of them.

    A signed formula is a formula and its sign: True for the formula itself, False for its negation.
    """
    node, positive = signed
    while node.op == "not":
        node, positive = node.args[0], not positive
    return node, positive


def _expand(signed: _Signed) -> tuple[FormulaOp, tuple[_Signed, ...]]:
    """Push the sign of a signed formula inwards: return its new outermost operator, and its signed operands.

    The sign is True for the formula itself, False for its negation. For ``a & b`` with the sign
    False, the operator is ``or``, and both operands get the sign False.
    """
    node, positive = signed
    op = node.op
    if op == "implies":
        left, right = node.args
        return "or" if positive else "and", (_strip((left, not positive)), _strip((right, positive)))
    if op == "iff":
        left, right = node.args
        if_left = build.and_(left, right if positive else build.not_(right))
        if_not_left = build.and_(build.not_(left), build.not_(right) if positive else right)
        return "or", (_strip((if_left, True)), _strip((if_not_left, True)))
    if not positive:
        op = {"and": "or", "or": "and"}.get(op, DUAL.get(op, op))  # type: ignore[assignment]
    return op, tuple(_strip((argument, positive)) for argument in node.args)


def _gather(op: FormulaOp, operands: tuple[_Signed, ...]) -> tuple[_Signed, ...]:
    """Return signed operands in order, without duplicates and with nested operators flattened.

    An operand with the operator ``op`` is replaced by its own operands. A signed operand is a
    formula and its sign: True for the formula itself, False for its negation.
    """
    gathered: list[_Signed] = []
    seen: set[_Signed] = set()
    stack = list(reversed(operands))
    while stack:
        signed = stack.pop()
        if signed in seen:
            continue
        seen.add(signed)
        inner_op, inner = _expand(signed)
        if inner_op == op:
            stack.extend(reversed(inner))
        else:
            gathered.append(signed)
    return tuple(gathered)


def _combine(signed: _Signed, op: FormulaOp, operands: tuple[Formula, ...]) -> Formula:
    """Return the negation normal form of a formula (sign True) or of its negation (sign False).

    ``op`` is the outermost operator after the sign was pushed inwards, and ``operands`` are the
    normal forms of its operands.
    """
    node, positive = signed
    if op in ("and", "or"):
        # The normal form of an operand may have the same operator: (a & b) | (a & b) becomes a & b.
        parts = (operand.args if operand.op == op else (operand,) for operand in operands)
        flat = dict.fromkeys(chain.from_iterable(parts))
        return build.and_(*flat) if op == "and" else build.or_(*flat)
    if op == "atom":
        return node if positive else build.not_(node)
    if op in ("true", "false"):
        return TRUE if (op == "true") == positive else FALSE
    return build.temporal(op, operands)
