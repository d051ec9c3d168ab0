"""Long chains of goals in time: which goals follow each other, and one atom that holds at the last of them.

A chain such as ``F(a & X F[0,n](b & X F[0,n] c))`` has several attempts at once, each with a time of its
own. An automaton that knows which of them are alive needs a state for each set of them. But whether a
sample is the last goal of a chain is a function of the trace so far, so one atom can say it.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Final, NamedTuple

from tltlc.logic.formula import Formula, and_, eventually, next_
from tltlc.resolve.timers import Reached, TimedGoal, Timers
from tltlc.resolve.windows import is_present, window_of

MOST_GOALS: Final = 4
"""Chains of at most this many goals become states: up to 2^(n-1) of them for n goals."""


class Goal(NamedTuple):
    """A goal of a chain: a sample with ``state``, from ``low`` to ``high`` steps after the goal before it.

    ``high`` is None if the goal may come at any time. The first goal may come at any sample.
    """

    state: Formula
    low: int
    high: int | None


class Segment(NamedTuple):
    """Goals of a chain, each of which but the first has a bound.

    ``body`` is the formula that holds at the first goal. ``rest`` is what must hold at the last goal, apart
    from its state; None if that is all.
    """

    body: Formula
    goals: tuple[Goal, ...]
    rest: Formula | None


def segments(body: Formula, fits: Callable[[Formula], bool]) -> list[Segment]:
    """Return the segments of the chain ``F body``: each further one begins at a goal that may come at any time.

    ``fits`` says whether a timer can be about a state. The list is empty if the first goal has none.
    """
    complete: list[Segment] = []
    goals: list[Goal] = []
    start, low, high, rest = body, 0, None, None
    node: Formula | None = body
    while node is not None:
        parts = node.args if node.op == "and" else (node,)
        present = [part for part in parts if is_present(part)]
        temporal = [part for part in parts if part not in present]
        if not present or len(temporal) > 1 or not fits(and_(*present)):
            break
        if goals and high is None:
            complete.append(Segment(start, tuple(goals), rest))
            start, goals = node, []
        goals.append(Goal(and_(*present), low, high))
        rest = temporal[0] if temporal else None
        low, high, node = (0, None, None) if rest is None else _next_goal(rest)
    return [*complete, Segment(start, tuple(goals), rest)] if goals else []


def _next_goal(rest: Formula) -> tuple[int, int | None, Formula | None]:
    """Return from ``F[low,high] body`` or ``F body``, also behind ``X``, its bound and its body."""
    bound = window_of(rest)
    if bound is not None:
        is_goal = bound.op == "F" and bound.low <= 1 <= bound.high
        return (bound.low, bound.high, bound.body) if is_goal else (0, None, None)
    low = int(rest.op == "X")
    inner = rest.args[0] if low else rest
    return low, None, inner.args[0] if inner.op == "F" else None


def timed_goals(segment: Segment, timers: Timers, first: Reached | None) -> list[TimedGoal]:
    """Return the goals of a segment, each as the event that it and all goals before it came in time.

    ``first`` is what must hold at the first goal besides its state; None if it may come at any sample.
    """
    goals: list[TimedGoal] = []
    for goal in segment.goals:
        text = timers.text(goal.state)
        if goals and goal.high is not None:
            last = goals[-1]
            recent = timers.recent(goal.low, goal.high, last.event, last.words)
            words = f"{text} within {timers.time(goal.high)} after {last.words}"
            goals.append(TimedGoal(and_(goal.state, recent), words, text, goal.low, goal.high))
        elif first is None:
            goals.append(TimedGoal(goal.state, text, text))
        else:
            words = f"{text} {first.words}"
            goals.append(TimedGoal(and_(goal.state, first.formula), words, words))
    return goals


def after(segment: Segment, low: int, timers: Timers, first: Reached | None) -> Reached:
    """Return the condition that a sample comes ``low`` or more steps after the last goal of a segment."""
    *_, last = timed_goals(segment, timers, first)
    return Reached(timers.earlier(low, last.event), f"after {last.words}")


def is_long(chain: Sequence[Segment]) -> bool:
    """Whether some segment of a chain would need many states."""
    return any(len(segment.goals) > MOST_GOALS for segment in chain)


def at_a_goal(body: Formula, low: int) -> Formula:
    """Return ``F body``, or ``X F body`` if ``low`` is 1."""
    return next_(eventually(body)) if low else eventually(body)
