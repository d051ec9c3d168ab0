"""Behaviour trees made of closures.

A node is a function from an actor to a status; a tick of the whole tree costs about a microsecond.
Nodes are stateless: the actor keeps all state, so all enemies of a kind share one tree.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, Final

FAILURE: Final = 0
"""The node cannot run now: a selector tries its next child."""
SUCCESS: Final = 1
RUNNING: Final = 2
"""The node continues at the next tick."""

Node = Callable[[Any], int]


def selector(*children: Node) -> Node:
    """At each tick, run the children from the left until one does not fail."""

    def tick(actor: Any) -> int:
        for child in children:
            status = child(actor)
            if status:
                return status
        return FAILURE

    return tick


def sequence(*children: Node) -> Node:
    """At each tick, run the children from the left as long as they succeed."""

    def tick(actor: Any) -> int:
        for child in children:
            status = child(actor)
            if status != SUCCESS:
                return status
        return SUCCESS

    return tick


def condition(test: Callable[[Any], bool]) -> Node:
    """Succeed if the test holds, else fail."""

    def tick(actor: Any) -> int:
        return SUCCESS if test(actor) else FAILURE

    return tick


def action(act: Callable[[Any], bool]) -> Node:
    """Run until ``act`` returns True."""

    def tick(actor: Any) -> int:
        return SUCCESS if act(actor) else RUNNING

    return tick
