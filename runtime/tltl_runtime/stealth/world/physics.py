"""The bodies of a level in pybullet: static boxes, barriers, movers, and the player's capsule.

The player is a dynamic capsule without rotation and friction, whose velocity is set once a decision; Bullet then runs
nine steps of 1/60 s at once.  What was measured, and must stay so:

- The player is a Featherstone body (a Bullet rigid body with a zero inertia becomes not-a-number); all else has
  maximal coordinates, because each further Featherstone body costs as much as the player in every step.
- Bullet keeps 16 children of a compound shape and silently drops the rest.
- A mass that changes between zero and non-zero resets collision filters, so masses never change.
- A body that is given no visual shape gets one from its collision shape (``URDF_IGNORE_VISUAL_SHAPES`` or not), so all
  get a triangle of a millimetre.
- Crouching swaps two capsules; the one that is not played touches nothing and is put back under the level once a
  decision (a Featherstone body that is put to sleep falls all the same; one that rests on a floor costs
  a quarter of the speed).
- Static bodies that collide with each other (group and mask share a bit) make a step four times slower.
- Every reset builds the world anew: that is what makes episodes the same bit for bit, whatever went before.
"""

from __future__ import annotations

from collections.abc import Sequence
from math import cos, floor, pi, sin, sqrt
from typing import Protocol

from tltl_runtime.stealth.level import Level, Point
from tltl_runtime.stealth.world.bodies import (
    COMPOUND,
    PARKED,
    PLAYER,
    RAY,
    STOPS,
    UPRIGHT,
    WORLD,
    capsule,
    set_filter,
    static_box,
    static_boxes,
)
from tltl_runtime.stealth.world.bullet import pybullet
from tltl_runtime.stealth.world.geometry import Bounds, around, cells, contact, depth, inside, parts, reaches, sides
from tltl_runtime.stealth.world.player import DECISION, PlayerKind, PlayerState, control
from tltl_runtime.stealth.world.way import Way

SUBSTEPS = 9
"""Physics steps in a decision."""

