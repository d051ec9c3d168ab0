"""The enemies of a level: their perception, memory and motion, without physics.

In each step an enemy looks, its behaviour tree sets a goal, and the enemy turns and walks towards
the goal. It walks only along straight lines that are free, so it cannot enter a solid or a shut
barrier.
"""

from __future__ import annotations

from collections.abc import Sequence
from copy import copy
from math import atan2, cos, hypot, pi, remainder, sin, sqrt
from typing import Final, Literal

import numpy as np

from tltl_runtime.stealth.enemies.branches import tree
from tltl_runtime.stealth.enemies.grid import Floor, Grid, Place, grid_of
from tltl_runtime.stealth.enemies.segments import Corners, corners, distance_to_segment, is_blocked
from tltl_runtime.stealth.level import Enemy, Point, StealthLevel
from tltl_runtime.stealth.world.geometry import Bounds
from tltlc.api import record

EnemyMode = Literal["patrol", "chase", "search", "return"]

EYES: Final = 1.6
"""The height of an enemy's eyes above its feet, in metres."""
STANDING_HEAD: Final = 1.5
CROUCHED_HEAD: Final = 0.7
"""The heights of the player's head above its feet, standing and crouched, in metres."""

CHEST: Final = 0.7
"""The height of the player's chest, as a fraction of the height of the head.

An enemy sees the player if it sees the head or the chest.
"""
_ARRIVED: Final = 0.05
_TURNED: Final = pi / 4
_MOST_LEGS: Final = 16


@record
class PlayerView:
    """The part of the player's state that enemies can see.

    ``position`` is at the feet; ``head`` is the height of the head above the feet, in metres.
    """

    position: Point
    head: float = STANDING_HEAD


class Enemies:
    """All enemies of a level. Call ``reset`` to begin an episode, then ``step`` repeatedly."""

    def __init__(self, level: StealthLevel, grid: Grid | None = None) -> None:
        self.level = level
        self.grid = grid_of(level) if grid is None else grid
        self.guards: tuple[EnemyGuard, ...] = ()
        self.damage = 0.0
        """The health that the player lost in the last step."""
        self._shut: set[int] = set()
        self._solids = [corners(solid.box) for solid in level.solids if solid.box.high[2] > 0.0]
        self._boxes: list[Corners] = []
        """The boxes that block sight: those that stand still, then the movers of the latest step."""
        self._standing = 0

    def reset(self, rng: np.random.Generator) -> None:
        """Put every enemy at its start and shut all barriers; ``rng`` gives the enemies random numbers."""
        self._shut = set(range(len(self.level.barriers)))
        floor = self._update_floor()
        self.guards = tuple(EnemyGuard(enemy, floor, rng) for enemy in self.level.enemies)
        self.damage = 0.0

    def set_open(self, barrier: int, opened: bool) -> None:
        """Open or shut the barrier with the index ``barrier`` in the level.

        The caller must not shut a barrier in which an enemy stands.
        """
        if opened == (barrier not in self._shut):
            return
        (self._shut.discard if opened else self._shut.add)(barrier)
        floor = self._update_floor()
        for guard in self.guards:
            guard.floor = floor
            guard.forget_path()

    def step(self, dt: float, player: PlayerView, movers: Sequence[Bounds] = ()) -> None:
        """Advance all enemies by ``dt`` seconds.

        ``movers`` are the current boxes of the level's movers (moving boxes), which block sight.
        """
        self._boxes[self._standing :] = [(*low, *high) for low, high in movers]
        self.damage = 0.0
        for guard in self.guards:
            self.damage += guard.step(dt, player, self._boxes)

    @property
    def positions(self) -> tuple[Point, ...]:
        """The positions of the enemies' feet."""
        return tuple([guard.position for guard in self.guards])

    @property
    def yaws(self) -> tuple[float, ...]:
        """The enemies' yaws in radians, from -pi to pi."""
        return tuple(guard.yaw for guard in self.guards)

    @property
    def modes(self) -> tuple[EnemyMode, ...]:
        """The enemies' modes: ``patrol``, ``chase``, ``search`` or ``return``."""
        return tuple(guard.mode for guard in self.guards)

    @property
    def sees(self) -> tuple[bool, ...]:
        """Whether each enemy sees the player."""
        return tuple([guard.sees for guard in self.guards])

    @property
    def knows(self) -> tuple[bool, ...]:
        """Whether each enemy has noticed the player and still knows its position."""
        return tuple([guard.knows for guard in self.guards])

    def _update_floor(self) -> Floor:
        shut = [self.level.barriers[index] for index in sorted(self._shut)]
        self._boxes = self._solids + [corners(barrier.box) for barrier in shut if barrier.kind == "solid"]
        self._standing = len(self._boxes)
        return self.grid.floor(self._shut)


