"""Behaviour trees out of closures.

A node is a function from what acts to a status; a tick of the whole tree costs about a microsecond.  Nodes keep
nothing: what lasts is kept by what acts, so all enemies of a kind share one tree.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, Final

FAILURE: Final = 0
"""Not now: a selector goes on to its next child."""
SUCCESS: Final = 1
RUNNING: Final = 2
"""Goes on at the next tick."""

Node = Callable[[Any], int]


def selector(*children: Node) -> Node:
    """The first child, from the left at each tick, that does not fail."""

    def tick(actor: Any) -> int:
        for child in children:
            status = child(actor)
            if status:
                return status
        return FAILURE

    return tick


def sequence(*children: Node) -> Node:
    """One child after the other, from the left at each tick, as long as they succeed."""

    def tick(actor: Any) -> int:
        for child in children:
            status = child(actor)
            if status != SUCCESS:
                return status
        return SUCCESS

    return tick


def condition(test: Callable[[Any], bool]) -> Node:
    """Succeeds where the test holds, fails elsewhere."""

    def tick(actor: Any) -> int:
        return SUCCESS if test(actor) else FAILURE

    return tick


def action(act: Callable[[Any], bool]) -> Node:
    """Runs until ``act`` returns True."""

    def tick(actor: Any) -> int:
        return SUCCESS if act(actor) else RUNNING

    return tick
