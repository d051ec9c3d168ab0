"""What enemies do: chase, search, return and patrol, and branches that a kind of enemy may add.

A branch sets where its guard goes; the guard moves after the tick.
"""

from __future__ import annotations

from collections.abc import Callable
from math import cos, hypot, pi, sin, sqrt
from typing import TYPE_CHECKING, Final

from tltl_runtime.stealth.enemies.behaviour import Node, action, condition, selector, sequence
from tltlc.core.record import record

if TYPE_CHECKING:
    from tltl_runtime.stealth.enemies.enemy import Guard

_CLOSE: Final = 0.55
"""Chasing stops at this share of the attack's range, so that who walks away stays in reach."""


@record
class Branch:
    """A branch of the enemies' tree; of several that could run, the lowest ``rank`` does."""

    name: str
    rank: int
    added: bool
    """Whether only kinds that name it have it; else all have."""
    node: Node


_BRANCHES: Final[dict[str, Branch]] = {}


def branch(name: str, *, rank: int, added: bool = False) -> Callable[[Callable[[], Node]], Callable[[], Node]]:
    """Decorator of a function that makes a branch's node; that function is all that a new branch takes.

    Raises ValueError for a name that is taken.
    """

    def register(make: Callable[[], Node]) -> Callable[[], Node]:
        if name in _BRANCHES:
            raise ValueError(f"there is a branch {name!r} already")
        _BRANCHES[name] = Branch(name, rank, added, make())
        return make

    return register


def added_branches() -> tuple[str, ...]:
    """The names that an enemy kind's ``branches`` may hold."""
    return tuple(sorted(each.name for each in _BRANCHES.values() if each.added))


def tree(branches: tuple[str, ...]) -> Node:
    """The tree of the branches that all enemies have, and of those named.

    Raises ValueError for a name that is no added branch's.
    """
    for name in branches:
        if name not in added_branches():
            raise ValueError(f"no branch {name!r} can be added to an enemy: there are {', '.join(added_branches())}")
    chosen = [each for each in _BRANCHES.values() if not each.added or each.name in branches]
    return selector(*(each.node for each in sorted(chosen, key=lambda each: (each.rank, each.name))))


@branch("chase", rank=10)
def chase() -> Node:
    """Run to a player whose place is known, and stop within reach of it."""

    def knows(guard: Guard) -> bool:
        return guard.knows

    def run(guard: Guard) -> bool:
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
def search() -> Node:
    """Go to where the player was last known to be, then look around there for a time."""

    def lost(guard: Guard) -> bool:
        return guard.search_left > 0.0

    def arrived(guard: Guard) -> bool:
        return guard.searching

    def go_there(guard: Guard) -> bool:
        guard.mode = "search"
        guard.go(guard.last_known[:2], guard.kind.chase_speed)
        guard.searching = guard.arrived
        return guard.searching

    def look_around(guard: Guard) -> bool:
        guard.mode = "search"
        guard.search_left -= guard.dt
        if guard.arrived:
            angle = 2 * pi * guard.rng.random()
            distance = guard.kind.search_radius * sqrt(guard.rng.random())
            x, y, _ = guard.last_known
            guard.go((x + distance * cos(angle), y + distance * sin(angle)), guard.kind.walk_speed)
        if guard.search_left <= 0.0:
            guard.search_left = 0.0
            guard.back = True
        return guard.back

    return sequence(condition(lost), selector(condition(arrived), action(go_there)), action(look_around))


@branch("return", rank=40)
def return_to_route() -> Node:
    """After a search, walk to the nearest point of the route."""

    def is_off(guard: Guard) -> bool:
        return guard.back

    def walk(guard: Guard) -> bool:
        if guard.mode != "return":
            guard.mode = "return"
            guard.leg = guard.nearest_leg()
        guard.go(guard.route[guard.leg], guard.kind.walk_speed)
        guard.back = not guard.arrived
        return False

    return sequence(condition(is_off), action(walk))


@branch("check_gaps", rank=50, added=True)
def check_gaps() -> Node:
    """On patrol, run to a narrow place off the route after each of its legs; each is visited before any again.

    Its speed is between those of walking and chasing, for a walk there would leave the route unwatched for long.
    """

    def is_due(guard: Guard) -> bool:
        return guard.gap is not None

    def visit(guard: Guard) -> bool:
        guard.mode = "patrol"
        assert guard.gap is not None
        guard.go(guard.gap, (guard.kind.walk_speed + guard.kind.chase_speed) / 2)
        if guard.arrived:
            guard.gap = None
        return False

    return sequence(condition(is_due), action(visit))


@branch("patrol", rank=60)
def patrol() -> Node:
    """Walk the route round and round."""

    def walk(guard: Guard) -> bool:
        guard.mode = "patrol"
        guard.go(guard.route[guard.leg], guard.kind.walk_speed)
        if guard.arrived and len(guard.route) > 1:
            guard.leg = (guard.leg + 1) % len(guard.route)
            guard.gap = guard.next_gap()
        return False

    return action(walk)
