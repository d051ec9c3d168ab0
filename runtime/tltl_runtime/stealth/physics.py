"""The bodies of a level in pybullet: static boxes, barriers, movers, and the player's capsule.

The player is a dynamic capsule without rotation and friction, whose velocity is set once a decision; Bullet then runs
nine steps of 1/60 s at once.  What was measured, and must stay so:

- The player is a Featherstone body (a Bullet rigid body with a zero inertia becomes not-a-number); all else has
  maximal coordinates, because each further Featherstone body costs as much as the player in every step.
- Bullet keeps 16 children of a compound shape and silently drops the rest.
- A mass that changes between zero and non-zero resets collision filters, so masses never change.
- A body that is given no visual shape gets one from its collision shape, unless ``URDF_IGNORE_VISUAL_SHAPES`` is set.
- Crouching swaps two capsules; the one that is not played stands on a perch under the level, that only it touches
  (a sleeping Featherstone body falls all the same).
- Every reset builds the world anew: that is what makes episodes the same bit for bit, whatever went before.
"""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise
from math import cos, floor, pi, sin, sqrt
from typing import Protocol

import pybullet

from tltl_runtime.stealth.level import Level, Mover, Point
from tltl_runtime.stealth.player import DECISION, PlayerKind, PlayerState, control

Bounds = tuple[Point, Point]
"""The low and the high corner of a box."""

SUBSTEPS = 9
"""Physics steps in a decision."""

_COMPOUND = 16
_RAY, _PLAYER, _PARKED, _WORLD = 1, 2, 4, 8
"""Groups of collision; Bullet puts rays in the first."""
_STOPS = _RAY | _PLAYER
"""What the world stops; not itself, since static bodies that meet would cost five times the rest of a step."""
_UPRIGHT = (0.0, 0.0, 0.0, 1.0)
_SPECULATION = 0.12
"""Contacts count from this distance on, so that a fast body is stopped at a surface and not a step behind it."""
_GIVE = 0.1
"""How far below the bounds the feet may be, for a landing."""
_ROOM = 0.02
"""How far a body may reach into another and still count as free of it."""
_HARDEST_PUSH = 8.0
"""Greatest speed that a mover gives the player."""


class Random(Protocol):
    """What a reset draws from; both ``random.Random`` and ``numpy.random.Generator`` will do."""

    def random(self) -> float:
        """A number in [0, 1)."""


class WorldError(RuntimeError):
    """The world is not what its level says, or a body left it: a fault of the level or of the physics."""

    def __init__(self, level: Level, step: int, body: str, what: str) -> None:
        super().__init__(f"level {level.name} {level.variant}, step {step}, {body}: {what}")
        self.level, self.variant, self.step, self.body = level.name, level.variant, step, body


