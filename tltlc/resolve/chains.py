"""Long chains of goals in time: which goals follow each other, and one atom that holds at the last of them.

A chain such as ``F(a & X F[0,n](b & X F[0,n] c))`` has several attempts at once, each with a time of its
own. An automaton that knows which of them are alive needs a state for each set of them. But whether a
sample is the last goal of a chain is a function of the trace so far, so one atom can say it.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Final, NamedTuple

from tltlc.logic.formula import Formula, and_, eventually, next_
from tltlc.resolve.timers import Reached, TimedGoal, TimerAtoms, in_time
from tltlc.resolve.windows import is_present

MOST_GOALS: Final = 4
"""Chains of at most this many goals become states: up to 2^(n-1) of them for n goals."""


class Goal(NamedTuple):
    """A goal of a chain: a sample with ``state``, at most ``length`` after the goal before it.

    It must come at a later sample if ``low`` is 1, and may come at the same one if it is 0. ``length`` is None
    if the goal may come at any time. The first goal may come at any sample.
    """

    state: Formula
    low: int
    length: float | None


class Link(NamedTuple):
    """What a goal of a chain asks for: ``F body``, at most ``length`` later, and ``low`` as in :class:`Goal`."""

    low: int
    length: float | None
    body: Formula


class Segment(NamedTuple):
    """Goals of a chain, each of which but the first has a bound.

    ``body`` is the formula that holds at the first goal. ``rest`` is what must hold at the last goal, apart
    from its state; None if that is all.
    """

    body: Formula
    goals: tuple[Goal, ...]
    rest: Formula | None


def segments(
    body: Formula, fits: Callable[[Formula], bool], timed_link: Callable[[Formula], Link | None]
) -> list[Segment]:
    """Return the segments of the chain ``F body``: each further one begins at a goal that may come at any time.

    ``fits`` says whether a timer can be about a state. ``timed_link`` returns a bounded operator as a link; None
    if it is none. The list is empty if the first goal has no timer.
    """
    complete: list[Segment] = []
    goals: list[Goal] = []
    start, low, length, rest = body, 0, None, None
    node: Formula | None = body
    while node is not None:
        parts = node.args if node.op == "and" else (node,)
        present = [part for part in parts if is_present(part)]
        temporal = [part for part in parts if part not in present]
        if not present or len(temporal) > 1 or not fits(and_(*present)):
            break
        if goals and length is None:
            complete.append(Segment(start, tuple(goals), rest))
            start, goals = node, []
        goals.append(Goal(and_(*present), low, length))
        rest = temporal[0] if temporal else None
        link = None if rest is None else timed_link(rest) or _open_link(rest)
        low, length, node = (0, None, None) if link is None else link
    return [*complete, Segment(start, tuple(goals), rest)] if goals else []


def _open_link(rest: Formula) -> Link | None:
    """Return ``F body``, also behind ``X``, as a link without a bound; None for any other formula."""
    low = int(rest.op == "X")
    inner = rest.args[0] if low else rest
    return Link(low, None, inner.args[0]) if inner.op == "F" else None


def timed_goals(segment: Segment, timers: TimerAtoms, first: Reached | None) -> list[TimedGoal]:
    """Return the goals of a segment, each as the event that it and all goals before it came in time.

    ``first`` is what must hold at the first goal besides its state; None if it may come at any sample.
    """
    goals: list[TimedGoal] = []
    for goal in segment.goals:
        text = timers.text(goal.state)
        if goals and goal.length is not None:
            last = goals[-1]
            recent = timers.recent(goal.low, goal.length, last.event, last.words)
            words = f"{text} {in_time(goal.low, timers.time(goal.length), last.words)}"
            goals.append(TimedGoal(and_(goal.state, recent), words, text, goal.low, goal.length))
        elif first is None:
            goals.append(TimedGoal(goal.state, text, text))
        else:
            words = f"{text} {first.words}"
            goals.append(TimedGoal(and_(goal.state, first.formula), words, words))
    return goals


def after(segment: Segment, low: int, timers: TimerAtoms, first: Reached | None) -> Reached:
    """Return the condition that a sample comes at the last goal of a segment or later; if ``low`` is 1, later."""
    *_, last = timed_goals(segment, timers, first)
    return Reached(timers.earlier(low, last.event), f"after {last.words}")


def is_long(chain: Sequence[Segment]) -> bool:
    """Whether some segment of a chain would need many states."""
    return any(len(segment.goals) > MOST_GOALS for segment in chain)


def at_a_goal(body: Formula, low: int) -> Formula:
    """Return ``F body``, or ``X F body`` if ``low`` is 1."""
    return next_(eventually(body)) if low else eventually(body)
