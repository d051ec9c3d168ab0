"""Decisions per second of the game, beside the physics alone; two worker processes beside one; the semantic map.

*Bare* is Bullet with the bodies of the level and nothing else: the player's velocity is set, and nine physics steps are
made at once, which is what each decision cannot do without.  *env* adds all that the game does and the
observation, *with spec* the automaton and its reward as well, and the resets of the episodes that it ends.

``python -m benchmarks.game LEVEL VARIANT`` measures one variant in a process of its own, and
``python -m benchmarks.game workers COUNT`` the worker processes.
"""

from __future__ import annotations

import json
import os
import sys
import time
from collections.abc import Callable, Sequence
from itertools import islice
from pathlib import Path
from typing import TYPE_CHECKING, Any

from benchmarks.measure import median, quartiles
from benchmarks.store import Record, Store, source_digest
from benchmarks.variants import measure_each, variants_of_all
from benchmarks.wander import actions

if TYPE_CHECKING:
    from tltl_runtime.stealth.env import GameEnv
    from tltl_runtime.vector import WorkerVectorEnv

SECTION = "game"
WORKERS = "workers"
DECISIONS = 600
ROUNDS = 9
TIMEOUT_S = 900.0

COUNTS = (32, 128)
"""Environments that workers share out.  A reset costs as much as ten decisions, and all wait for it: fewer, longer."""
WORKERS_LEVEL = "cover_and_hide"
WORKERS_STEPS = 60
WORKERS_ROUNDS = 9
MOST_TRIES = 60
PROBE_S = 0.3
IDLE_CORES = 1.8
"""Fewer are not two free cores."""


def measure(store: Store, _: float, say: Callable[[str], None]) -> None:
    """Measure each variant that the store does not have yet, or that failed, then the workers."""
    measure_each(
        store, SECTION, lambda: [*variants_of_all(), *((WORKERS, str(count)) for count in COUNTS)], TIMEOUT_S, say
    )


def compared(level: str, variant: str) -> Record:
    """CPU time of a decision in microseconds, bare, in the environment and with its spec, and the ratios."""
    import numpy as np

    from tltl_runtime.stealth.env import GameEnv, make_env

    chosen = [np.array(action) for action in islice(actions(np.random.default_rng(1)), DECISIONS)]
    env, judged = GameEnv(level, variant), make_env(level, variant)
    bare = _bare(env, chosen)
    seeds = iter(range(10_000))

    def with_observations() -> None:
        for action in chosen:
            env.step(action)

    def with_spec() -> None:
        for action in chosen:
            *_, terminated, truncated, _ = judged.step(action)
            if terminated or truncated:
                judged.reset(seed=next(seeds))

    judged.reset(seed=next(seeds))
    times = []
    for round_ in range(ROUNDS + 1):
        env.reset(seed=round_)
        row = [_us(work) for work in (bare, with_observations, with_spec)]
        if round_:
            times.append(row)
    return {
        "rounds": ROUNDS,
        "bare_us": median([row[0] for row in times]),
        "env_us": median([row[1] for row in times]),
        "spec_us": median([row[2] for row in times]),
        "bare_to_env": quartiles([row[0] / row[1] for row in times]),
        "bare_to_spec": quartiles([row[0] / row[2] for row in times]),
        "map_us": _map_us(env),
        "source": source_digest("tltlc", "runtime"),
    }


def _bare(env: GameEnv, chosen: Sequence[Any]) -> Callable[[], None]:
    """The physics of a decision for each action, in a world like that of ``env``."""
    import pybullet

    from tltl_runtime.stealth.world.physics import World
    from tltl_runtime.stealth.world.player import control

    class Bare(World):
        def run(self) -> None:
            client, body = self._client, self._capsules.body
            for velocity in velocities:
                pybullet.resetBaseVelocity(body, velocity, physicsClientId=client)
                pybullet.stepSimulation(physicsClientId=client)

    world = Bare(env.level)
    velocities = [(*control(world.kind, world.player, action.tolist(), False).velocity, -1.0) for action in chosen]
    return world.run


def _us(work: Callable[[], None]) -> float:
    """CPU time per decision, in microseconds."""
    began = time.process_time()
    work()
    return (time.process_time() - began) * 1e6 / DECISIONS


def _map_us(env: GameEnv) -> tuple[float, float]:
    """Microseconds of a look at the semantic map where the game stands, and with the layers made of it."""
    from tltl_runtime.stealth.observation.semantic_map import SemanticMap

    semantic_map, game = SemanticMap(env.level), env.game
    given = (game.world.player.position, False, game.world.mover_boxes(), game.enemies.positions)

    def look() -> None:
        for _ in range(DECISIONS):
            semantic_map.look(*given)

    def look_and_layer() -> None:
        for _ in range(DECISIONS):
            semantic_map.one_hot(semantic_map.look(*given))

    return median([_us(look) for _ in range(ROUNDS)]), median([_us(look_and_layer) for _ in range(ROUNDS)])


def two_beside_one(count: int) -> Record:
    """Decisions per second of wall time of one and of two worker processes with ``count`` environments, in turns.

    A round counts only where two cores were idle before and after it.  Without any, ``idle_cores`` says how
    many were.
    """
    from tltl_runtime.vector import make_vec

    one, two = (make_vec(WORKERS_LEVEL, "v0", count, workers) for workers in (1, 2))
    rates: list[tuple[float, float]] = []
    idle = []
    for env in (one, two):
        env.reset(seed=1)
        env.action_space.seed(1)
        _rate(env)
    for _ in range(MOST_TRIES):
        before = _idle_cores()
        found = (_rate(one), _rate(two))
        idle.append(min(before, _idle_cores()))
        if idle[-1] >= IDLE_CORES:
            rates.append(found)
        if len(rates) == WORKERS_ROUNDS:
            break
    one.close()
    two.close()
    record: Record = {"tries": len(idle), "rounds": len(rates), "idle_cores": median(idle), "count": count}
    if rates:
        record["decisions_per_s"] = [round(median([rate[side] for rate in rates])) for side in (0, 1)]
        record["two_to_one"] = quartiles([second / first for first, second in rates])
        record["source"] = source_digest("tltlc", "runtime")
    return record


def _rate(env: WorkerVectorEnv) -> float:
    """Decisions per second of wall time."""
    began = time.perf_counter()
    for step in range(WORKERS_STEPS):
        if step % 6 == 0:
            chosen = env.action_space.sample()
        env.step(chosen)
    return WORKERS_STEPS * env.num_envs / (time.perf_counter() - began)


def _idle_cores() -> float:
    """How many cores of the machine nobody used for a moment; as many as there are where it does not tell."""
    before = _idle_ticks()
    time.sleep(PROBE_S)
    after = _idle_ticks()
    if before is None or after is None:
        return float(os.cpu_count() or 1)
    return (after - before) / os.sysconf("SC_CLK_TCK") / PROBE_S


def _idle_ticks() -> int | None:
    try:
        _, _, _, _, idle, waiting, *_ = Path("/proc/stat").read_text(encoding="ascii").split("\n", 1)[0].split()
    except OSError:
        return None
    return int(idle) + int(waiting)


if __name__ == "__main__":
    print(json.dumps(two_beside_one(int(sys.argv[2])) if sys.argv[1] == WORKERS else compared(*sys.argv[1:])))
