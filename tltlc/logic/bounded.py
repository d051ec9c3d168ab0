"""Bounded operators, found again in the nexts that they were expanded into.

``F[0,2] p`` is the formula ``p | X(p | X p)`` and ``G[0,2] p`` is ``p & N(p & N p)``: texts say the former,
which stays short whatever the bound.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final, NamedTuple
from weakref import WeakKeyDictionary

from tltlc.logic.formula import Formula, rebuild

LEAST: Final = 2
"""The least bound that is written as one: ``a | X a`` needs no other form."""


class Bounded(NamedTuple):
    """``F[0,steps] body`` or ``G[0,steps] body``, with ``steps`` at least 1."""

    op: str
    steps: int
    body: Formula


_known: WeakKeyDictionary[Formula, Bounded | None] = WeakKeyDictionary()


def bounded(node: Formula) -> Bounded | None:
    """The bounded operator that the whole of an ``or`` or ``and`` expands, None where it is none.

    Answers are remembered: the labels of n states that count down a bound take n steps, not n².
    """
    chain: list[Formula] = []
    inner = node
    while inner not in _known and inner.op in ("or", "and") and inner.args[-1].op == _step(inner):
        chain.append(inner)
        inner = inner.args[-1].args[0]
    for outer in reversed(chain):
        *given, last = outer.args
        found = _ended_by(last, outer, given)
        _known[outer] = found if found and len(given) == len(_operands(found.body, outer)) else None
    return _known.get(node)


def with_bounds(node: Formula) -> list[Formula]:
    """The operands of an ``or`` or ``and``, those joined that together expand a bound of :data:`LEAST` or more."""
    operands: list[Formula] = []
    for operand in node.args:
        found = _ended_by(operand, node, operands) if operand.op == _step(node) else None
        if found is not None and found.steps >= LEAST:
            body = _operands(found.body, node)
            del operands[-len(body) :]
            operand = rebuild(node, (*body, operand))
        operands.append(operand)
    return operands


def _ended_by(last: Formula, node: Formula, before: Sequence[Formula]) -> Bounded | None:
    """The operator whose expansion ends with ``last`` and begins among the operands before it."""
    inner = last.args[0]
    rest = bounded(inner)
    if rest is not None and inner.op == node.op and _end(before, _operands(rest.body, node)):
        return Bounded(rest.op, rest.steps + 1, rest.body)
    if _end(before, _operands(inner, node)):
        return Bounded("F" if node.op == "or" else "G", 1, inner)
    return None


def _step(node: Formula) -> str:
    return "X" if node.op == "or" else "N"


def _operands(body: Formula, node: Formula) -> tuple[Formula, ...]:
    """The operands as which ``body`` stands in an ``or`` or ``and``, which hold none of their own kind."""
    return body.args if body.op == node.op else (body,)


def _end(operands: Sequence[Formula], end: tuple[Formula, ...]) -> bool:
    return tuple(operands[-len(end) :]) == end