class World:
    """A level's bodies in one pybullet client of their own.

    Barriers and movers go by their index in the level.  Lasers have no body here: they stop neither bodies nor sight.
    The constructor checks the world (see ``check``) and leaves it reset, with the player at the start itself.
    """

    def __init__(self, level: Level, kind: PlayerKind | None = None) -> None:
        self.level = level
        self.kind = PlayerKind() if kind is None else kind
        self.steps = 0
        self._client = pybullet.connect(pybullet.DIRECT)
        self._open = [False] * len(level.barriers)
        self._clocks = [mover.offset for mover in level.movers]
        self._ways = [Way(mover) for mover in level.movers]
        self._boxes = [(solid.box.low, solid.box.high) for solid in level.solids]
        self._around = _cells(self._boxes, self.kind.radius + self.kind.sprint_speed * DECISION)
        try:
            self.reset(None)
            self.check()
        except BaseException:
            self.close()
            raise

    def close(self) -> None:
        """Give the client back; the world is of no use afterwards.  Closing twice does nothing."""
        if self._client >= 0:
            pybullet.disconnect(physicsClientId=self._client)
            self._client = -1

    def reset(self, rng: Random | None) -> None:
        """Begin an episode: barriers shut, movers at their offset, the player within the start's spread.

        Without ``rng`` the player is at the start itself.  Raises WorldError where it finds no room there.
        """
        self.steps = 0
        self._open = [False] * len(self.level.barriers)
        self._clocks = [mover.offset for mover in self.level.movers]
        self._places = [way.at(clock) for way, clock in zip(self._ways, self._clocks, strict=True)]
        self._build()
        feet = self._start(rng)
        self._stance(False, feet, (0.0, 0.0, 0.0))
        self._state = PlayerState(feet, (0.0, 0.0, 0.0), self.level.start.yaw, False, True, 1.0)
        pybullet.stepSimulation(physicsClientId=self._client)
        self._observe(False, self.level.start.yaw, 1.0)

    def step(self, action: Sequence[int]) -> None:
        """Advance by one decision, 0.15 s.

        Raises WorldError when the player is no longer inside the level's bounds.
        """
        self.steps += 1
        old = self._state
        kind = self.kind
        crouching = bool(action[3]) or (old.crouching and not self.room(old.position, kind.height))
        wish = control(kind, old, action, crouching)
        velocity = (*wish.velocity, kind.jump_speed if wish.jump else max(old.velocity[2], -kind.fall_speed))
        step = 0.0 if wish.jump or not old.grounded else self._step_ahead(wish.velocity, self._height(crouching))
        if step or crouching != old.crouching:
            x, y, z = old.position
            self._stance(crouching, (x, y, z + step), (*wish.velocity, 0.0) if step else velocity)
        else:
            pybullet.resetBaseVelocity(self._body, velocity, physicsClientId=self._client)
        if self._ways:
            self._step_with_movers(velocity)
        else:
            pybullet.stepSimulation(physicsClientId=self._client)
        self._observe(crouching, wish.yaw, wish.stamina)

    @property
    def player(self) -> PlayerState:
        """The player after the last decision."""
        return self._state

    def mover_positions(self) -> tuple[Point, ...]:
        """The centres of the level's movers, in its order."""
        return tuple(self._places)

    def is_open(self, barrier: int) -> bool:
        """Whether a barrier is open."""
        return self._open[barrier]

    def set_open(self, barrier: int, is_open: bool) -> None:
        """Open or shut a barrier; an open one stops neither bodies nor sight."""
        self._open[barrier] = is_open
        body = self._barriers[barrier]
        if body is not None:
            # Switching the filter keeps the body where its level says, and rays honour it (moving it does as well).
            self._filter(body, 0 if is_open else _WORLD, 0 if is_open else _STOPS)

    def ray_blocked(self, start: Point, end: Point) -> bool:
        """Whether a solid, a shut barrier or a mover stands between two points; lasers and the player do not."""
        hit = pybullet.rayTest(start, end, collisionFilterMask=_WORLD, physicsClientId=self._client)[0]
        return bool(hit[0] >= 0)

    def room(self, feet: Point, height: float) -> bool:
        """Whether a capsule of the player's radius and this ``height`` is free of everything that stops bodies."""
        radius = self.kind.radius
        return all(
            _depth(feet, height, radius, low, high) <= _ROOM
            for boxes in (self._near(feet), self._changing())
            for low, high in boxes
        )

    def check(self) -> None:
        """Raise WorldError where a wall is missing, by rays to the six sides of all boxes, or a filter is wrong.

        A side is tested at its middle, from a centimetre outside, unless another body covers that point.
        """
        boxes = [(solid.name, solid.box.low, solid.box.high) for solid in self.level.solids]
        boxes += [
            (barrier.name, barrier.box.low, barrier.box.high)
            for barrier, is_open in zip(self.level.barriers, self._open, strict=True)
            if barrier.kind == "solid" and not is_open
        ]
        boxes += [
            (mover.name, *_around(centre, mover.size))
            for mover, centre in zip(self.level.movers, self._places, strict=True)
        ]
        for name, low, high in boxes:
            for side, (outside, face) in _sides(low, high).items():
                if any(_inside(outside, other_low, other_high) for _, other_low, other_high in boxes):
                    continue
                middle = tuple((a + b) / 2 for a, b in zip(low, high, strict=True))
                hit = pybullet.rayTest(outside, middle, collisionFilterMask=_WORLD, physicsClientId=self._client)[0]
                if hit[0] < 0 or max(abs(a - b) for a, b in zip(hit[3], face, strict=True)) > 0.005:
                    raise WorldError(self.level, self.steps, name, f"nothing is hit on its side {side}")
        self._check_filters()

    # Building

    def _build(self) -> None:
        client = self._client
        pybullet.resetSimulation(physicsClientId=client)
        pybullet.setGravity(0.0, 0.0, -self.kind.gravity, physicsClientId=client)
        pybullet.setPhysicsEngineParameter(
            fixedTimeStep=DECISION,
            numSubSteps=SUBSTEPS,
            deterministicOverlappingPairs=1,
            contactBreakingThreshold=_SPECULATION,
            physicsClientId=client,
        )
        self._speed_of_time = SUBSTEPS
        for part in _parts(self._boxes):
            self._compound(part)
        self._barriers = [
            self._compound([(barrier.box.low, barrier.box.high)]) if barrier.kind == "solid" else None
            for barrier in self.level.barriers
        ]
        self._movers = [self._mover(mover, place) for mover, place in zip(self.level.movers, self._places, strict=True)]
        low, high = self.level.bounds.low, self.level.bounds.high
        perch = ((low[0] + high[0]) / 2, (low[1] + high[1]) / 2, low[2] - 10.0)
        self._perches = {False: perch, True: (perch[0] + 2.0, perch[1], perch[2])}
        ground = self._compound([((perch[0] - 4, perch[1] - 4, perch[2] - 1), (perch[0] + 6, perch[1] + 4, perch[2]))])
        self._filter(ground, _PARKED, _PARKED)
        self._bodies = {crouching: self._capsule(crouching) for crouching in (False, True)}
        self._body = self._bodies[False]

    def _compound(self, boxes: Sequence[Bounds]) -> int:
        """One static body of at most 16 boxes."""
        shape = pybullet.createCollisionShapeArray(
            shapeTypes=[pybullet.GEOM_BOX] * len(boxes),
            halfExtents=[[(b - a) / 2 for a, b in zip(low, high, strict=True)] for low, high in boxes],
            collisionFramePositions=[[(a + b) / 2 for a, b in zip(low, high, strict=True)] for low, high in boxes],
            physicsClientId=self._client,
        )
        return self._static(shape, (0.0, 0.0, 0.0))

    def _mover(self, mover: Mover, place: Point) -> int:
        half = [side / 2 for side in mover.size]
        shape = pybullet.createCollisionShape(pybullet.GEOM_BOX, halfExtents=half, physicsClientId=self._client)
        return self._static(shape, place)

    def _static(self, shape: int, place: Point) -> int:
        body: int = pybullet.createMultiBody(
            0.0,
            shape,
            -1,
            place,
            useMaximalCoordinates=1,
            flags=pybullet.URDF_IGNORE_VISUAL_SHAPES,
            physicsClientId=self._client,
        )
        pybullet.changeDynamics(body, -1, lateralFriction=0.0, restitution=0.0, physicsClientId=self._client)
        self._filter(body, _WORLD, _STOPS)
        return body

    def _capsule(self, crouching: bool) -> int:
        kind = self.kind
        height = kind.crouched_height if crouching else kind.height
        shape = pybullet.createCollisionShape(
            pybullet.GEOM_CAPSULE, radius=kind.radius, height=height - 2 * kind.radius, physicsClientId=self._client
        )
        x, y, z = self._perches[crouching]
        body: int = pybullet.createMultiBody(
            1.0,
            shape,
            -1,
            (x, y, z + height / 2),
            flags=pybullet.URDF_IGNORE_VISUAL_SHAPES,
            physicsClientId=self._client,
        )
        pybullet.changeDynamics(
            body,
            -1,
            localInertiaDiagonal=(0.0, 0.0, 0.0),
            lateralFriction=0.0,
            spinningFriction=0.0,
            rollingFriction=0.0,
            restitution=0.0,
            linearDamping=0.0,
            angularDamping=0.0,
            physicsClientId=self._client,
        )
        self._filter(body, _PARKED, _PARKED)
        return body

    def _filter(self, body: int, group: int, mask: int) -> None:
        pybullet.setCollisionFilterGroupMask(body, -1, group, mask, physicsClientId=self._client)

    # The player

    def _start(self, rng: Random | None) -> Point:
        """Where the feet are put, free of everything."""
        x, y, z = self.level.start.position
        for _ in range(100 if rng is not None else 1):
            if rng is None:
                feet = (x, y, z)
            else:
                distance, angle = self.level.start.spread * sqrt(rng.random()), 2 * pi * rng.random()
                feet = (x + distance * cos(angle), y + distance * sin(angle), z)
            if self.room(feet, self.kind.height):
                return feet
        raise WorldError(self.level, 0, "player", f"there is no room at the start ({x:g}, {y:g}, {z:g})")

    def _stance(self, crouching: bool, feet: Point, velocity: Point) -> None:
        """Play the standing or the crouched capsule, and park the other."""
        for body, played in ((self._bodies[not crouching], False), (self._bodies[crouching], True)):
            height = self._height(crouching if played else not crouching)
            x, y, z = feet if played else self._perches[not crouching]
            self._filter(body, _PLAYER if played else _PARKED, _WORLD | _RAY if played else _PARKED)
            place = (x, y, z + height / 2)
            pybullet.resetBasePositionAndOrientation(body, place, _UPRIGHT, physicsClientId=self._client)
            pybullet.resetBaseVelocity(
                body, velocity if played else (0.0, 0.0, 0.0), (0.0, 0.0, 0.0), physicsClientId=self._client
            )
        self._body = self._bodies[crouching]
        self._check_filters()

    def _step_ahead(self, velocity: tuple[float, float], height: float) -> float:
        """How high the feet are lifted to walk up a stair that is in the way of this decision; 0 where there is none.

        A velocity that is set once a decision is spent at the first edge, so that Bullet alone climbs no stairs.
        """
        kind = self.kind
        if velocity == (0.0, 0.0):
            return 0.0
        x, y, z = self._state.position
        boxes = [box for box in self._near((x, y, z)) if z + _ROOM < box[1][2] and box[0][2] < z + kind.radius]
        if not boxes:
            return 0.0
        # A wall beside the stairs must not stop who goes up along it, so each direction counts by itself as well.
        both = velocity[0] and velocity[1]
        ways = (velocity, (velocity[0], 0.0), (0.0, velocity[1])) if both else (velocity,)
        return max(self._step_along(way, height, boxes) for way in ways)

    def _step_along(self, velocity: tuple[float, float], height: float, boxes: Sequence[Bounds]) -> float:
        """The step up to the first of ``boxes`` that is met, where it is low enough and there is room above it."""
        kind = self.kind
        x, y, z = self._state.position
        for share in (1 / 3, 2 / 3, 1.0):
            ahead = (x + velocity[0] * DECISION * share, y + velocity[1] * DECISION * share)
            tops = [high[2] for low, high in boxes if _depth((*ahead, z), height, kind.radius, low, high) > _ROOM]
            if tops:
                step = max(tops) - z + 0.005
                fits = step <= kind.step_height + _ROOM and all(
                    self.room((a, b, z + step), height) for a, b in ((x, y), ahead)
                )
                return step if fits else 0.0
        return 0.0

    def _height(self, crouching: bool) -> float:
        return self.kind.crouched_height if crouching else self.kind.height

    def _check_filters(self) -> None:
        """A ray down the played capsule hits it, and one down the parked capsule does not, each in its own group."""
        for crouching, body in self._bodies.items():
            (x, y, z), _ = pybullet.getBasePositionAndOrientation(body, physicsClientId=self._client)
            top = (x, y, z + self._height(crouching) / 2 + 0.005)
            hit = pybullet.rayTest(top, (x, y, z), collisionFilterMask=_PLAYER, physicsClientId=self._client)[0][0]
            if (hit == body) != (body == self._body):
                name = "crouched player" if crouching else "standing player"
                raise WorldError(self.level, self.steps, name, "its collision filter is not the one that was set")

    def _observe(self, crouching: bool, yaw: float, stamina: float) -> None:
        """Read the player back from the physics, and make sure that it is inside the bounds."""
        client = self._client
        place, _ = pybullet.getBasePositionAndOrientation(self._body, physicsClientId=client)
        velocity, _ = pybullet.getBaseVelocity(self._body, physicsClientId=client)
        x, y, z = place
        low, high = self.level.bounds.low, self.level.bounds.high
        z -= self._height(crouching) / 2
        # Not-a-number fails the comparison as well.
        if not (low[0] <= x <= high[0] and low[1] <= y <= high[1] and low[2] - _GIVE <= z <= high[2]):
            raise WorldError(self.level, self.steps, "player", f"({x:g}, {y:g}, {z:g}) is outside the level's bounds")
        contacts = pybullet.getContactPoints(self._body, physicsClientId=client)
        grounded = any(contact[7][2] > 0.5 and contact[8] < _ROOM for contact in contacts)
        self._state = PlayerState((x, y, z), velocity, yaw, crouching, grounded, stamina)

    # Movers

    def _step_with_movers(self, velocity: Point) -> None:
        """Advance one decision; physics step by physics step where the player is near a mover, else at once."""
        x, y, z = self._state.position
        reach = 1.5
        near = any(
            _reaches((x, y, z), self.kind.height, place, mover, reach + mover.speed * DECISION)
            for place, mover in zip(self._places, self.level.movers, strict=True)
        )
        if near:
            self._time(1)
            for _ in range(SUBSTEPS):
                self._push(DECISION / SUBSTEPS)
        else:
            self._time(SUBSTEPS)
            for index in range(len(self._movers)):
                self._place(index, self._clocks[index] + DECISION)
            pybullet.stepSimulation(physicsClientId=self._client)

    def _time(self, substeps: int) -> None:
        """How many physics steps Bullet runs at once."""
        if substeps != self._speed_of_time:
            self._speed_of_time = substeps
            pybullet.setPhysicsEngineParameter(
                fixedTimeStep=DECISION * substeps / SUBSTEPS, numSubSteps=substeps, physicsClientId=self._client
            )

    def _place(self, index: int, clock: float) -> None:
        """Put a mover where it is at a time of its own clock."""
        self._clocks[index] = clock
        self._places[index] = place = self._ways[index].at(clock)
        pybullet.resetBasePositionAndOrientation(self._movers[index], place, _UPRIGHT, physicsClientId=self._client)

    def _push(self, seconds: float) -> None:
        """One physics step with movers: each goes on and pushes; it waits where the player has no room to be pushed to.

        Bullet sees a box that is put elsewhere, not one that moves, so the push is given to the player as velocity.
        A box that went on regardless would press the player through a wall, however slowly.
        """
        client = self._client
        height, radius = self._height(self._body == self._bodies[True]), self.kind.radius
        (x, y, z), _ = pybullet.getBasePositionAndOrientation(self._body, physicsClientId=client)
        feet = (x, y, z - height / 2)
        for index, mover in enumerate(self.level.movers):
            clock, place = self._clocks[index], self._places[index]
            self._place(index, clock + seconds)
            depth, normal = _contact(feet, height, radius, *_around(self._places[index], mover.size))
            if depth <= 0.0 or depth <= _contact(feet, height, radius, *_around(place, mover.size))[0]:
                continue
            across = sqrt(normal[0] ** 2 + normal[1] ** 2)
            if normal[2] < 0.0 and across > 0.3:
                # An edge that comes down on the shoulder pushes aside.
                depth, normal = depth / across, (normal[0] / across, normal[1] / across, 0.0)
            pushed = (x + depth * normal[0], y + depth * normal[1], feet[2] + depth * normal[2])
            if not self._room_beside(index, pushed, height):
                self._place(index, clock)
                continue
            now, _ = pybullet.getBaseVelocity(self._body, physicsClientId=client)
            lack = min(depth / seconds, _HARDEST_PUSH) - sum(a * b for a, b in zip(now, normal, strict=True))
            if lack > 0.0:
                faster = [a + lack * b for a, b in zip(now, normal, strict=True)]
                pybullet.resetBaseVelocity(self._body, faster, physicsClientId=client)
        pybullet.stepSimulation(physicsClientId=client)

    def _room_beside(self, mover: int, feet: Point, height: float) -> bool:
        """Whether the player has room there, but for one mover."""
        changing = self._changing()
        del changing[len(changing) - len(self._movers) + mover]
        radius = self.kind.radius
        return all(
            _depth(feet, height, radius, low, high) <= _ROOM
            for boxes in (self._near(feet), changing)
            for low, high in boxes
        )

    # What stops bodies

    def _near(self, feet: Point) -> list[Bounds]:
        """The solids that a capsule with its feet there, or a decision's way from there, can touch."""
        return self._around.get((floor(feet[0]), floor(feet[1])), [])

    def _changing(self) -> list[Bounds]:
        """The shut barriers and the movers."""
        boxes = [
            (barrier.box.low, barrier.box.high)
            for barrier, is_open in zip(self.level.barriers, self._open, strict=True)
            if barrier.kind == "solid" and not is_open
        ]
        boxes += [_around(place, mover.size) for place, mover in zip(self._places, self.level.movers, strict=True)]
        return boxes


