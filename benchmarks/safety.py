"""A million random steps in the game's worlds: nothing passes a wall, leaves its bounds or stops being a number.

Half of the episodes begin at the level's start, half anywhere on its floors.  At each reset and at each end of an
episode the world checks its walls, by rays, and its collision filters; it does so with filters after each crouch.

``python -m benchmarks.safety LEVEL VARIANT [STEPS]`` tries one variant in a process of its own.
"""

from __future__ import annotations

import json
import math
import sys
import time
import zlib
from collections.abc import Callable, Iterable
from typing import TYPE_CHECKING, Any

from benchmarks.store import Record, Store, source_digest
from benchmarks.variants import measure_each, variants_of_all
from benchmarks.wander import actions

if TYPE_CHECKING:
    import numpy as np

    from tltl_runtime.stealth.env import GameEnv
    from tltl_runtime.stealth.level import Level, Point

SECTION = "safety"
STEPS = 112_000
"""In each variant; nine make a million."""
EPISODE = 400
TIMEOUT_S = 3600.0
DEEPEST = 0.25
"""How far the capsule may reach into a box, in metres: its axis, 0.3 m further in, stays outside."""


class Violation(AssertionError):
    """Something that must never be."""


def measure(store: Store, _: float, say: Callable[[str], None]) -> None:
    """Try each variant that the store does not have yet, or that failed."""
    measure_each(store, SECTION, variants_of_all, TIMEOUT_S, say)


def tried(level: str, variant: str, steps: int) -> Record:
    """So many random steps of one variant, with a seed of its own.

    ``checks`` counts those of all walls and filters; ``deepest_m`` is how far the player's body ever reached into
    a box.  Raises Violation and WorldError, which say where and when.
    """
    import numpy as np

    from tltl_runtime.stealth.env import GameEnv

    seed = zlib.crc32(f"{level} {variant}".encode())
    rng = np.random.default_rng(seed)
    env = GameEnv(level, variant)
    chosen = actions(rng)
    own = env.level
    began, deepest, checks, episodes = time.process_time(), 0.0, 0, 0
    for step in range(steps):
        if step % EPISODE == 0:
            if step:
                env.game.world.check()
            _begin(env, own, rng, anywhere=episodes % 2 == 1)
            env.game.world.check()
            episodes, checks = episodes + 1, checks + 2
        observation, *_ = env.step(next(chosen))
        try:
            deepest = max(deepest, _look_over(env, observation))
        except Violation as violation:
            raise Violation(f"{level} {variant}, seed {seed}, step {step}: {violation}") from None
    env.close()
    return {
        "steps": steps,
        "episodes": episodes,
        "checks": checks - 1,
        "deepest_m": round(deepest, 4),
        "steps_per_cpu_s": round(steps / (time.process_time() - began)),
        "source": source_digest("runtime"),
    }


def _begin(env: GameEnv, own: Level, rng: np.random.Generator, *, anywhere: bool) -> None:
    """Begin an episode at the start of the level, its ``own``, or anywhere on a floor where there is room."""
    from tltl_runtime.stealth.level import Start
    from tltlc.core.record import replace

    world = env.game.world
    world.level = own
    env.reset(seed=int(rng.integers(2**31)))
    if anywhere:
        place = next(place for place in _places(own, rng) if world.room(place, world.kind.height))
        world.level = replace(own, start=Start(place, own.start.yaw, 0.0))
        env.reset(seed=int(rng.integers(2**31)))


def _places(level: Level, rng: np.random.Generator) -> Iterable[Point]:
    """Random places on floors, without end, a body's width from their edges."""
    floors = [solid.box for solid in level.solids if solid.kind == "floor"]
    areas = [(box.high[0] - box.low[0]) * (box.high[1] - box.low[1]) for box in floors]
    while True:
        box = floors[int(rng.choice(len(floors), p=[area / sum(areas) for area in areas]))]
        x, y = (float(rng.uniform(box.low[axis] + 0.5, box.high[axis] - 0.5)) for axis in (0, 1))
        yield (x, y, box.high[2])


def _look_over(env: GameEnv, observation: dict[str, Any]) -> float:
    """All that can be told from outside after a step; returns how far the body reaches into boxes, in metres."""
    game = env.game
    player, level = game.world.player, env.level
    numbers = [*player.position, *player.velocity, player.yaw, player.stamina, game.health, *game.enemies.yaws]
    if not all(map(math.isfinite, numbers)):
        raise Violation(f"a number of {player} or of the enemies is not finite")
    if not env.observation_space.contains(observation):
        raise Violation("an observation is not in its space")
    low, high = level.bounds.low, level.bounds.high
    if not all(a - 0.2 <= value <= b for a, value, b in zip(low, player.position, high, strict=True)):
        raise Violation(f"the player is at {player.position}")
    for x, y, z in game.enemies.positions:
        if not (low[0] <= x <= high[0] and low[1] <= y <= high[1] and z == 0.0):
            raise Violation(f"an enemy is at {(x, y, z)}")
    deep = _deepest(game.world.kind, player, level)
    if deep > DEEPEST:
        raise Violation(f"the player at {player.position} is {deep:.2f} m inside a box")
    return deep


def _deepest(kind: Any, player: Any, level: Level) -> float:
    from tltl_runtime.stealth.world.geometry import depth

    x, y, z = player.position
    height = kind.crouched_height if player.crouching else kind.height
    reach = kind.radius
    return max(
        (
            depth(player.position, height, reach, solid.box.low, solid.box.high)
            for solid in level.solids
            if solid.box.low[0] - reach < x < solid.box.high[0] + reach
            and solid.box.low[1] - reach < y < solid.box.high[1] + reach
            and solid.box.low[2] - height < z < solid.box.high[2]
        ),
        default=0.0,
    )


def main() -> None:
    """Try what the command line names; a violation is told in the record."""
    from tltl_runtime.stealth.world.physics import WorldError

    level, variant, *steps = sys.argv[1:]
    try:
        record = tried(level, variant, int(steps[0]) if steps else STEPS)
    except (Violation, WorldError) as error:
        record = {"failed": str(error)}
    print(json.dumps(record))


if __name__ == "__main__":
    main()
