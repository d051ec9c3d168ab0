"""The bodies of a level in pybullet: static boxes, barriers, movers, and the player's capsule.

The player is a dynamic capsule without rotation and friction. Its velocity is set once per
decision, which is one action of 0.15 s; Bullet then runs nine steps of 1/60 s in one call. The code
depends on these properties of pybullet, which were measured:

- The player is a Featherstone body (a Bullet rigid body with zero inertia becomes not-a-number).
  Everything else uses maximal coordinates, because each further Featherstone body costs as much per
  step as the player.
- Bullet keeps 16 children of a compound shape and silently drops the rest.
- A change of mass between zero and non-zero resets collision filters, so masses never change.
- A body without a visual shape gets one from its collision shape (with or without
  ``URDF_IGNORE_VISUAL_SHAPES``), so every body gets a triangle of one millimetre.
- A shape cannot be resized, so crouching swaps two capsules (``capsules``).
- Each pybullet call costs 0.4 to 1.5 µs, a fifth of it for keyword arguments. So calls that run in
  every decision have no keyword arguments.
- Static bodies that collide with each other (their group and mask share a bit) make a step four
  times slower.
- Every reset rebuilds the world. This makes episodes bit-for-bit reproducible, whatever ran before.
"""

from __future__ import annotations

import weakref
from collections.abc import Sequence
from math import cos, floor, pi, sin, sqrt
from typing import NoReturn, Protocol

from tltl_runtime.stealth.level import Barrier, Point, StealthLevel
from tltl_runtime.stealth.world.bodies import COMPOUND, STOPS, WORLD, set_filter, static_boxes
from tltl_runtime.stealth.world.bullet import pybullet
from tltl_runtime.stealth.world.capsules import Capsules
from tltl_runtime.stealth.world.geometry import TOUCH, Bounds, boxes_by_cell, depth, group_boxes, is_inside, sides
from tltl_runtime.stealth.world.mover_bodies import MoverBody, push
from tltl_runtime.stealth.world.player import DECISION, SUBSTEPS, PlayerKind, PlayerState, control
from tltl_runtime.stealth.world.stairs import lift

_SINK_TOLERANCE = 0.2
"""The greatest depth of the feet below the bounds, in metres.

A landing sinks into the floor by up to one physics step of a fall.
"""
_PARK_INTERVAL = 64
"""The inactive capsule is moved back after this many time steps; by then it has fallen 1 km."""


class Random(Protocol):
    """A source of random numbers, such as ``random.Random`` or ``numpy.random.Generator``."""

    def random(self) -> float:
        """Return a number in [0, 1)."""


class WorldError(RuntimeError):
    """Raised if the physics differs from the level, or if the player has no room or leaves the level.

    ``body`` is the name of the body that the error is about, such as ``player``, and ``step`` the
    number of the time step.
    """

    def __init__(self, level: StealthLevel, step: int, body: str, problem: str) -> None:
        super().__init__(f"level {level.name} {level.variant}, step {step}, {body}: {problem}")
        self.level, self.variant, self.step, self.body = level.name, level.variant, step, body
        self._arguments = level, step, body, problem

    def __reduce__(self) -> tuple[type[WorldError], tuple[StealthLevel, int, str, str]]:
        # Unpickle the error from its arguments, not from its message: processes send it to each other.
        return type(self), self._arguments


class NoRoomError(WorldError):
    """Raised if something stands where the player starts."""