class Way:
    """Where a mover is at a time of its own clock: there and back again, or round and round where it is closed."""

    def __init__(self, mover: Mover) -> None:
        path = mover.path
        stops = [*path, path[0]] if mover.closed else [*path, *path[-2::-1]]
        self._first = path[0]
        self._legs: list[tuple[float, Point, Point, float]] = []
        self._pause = mover.pause
        self._lap = 0.0
        for start, end in pairwise(stops):
            length = sqrt(sum((b - a) ** 2 for a, b in zip(start, end, strict=True)))
            self._legs.append((self._lap, start, end, length / mover.speed))
            self._lap += mover.pause + length / mover.speed

    def at(self, clock: float) -> Point:
        """The centre at ``clock`` seconds; each leg begins with the pause at its first point."""
        if self._lap <= 0.0:
            return self._first
        time = clock % self._lap
        begin, start, end, duration = next(leg for leg in reversed(self._legs) if leg[0] <= time)
        share = 0.0 if duration <= 0.0 else min(1.0, max(0.0, (time - begin - self._pause) / duration))
        return (
            start[0] + share * (end[0] - start[0]),
            start[1] + share * (end[1] - start[1]),
            start[2] + share * (end[2] - start[2]),
        )


def _parts(boxes: list[Bounds]) -> list[list[Bounds]]:
    """The boxes in groups of at most 16 that lie together: halves along the longer side, again and again."""
    if len(boxes) <= _COMPOUND:
        return [boxes] if boxes else []
    middles = [[low[axis] + high[axis] for low, high in boxes] for axis in (0, 1)]
    axis = 0 if max(middles[0]) - min(middles[0]) >= max(middles[1]) - min(middles[1]) else 1
    ordered = sorted(boxes, key=lambda box: box[0][axis] + box[1][axis])
    half = len(boxes) // 2
    return _parts(ordered[:half]) + _parts(ordered[half:])


