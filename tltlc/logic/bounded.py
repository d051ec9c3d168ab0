"""Bounded operators, found again in the nexts that they were expanded into.

``F[0,2] p`` is the formula ``p | X(p | X p)`` and ``G[0,2] p`` is ``p & N(p & N p)``: texts say the former,
which stays short whatever the bound.
"""

from __future__ import annotations

from collections.abc import Container, Iterator, Sequence
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
_shorter: WeakKeyDictionary[Formula, Formula | None] = WeakKeyDictionary()


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


def counted_down(node: Formula) -> Formula | None:
    """The bound with one step less that an ``X`` or ``N`` counts down: ``X(p | X p)`` of ``X(p | X(p | X p))``.

    Over ``or`` it implies the longer one, over ``and`` the longer one implies it.  None where there is no such.
    """
    chain: list[Formula] = []
    inner: Formula | None = node
    while inner is not None and inner not in _shorter:
        chain.append(inner)
        inner = _last_step(inner)
    for outer in reversed(chain):
        last = _last_step(outer)
        _shorter[outer] = last if last is not None and _is_same(outer.args[0], last) else None
    return _shorter[node]


def counted_down_from(node: Formula, known: Container[Formula]) -> Iterator[Formula]:
    """What ``node`` is counted down to, step by step, up to one that is ``known``, exclusively."""
    shorter = counted_down(node)
    while shorter is not None and shorter not in known:
        yield shorter
        shorter = counted_down(shorter)


def _last_step(node: Formula) -> Formula | None:
    """The ``X`` that an ``X`` over an ``or`` or ``and`` ends with, or the ``N`` of an ``N``."""
    if node.op not in ("X", "N") or node.args[0].op not in ("or", "and"):
        return None
    last = node.args[0].args[-1]
    return last if last.op == node.op else None


def _is_same(body: Formula, last: Formula) -> bool:
    """Whether ``last``, with which ``body`` ends, is over the other operands alone, or counts them down in its turn."""
    given, inner = body.args[:-1], last.args[0]
    if inner == (given[0] if len(given) == 1 else rebuild(body, given)):
        return True
    return inner.op == body.op and inner.args[:-1] == given and _shorter[last] is not None


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
