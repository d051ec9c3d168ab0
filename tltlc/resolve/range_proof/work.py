"""How much the checks of predicates may do: steps are counted, so that every machine gives the same answer.

A step takes a few microseconds. What takes longer counts as several. Where nobody has set a limit, nothing is counted.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from contextvars import ContextVar
from typing import Any


class OutOfWorkError(Exception):
    """A check has used all steps that it may take."""


class Work:
    """The steps that are left, and answers that need not be computed again while they last."""

    __slots__ = ("left", "memo")

    def __init__(self, steps: int) -> None:
        self.left = steps
        self.memo: dict[Any, Any] = {}


_CURRENT: ContextVar[Work | None] = ContextVar("work", default=None)


def current() -> Work | None:
    """What counts at present."""
    return _CURRENT.get()


def spend(steps: int = 1) -> None:
    """Count steps; raises OutOfWorkError where none are left."""
    work = _CURRENT.get()
    if work is not None:
        work.left -= steps
        if work.left < 0:
            raise OutOfWorkError


@contextmanager
def limited(steps: int, *, counts_outside: bool = True) -> Iterator[Work]:
    """Limit the block to ``steps``.

    If its steps count outside, too, it may take no more than are left there.
    """
    outer = _CURRENT.get() if counts_outside else None
    allowed = steps if outer is None else min(steps, max(0, outer.left))
    work = Work(allowed)
    token = _CURRENT.set(work)
    try:
        yield work
    finally:
        _CURRENT.reset(token)
        if outer is not None:
            outer.left -= allowed - max(0, work.left)
