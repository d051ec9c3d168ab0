"""The branches of the enemies' behaviour tree.

All enemies have the branches chase, search, return and patrol; some have optional branches as well.
A branch only sets the goal of its enemy, the *guard*. The guard moves after the tick of the tree.
"""

from __future__ import annotations

from collections.abc import Callable
from math import cos, hypot, pi, sin, sqrt
from typing import TYPE_CHECKING, Final

from tltl_runtime.stealth.enemies.behaviour import TreeNode, action, condition, selector, sequence
from tltlc.api import record

if TYPE_CHECKING:
    from tltl_runtime.stealth.enemies.enemy import EnemyGuard

_CLOSE: Final = 0.55
"""In a chase, the guard stops at this fraction of its attack range from the player.

So a player who walks away stays in reach.
"""


@record
class Branch:
    """A branch of the enemies' behaviour tree.

    At each tick, the tree runs the branch with the lowest ``rank`` among those that can run.
    """

    name: str
    rank: int
    added: bool
    """Whether the branch is optional: only enemy kinds that name an optional branch have it."""
    node: TreeNode


_BRANCHES: Final[dict[str, Branch]] = {}


def branch(name: str, *, rank: int, added: bool = False) -> Callable[[Callable[[], TreeNode]], Callable[[], TreeNode]]:
    """Return a decorator that registers a branch of the enemies' behaviour tree.

    The decorated function must return the branch's node of the tree. ``rank`` and ``added`` are
    those of :class:`Branch`. The decorator raises ValueError if the name is taken.
    """

    def register(make: Callable[[], TreeNode]) -> Callable[[], TreeNode]:
        if name in _BRANCHES:
            raise ValueError(f"the branch {name!r} already exists")
        _BRANCHES[name] = Branch(name, rank, added, make())
        return make

    return register


def added_branches() -> tuple[str, ...]:
    """Return the names of the optional branches, which an enemy kind's ``branches`` can list."""
    return tuple(sorted(branch.name for branch in _BRANCHES.values() if branch.added))


def tree(branches: tuple[str, ...]) -> TreeNode:
    """Build a behaviour tree from the branches that all enemies have and the optional ``branches``.

    Raises ValueError if ``branches`` contains a name that is not an optional branch.
    """
    for name in branches:
        if name not in added_branches():
            raise ValueError(f"{name!r} is not one of the optional branches: {', '.join(added_branches())}")
    chosen = [branch for branch in _BRANCHES.values() if not branch.added or branch.name in branches]
    return selector(*(branch.node for branch in sorted(chosen, key=lambda branch: (branch.rank, branch.name))))


@branch("chase", rank=10)
def chase() -> TreeNode:
    """Make a node that runs to the player while the enemy (the guard) knows where the player is.

    The guard stops within its attack range.
    """

    def knows(guard: EnemyGuard) -> bool:
        return guard.knows

    def run(guard: EnemyGuard) -> bool:
        guard.mode = "chase"
        x, y, _ = guard.last_known
        speed = guard.kind.chase_speed
        if guard.sees or guard.in_reach:
            left = hypot(x - guard.x, y - guard.y) - _CLOSE * guard.kind.attack_range
            speed = min(speed, max(0.0, left) / guard.dt)
        guard.go((x, y), speed)
        guard.face(x, y)
        return False

    return sequence(condition(knows), action(run))


@branch("search", rank=20)
def search() -> TreeNode:
    """Make a node for an enemy that has lost the player.

    The enemy goes where it last saw the player, and looks around there for a while.
    """

    def lost(guard: EnemyGuard) -> bool:
        return guard.search_left > 0.0

    def arrived(guard: EnemyGuard) -> bool:
        return guard.searching

    def go_there(guard: EnemyGuard) -> bool:
        guard.mode = "search"
        guard.go(guard.last_known[:2], guard.kind.chase_speed)
        guard.searching = guard.arrived
        return guard.searching

    def look_around(guard: EnemyGuard) -> bool:
        guard.mode = "search"
        guard.search_left -= guard.dt
        if guard.arrived:
            angle = 2 * pi * guard.rng.random()
            distance = guard.kind.search_radius * sqrt(guard.rng.random())
            x, y, _ = guard.last_known
            guard.go((x + distance * cos(angle), y + distance * sin(angle)), guard.kind.walk_speed)
        if guard.search_left <= 0.0:
            guard.search_left = 0.0
            guard.is_off_route = True
        return guard.is_off_route

    return sequence(condition(lost), selector(condition(arrived), action(go_there)), action(look_around))


@branch("return", rank=40)
def return_to_route() -> TreeNode:
    """Make a node that walks back to the nearest point of the enemy's route."""

    def is_off(guard: EnemyGuard) -> bool:
        return guard.is_off_route

    def walk(guard: EnemyGuard) -> bool:
        if guard.mode != "return":
            guard.mode = "return"
            guard.leg = guard.nearest_leg()
        guard.go(guard.route[guard.leg], guard.kind.walk_speed)
        guard.is_off_route = not guard.arrived
        return False

    return sequence(condition(is_off), action(walk))


@branch("check_gaps", rank=50, added=True)
def check_gaps() -> TreeNode:
    """Make a node that runs to a narrow place off the route, after each leg of the enemy's patrol.

    :meth:`~tltl_runtime.stealth.enemies.enemy.EnemyGuard.next_gap` chooses the place. The speed is
    the mean of the walking speed and the chasing speed: at walking speed, the enemy would leave its
    route unwatched for too long.
    """

    def is_due(guard: EnemyGuard) -> bool:
        return guard.gap is not None

    def visit(guard: EnemyGuard) -> bool:
        guard.mode = "patrol"
        assert guard.gap is not None
        guard.go(guard.gap, (guard.kind.walk_speed + guard.kind.chase_speed) / 2)
        if guard.arrived:
            guard.gap = None
        return False

    return sequence(condition(is_due), action(visit))


@branch("patrol", rank=60)
def patrol() -> TreeNode:
    """Make a node that walks the enemy's route in a loop."""

    def walk(guard: EnemyGuard) -> bool:
        guard.mode = "patrol"
        guard.go(guard.route[guard.leg], guard.kind.walk_speed)
        if guard.arrived and len(guard.route) > 1:
            guard.leg = (guard.leg + 1) % len(guard.route)
            guard.gap = guard.next_gap()
        return False

    return action(walk)