_GIVE = 0.2
"""How far below the bounds the feet may be: a landing reaches up to one physics step of a fall into the floor."""
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
        self._around = cells(self._boxes, self.kind.radius + self.kind.sprint_speed * DECISION)
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
        self._park()
        if self._ways:
            self._step_with_movers(velocity)
        else:
            pybullet.stepSimulation(physicsClientId=self._client)
        self._observe(crouching, wish.yaw, wish.stamina)

    def put(self, state: PlayerState) -> None:
        """Make ``state``, one that ``player`` had, that of the player: for searches that try many ways on from it.

        Everything else stays as it is.  What Bullet remembers of contacts does not come back, so that the next decision
        may end some millimetres from where it did.
        """
        self._stance(state.crouching, state.position, state.velocity)
        self._state = state

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
            set_filter(self._client, body, 0 if is_open else WORLD, 0 if is_open else STOPS)

    def ray_blocked(self, start: Point, end: Point) -> bool:
        """Whether a solid, a shut barrier or a mover stands between two points; lasers and the player do not."""
        hit = pybullet.rayTest(start, end, collisionFilterMask=WORLD, physicsClientId=self._client)[0]
        return bool(hit[0] >= 0)

    def room(self, feet: Point, height: float, but: int | None = None) -> bool:
        """Whether a capsule of the player's radius and this ``height`` is free of everything that stops bodies.

        The mover ``but`` is left out.
        """
        radius = self.kind.radius
        return all(
            depth(feet, height, radius, low, high) <= _ROOM
            for boxes in (self._near(feet), self._changing(but))
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
            (mover.name, *around(centre, mover.size))
            for mover, centre in zip(self.level.movers, self._places, strict=True)
        ]
        for name, low, high in boxes:
            for side, (outside, face) in sides(low, high).items():
                if any(inside(outside, other_low, other_high) for _, other_low, other_high in boxes):
                    continue
                middle = tuple((a + b) / 2 for a, b in zip(low, high, strict=True))
                hit = pybullet.rayTest(outside, middle, collisionFilterMask=WORLD, physicsClientId=self._client)[0]
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
            physicsClientId=client,
        )
        self._speed_of_time = SUBSTEPS
        for part in parts(self._boxes, COMPOUND):
            static_boxes(client, part)
        self._barriers = [
            static_boxes(client, [(barrier.box.low, barrier.box.high)]) if barrier.kind == "solid" else None
            for barrier in self.level.barriers
        ]
        self._movers = [
            static_box(client, mover.size, place) for mover, place in zip(self.level.movers, self._places, strict=True)
        ]
        low, high = self.level.bounds.low, self.level.bounds.high
        self._parking = ((low[0] + high[0]) / 2, (low[1] + high[1]) / 2, low[2] - 10.0)
        self._bodies = {
            crouching: capsule(client, self.kind.radius, self._height(crouching), self._parking)
            for crouching in (False, True)
        }
        self._body, self._parked = self._bodies[False], self._bodies[True]

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
        self._body, self._parked = self._bodies[crouching], self._bodies[not crouching]
        set_filter(self._client, self._parked, PARKED, 0)
        set_filter(self._client, self._body, PLAYER, WORLD | RAY)
        place = (feet[0], feet[1], feet[2] + self._height(crouching) / 2)
        pybullet.resetBasePositionAndOrientation(self._body, place, UPRIGHT, physicsClientId=self._client)
        pybullet.resetBaseVelocity(self._body, velocity, (0.0, 0.0, 0.0), physicsClientId=self._client)
        self._park()
        self._check_filters()

    def _park(self) -> None:
        """Put the capsule that is not played back under the level; it falls 0.2 m a decision."""
        client = self._client
        pybullet.resetBasePositionAndOrientation(self._parked, self._parking, UPRIGHT, physicsClientId=client)
        pybullet.resetBaseVelocity(self._parked, (0.0, 0.0, 0.0), physicsClientId=client)

    def _step_ahead(self, velocity: tuple[float, float], height: float) -> float:
        """How high the feet are lifted to walk up a stair that is in the way of this decision; 0 where there is none.

        A velocity that is set once a decision is spent at the first edge, so that Bullet alone climbs no stairs.
        """
        kind = self.kind
        if velocity == (0.0, 0.0):
            return 0.0
        x, y, z = self._state.position
        ahead = (x + velocity[0] * DECISION, y + velocity[1] * DECISION)
        west, east = min(x, ahead[0]) - kind.radius, max(x, ahead[0]) + kind.radius
        south, north = min(y, ahead[1]) - kind.radius, max(y, ahead[1]) + kind.radius
        boxes = [
            (low, high)
            for low, high in self._near((x, y, z))
            if low[2] < z + kind.radius
            and z + _ROOM < high[2]
            and low[0] < east
            and west < high[0]
            and low[1] < north
            and south < high[1]
        ]
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
            tops = [high[2] for low, high in boxes if depth((*ahead, z), height, kind.radius, low, high) > _ROOM]
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
            hit = pybullet.rayTest(top, (x, y, z), collisionFilterMask=PLAYER, physicsClientId=self._client)[0][0]
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
        near = []
        for index, (place, mover) in enumerate(zip(self._places, self.level.movers, strict=True)):
            if reaches((x, y, z), self.kind.height, place, mover, reach + mover.speed * DECISION):
                near.append(index)
            else:
                self._place(index, self._clocks[index] + DECISION)
        if near:
            self._time(1)
            for _ in range(SUBSTEPS):
                self._push(near, DECISION / SUBSTEPS)
        else:
            self._time(SUBSTEPS)
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
        pybullet.resetBasePositionAndOrientation(self._movers[index], place, UPRIGHT, physicsClientId=self._client)

    def _push(self, near: Sequence[int], seconds: float) -> None:
        """One physics step with the movers that are near: each goes on and pushes.

        It waits where the player has no room to be pushed to.  Bullet sees a box that is put elsewhere,
        not one that moves, so the push is given to the player as velocity.  A box that went on regardless would press
        the player through a wall, however slowly.
        """
        client = self._client
        height, radius = self._height(self._body == self._bodies[True]), self.kind.radius
        (x, y, z), _ = pybullet.getBasePositionAndOrientation(self._body, physicsClientId=client)
        feet = (x, y, z - height / 2)
        for index in near:
            mover, clock, place = self.level.movers[index], self._clocks[index], self._places[index]
            self._place(index, clock + seconds)
            deep, normal = contact(feet, height, radius, *around(self._places[index], mover.size))
            if deep <= 0.0 or deep <= contact(feet, height, radius, *around(place, mover.size))[0]:
                continue
            across = sqrt(normal[0] ** 2 + normal[1] ** 2)
            if normal[2] < 0.0 and across > 0.3:
                # An edge that comes down on the shoulder pushes aside.
                deep, normal = deep / across, (normal[0] / across, normal[1] / across, 0.0)
            pushed = (x + deep * normal[0], y + deep * normal[1], feet[2] + deep * normal[2])
            if not self.room(pushed, height, but=index):
                self._place(index, clock)
                continue
            now, _ = pybullet.getBaseVelocity(self._body, physicsClientId=client)
            lack = min(deep / seconds, _HARDEST_PUSH) - sum(a * b for a, b in zip(now, normal, strict=True))
            if lack > 0.0:
                faster = [a + lack * b for a, b in zip(now, normal, strict=True)]
                pybullet.resetBaseVelocity(self._body, faster, physicsClientId=client)
        pybullet.stepSimulation(physicsClientId=client)

    # What stops bodies

    def _near(self, feet: Point) -> list[Bounds]:
        """The solids that a capsule with its feet there, or a decision's way from there, can touch."""
        return self._around.get((floor(feet[0]), floor(feet[1])), [])

    def _changing(self, but: int | None) -> list[Bounds]:
        """The shut barriers and the movers, without the mover ``but``."""
        boxes = [
            (barrier.box.low, barrier.box.high)
            for barrier, is_open in zip(self.level.barriers, self._open, strict=True)
            if barrier.kind == "solid" and not is_open
        ]
        for index, (place, mover) in enumerate(zip(self._places, self.level.movers, strict=True)):
            if index != but:
                boxes.append(around(place, mover.size))
        return boxes
