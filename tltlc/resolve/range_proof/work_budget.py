"""Limits on the work of predicate checks.

The limits count steps, not time, so that every machine gives the same answer. A step takes a few
microseconds; longer operations count as several. Outside :func:`step_limit`, nothing is counted.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from contextvars import ContextVar
from typing import Any


class OutOfWorkError(Exception):
    """Raised when a check has used all its steps."""


class ProofBudget:
    """The number of steps that remain of a :func:`step_limit` (``left``), and a cache (``memo``).

    The cache lives as long as the limit is active.
    """

    __slots__ = ("left", "memo")

    def __init__(self, steps: int) -> None:
        self.left = steps
        self.memo: dict[Any, Any] = {}


_CURRENT: ContextVar[ProofBudget | None] = ContextVar("work", default=None)


def current_budget() -> ProofBudget | None:
    """Return the budget of the innermost active :func:`step_limit`, or None if no limit is active."""
    return _CURRENT.get()


def spend(steps: int = 1) -> None:
    """Count steps against the active :func:`step_limit`; raise OutOfWorkError if too few are left."""
    work = _CURRENT.get()
    if work is not None:
        work.left -= steps
        if work.left < 0:
            raise OutOfWorkError


@contextmanager
def step_limit(steps: int, *, counts_outside: bool = True) -> Iterator[ProofBudget]:
    """Limit the ``with`` block to this many steps; :func:`spend` raises OutOfWorkError beyond them.

    If ``counts_outside``, the steps also count against the enclosing limit, and the block gets no
    more steps than the enclosing limit has left. Yields the budget of the block.
    """
    outer = _CURRENT.get() if counts_outside else None
    allowed = steps if outer is None else min(steps, max(0, outer.left))
    work = ProofBudget(allowed)
    token = _CURRENT.set(work)
    try:
        yield work
    finally:
        _CURRENT.reset(token)
        if outer is not None:
            outer.left -= allowed - max(0, work.left)
