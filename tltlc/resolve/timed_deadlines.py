"""Replace bounded operators by timers in seconds, where each sample brings its own length (``clock varies``).

Each rule replaces a formula by an equivalent one over atoms that read a register. The proofs are in
``docs/semantics.md``, "A clock that varies". In the rules, T is a time above 0, ``p`` and
``q`` are formulas without temporal operators, and ``f`` is any formula. ``F`` within T includes the
sample at T, and ``G`` for T ends before it. ``F`` later within T leaves out the first sample.

==============================  ==============================================================
where it stands                 rule
==============================  ==============================================================
at the first sample             ``F[T] f`` is ``!over U (!over & f)``
at the first sample             ``G[T] f`` is ``lasted R (lasted | f)``, or ``G !breach`` if there are more
at the first sample             ``F G[T] p`` is ``F(p has held for T | p & !X true)``
at the first sample             ``F(p & X F G[T] q)`` is ``F(p & X F G[T] (q & previously once p))``
at the first sample             ``G(p -> F[T] q)`` is ``G !late & G(due -> X true)``
at the first sample             ``G(p -> G[T] q)`` is ``G !breach``
at the first sample             ``G(p -> X f)``, f as above, is the same of ``previously p``, & ``G(p -> X true)``
at the first sample             ``G(p -> !F[T] f)`` is ``!F(p & F[T] f)``
at the first sample             ``G !F(p & F[T] q)`` is ``G !(q & lately)``; ``recent`` for ``F[later, T]``
anywhere                        ``F(p & F[later, T] f)`` is ``F(p & X(recent U (recent & f)))``
anywhere                        ``F(p & F[T] f)`` is ``F(p & (lately U (lately & f)))``
at the first sample             a long chain of the last two is ``F chain`` (:mod:`tltlc.resolve.chains`)
==============================  ==============================================================

There are no other rules, and a time is no number of states: any other bound is an error.
"""

from __future__ import annotations

from typing import NamedTuple

from tltlc.logic.formula import (
    TRUE,
    Formula,
    always,
    and_,
    eventually,
    implies,
    next_,
    not_,
    or_,
    release,
    time_bound_of,
    until,
)
from tltlc.resolve.chains import Link
from tltlc.resolve.deadlines import Rewriting, and_both, negated, stay_for
from tltlc.resolve.elapsed import ElapsedTimers
from tltlc.resolve.timers import Reached, in_time
from tltlc.resolve.windows import is_present


def with_elapsed_timers(formula: Formula, timers: ElapsedTimers, *, many_rules: bool = False) -> Formula:
    """Return an equivalent formula in which timers replace the bounded operators that have a rule.

    ``formula`` and ``many_rules`` are those of :func:`tltlc.resolve.deadlines.with_timers`.
    """
    try:
        return _TimedRewriting(timers, many_rules).at_start(formula)
    except RecursionError:
        return formula  # Operators nest too deep.


class _Window(NamedTuple):
    """``F[T] body`` or ``G[T] body``, behind an ``X`` or ``N`` if ``following``.

    ``exists`` says whether the next sample must exist, as ``X`` asks.
    """

    op: str
    seconds: float
    later: bool
    body: Formula
    following: bool = False
    exists: bool = False


