"""Rewrites of the temporal operators over finite traces.

The laws are listed in :mod:`tltlc.logic.rewrite`. Each rule takes a formula and returns an
equivalent formula that is not larger. If the rule does not apply, it returns the same object.
"""

from __future__ import annotations

from collections.abc import Callable, Collection

from tltlc.logic import formula as build
from tltlc.logic.boolean_rules import join
from tltlc.logic.formula import FALSE, TRUE, Formula, FormulaOp
from tltlc.logic.implication import DUAL, complement, syntactically_implies, value_at_last


def push_not(node: Formula) -> Formula:
    """Push ``not`` through a temporal operator if this does not make the formula larger: ``!F a`` becomes ``G !a``."""
    (inner,) = node.args
    if not inner.is_temporal or (len(inner.args) == 2 and all(part.op != "not" for part in inner.args)):
        return node
    args = tuple(part.args[0] if part.op == "not" else build.not_(part) for part in inner.args)
    return build.temporal(DUAL[inner.op], args)


def evaluate_constant(node: Formula) -> Formula:
    """Evaluate ``X``, ``F``, ``G`` or ``N`` of a constant: ``F true`` becomes ``true``.

    ``X true`` (not the last sample) and ``N false`` (the last sample) are not constant, and stay.
    """
    (inner,) = node.args
    reducible = {"X": FALSE, "N": TRUE}.get(node.op, inner)
    return inner if inner is reducible and inner in (TRUE, FALSE) else node


def evaluate_at_last(node: Formula) -> Formula:
    """Replace ``F p`` by ``true`` if ``p`` is true at the last sample of every trace, as ``N a`` is.

    Replace ``G p`` by ``false`` if ``p`` is false at the last sample of every trace, as ``X a`` is.
    """
    value = value_at_last(node.args[0])
    if value is None or value != (node.op == "F"):
        return node
    return TRUE if value else FALSE


def simplify_nested(node: Formula) -> Formula:
    """Simplify ``F`` and ``G`` over temporal operators: ``F F a`` becomes ``F a``, and ``F(a U b)`` becomes ``F b``."""
    (inner,) = node.args
    until, strong = ("U", "M") if node.op == "F" else ("R", "W")
    if inner.op == node.op:
        return inner
    if inner.op == until:
        return build.temporal(node.op, (inner.args[1],))
    if inner.op == strong:
        return build.temporal(node.op, (join("and" if node.op == "F" else "or", inner.args),))
    if inner.op == DUAL[node.op] and inner.args[0].op == node.op:
        return inner
    if inner.op == ("X" if node.op == "F" else "N"):
        return build.temporal(inner.op, (build.temporal(node.op, inner.args),))
    if inner.op == ("or" if node.op == "F" else "and"):
        parts = [part.args[-1] if part.op in (node.op, until) else part for part in inner.args]
        return build.temporal(node.op, (join(inner.op, parts),)) if parts != list(inner.args) else node
    return node


def simplify_until(node: Formula) -> Formula:
    """Simplify ``a U b`` and ``a W b``.

    Applies if an operand is a constant, if ``a`` or its negation implies ``b``, or if an operand
    repeats the operator, as in ``a U (a U b)`` and ``a U F b``.
    """
    left, right = node.args
    strong = node.op == "U"
    if syntactically_implies(left, right) or right is TRUE:
        return right
    if right is FALSE:
        return FALSE if strong else build.always(left)
    if syntactically_implies(complement(left), right):
        return build.eventually(right) if strong else TRUE
    if right.op == node.op and right.args[0] is left:
        return right
    if left.op == node.op and left.args[1] is right:
        return left
    return right if strong and right.op == "F" else node


def simplify_release(node: Formula) -> Formula:
    """Simplify ``a R b`` and ``a M b``.

    Applies if an operand is a constant, if ``b`` implies ``a``, if ``a`` implies the negation of
    ``b``, or if an operand repeats the operator, as in ``a R (a R b)`` and ``a R G b``.
    """
    left, right = node.args
    weak = node.op == "R"
    if syntactically_implies(right, left) or right is FALSE:
        return right
    if right is TRUE:
        return TRUE if weak else build.eventually(left)
    if syntactically_implies(left, complement(right)):
        return build.always(right) if weak else FALSE
    if right.op == node.op and right.args[0] is left:
        return right
    if left.op == node.op and left.args[1] is right:
        return left
    return right if weak and right.op == "G" else node


