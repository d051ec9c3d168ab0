"""Measure how long a decision takes in the game and in bare physics, and how fast worker processes are.

*Bare* is Bullet with only the bodies of the level: it sets the player's velocity and makes nine
physics steps, which every decision needs. *env* adds the rest of the game and the observation.
*with spec* also adds the automaton, its reward, and the resets after the episodes that it ends. The
time to compute the semantic map is measured, too.

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
"""Numbers of environments, shared by the workers. All wait for a reset, which takes as long as ten decisions."""
WORKERS_LEVEL = "cover_and_hide"
WORKERS_STEPS = 60
WORKERS_ROUNDS = 9
MOST_TRIES = 60
PROBE_S = 0.3
IDLE_CORES = 1.8
"""A round counts if at least this many cores were idle."""


def measure(store: Store, _: float, say: Callable[[str], None]) -> None:
    """Measure each variant without a record in the store, or with a failed one, then the workers."""
    measure_each(
        store, SECTION, lambda: [*variants_of_all(), *((WORKERS, str(count)) for count in COUNTS)], TIMEOUT_S, say
    )


def compare_speeds(level: str, variant: str) -> Record:
    """Return the microseconds of CPU time of a decision: bare, in the environment, and with its spec; and ratios."""
    import numpy as np

    from tltl_runtime.stealth.env import GameEnv, make_env

    chosen_actions = [np.array(action) for action in islice(actions(np.random.default_rng(1)), DECISIONS)]
    env, env_with_spec = GameEnv(level, variant), make_env(level, variant)
    bare = _bare_physics(env, chosen_actions)
    seeds = iter(range(10_000))

    def with_observations() -> None:
        for action in chosen_actions:
            env.step(action)

    def with_spec() -> None:
        for action in chosen_actions:
            *_, terminated, truncated, _ = env_with_spec.step(action)
            if terminated or truncated:
                env_with_spec.reset(seed=next(seeds))

    env_with_spec.reset(seed=next(seeds))
    times = []
    for round_ in range(ROUNDS + 1):
        env.reset(seed=round_)
        row = [_microseconds(work) for work in (bare, with_observations, with_spec)]
        if round_:
            times.append(row)
    return {
        "rounds": ROUNDS,
        "bare_us": median([row[0] for row in times]),
        "env_us": median([row[1] for row in times]),
        "spec_us": median([row[2] for row in times]),
        "bare_to_env": quartiles([row[0] / row[1] for row in times]),
        "bare_to_spec": quartiles([row[0] / row[2] for row in times]),
        "map_us": _map_microseconds(env),
        "source": source_digest("tltlc", "runtime"),
    }


def _bare_physics(env: GameEnv, chosen_actions: Sequence[Any]) -> Callable[[], None]:
    """Return a function that makes the physics of a decision for each action, in a world like that of ``env``."""
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
    velocities = [
        (*control(world.kind, world.player, action.tolist(), False).velocity, -1.0) for action in chosen_actions
    ]
    return world.run


def _microseconds(work: Callable[[], None]) -> float:
    """Return the CPU time per decision, in microseconds."""
    start = time.process_time()
    work()
    return (time.process_time() - start) * 1e6 / DECISIONS


def _map_microseconds(env: GameEnv) -> tuple[float, float]:
    """Return the microseconds to compute the semantic map at the present state, without and with its layers."""
    from tltl_runtime.stealth.observation.semantic_map import SemanticMap

    semantic_map, game = SemanticMap(env.level), env.game
    arguments = (game.world.player.position, False, game.world.mover_boxes(), game.enemies.positions)

    def look() -> None:
        for _ in range(DECISIONS):
            semantic_map.look(*arguments)

    def look_and_layer() -> None:
        for _ in range(DECISIONS):
            semantic_map.one_hot(semantic_map.look(*arguments))

    return median([_microseconds(look) for _ in range(ROUNDS)]), median(
        [_microseconds(look_and_layer) for _ in range(ROUNDS)]
    )


def compare_worker_counts(count: int) -> Record:
    """Measure decisions per second of wall time with one and with two worker processes, in turns.

    ``count`` is the number of environments. A round counts only if two cores were idle before and
    after it. ``idle_cores`` is the median number of idle cores.
    """
    from tltl_runtime.vector import make_vec

    single, double = (make_vec(WORKERS_LEVEL, "v0", count, workers) for workers in (1, 2))
    rates: list[tuple[float, float]] = []
    idle = []
    for env in (single, double):
        env.reset(seed=1)
        env.action_space.seed(1)
        _rate(env)
    for _ in range(MOST_TRIES):
        before = _idle_cores()
        pair = (_rate(single), _rate(double))
        idle.append(min(before, _idle_cores()))
        if idle[-1] >= IDLE_CORES:
            rates.append(pair)
        if len(rates) == WORKERS_ROUNDS:
            break
    single.close()
    double.close()
    record: Record = {"tries": len(idle), "rounds": len(rates), "idle_cores": median(idle), "count": count}
    if rates:
        record["decisions_per_s"] = [round(median([rate[side] for rate in rates])) for side in (0, 1)]
        record["two_to_one"] = quartiles([second / first for first, second in rates])
        record["source"] = source_digest("tltlc", "runtime")
    return record


def _rate(env: WorkerVectorEnv) -> float:
    """Return decisions per second of wall time."""
    start = time.perf_counter()
    for step in range(WORKERS_STEPS):
        if step % 6 == 0:
            chosen_actions = env.action_space.sample()
        env.step(chosen_actions)
    return WORKERS_STEPS * env.num_envs / (time.perf_counter() - start)


def _idle_cores() -> float:
    """Return how many cores were idle during a short pause; the number of all cores if the system does not tell."""
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
    print(
        json.dumps(compare_worker_counts(int(sys.argv[2])) if sys.argv[1] == WORKERS else compare_speeds(*sys.argv[1:]))
    )
