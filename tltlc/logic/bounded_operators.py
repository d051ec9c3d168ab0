"""Recognise the formulas that are expansions of bounded operators.

``F[0,2] p`` is the formula ``p | X(p | X p)``, and ``G[0,2] p`` is ``p & N(p & N p)``. Texts print
the bounded form, which stays short for any bound.
"""

from __future__ import annotations

from collections.abc import Container, Iterator, Sequence
from typing import Final, NamedTuple
from weakref import WeakKeyDictionary

from tltlc.logic.formula import Formula, and_, not_, or_, rebuild, temporal

LEAST: Final = 2
"""The fewest steps of a bound that is printed in bounded form: ``a | X a``, with one step, is not."""


class Bounded(NamedTuple):
    """``F[0,steps] body`` (``op`` is ``F``) or ``G[0,steps] body`` (``G``), with ``steps`` at least 1."""

    op: str
    steps: int
    body: Formula


_operators: WeakKeyDictionary[Formula, Bounded | None] = WeakKeyDictionary()
_counted_down: WeakKeyDictionary[Formula, Formula | None] = WeakKeyDictionary()


def bounded_operator(node: Formula) -> Bounded | None:
    """Return the bounded operator whose expansion is ``node``, or None if ``node`` is not such an expansion.

    ``p | X(p | X p)`` is the expansion of ``F[0,2] p``. Results are cached, so that the labels of n
    states that count down a bound take time proportional to n, not n².
    """
    if not _ends_with_next(node):
        return None
    chain: list[Formula] = []
    inner = node
    while _ends_with_next(inner) and inner not in _operators:
        chain.append(inner)
        inner = inner.args[-1].args[0]
    for outer in reversed(chain):
        *before, last = outer.args
        operator = _bounded_ending_in(last, outer, before)
        _operators[outer] = operator if operator and len(before) == len(_operands(operator.body, outer)) else None
    return _operators[node]


def opposite(operator: Bounded) -> Formula:
    """Return the expansion of the negation of a bounded operator: of ``G[0,2] !p`` for ``F[0,2] p``."""
    body = operator.body.args[0] if operator.body.op == "not" else not_(operator.body)
    expansion = body
    for _ in range(operator.steps):
        if operator.op == "F":
            expansion = and_(body, temporal("N", (expansion,)))
        else:
            expansion = or_(body, temporal("X", (expansion,)))
    return expansion


def count_down(node: Formula) -> Formula | None:
    """Return ``node``, which counts down a bound, with one step less; None if ``node`` has another form.

    For ``X(p | X(p | X p))`` the result is ``X(p | X p)``, and for ``X(p | X p)`` it is ``X p``.
    The formula may have ``N`` in place of ``X``, and ``and`` in place of ``or``. With ``or``, the
    result implies ``node``; with ``and``, ``node`` implies the result.
    """
    chain: list[Formula] = []
    inner: Formula | None = node
    while inner is not None and inner not in _counted_down:
        chain.append(inner)
        inner = _last_step(inner)
    for outer in reversed(chain):
        last = _last_step(outer)
        _counted_down[outer] = last if last is not None and _repeats_operands(outer.args[0], last) else None
    return _counted_down[node]


def count_down_from(node: Formula, known: Container[Formula]) -> Iterator[Formula]:
    """Call :func:`count_down` again and again, and yield each result, until a result is None or in ``known``."""
    shorter = count_down(node)
    while shorter is not None and shorter not in known:
        yield shorter
        shorter = count_down(shorter)


def _last_step(node: Formula) -> Formula | None:
    """Return ``X q`` for ``X(p | … | X q)`` and ``X(p & … & X q)``; None for any other formula.

    The formula may also have ``N`` in place of both ``X``.
    """
    if node.op not in ("X", "N") or node.args[0].op not in ("or", "and"):
        return None
    last = node.args[0].args[-1]
    return last if last.op == node.op else None


def _repeats_operands(body: Formula, last: Formula) -> bool:
    """Whether ``body`` is ``p | X p``, ``p | X(p | X p)`` and so on; ``last`` is its last operand.

    ``p`` stands for one or more operands. The same forms with ``&`` or ``N`` count, too.
    """
    operands, inner = body.args[:-1], last.args[0]
    if inner == (operands[0] if len(operands) == 1 else rebuild(body, operands)):
        return True
    return inner.op == body.op and inner.args[:-1] == operands and _counted_down[last] is not None


def operands_with_bounds(node: Formula) -> list[Formula]:
    """Return the operands of an ``or`` or ``and``; operands that form a bounded operator are joined to one operand.

    ``a | p | X(p | X p)`` gives two operands, ``a`` and ``p | X(p | X p)``, since the latter is
    ``F[0,2] p``. Bounds of less than :data:`LEAST` steps are not joined.
    """
    operands: list[Formula] = []
    for operand in node.args:
        operator = _bounded_ending_in(operand, node, operands) if operand.op == _next_op(node) else None
        if operator is not None and operator.steps >= LEAST:
            body = _operands(operator.body, node)
            del operands[-len(body) :]
            operand = rebuild(node, (*body, operand))
        operands.append(operand)
    return operands


def _bounded_ending_in(last: Formula, node: Formula, before: Sequence[Formula]) -> Bounded | None:
    """Return the bounded operator whose expansion ends with the operand ``last``, or None if no expansion does.

    ``before`` are the operands before ``last``; the expansion begins among them.
    """
    inner = last.args[0]
    rest = bounded_operator(inner)
    if rest is not None and inner.op == node.op and _ends_with(before, _operands(rest.body, node)):
        return Bounded(rest.op, rest.steps + 1, rest.body)
    if _ends_with(before, _operands(inner, node)):
        return Bounded("F" if node.op == "or" else "G", 1, inner)
    return None


def _ends_with_next(node: Formula) -> bool:
    """Whether the node has the form ``… | X p`` or ``… & N p``."""
    return node.op in ("or", "and") and node.args[-1].op == _next_op(node)


def _next_op(node: Formula) -> str:
    return "X" if node.op == "or" else "N"


def _operands(body: Formula, node: Formula) -> tuple[Formula, ...]:
    """Return the operands of ``body`` if it has the operator of ``node``; otherwise ``body`` alone."""
    return body.args if body.op == node.op else (body,)


def _ends_with(operands: Sequence[Formula], end: tuple[Formula, ...]) -> bool:
    return tuple(operands[-len(end) :]) == end