def distribute(node: Formula) -> Formula:
    """Merge operands of ``and`` or ``or`` that begin with the same temporal operator.

    ``G a & G b`` becomes ``G(a & b)``, and ``F a | F b`` becomes ``F(a | b)``. ``X a & N b``
    becomes ``X(a & b)``, and ``X a | N b`` becomes ``N(a | b)``.
    """
    distributes: FormulaOp
    decides: FormulaOp
    distributes, decides = ("G", "X") if node.op == "and" else ("F", "N")
    for ops in (("X", "N"), (distributes,)):
        positions = [index for index, part in enumerate(node.args) if part.op in ops]
        if len(positions) < 2:
            continue
        parts = [node.args[index] for index in positions]
        op = decides if any(part.op == decides for part in parts) else parts[0].op
        combined = build.temporal(op, (join(node.op, (part.args[0] for part in parts)),))
        return _replace(node, positions, combined)
    return node


def merge_at_last(node: Formula) -> Formula:
    """Merge operands of the forms ``F G p`` and ``G F p``, which both mean ``p`` at the last sample.

    ``F G a & G F b`` becomes ``F G (a & b)``.
    """
    positions = [i for i, part in enumerate(node.args) if part.op in ("F", "G") and part.args[0].op == DUAL[part.op]]
    if len(positions) < 2:
        return node
    first = node.args[positions[0]]
    body = join(node.op, (node.args[index].args[0].args[0] for index in positions))
    return _replace(node, positions, build.temporal(first.op, (build.temporal(first.args[0].op, (body,)),)))


def fold_expansion(node: Formula) -> Formula:
    """Replace the expansion of a temporal operator by the operator: ``a | X F a`` becomes ``F a``.

    The expansion of an operator says the same with a part about this sample and a part about the
    rest of the trace.
    """
    inner_op = "or" if node.op == "and" else "and"
    for index, part in enumerate(node.args):
        if part.op in ("X", "N"):
            whole = part.args[0]
            now = whole.args[0] if (node.op, part.op, whole.op) in (("or", "X", "F"), ("and", "N", "G")) else None
        elif part.op == inner_op:
            whole, now = _expansion(node.op, part)
        else:
            continue
        if now is None:
            continue
        positions = _positions(node, now)
        if positions is not None:
            return _replace(node, sorted({*positions, index}), whole)
    return node


_EXPANDED = {("or", "X"): "U", ("or", "N"): "W", ("and", "X"): "M", ("and", "N"): "R"}


def _expansion(op: str, part: Formula) -> tuple[Formula, Formula | None]:
    """Return ``a U b`` and ``b`` if ``part`` is ``a & X(a U b)``, since ``b | a & X(a U b)`` is ``a U b``.

    ``op``, here ``or``, is the operator of which ``part`` is an operand. ``W``, ``M`` and ``R`` have
    similar forms. If ``part`` has no such form, the second result is None.
    """
    for index, step in enumerate(part.args):
        if step.op in ("X", "N") and step.args[0].op == _EXPANDED[op, step.op]:
            whole = step.args[0]
            if join(part.op, part.args[:index] + part.args[index + 1 :]) is whole.args[0]:
                return whole, whole.args[1]
    return part, None


def merge_weak_and_strong(node: Formula) -> Formula:
    """Merge two operands of ``and`` or ``or`` into one temporal operator.

    - ``a U b | G a`` becomes ``a W b``.
    - ``a M b | G b`` becomes ``a R b``.
    - ``a W b & F b`` becomes ``a U b``.
    - ``a R b & F a`` becomes ``a M b``.
    """
    weak = node.op == "or"
    pairs: dict[str, tuple[str, int, Callable[[Formula, Formula], Formula]]] = (
        {"U": ("G", 0, build.weak_until), "M": ("G", 1, build.release)}
        if weak
        else {"W": ("F", 1, build.until), "R": ("F", 0, build.strong_release)}
    )
    for index, part in enumerate(node.args):
        if part.op in pairs:
            companion, operand, make = pairs[part.op]
            partner = build.temporal("G" if companion == "G" else "F", (part.args[operand],))
            if partner in node.args:
                return _replace(node, sorted((index, node.args.index(partner))), make(*part.args))
    return node


def _positions(node: Formula, part: Formula) -> list[int] | None:
    """Return the position of ``part`` among the operands of ``node``, as a list.

    If ``part`` is not there but has the operator of ``node``, returns the positions of its operands
    instead. Returns None if any of these is missing.
    """
    if part in node.args:
        return [node.args.index(part)]
    if part.op == node.op and all(inner in node.args for inner in part.args):
        return [node.args.index(inner) for inner in part.args]
    return None


def _replace(node: Formula, positions: Collection[int], new: Formula) -> Formula:
    """Return a copy of ``node`` in which ``new`` replaces the operands at ``positions``.

    ``new`` stands at the first of these positions.
    """
    first = min(positions)
    parts = (new if i == first else part for i, part in enumerate(node.args) if i == first or i not in positions)
    return join(node.op, parts)
