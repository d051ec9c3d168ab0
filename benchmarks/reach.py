"""Where the player gets in the real physics: a search over poses, by every action from each.

A pose is a cell of the level with a stance, whether the player stands on something, and how fast it rises or falls;
each is explored from one state, the first that was met in it.  So what is found can be reached, and what
is not found may still be; what is out of reach for certain is told by :mod:`tltl_runtime.stealth.capabilities.reach`.

``python -m benchmarks.reach`` shows both for ``navigation`` v0 and v2, from the start, with the gap shut until its
switch has been pressed.  It takes a minute, and is no part of ``python -m benchmarks``.
"""

from __future__ import annotations

import time
from collections.abc import Callable
from contextlib import closing
from heapq import heappop, heappush
from itertools import product
from math import floor
from typing import TYPE_CHECKING

from tltlc.core.record import record

if TYPE_CHECKING:
    from tltl_runtime.stealth.level import Point
    from tltl_runtime.stealth.world.physics import World
    from tltl_runtime.stealth.world.player import Action, PlayerState

CELL_M = 0.2
SPEED_BUCKET = 3.0
"""Metres a second of rising or falling that count as alike: what gravity does to a decision."""


@record
class Search:
    """What a search found: ``met`` its goal or not; how many ``poses`` and ``decisions``; where the feet came."""

    met: bool
    poses: int
    decisions: int
    places: tuple[Point, ...]


def search(
    world: World,
    goal: Callable[[Point], bool],
    *,
    cell: float = CELL_M,
    most: int | None = None,
    first: Callable[[Point], float] = lambda place: 0.0,
) -> Search:
    """Explore all poses from that of the player on, until ``goal`` holds of the feet or nothing is left.

    Those with the least ``first`` are explored first; no more than ``most`` decisions are made.
    """
    begin = world.player
    met = {_pose(begin, cell)}
    waiting: list[tuple[float, int, PlayerState]] = [(first(begin.position), 0, begin)]
    places = [begin.position]
    decisions = 0
    while waiting and (most is None or decisions < most):
        _, _, state = heappop(waiting)
        for action in _actions(state):
            world.put(state)
            world.step(action)
            decisions += 1
            new = world.player
            pose = _pose(new, cell)
            if pose in met:
                continue
            met.add(pose)
            places.append(new.position)
            if goal(new.position):
                return Search(True, len(met), decisions, tuple(places))
            # Sprinting is always possible here: the search asks where, and not how fast one tires.
            heappush(waiting, (first(new.position), len(met), _rested(new)))
    return Search(False, len(met), decisions, tuple(places))


def _actions(state: PlayerState) -> list[Action]:
    """The 72 actions, without those that come to the same as another in this state."""
    found = []
    for x, y, jump, crouch, sprint in product((0, 1, 2), (0, 1, 2), (0, 1), (0, 1), (0, 1)):
        if jump and (crouch or not state.grounded):
            continue
        if sprint and (crouch or not (x or y)):
            continue
        found.append((x, y, jump, crouch, sprint))
    return found


def _pose(state: PlayerState, cell: float) -> tuple[int, int, int, bool, bool, int]:
    x, y, z = (floor(value / cell) for value in state.position)
    return x, y, z, state.crouching, state.grounded, round(state.velocity[2] / SPEED_BUCKET)


def _rested(state: PlayerState) -> PlayerState:
    from tltlc.core.record import replace

    return replace(state, stamina=1.0)


def main() -> None:
    """Search v0 and v2 of navigation, and say how far one gets."""
    for variant in ("v0", "v2"):
        _show(variant)


def _show(variant: str) -> None:
    from tltl_runtime.stealth.capabilities.reach import reachable
    from tltl_runtime.stealth.levels.file import load_level
    from tltl_runtime.stealth.world.physics import World

    level = load_level("navigation", variant)
    switch, begin = level.switches[0], time.perf_counter()
    with closing(World(level)) as world:
        world.reset(None)
        room = search(world, lambda place: _near(place, switch.position, switch.radius))
        print(f"{variant}: {switch.name} {'reached' if room.met else 'NOT reached'} after {room.decisions} decisions")
        for index, barrier in enumerate(level.barriers):
            world.set_open(index, barrier.opened_by == (switch.name,))
        # The hurdle at the end of the corridor is 15.4 m from the west.
        rest = search(world, lambda place: place[0] > 16.0, first=lambda place: -place[0])
    print(
        f"{variant}: {'passed' if rest.met else 'never passed'} the corridor, "
        f"furthest east {max(place[0] for place in rest.places):.2f} m; {rest.poses} poses, "
        f"{room.decisions + rest.decisions} decisions, {time.perf_counter() - begin:.0f} s"
    )
    near = ", ".join(f"{name} {distance:.1f} m" for name, distance in reachable(level).distances.items())
    print(f"{variant}: for certain, nobody gets nearer to each than: {near}")


def _near(place: Point, other: Point, radius: float) -> bool:
    return sum((a - b) ** 2 for a, b in zip(place, other, strict=True)) <= radius * radius


if __name__ == "__main__":
    main()
