"""Behaviour trees made of closures.

A node is a function from an actor to a status: FAILURE, SUCCESS or RUNNING. A *tick* calls the root
of the tree once and takes about a microsecond. Nodes have no state, so actors can share them: the
actor keeps all state.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, Final

FAILURE: Final = 0
"""The node cannot run in this tick: a selector then tries its next child."""
SUCCESS: Final = 1
RUNNING: Final = 2
"""The node has begun, and continues in the next tick."""

TreeNode = Callable[[Any], int]


def selector(*children: TreeNode) -> TreeNode:
    """Make a node that runs its children in order, at each tick, until one of them does not fail.

    The node's status is that of this child; the node fails if all children fail.
    """

    def tick(actor: Any) -> int:
        for child in children:
            status = child(actor)
            if status:
                return status
        return FAILURE

    return tick


def sequence(*children: TreeNode) -> TreeNode:
    """Make a node that runs its children in order, at each tick, as long as they succeed.

    The node's status is that of the first child that does not succeed. The node succeeds if all
    children succeed.
    """

    def tick(actor: Any) -> int:
        for child in children:
            status = child(actor)
            if status != SUCCESS:
                return status
        return SUCCESS

    return tick


def condition(test: Callable[[Any], bool]) -> TreeNode:
    """Make a node that succeeds at a tick if ``test`` holds for the actor, else fails."""

    def tick(actor: Any) -> int:
        return SUCCESS if test(actor) else FAILURE

    return tick


def action(act: Callable[[Any], bool]) -> TreeNode:
    """Make a node that calls ``act`` at each tick and succeeds when ``act`` returns True.

    Until then, the node's status is RUNNING.
    """

    def tick(actor: Any) -> int:
        return SUCCESS if act(actor) else RUNNING

    return tick
