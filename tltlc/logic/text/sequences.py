"""Recognise the goals of a sequence, which must be reached in order, perhaps in time: ``F(a & X F[0,4] b)``."""

from __future__ import annotations

from tltlc.core.record import record
from tltlc.logic.bounded_operators import bounded_operator
from tltlc.logic.formula import Formula
from tltlc.logic.text.phrases import is_state


@record
class NextGoal:
    """The goal after another one: ``body`` must hold when it is reached.

    ``link`` is `then`, or `then or at the same time`. ``steps`` is how many steps later it must be reached
    at most; it is None if it has no such time.
    """

    link: str
    body: Formula
    steps: int | None = None


def next_goal(body: Formula) -> NextGoal | None:
    """Return the goal that follows in ``p & X F q``, ``p & X F[0,n] q`` or ``p & F q``; None for any other body."""
    if body.op != "and":
        return None
    temporal = [part for part in body.args if not is_state(part)]
    if len(temporal) != 1 or len(body.args) == 1:
        return None
    (rest,) = temporal
    if rest.op == "F":
        return NextGoal("then or at the same time", rest.args[0])
    if rest.op != "X":
        return None
    (later,) = rest.args
    if later.op == "F":
        return NextGoal("then", later.args[0])
    bound = bounded_operator(later)
    if bound is None or bound.op != "F" or not (is_state(bound.body) or next_goal(bound.body)):
        return None
    return NextGoal("then", bound.body, bound.steps + 1)