class EnemyGuard:
    """One enemy in an episode: its pose, its perception and its memory."""

    def __init__(self, enemy: Enemy, floor: Floor, rng: np.random.Generator) -> None:
        self.kind = enemy.kind
        self.floor = floor
        self.rng = rng
        self.route: tuple[Place, ...] = tuple(point[:2] for point in enemy.route)
        self.x, self.y = floor.standing_place(self.route[0])
        self.leg = min(1, len(self.route) - 1)
        dx, dy = self.route[self.leg][0] - self.x, self.route[self.leg][1] - self.y
        self.yaw = atan2(dy, dx)
        self.mode: EnemyMode = "patrol"
        self.dt = 0.0
        self.sees = False
        self.knows = False
        self.in_reach = False
        """Whether the guard can hit the player.

        The guard must know the player's position and be near enough, with nothing in between.
        """
        self.last_known: Point = (self.x, self.y, 0.0)
        self.search_left = 0.0
        self.searching = False
        """Whether the search has reached the player's last known position."""
        self.is_off_route = False
        """Whether the guard is off its route and has to return to it."""
        self.gap: Place | None = None
        self._visited: set[Place] = set()
        self._gaps_of: Floor | None = None
        self._gaps: tuple[Place, ...] = ()
        self._tick = tree(enemy.kind.branches)
        self._in_sight = 0.0
        self._out_of_sight = 0.0
        self._goal: Place = (self.x, self.y)
        self._speed = 0.0
        self._facing: Place | None = None
        self._waypoint: Place | None = None
        self._anchor: Place = (self.x, self.y)
        """The last position from which the guard found a path.

        If the guard is stuck in a narrow corner, it can walk back there in a straight line.
        """
        self._half_angle_cosine = cos(min(enemy.kind.sight_angle, 2 * pi) / 2)

    def fork(self, rng: np.random.Generator) -> EnemyGuard:
        """Return an independent copy of the guard that draws random numbers from ``rng``."""
        copy_of_guard = copy(self)
        copy_of_guard.rng = rng
        copy_of_guard._visited = set(self._visited)
        return copy_of_guard

    def step(self, dt: float, player: PlayerView, boxes: Sequence[Corners]) -> float:
        """Look, decide and move for ``dt`` seconds; return the health that the player loses.

        ``boxes`` block the guard's sight.
        """
        self.dt = dt
        self._look(player, boxes)
        self._facing = None
        self._tick(self)
        self._move(dt)
        return self.kind.attack_damage * dt if self.knows and self.in_reach else 0.0

    @property
    def state(self) -> tuple[object, ...]:
        """The guard's pose and current task.

        Two guards in equal states move equally while they see no player. Guards that search or have
        optional branches are exceptions, because they draw random numbers.
        """
        return (self.x, self.y, self.yaw, self.mode, self.leg, self.is_off_route, self.search_left > 0.0)

    @property
    def position(self) -> Point:
        """The position of the guard's feet."""
        return (self.x, self.y, 0.0)

    def go(self, goal: Place, speed: float) -> None:
        """Set the goal and the speed, in m/s, at which the guard walks in this and later steps.

        If the goal cannot be reached, the guard walks to the reachable place nearest to it.
        """
        if goal != self._goal:
            self._goal = goal
            self._waypoint = None
        self._speed = speed

    def face(self, x: float, y: float) -> None:
        """Turn towards a point in this step if the guard does not walk."""
        self._facing = (x, y)

    @property
    def arrived(self) -> bool:
        """Whether the guard has reached the goal of ``go``, or cannot come nearer."""
        if hypot(self._goal[0] - self.x, self._goal[1] - self.y) < _ARRIVED:
            return True
        return self._next_waypoint() == (self.x, self.y)

    def nearest_leg(self) -> int:
        """Return the index of the point of the route that is nearest to the guard, measured in a straight line."""
        return min(range(len(self.route)), key=lambda i: hypot(self.route[i][0] - self.x, self.route[i][1] - self.y))

    def next_gap(self) -> Place | None:
        """Pick a gap, a narrow place off the route: at random, one of the three nearest unvisited gaps.

        When all gaps have been visited, all count as unvisited again. Return None if the floor has
        no gap.
        """
        if self._gaps_of is not self.floor:
            self._gaps_of = self.floor
            gaps = self.floor.gaps(self.floor.area((self.x, self.y)))
            self._gaps = tuple(gap for gap in gaps if not self._is_on_route(gap))
        if not self._gaps:
            return None
        if self._visited.issuperset(self._gaps):
            self._visited.clear()
        left = [gap for gap in self._gaps if gap not in self._visited]
        left.sort(key=lambda gap: hypot(gap[0] - self.x, gap[1] - self.y))
        chosen = left[int(self.rng.integers(min(3, len(left))))]
        self._visited.add(chosen)
        return chosen

    def forget_path(self) -> None:
        """Discard the path to the current goal; call this when the floor has changed."""
        self._waypoint = None

    def _is_on_route(self, gap: Place) -> bool:
        ends = zip(self.route, (*self.route[1:], self.route[0]), strict=True)
        return any(distance_to_segment(gap, a, b) < 1.0 for a, b in ends)

    def _look(self, player: PlayerView, boxes: Sequence[Corners]) -> None:
        """Update what the guard sees and knows, and whether the player is in reach.

        ``boxes`` block sight. A guard that knows the player's position turns its head: it sees in
        all directions.
        """
        dt, kind = self.dt, self.kind
        px, py, pz = player.position
        dx, dy = px - self.x, py - self.y
        flat = hypot(dx, dy)
        self.sees = self.in_reach = False
        if flat <= kind.sight_range:
            head, chest = (px, py, pz + player.head), (px, py, pz + CHEST * player.head)
            eyes = (self.x, self.y, EYES)
            in_cone = self.knows or dx * cos(self.yaw) + dy * sin(self.yaw) >= flat * self._half_angle_cosine
            near = flat <= kind.attack_range and self.knows
            if in_cone and sqrt(flat**2 + (head[2] - EYES) ** 2) <= kind.sight_range:
                self.sees = not is_blocked(eyes, head, boxes) or not is_blocked(eyes, chest, boxes)
            if near and abs(pz) < 1.0:
                self.in_reach = self.sees or not is_blocked(eyes, chest, boxes)
        if self.sees:
            self._in_sight += dt
            self._out_of_sight = 0.0
            if self._in_sight >= kind.reaction_time - 1e-9:
                self.knows = True
        else:
            self._in_sight = 0.0
            self._out_of_sight += dt
            if self.knows and self._out_of_sight > kind.memory_time + 1e-9:
                self.knows, self.searching = False, False
                self.search_left = kind.search_time
                self.is_off_route = kind.search_time <= 0.0
        if self.knows:
            self.last_known = player.position
            self.search_left = 0.0
            self.is_off_route = True

    def _next_waypoint(self) -> Place:
        if self._waypoint is None:
            here = (self.x, self.y)
            waypoint = self.floor.next_point(here, self._goal)
            if waypoint is not None:
                self._anchor = here
            self._waypoint = self._anchor if waypoint is None else waypoint
        return self._waypoint

    def _move(self, dt: float) -> None:
        """Walk towards the goal for ``dt`` seconds, around corners.

        First turn towards the next point of the path. If this point is then still more than 45
        degrees to the side, do not walk.
        """
        left = self._speed * dt
        turned = False
        for _leg in range(_MOST_LEGS):
            if left <= 0.0 or (self.x, self.y) == self._goal:
                break
            x, y = self._next_waypoint()
            distance = hypot(x - self.x, y - self.y)
            if distance == 0.0:
                break
            if not turned:
                turned = True
                if abs(self._turn(atan2(y - self.y, x - self.x), dt)) > _TURNED:
                    return
            if distance <= left:
                self.x, self.y = x, y
                self._waypoint = None
                left -= distance
            else:
                self.x += (x - self.x) * left / distance
                self.y += (y - self.y) * left / distance
                left = 0.0
        if not turned and self._facing is not None:
            x, y = self._facing
            if (x, y) != (self.x, self.y):
                self._turn(atan2(y - self.y, x - self.x), dt)

    def _turn(self, yaw: float, dt: float) -> float:
        """Turn towards ``yaw`` for ``dt`` seconds; return the angle that is still missing, in radians."""
        missing = remainder(yaw - self.yaw, 2 * pi)
        most = self.kind.turn_speed * dt
        turn = min(max(missing, -most), most)
        self.yaw = remainder(self.yaw + turn, 2 * pi)
        return missing - turn
