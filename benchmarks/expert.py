"""How often the scripted expert finishes each level, when it keeps out of sight and when it minds no enemies.

A level is one of stealth where the second fails.  Episodes are told apart by the barrier that opened by chance.

``python -m benchmarks.expert LEVEL VARIANT careful|careless [EPISODES]`` plays one variant in a process of its own.
"""

from __future__ import annotations

import json
import math
import statistics
import sys
import time
from collections.abc import Callable, Collection, Iterable, Iterator, Sequence
from typing import TYPE_CHECKING

from benchmarks.store import Record, Store, source_digest
from benchmarks.variants import measure_each, variants_of_all

if TYPE_CHECKING:
    from tltl_runtime.spec.episode_summary import EpisodeSummary
    from tltl_runtime.stealth.level import Level

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
    from tltl_runtime.stealth.expert.expert import Expert, play_episode
    from tltl_runtime.stealth.recording import RecordEpisode
    from tltl_runtime.stealth.recordings.episode_summary import opened_barriers, summary_of, was_chased

    env = RecordEpisode(make_env(level, variant))
    expert = Expert(env, careful=care == "careful")
    began = time.process_time()
    by_barrier: dict[str, list[tuple[EpisodeSummary, bool]]] = {}
    for seed in range(episodes):
        play_episode(env, expert, seed)
        episode = env.episode
        barrier = _chance(expert.level, opened_barriers(episode))
        by_barrier.setdefault(barrier, []).append((summary_of(episode), was_chased(episode)))
    env.close()
    return {
        "barriers": {name: _summary(episodes) for name, episodes in sorted(by_barrier.items())},
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


def _chance(level: Level, opened: Collection[str]) -> str:
    """The barrier that an unlocking by chance has opened."""
    chosen = (name for unlock in level.unlocks for name in unlock.barriers)
    return next((name for name in chosen if name in opened), "")


def _summary(episodes: Sequence[tuple[EpisodeSummary, bool]]) -> Record:
    """The figures of episodes; the second value says whether an enemy chased the player."""
    return {
        "episodes": len(episodes),
        "successes": sum(episode.success for episode, _ in episodes),
        "progress": _mean(episode.progress for episode, _ in episodes),
        "reward": _mean(episode.reward for episode, _ in episodes),
        "length": _mean(episode.steps for episode, _ in episodes),
        "chased": _mean(was_chased for _, was_chased in episodes),
    }


def _mean(values: Iterable[float]) -> float:
    return round(statistics.fmean(values), 3)


if __name__ == "__main__":
    asked, in_variant, with_care, *times = sys.argv[1:]
    count = int(times[0]) if times else EPISODES.get(in_variant, OTHERS)
    print(json.dumps(played(asked, in_variant, with_care, count)))
