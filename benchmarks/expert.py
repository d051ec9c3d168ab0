"""How often the scripted expert finishes each level, when it keeps out of sight and when it minds no enemies.

A level is one of stealth where the second fails.  Episodes are told apart by the barrier that opened by chance.

``python -m benchmarks.expert LEVEL VARIANT careful|careless [EPISODES]`` plays one variant in a process of its own.
"""

from __future__ import annotations

import json
import math
import sys
import time
from collections.abc import Callable, Iterator, Sequence
from typing import TYPE_CHECKING, Any

from benchmarks.store import Record, Store, source_digest
from benchmarks.variants import measure_each, variants_of_all

if TYPE_CHECKING:
    from tltl_runtime.stealth.expert.expert import Expert
    from tltl_runtime.stealth.game import Game

SECTION = "expert"
CARES = ("careful", "careless")
EPISODES = {"v0": 100}
OTHERS = 50
TIMEOUT_S = 3600.0
Z = 1.959964
"""Of a two-sided interval of 95 %."""


def measure(store: Store, _: float, say: Callable[[str], None]) -> None:
    """Play what the store does not have yet, or what failed."""
    measure_each(store, SECTION, _cases, TIMEOUT_S, say)


def played(level: str, variant: str, care: str, episodes: int) -> Record:
    """Episodes of the seeds from 0 on: outcomes by the barrier that opened by chance, ``""`` where there is none."""
    from tltl_runtime.stealth.env import make_env
    from tltl_runtime.stealth.expert.expert import Expert

    env = make_env(level, variant)
    expert = Expert(env, careful=care == "careful")
    began = time.process_time()
    by_barrier: dict[str, list[dict[str, float]]] = {}
    for seed in range(episodes):
        outcome = _episode(env, expert, seed)
        by_barrier.setdefault(_chance(env.get_wrapper_attr("game")), []).append(outcome)
    env.close()
    return {
        "barriers": {name: _summary(outcomes) for name, outcomes in sorted(by_barrier.items())},
        "cpu_s": round((time.process_time() - began) / episodes, 2),
        "source": source_digest("tltlc", "runtime"),
    }


def wilson(successes: int, episodes: int) -> tuple[float, float]:
    """The interval of 95 % for a rate, as E. B. Wilson gave it in 1927."""
    rate, square = successes / episodes, Z * Z / episodes
    middle = (rate + square / 2) / (1 + square)
    half = Z * math.sqrt(rate * (1 - rate) / episodes + square / (4 * episodes)) / (1 + square)
    return max(0.0, middle - half), min(1.0, middle + half)


def _cases() -> Iterator[Sequence[str]]:
    """Each variant with each kind of care that makes a difference there."""
    from tltl_runtime.stealth.levels.file import load_level

    for level, variant in variants_of_all():
        for care in CARES if load_level(level, variant).enemies else CARES[:1]:
            yield level, variant, care


def _episode(env: Any, expert: Expert, seed: int) -> dict[str, float]:
    env.reset(seed=seed)
    expert.reset()
    game: Game = env.get_wrapper_attr("game")
    total, length, chased, over = 0.0, 0, False, False
    while not over:
        _, reward, terminated, truncated, info = env.step(expert.act())
        over = terminated or truncated
        total, length, chased = total + reward, length + 1, chased or "chase" in game.enemies.modes
    return {
        "success": info["success"],
        "progress": info["progress"],
        "reward": total,
        "length": length,
        "chased": chased,
    }


def _chance(game: Game) -> str:
    """The barrier that an unlocking by chance has opened."""
    chosen = {name for unlock in game.level.unlocks for name in unlock.barriers}
    names = (barrier.name for barrier, is_open in zip(game.level.barriers, game.open, strict=True) if is_open)
    return next((name for name in names if name in chosen), "")


def _summary(outcomes: list[dict[str, float]]) -> Record:
    count = len(outcomes)
    mean = {key: round(sum(outcome[key] for outcome in outcomes) / count, 3) for key in outcomes[0]}
    successes = sum(bool(outcome["success"]) for outcome in outcomes)
    return {"episodes": count, "successes": successes, **{key: mean[key] for key in mean if key != "success"}}


if __name__ == "__main__":
    asked, in_variant, with_care, *times = sys.argv[1:]
    count = int(times[0]) if times else EPISODES.get(in_variant, OTHERS)
    print(json.dumps(played(asked, in_variant, with_care, count)))
