"""The normal form of formulas over infinite traces, and functions that build simplified formulas in it.

The operators of the normal form are ``true false atom not and or X U W``, with ``not`` only before
atoms, and the *rigid* formulas ``G F p`` and ``F G p``, whose truth does not change with time.
``F p`` is ``true U p`` and ``G p`` is ``p W false``. On infinite traces ``N`` is ``X``, ``a R b``
is ``b W (a & b)`` and ``a M b`` is ``b U (a & b)``.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from functools import lru_cache
from itertools import chain

from tltlc.logic import formula as build
from tltlc.logic.formula import FALSE, TRUE, Formula
from tltlc.logic.normal_form import negation_normal_form

_MOST_PULLED = 6
"""The most rigid formulas that are moved out of a temporal operator; each doubles the size of the formula."""


def infinite_form(formula: Formula) -> Formula:
    """Return a formula in normal form that is equivalent on every infinite trace.

    The operators of the normal form are ``and``, ``or``, ``X``, ``U`` and ``W``, ``not`` before
    atoms, and ``G F p`` and ``F G p``.
    """
    normal = negation_normal_form(formula)
    done: dict[Formula, Formula] = {}
    for node in normal.bottom_up():
        done[node] = _rebuild(node, [done[argument] for argument in node.args])
    return done[normal]


def _rebuild(node: Formula, args: list[Formula]) -> Formula:
    match node.op:
        case "and":
            return conjunction(args)
        case "or":
            return disjunction(args)
        case "X" | "N":
            return next_(args[0])
        case "F":
            return until(TRUE, args[0])
        case "G":
            return weak_until(args[0], FALSE)
        case "U":
            return until(*args)
        case "W":
            return weak_until(*args)
        case "R":
            return weak_until(args[1], conjunction(args))
        case "M":
            return until(args[1], conjunction(args))
        case _:
            return node


def negation(formula: Formula) -> Formula:
    """Return the negation, in normal form, of a formula in normal form."""
    done: dict[Formula, Formula] = {}
    for node in formula.bottom_up():
        if node.op == "not":
            done[node] = node.args[0]
            continue
        args = [done[argument] for argument in node.args]
        match node.op:
            case "true" | "false":
                done[node] = FALSE if node is TRUE else TRUE
            case "atom":
                done[node] = build.not_(node)
            case "and":
                done[node] = disjunction(args)
            case "or":
                done[node] = conjunction(args)
            case "X":
                done[node] = next_(args[0])
            case "U":
                # The negation of `a U b` is `!b W (!a & !b)`.
                done[node] = weak_until(args[1], conjunction(args))
            case "W":
                done[node] = until(args[1], conjunction(args))
            case _ if node.args[0].op in ("F", "G"):
                inner = done[node.args[0].args[0]]
                done[node] = always_eventually(inner) if node.op == "F" else eventually_always(inner)
            case _:
                # The inner operator of a rigid formula. The case above negates it together with the outer one.
                done[node] = node
    return done[formula]


# --- constructors ---------------------------------------------------------------------------------


def conjunction(operands: Iterable[Formula]) -> Formula:
    """Return the ``and`` of the operands, simplified.

    Drops ``true`` and repeated operands, and drops ``a | b`` beside ``a``. The result is ``false``
    if an operand is ``false``, or if there are operands ``a`` and ``!a`` for an atom.
    """
    return _nary("and", operands)


def disjunction(operands: Iterable[Formula]) -> Formula:
    """Return the ``or`` of the operands, with the simplifications that are dual to those of :func:`conjunction`."""
    return _nary("or", operands)


def _nary(op: str, operands: Iterable[Formula]) -> Formula:
    neutral, absorbing = (TRUE, FALSE) if op == "and" else (FALSE, TRUE)
    flat = dict.fromkeys(chain.from_iterable(operand.args if operand.op == op else (operand,) for operand in operands))
    flat.pop(neutral, None)
    if absorbing in flat or any(operand.op == "not" and operand.args[0] in flat for operand in flat):
        return absorbing
    inner = "or" if op == "and" else "and"
    needed = [operand for operand in flat if not (operand.op == inner and any(part in flat for part in operand.args))]
    if not needed:
        return neutral
    return build.and_(*needed) if op == "and" else build.or_(*needed)


def is_rigid(formula: Formula) -> bool:
    """Whether a formula in normal form has the same truth value at all samples of a trace, as ``G F p`` has."""
    if formula.op in ("and", "or"):
        return all(map(is_rigid, formula.args))
    return formula.op in ("true", "false", "G", "F")


def next_(operand: Formula) -> Formula:
    """Return ``X operand``, simplified."""
    if is_rigid(operand):
        return operand
    return _pull_rigid(next_, operand) or build.next_(operand)


def until(left: Formula, right: Formula) -> Formula:
    """Return ``left U right``, simplified."""
    if is_rigid(right) or left is FALSE or left is right:
        return right
    if pulled := _pull_rigid(until, left, right):
        return pulled
    if right.op == "U" and (left is TRUE or right.args[0] is left):
        return right if right.args[0] is left else until(TRUE, right.args[1])
    if left is TRUE and right.op == "W":
        return disjunction((eventually_always(right.args[0]), until(TRUE, right.args[1])))
    if left is TRUE and right.op == "or":
        return disjunction(until(TRUE, part) for part in right.args) if _splits(right, "W") else _until(left, right)
    if left.op == "U" and left.args[1] is right:
        return left
    return _until(left, right)


def _until(left: Formula, right: Formula) -> Formula:
    parts = right.args if right.op == "or" else (right,)
    if (left.op == "not" and left.args[0] in parts) or build.not_(left) in parts:
        left = TRUE
    return build.until(left, right)


def weak_until(left: Formula, right: Formula) -> Formula:
    """Return ``left W right``, simplified."""
    if left is TRUE or right is TRUE or left is right:
        return TRUE if TRUE in (left, right) else right
    if left is FALSE:
        return right
    if is_rigid(left):
        return disjunction((left, right))
    if is_rigid(right) and right is not FALSE:
        return disjunction((right, weak_until(left, FALSE)))
    if pulled := _pull_rigid(weak_until, left, right):
        return pulled
    if right is FALSE:
        if left.op == "W":
            return weak_until(disjunction(left.args), FALSE)
        if left.op == "U":
            return conjunction((always_eventually(left.args[1]), weak_until(disjunction(left.args), FALSE)))
        if left.op == "and" and _splits(left, "U"):
            return conjunction(weak_until(part, FALSE) for part in left.args)
    if right.op == "W" and right.args[0] is left:
        return right
    if left.op == "W" and left.args[1] is right:
        return left
    parts = right.args if right.op == "or" else (right,)
    if (left.op == "not" and left.args[0] in parts) or build.not_(left) in parts:
        return TRUE
    return build.weak_until(left, right)


def _splits(formula: Formula, op: str) -> bool:
    """Whether an operand of the formula has the outermost operator ``op``.

    If so, callers distribute ``F`` or ``G`` over the operands: ``F`` of a ``W``, and ``G`` of a
    ``U``, can be written with a rigid formula.
    """
    return any(operand.op == op for operand in formula.args)


@lru_cache(maxsize=4096)
def always_eventually(inner: Formula) -> Formula:
    """Return ``G F inner``, simplified."""
    if is_rigid(inner):
        return inner
    if inner.op == "or":
        return disjunction(always_eventually(operand) for operand in inner.args)
    if inner.op == "X":
        return always_eventually(inner.args[0])
    if inner.op == "U":
        return always_eventually(inner.args[1])
    if inner.op == "W":
        return disjunction((eventually_always(inner.args[0]), always_eventually(inner.args[1])))
    if inner.op == "and" and all(operand.op == "X" for operand in inner.args):
        return always_eventually(conjunction(operand.args[0] for operand in inner.args))
    if pulled := _pull_rigid(always_eventually, inner):
        return pulled
    return build.always(build.eventually(inner))


@lru_cache(maxsize=4096)
def eventually_always(inner: Formula) -> Formula:
    """Return ``F G inner``, simplified."""
    if is_rigid(inner):
        return inner
    if inner.op == "and":
        return conjunction(eventually_always(operand) for operand in inner.args)
    if inner.op == "X":
        return eventually_always(inner.args[0])
    if inner.op == "W":
        return eventually_always(disjunction(inner.args))
    if inner.op == "U":
        return conjunction((always_eventually(inner.args[1]), eventually_always(disjunction(inner.args))))
    if inner.op == "or" and all(operand.op == "X" for operand in inner.args):
        return eventually_always(disjunction(operand.args[0] for operand in inner.args))
    if pulled := _pull_rigid(eventually_always, inner):
        return pulled
    return build.eventually(build.always(inner))


def with_derived_operators(formula: Formula, known: dict[Formula, Formula] | None = None) -> Formula:
    """Return the formula with ``F p`` for ``true U p`` and ``G p`` for ``p W false``.

    ``known`` caches the result of each subformula; pass the same dict for formulas that share
    subformulas.
    """
    done: dict[Formula, Formula] = {} if known is None else known
    for node in formula.bottom_up(known=done):
        args = tuple(done[argument] for argument in node.args)
        if node.op == "U" and args[0] is TRUE:
            done[node] = build.eventually(args[1])
        elif node.op == "W" and args[1] is FALSE:
            done[node] = build.always(args[0])
        else:
            done[node] = build.rebuild(node, args)
    return done[formula]


# --- rigid formulas -------------------------------------------------------------------------------


@lru_cache(maxsize=16384)
def rigid_parts(formula: Formula) -> tuple[Formula, ...]:
    """Return the distinct outermost subformulas of the forms ``G F p`` and ``F G p``, in the order of the formula."""
    if formula.op in ("G", "F"):
        return (formula,)
    return tuple(dict.fromkeys(chain.from_iterable(map(rigid_parts, formula.args))))


def substitute(formula: Formula, values: dict[Formula, Formula]) -> Formula:
    """Return the formula with the keys of ``values`` replaced by their values, simplified.

    Subformulas inside ``G F p`` and ``F G p`` are not replaced.
    """
    return _substitute(formula, dict(values))


def _substitute(formula: Formula, done: dict[Formula, Formula]) -> Formula:
    result = done.get(formula)
    if result is None:
        result = formula
        if formula.args and formula.op not in ("not", "G", "F"):
            args = [_substitute(argument, done) for argument in formula.args]
            if any(new is not old for new, old in zip(args, formula.args, strict=True)):
                result = _rebuild(formula, args)
        done[formula] = result
    return result


def substitute_operands(formula: Formula, values: dict[Formula, Formula]) -> Formula:
    """Return the formula with each operand replaced by its value in ``values``, simplified."""
    return _rebuild(formula, [values[operand] for operand in formula.args])


def _pull_rigid(make: Callable[..., Formula], *args: Formula) -> Formula | None:
    """Return the formula f = ``make(*args)`` with a rigid subformula g moved out of its outermost operator.

    A rigid formula is ``G F p`` or ``F G p``. The result is ``g & f[g := true] | f[g := false]``.
    Returns None if f has no rigid subformula, or more than :data:`_MOST_PULLED`.
    """
    rigid = tuple(dict.fromkeys(chain.from_iterable(map(rigid_parts, args))))
    if not rigid or len(rigid) > _MOST_PULLED:
        return None
    true, false = (make(*(substitute(argument, {rigid[0]: value}) for argument in args)) for value in (TRUE, FALSE))
    return disjunction((conjunction((rigid[0], true)), false))