class World:
    """The bodies of a level, in a pybullet client of their own.

    Barriers and movers (moving boxes) are identified by their index in the level. Lasers have no
    body here: they stop neither bodies nor sight. The constructor resets the world, with the player
    exactly at the start, and checks it (see ``check``). It raises WorldError if the player has no
    room, or if the check fails.
    """

    def __init__(self, level: StealthLevel, kind: PlayerKind | None = None) -> None:
        self.level = level
        self.kind = PlayerKind() if kind is None else kind
        self.steps = 0
        self._client = pybullet.connect(pybullet.DIRECT)
        # A client holds 28 MB; disconnect it if the world is garbage collected without `close`.
        self._disconnect = weakref.finalize(self, pybullet.disconnect, self._client)
        self._open = [False] * len(level.barriers)
        self._boxes = [(solid.box.low, solid.box.high) for solid in level.solids]
        self._boxes_by_cell = boxes_by_cell(self._boxes, self.kind.radius + self.kind.sprint_speed * DECISION)
        try:
            self.reset(None)
            self.check()
        except BaseException:
            self.close()
            raise

    def close(self) -> None:
        """Disconnect the client; the world cannot be used afterwards.

        Closing twice does nothing.
        """
        self._disconnect()
        self._client = -1

    def __reduce__(self) -> NoReturn:
        help_ = "make another environment, and reset it with the same seed"
        raise TypeError(f"a running game can be neither copied nor pickled: {help_}")

    def reset(self, rng: Random | None) -> None:
        """Begin an episode.

        All barriers are shut. Each mover has already moved for the ``offset`` seconds that the
        level gives it. The player is at a random place at most ``spread`` metres from the level's
        start, or without ``rng`` exactly at the start. Raises WorldError if the player has no room
        there.
        """
        self.steps = 0
        self._open = [False] * len(self.level.barriers)
        self._build()
        feet = self._start(rng)
        self._put(False, feet, (0.0, 0.0, 0.0))
        pybullet.stepSimulation(self._client)
        self._observe(False, self.level.start.yaw, 1.0)

    def step(self, action: Sequence[int]) -> None:
        """Apply an action of the player for one time step, which lasts 0.15 s.

        Raises WorldError if the player leaves the level's bounds.
        """
        self.steps += 1
        old = self._state
        kind = self.kind
        crouching = bool(action[3]) or (old.crouching and not self.has_room(old.position, kind.height))
        wish = control(kind, old, action, crouching)
        velocity = (*wish.velocity, kind.jump_speed if wish.jump else max(old.velocity[2], -kind.fall_speed))
        step = 0.0
        if old.grounded and not wish.jump:
            near = self._solids_near(old.position)
            height = kind.crouched_height if crouching else kind.height
            step = lift(kind, old.position, height, wish.velocity, near, self.has_room)
        if step or crouching != old.crouching:
            x, y, z = old.position
            self._put(crouching, (x, y, z + step), (*wish.velocity, 0.0) if step else velocity)
        else:
            self._capsules.set_velocity(velocity)
        if self.steps % _PARK_INTERVAL == 0:
            self._capsules.park()
        self._advance(self._movers_near())
        self._observe(crouching, wish.yaw, wish.stamina)

    def put(self, state: PlayerState) -> None:
        """Set the player to ``state``, an earlier value of ``player``.

        A search can then continue from that state. Movers and barriers stay unchanged, and Bullet's
        contact cache is not restored. So if an action is repeated, it may end some millimetres away
        from its first result.
        """
        self._put(state.crouching, state.position, state.velocity)
        self._state = state

    @property
    def player(self) -> PlayerState:
        """The state of the player after the last :meth:`step`, :meth:`reset` or :meth:`put`."""
        return self._state

    def mover_positions(self) -> tuple[Point, ...]:
        """Return the centres of the movers (moving boxes), in the order in which the level lists them."""
        return tuple(mover.place for mover in self.movers)

    def mover_boxes(self) -> list[Bounds]:
        """Return the lowest and highest corner of each mover (moving box), in the order of the level."""
        return [mover.box for mover in self.movers]

    def is_open(self, barrier: int) -> bool:
        """Whether the barrier with the index ``barrier`` is open."""
        return self._open[barrier]

    def set_open(self, barrier: int, is_open: bool) -> None:
        """Open or shut a barrier; an open barrier stops neither bodies nor sight."""
        self._open[barrier] = is_open
        body = self._barriers[barrier]
        if body is not None:
            # Change the filter, not the position: the body stays in place, and rays respect the filter, too.
            set_filter(self._client, body, 0 if is_open else WORLD, 0 if is_open else STOPS)

    def ray_blocked(self, start: Point, end: Point) -> bool:
        """Whether a solid, a shut barrier or a mover is between two points.

        Lasers and the player do not count.
        """
        hit = pybullet.rayTest(start, end, collisionFilterMask=WORLD, physicsClientId=self._client)[0]
        return bool(hit[0] >= 0)

    def has_room(self, feet: Point, height: float, ignored: MoverBody | None = None) -> bool:
        """Whether a capsule of this height would be free of everything that stops bodies.

        The capsule has the player's radius and stands at ``feet``. It may overlap the mover
        ``ignored``.
        """
        radius = self.kind.radius
        return all(
            depth(feet, height, radius, low, high) <= TOUCH
            for boxes in (self._solids_near(feet), self._changing_boxes(ignored))
            for low, high in boxes
        )

    def check(self) -> None:
        """Test with rays whether the world matches the level.

        A ray tests the middle of each side of each box, from 1 cm outside, unless another body
        covers that point. Raises WorldError if a box is missing or a collision filter is wrong.
        """
        boxes = [(solid.name, solid.box.low, solid.box.high) for solid in self.level.solids]
        boxes += [(barrier.name, barrier.box.low, barrier.box.high) for barrier in self._shut_barriers()]
        boxes += [(mover.name, *box) for mover, box in zip(self.level.movers, self.mover_boxes(), strict=True)]
        for name, low, high in boxes:
            for side, (outside, face) in sides(low, high).items():
                if any(is_inside(outside, other_low, other_high) for _, other_low, other_high in boxes):
                    continue
                middle = tuple((a + b) / 2 for a, b in zip(low, high, strict=True))
                hit = pybullet.rayTest(outside, middle, collisionFilterMask=WORLD, physicsClientId=self._client)[0]
                if hit[0] < 0 or max(abs(a - b) for a, b in zip(hit[3], face, strict=True)) > 0.005:
                    raise WorldError(self.level, self.steps, name, f"a ray does not hit its side {side}")
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
        self._substeps = SUBSTEPS
        for part in group_boxes(self._boxes, COMPOUND):
            static_boxes(client, part)
        self._barriers = [
            static_boxes(client, [(barrier.box.low, barrier.box.high)]) if barrier.kind == "solid" else None
            for barrier in self.level.barriers
        ]
        self.movers = [MoverBody(client, mover) for mover in self.level.movers]
        low, high = self.level.bounds.low, self.level.bounds.high
        parking = ((low[0] + high[0]) / 2, (low[1] + high[1]) / 2, low[2] - 10.0)
        self._capsules = Capsules(client, self.kind, parking)

    # The player

    def _start(self, rng: Random | None) -> Point:
        """Return a position for the player's feet at the beginning of an episode.

        It is a random place at most ``spread`` metres from the level's start, or without ``rng``
        exactly the start. Raises NoRoomError if the player has no room there, even after 100 random
        tries.
        """
        x, y, z = self.level.start.position
        for _ in range(100 if rng is not None else 1):
            if rng is None:
                feet = (x, y, z)
            else:
                distance, angle = self.level.start.spread * sqrt(rng.random()), 2 * pi * rng.random()
                feet = (x + distance * cos(angle), y + distance * sin(angle), z)
            if self.has_room(feet, self.kind.height):
                return feet
        raise NoRoomError(self.level, 0, "player", f"there is no room at the start ({x:g}, {y:g}, {z:g})")

    def _put(self, crouching: bool, feet: Point, velocity: Point) -> None:
        if self._capsules.put(crouching, feet, velocity):
            self._check_filters()

    def _check_filters(self) -> None:
        name = self._capsules.misfiltered_capsule()
        if name is not None:
            problem = "its collision filter is not the one that was set"
            raise WorldError(self.level, self.steps, f"{name} player", problem)

    def _observe(self, crouching: bool, yaw: float, stamina: float) -> None:
        """Read the state of the player from pybullet after a time step, and store it.

        The position, the velocity and the contact with the ground come from pybullet, the rest from
        the arguments. Raises WorldError if the player is outside the level's bounds.
        """
        capsules, low, high = self._capsules, self.level.bounds.low, self.level.bounds.high
        x, y, z = feet = capsules.feet()
        # Not-a-number fails this comparison, too.
        if not (low[0] <= x <= high[0] and low[1] <= y <= high[1] and low[2] - _SINK_TOLERANCE <= z <= high[2]):
            raise WorldError(self.level, self.steps, "player", f"({x:g}, {y:g}, {z:g}) is outside the level's bounds")
        self._state = PlayerState(feet, capsules.velocity(), yaw, crouching, capsules.is_grounded(), stamina)

    # Time

    def _movers_near(self) -> list[MoverBody]:
        """Return the movers that the player can touch in this time step; advance all other movers by the step."""
        near = []
        for mover in self.movers:
            if mover.is_near(self._state.position, self.kind.height):
                near.append(mover)
            else:
                mover.put(mover.clock + DECISION)
        return near

    def _advance(self, near: Sequence[MoverBody]) -> None:
        """Run the physics of a time step.

        Without movers ``near``, this is one call of pybullet. Otherwise these movers push the
        player before each physics step.
        """
        if not near:
            self._run_at_once(SUBSTEPS)
            pybullet.stepSimulation(self._client)
            return
        self._run_at_once(1)
        for _ in range(SUBSTEPS):
            push(near, DECISION / SUBSTEPS, self._capsules, self.has_room)
            pybullet.stepSimulation(self._client)

    def _run_at_once(self, substeps: int) -> None:
        """Set how many physics steps Bullet runs in one call."""
        if substeps != self._substeps:
            self._substeps = substeps
            pybullet.setPhysicsEngineParameter(
                fixedTimeStep=DECISION * substeps / SUBSTEPS, numSubSteps=substeps, physicsClientId=self._client
            )

    # The boxes that stop bodies

    def _solids_near(self, feet: Point) -> list[Bounds]:
        """Return the boxes of solids that the player may touch within one time step from ``feet``."""
        return self._boxes_by_cell.get((floor(feet[0]), floor(feet[1])), [])

    def _changing_boxes(self, ignored: MoverBody | None) -> list[Bounds]:
        """Return the boxes of the shut barriers, and of the movers except ``ignored``.

        A box is a pair: its lowest and its highest corner.
        """
        shut = [(barrier.box.low, barrier.box.high) for barrier in self._shut_barriers()]
        return shut + [mover.box for mover in self.movers if mover is not ignored]

    def _shut_barriers(self) -> list[Barrier]:
        """Return the shut barriers that stop bodies, which are those of the kind ``solid``."""
        barriers = zip(self.level.barriers, self._open, strict=True)
        return [barrier for barrier, is_open in barriers if barrier.kind == "solid" and not is_open]
