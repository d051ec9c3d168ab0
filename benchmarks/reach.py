"""Search for the places that a player can reach in the real physics, by every action from every pose.

A pose is a cell of the level with a stance, whether the player stands on something, and how fast it
rises or falls. Each pose is explored from the first state that was reached in it. So a place that is
found can be reached; a place that is not found may be reachable, too.
:mod:`tltl_runtime.stealth.capabilities.reach` proves that places cannot be reached.

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
"""Vertical speeds are rounded to multiples of this, in m/s: the change by gravity in a decision."""


@record
class Search:
    """The result of a search: whether it found the goal, how much it explored, and where the feet were."""

    found_goal: bool
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
    """Explore poses from the player's pose on, until the feet are at a ``goal`` or no pose is left.

    Poses with the least ``first`` are explored first. The search ends after ``most`` decisions.
    """
    begin = world.player
    explored = {_pose(begin, cell)}
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
            if pose in explored:
                continue
            explored.add(pose)
            places.append(new.position)
            if goal(new.position):
                return Search(True, len(explored), decisions, tuple(places))
            # Restore the stamina: the search looks for places, whether or not the player would be tired.
            heappush(waiting, (first(new.position), len(explored), _with_full_stamina(new)))
    return Search(False, len(explored), decisions, tuple(places))


def _actions(state: PlayerState) -> list[Action]:
    """Return the 72 actions, without those that have the same effect as another in this state."""
    distinct_actions = []
    for x, y, jump, crouch, sprint in product((0, 1, 2), (0, 1, 2), (0, 1), (0, 1), (0, 1)):
        if jump and (crouch or not state.grounded):
            continue
        if sprint and (crouch or not (x or y)):
            continue
        distinct_actions.append((x, y, jump, crouch, sprint))
    return distinct_actions


def _pose(state: PlayerState, cell: float) -> tuple[int, int, int, bool, bool, int]:
    x, y, z = (floor(value / cell) for value in state.position)
    return x, y, z, state.crouching, state.grounded, round(state.velocity[2] / SPEED_BUCKET)


def _with_full_stamina(state: PlayerState) -> PlayerState:
    from tltlc.core.record import replace

    return replace(state, stamina=1.0)


def main() -> None:
    """Search v0 and v2 of navigation, and print how far the player gets."""
    for variant in ("v0", "v2"):
        _show(variant)


def _show(variant: str) -> None:
    from tltl_runtime.stealth.capabilities.reach import compute_reach
    from tltl_runtime.stealth.levels.file import load_level
    from tltl_runtime.stealth.world.physics import World

    level = load_level("navigation", variant)
    switch, begin = level.switches[0], time.perf_counter()
    with closing(World(level)) as world:
        world.reset(None)
        room = search(world, lambda place: _is_near(place, switch.position, switch.radius))
        outcome = "reached" if room.found_goal else "NOT reached"
        print(f"{variant}: {switch.name} {outcome} after {room.decisions} decisions")
        for index, barrier in enumerate(level.barriers):
            world.set_open(index, barrier.opened_by == (switch.name,))
        # The hurdle at the end of the corridor is 15.4 m from the west.
        rest = search(world, lambda place: place[0] > 16.0, first=lambda place: -place[0])
    print(
        f"{variant}: {'passed' if rest.found_goal else 'never passed'} the corridor, "
        f"furthest east {max(place[0] for place in rest.places):.2f} m; {rest.poses} poses, "
        f"{room.decisions + rest.decisions} decisions, {time.perf_counter() - begin:.0f} s"
    )
    near = ", ".join(f"{name} {distance:.1f} m" for name, distance in compute_reach(level).distances.items())
    print(f"{variant}: for certain, nobody gets nearer to each than: {near}")


def _is_near(place: Point, centre: Point, radius: float) -> bool:
    return sum((a - b) ** 2 for a, b in zip(place, centre, strict=True)) <= radius * radius


if __name__ == "__main__":
    main()