class _TimedRewriting(Rewriting):
    """The rules for bounds in seconds."""

    def __init__(self, timers: ElapsedTimers, many_rules: bool) -> None:
        super().__init__(timers)
        self._timers, self._many_rules = timers, many_rules

    def stay(self, node: Formula, before: Formula) -> Formula | None:
        window = _window(node)
        if window is not None and window.op == "F" and not (window.following or window.later) and before is TRUE:
            return eventually(self.inside(window.body))  # The bound has no effect.
        if window is None or window.op != "G" or window.following:
            return None
        state = and_both(window.body, before)
        return stay_for(state, self._timers.held(window.seconds, state)) if self.fits(state) else None

    def from_start(self, node: Formula) -> Formula | None:
        timers, window = self._timers, _window(node)
        if window is None:
            return self._long_chain(node)
        if window.following or window.later:
            return None
        if window.op == "F":
            in_bound = not_(timers.over(window.seconds))
            body, goals = self._chain(window.body, Reached(in_bound, f"within {timers.time(window.seconds)}"))
            if goals is not None:
                return until(not_(timers.lost(goals, window.seconds)), body)
            return until(in_bound, and_(in_bound, body))
        if self._many_rules and self.fits(window.body):
            return always(not_(timers.breach_from_start(window.seconds, window.body)))
        lasted = timers.lasted(window.seconds)
        return release(lasted, or_(lasted, self.inside(window.body)))

    def response(self, clause: tuple[Formula, ...]) -> Formula | None:
        temporal = [part for part in clause if not is_present(part)]
        window = _window(temporal[0]) if len(temporal) == 1 else None
        given = [negated(part) for part in clause if part not in temporal]
        event = and_(*given)
        if len(temporal) == 1 and temporal[0].op == "not":
            return self._never(and_(*given, temporal[0].args[0]))
        if window is None or window.later:
            return None
        if not self.fits(event, window.body):
            return None
        request = self._timers.previous(event) if window.following else event
        if window.op == "F":
            due, late = self._timers.response(request, window.body, window.seconds)
            rule = and_(always(not_(late)), always(implies(due, next_(TRUE))))
        else:
            rule = always(not_(self._timers.breach(window.seconds, request, window.body)))
        return and_(rule, always(implies(self._timers.now(event), next_(TRUE)))) if window.exists else rule

    def anchored(self, body: Formula, reached: Reached | None) -> Formula:
        parts = body.args if body.op == "and" else (body,)
        temporal = [part for part in parts if not is_present(part)]
        window = _window(temporal[0]) if len(temporal) == 1 else None
        present = [part for part in parts if part not in temporal]
        if window is None or window.op != "F" or window.following or not present:
            return self.inside(body)
        anchor, event_words = and_(*present), self._timers.text(and_(*present))
        if reached is not None:
            anchor, event_words = and_(anchor, reached.formula), f"{event_words} {reached.words}"
        if not self.fits(anchor):
            return self.inside(body)
        recent = self._timers.recent(int(window.later), window.seconds, anchor, event_words)
        words = in_time(int(window.later), self._timers.time(window.seconds), event_words)
        waiting = until(recent, and_(recent, self.anchored(window.body, Reached(recent, words))))
        return and_(*present, next_(waiting) if window.later else waiting)

    def _never(self, body: Formula) -> Formula | None:
        """Return ``G !body`` for a chain ``body`` or ``F body``: that its last goal never comes in time."""
        bound = time_bound_of(body)
        if bound is not None and body.op == "F[]" and not bound.later:
            return always(not_(self.inside(body.args[0])))  # `G !F[T] f` is `G !f`.
        chain = body.args[0] if body.op == "F" else body
        goal = self._last_goal(chain, None)
        if goal is not None:
            return always(not_(goal))
        is_timed = body.op == "and" and any(time_bound_of(part) is not None for part in body.args)
        return not_(eventually(self.anchored(body, None))) if is_timed else None

    def _last_goal(self, body: Formula, reached: Reached | None) -> Formula | None:
        """Return what holds where all goals of the chain ``F body`` came in time; None if ``body`` is no chain."""
        parts = body.args if body.op == "and" else (body,)
        temporal = [part for part in parts if not is_present(part)]
        present = [part for part in parts if part not in temporal]
        goal = and_(*present) if reached is None else and_(*present, reached.formula)
        if not temporal:
            return None if reached is None else goal
        window = _window(temporal[0]) if len(temporal) == 1 else None
        if window is None or window.op != "F" or window.following or not present or not self.fits(goal):
            return None
        words = self._timers.text(and_(*present)) + ("" if reached is None else f" {reached.words}")
        recent = self._timers.recent(int(window.later), window.seconds, goal, words)
        reached_words = in_time(int(window.later), self._timers.time(window.seconds), words)
        return self._last_goal(window.body, Reached(recent, reached_words))

    def timed_link(self, rest: Formula) -> Link | None:
        window = _window(rest)
        if window is None or window.op != "F" or window.following:
            return None
        return Link(int(window.later), window.seconds, window.body)

    def dual(self, inner: Formula, operand: Formula) -> Formula | None:
        # `F` includes the end of its time and `G` does not, so neither is the negation of the other.
        return None


def _window(node: Formula) -> _Window | None:
    """Return ``node`` as a bounded operator, also behind one ``X`` or ``N``; None if it is none."""
    inner = node.args[0] if node.op in ("X", "N") else node
    bound = time_bound_of(inner)
    if bound is None:
        return None
    op = inner.op[0]
    if node is inner:
        return _Window(op, bound.seconds, bound.later, inner.args[0])
    return _Window(op, bound.seconds, bound.later, inner.args[0], following=True, exists=node.op == "X")