def _cells(boxes: list[Bounds], reach: float) -> dict[tuple[int, int], list[Bounds]]:
    """For each square metre, the boxes within ``reach`` of it."""
    cells: dict[tuple[int, int], list[Bounds]] = {}
    for low, high in boxes:
        for x in range(floor(low[0] - reach), floor(high[0] + reach) + 1):
            for y in range(floor(low[1] - reach), floor(high[1] + reach) + 1):
                cells.setdefault((x, y), []).append((low, high))
    return cells


def _depth(feet: Point, height: float, radius: float, low: Point, high: Point) -> float:
    """How far an upright capsule reaches into a box; negative when they are apart."""
    return _contact(feet, height, radius, low, high)[0]


def _contact(feet: Point, height: float, radius: float, low: Point, high: Point) -> tuple[float, Point]:
    """How far an upright capsule reaches into a box, and the direction out of the box in which it is freed."""
    x, y, z = feet
    bottom, top = z + radius, z + height - radius
    dx = x - min(max(x, low[0]), high[0])
    dy = y - min(max(y, low[1]), high[1])
    # The point of the axis that is nearest to the box, and the point of the box nearest to it.
    if top < low[2]:
        dz = top - low[2]
    elif bottom > high[2]:
        dz = bottom - high[2]
    else:
        dz = 0.0
    distance = sqrt(dx * dx + dy * dy + dz * dz)
    if distance > 0.0:
        return radius - distance, (dx / distance, dy / distance, dz / distance)
    # The axis is inside the box: out by the nearest side.
    ways = (
        (x - low[0], (-1.0, 0.0, 0.0)),
        (high[0] - x, (1.0, 0.0, 0.0)),
        (y - low[1], (0.0, -1.0, 0.0)),
        (high[1] - y, (0.0, 1.0, 0.0)),
        (top - low[2], (0.0, 0.0, -1.0)),
        (high[2] - bottom, (0.0, 0.0, 1.0)),
    )
    way, normal = min(ways)
    return radius + way, normal


