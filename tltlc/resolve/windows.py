"""Operators with a bound in steps, as the steps from a sample at which their operand is judged."""

from __future__ import annotations

from typing import NamedTuple

from tltlc.logic.formula import Formula, bound_of


class Window(NamedTuple):
    """``F[low,high] body`` (``op`` is ``F``) or ``G[low,high] body``, after leading ``X`` or ``N`` have become steps.

    ``exists`` says whether the next sample must exist: ``X G[0,n] p`` asks for it.
    """

    op: str
    low: int
    high: int
    body: Formula
    exists: bool = False


def window_of(node: Formula) -> Window | None:
    """Return ``node`` as a bounded operator; None if it is none, also behind ``X`` or ``N``."""
    steps = 0
    op = ""
    while node.op in ("X", "N"):
        if op and node.op != op:
            return None
        op, steps, node = node.op, steps + 1, node.args[0]
    bound = bound_of(node)
    if bound is None:
        return None
    if node.op == "F[]":
        return None if op == "N" else Window("F", bound.low + steps, bound.high + steps, node.args[0])
    # `X X G p` asks for two samples: only a single one can be asked for.
    if op == "X" and steps > 1:
        return None
    return Window("G", bound.low + steps, bound.high + steps, node.args[0], exists=op == "X")


def is_present(node: Formula) -> bool:
    """Whether a formula is about one sample and those before it: it has no temporal operators."""
    return not any(part.is_temporal for part in node.walk())
