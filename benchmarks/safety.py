"""Play a million random steps, and check that nothing passes a wall, leaves its bounds or becomes NaN.

Half of the episodes begin at the level's start, half anywhere on its floors. At each reset and at
each end of an episode, the world checks its walls, by rays, and its collision filters.

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
    from tltl_runtime.stealth.level import Point, StealthLevel

SECTION = "safety"
STEPS = 112_000
"""Steps in each variant; the nine variants together have a million."""
EPISODE = 400
TIMEOUT_S = 3600.0
DEEPEST = 0.25
"""How far the capsule may reach into a box, in metres; its radius is 0.3 m, so its axis stays outside."""


class Violation(AssertionError):
    """A check has failed."""


def measure(store: Store, _: float, say: Callable[[str], None]) -> None:
    """Check each variant without a record in the store, or with a failed one."""
    measure_each(store, SECTION, variants_of_all, TIMEOUT_S, say)


def play_random_steps(level: str, variant: str, steps: int) -> Record:
    """Play random steps in one variant, with a seed that depends on the variant.

    In the result, ``checks`` counts the checks of all walls and filters, and ``deepest_m`` is how far
    the player's body ever reached into a box. Raises Violation and WorldError with the place and step.
    """
    import numpy as np

    from tltl_runtime.stealth.env import GameEnv

    seed = zlib.crc32(f"{level} {variant}".encode())
    rng = np.random.default_rng(seed)
    env = GameEnv(level, variant)
    random_actions = actions(rng)
    own_level = env.level
    start_s, deepest, checks, episodes = time.process_time(), 0.0, 0, 0
    for step in range(steps):
        if step % EPISODE == 0:
            if step:
                env.game.world.check()
            _begin_episode(env, own_level, rng, anywhere=episodes % 2 == 1)
            env.game.world.check()
            episodes, checks = episodes + 1, checks + 2
        observation, *_ = env.step(next(random_actions))
        try:
            deepest = max(deepest, _check_step(env, observation))
        except Violation as violation:
            raise Violation(f"{level} {variant}, seed {seed}, step {step}: {violation}") from None
    env.close()
    return {
        "steps": steps,
        "episodes": episodes,
        "checks": checks - 1,
        "deepest_m": round(deepest, 4),
        "steps_per_cpu_s": round(steps / (time.process_time() - start_s)),
        "source": source_digest("runtime"),
    }


def _begin_episode(env: GameEnv, own_level: StealthLevel, rng: np.random.Generator, *, anywhere: bool) -> None:
    """Begin an episode at the start of the level ``own_level``, or anywhere on a floor where there is room."""
    from tltl_runtime.stealth.level import Start
    from tltlc.core.record import replace

    world = env.game.world
    world.level = own_level
    env.reset(seed=int(rng.integers(2**31)))
    if anywhere:
        place = next(place for place in _places(own_level, rng) if world.has_room(place, world.kind.height))
        world.level = replace(own_level, start=Start(place, own_level.start.yaw, 0.0))
        env.reset(seed=int(rng.integers(2**31)))


def _places(level: StealthLevel, rng: np.random.Generator) -> Iterable[Point]:
    """Yield random places on the floors, at least 0.5 m from their edges; the iterator never ends."""
    floors = [solid.box for solid in level.solids if solid.kind == "floor"]
    areas = [(box.high[0] - box.low[0]) * (box.high[1] - box.low[1]) for box in floors]
    while True:
        box = floors[int(rng.choice(len(floors), p=[area / sum(areas) for area in areas]))]
        x, y = (float(rng.uniform(box.low[axis] + 0.5, box.high[axis] - 0.5)) for axis in (0, 1))
        yield (x, y, box.high[2])


def _check_step(env: GameEnv, observation: dict[str, Any]) -> float:
    """Check everything that can be observed after a step; return how far the body reaches into boxes, in metres."""
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
    deep = _depth_in_boxes(game.world.kind, player, level)
    if deep > DEEPEST:
        raise Violation(f"the player at {player.position} is {deep:.2f} m inside a box")
    return deep


def _depth_in_boxes(kind: Any, player: Any, level: StealthLevel) -> float:
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
    """Check the variant that the command line names, and print the record; ``failed`` says which check failed."""
    from tltl_runtime.stealth.world.physics import WorldError

    level, variant, *steps = sys.argv[1:]
    try:
        record = play_random_steps(level, variant, int(steps[0]) if steps else STEPS)
    except (Violation, WorldError) as error:
        record = {"failed": str(error)}
    print(json.dumps(record))


if __name__ == "__main__":
    main()