def _reaches(feet: Point, height: float, place: Point, mover: Mover, reach: float) -> bool:
    low, high = _around(place, mover.size)
    return all(low[axis] - reach <= feet[axis] <= high[axis] + reach for axis in (0, 1)) and (
        low[2] - reach - height <= feet[2] <= high[2] + reach
    )


def _around(centre: Point, size: Point) -> tuple[Point, Point]:
    (x, y, z), (a, b, c) = centre, size
    return (x - a / 2, y - b / 2, z - c / 2), (x + a / 2, y + b / 2, z + c / 2)


def _inside(point: Point, low: Point, high: Point) -> bool:
    return all(a <= value <= b for a, value, b in zip(low, point, high, strict=True))


def _sides(low: Point, high: Point) -> dict[str, tuple[Point, Point]]:
    """The six sides of a box by name: a point a centimetre outside its middle, and the middle itself."""
    middle = [(a + b) / 2 for a, b in zip(low, high, strict=True)]
    sides: dict[str, tuple[Point, Point]] = {}
    for axis, name in enumerate("xyz"):
        for sign, edge in ((-1, low[axis]), (1, high[axis])):
            outside, face = list(middle), list(middle)
            outside[axis], face[axis] = edge + 0.01 * sign, edge
            key = ("+" if sign > 0 else "-") + name
            sides[key] = ((outside[0], outside[1], outside[2]), (face[0], face[1], face[2]))
    return sides


__all__ = ["SUBSTEPS", "Random", "Way", "World", "WorldError"]
