"""The abilities of the player: its parameters, and the motion that an action requests.

An action is five whole numbers, the branches of MultiDiscrete([3, 3, 2, 2, 2]): x (0 none, 1 along
x, 2 against it), y (the same), jump, crouch, sprint.
"""

from __future__ import annotations

from collections.abc import Sequence
from math import atan2, sqrt

from tltl_runtime.stealth.level import Point
from tltlc.api import record

Action = tuple[int, int, int, int, int]

DECISION = 0.15
"""Seconds from one action to the next: a decision is a time step of the game."""
SUBSTEPS = 9
"""Physics steps in a decision."""

SIGN = (0.0, 1.0, -1.0)
"""The direction along an axis for each choice of the branches x and y."""


@record
class PlayerKind:
    """The parameters of the player, in metres, seconds and metres per second.

    A jump lifts the feet by 0.97 m, which follows from ``jump_speed`` and ``gravity``. The body is
    a capsule, whose round lower end can also slide up an edge that is a little higher. From a walk
    or a sprint, the player reaches platforms of 1.0 m, hardly ever those of 1.2 m, and never higher
    ones.
    """

    radius: float = 0.3
    height: float = 1.8
    crouched_height: float = 0.9
    walk_speed: float = 3.0
    sprint_speed: float = 5.0
    crouch_speed: float = 1.5
    stamina_time: float = 3.0
    """Seconds of sprinting that use up a full stamina."""
    refill_time: float = 5.0
    """Seconds until an empty stamina is full again."""
    jump_speed: float = 6.4
    gravity: float = 20.0
    step_height: float = 0.25
    """The highest stair that the player walks up."""
    fall_speed: float = 8.0
    """The greatest speed of a fall at the start of a decision (a time step).

    A faster body could pass through a floor when it lands.
    """


@record
class PlayerState:
    """The player at the end of a time step; ``position`` is at the feet, ``stamina`` in [0, 1]."""

    position: Point
    velocity: Point
    yaw: float
    crouching: bool
    grounded: bool
    stamina: float


@record
class Control:
    """The motion that an action requests for one time step.

    ``stamina`` is the stamina at the end of the time step, in [0, 1].
    """

    velocity: tuple[float, float]
    yaw: float
    jump: bool
    stamina: float


def control(kind: PlayerKind, state: PlayerState, action: Sequence[int], crouching: bool) -> Control:
    """Return the motion that ``action`` requests of a player in ``state``.

    ``crouching`` says whether the player crouches in this time step. Diagonal motion is no faster
    than straight motion. A sprint needs stamina for a whole time step, and a jump needs ground. A
    crouched player neither sprints nor jumps.
    """
    x, y = SIGN[action[0]], SIGN[action[1]]
    moving = x != 0.0 or y != 0.0
    spent = DECISION / kind.stamina_time
    sprinting = moving and bool(action[4]) and not crouching and state.stamina >= spent - 1e-9
    if sprinting:
        speed, stamina = kind.sprint_speed, max(0.0, state.stamina - spent)
    else:
        speed = kind.crouch_speed if crouching else kind.walk_speed
        stamina = min(1.0, state.stamina + DECISION / kind.refill_time)
    if x and y:
        speed /= sqrt(2.0)
    jump = bool(action[2]) and state.grounded and not crouching
    return Control((speed * x, speed * y), atan2(y, x) if moving else state.yaw, jump, stamina)
