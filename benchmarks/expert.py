"""Measure how often the scripted expert finishes each level, once avoiding enemies and once ignoring them.

A level needs stealth if the expert that ignores enemies fails. Episodes are grouped by the barrier
that opened by chance.

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
    from tltl_runtime.stealth.level import StealthLevel

SECTION = "expert"
KINDS_OF_CARE = ("careful", "careless")
EPISODES = {"v0": 100}
OTHER_EPISODES = 50
TIMEOUT_S = 3600.0
Z = 1.959964
"""The quantile of the normal distribution for a two-sided interval of 95 %."""


def measure(store: Store, _: float, say: Callable[[str], None]) -> None:
    """Play each case without a record in the store, or with a failed one."""
    measure_each(store, SECTION, _cases, TIMEOUT_S, say)


def play_episodes(level: str, variant: str, care: str, episodes: int) -> Record:
    """Play episodes with seeds from 0; return their figures by the barrier that opened by chance.

    The barrier is ``""`` if none opens by chance. ``cpu_s`` is the CPU time per episode.
    """
    from tltl_runtime.game.episode_summary import summary_of
    from tltl_runtime.stealth.env import make_env
    from tltl_runtime.stealth.episode_recorder import RecordEpisode
    from tltl_runtime.stealth.expert.expert import Expert, play_episode
    from tltl_runtime.stealth.recordings.figures import opened_barriers, was_chased

    env = RecordEpisode(make_env(level, variant))
    expert = Expert(env, careful=care == "careful")
    start_s = time.process_time()
    by_barrier: dict[str, list[tuple[EpisodeSummary, bool]]] = {}
    for seed in range(episodes):
        play_episode(env, expert, seed)
        episode = env.episode
        barrier = _chance_barrier(expert.level, opened_barriers(episode))
        by_barrier.setdefault(barrier, []).append((summary_of(episode), was_chased(episode)))
    env.close()
    return {
        "barriers": {name: _summary(episodes) for name, episodes in sorted(by_barrier.items())},
        "cpu_s": round((time.process_time() - start_s) / episodes, 2),
        "source": source_digest("tltlc", "runtime"),
    }


def wilson(successes: int, episodes: int) -> tuple[float, float]:
    """Return the Wilson interval of a rate at 95 % (E. B. Wilson, JASA 22, 1927)."""
    rate, square = successes / episodes, Z * Z / episodes
    middle = (rate + square / 2) / (1 + square)
    half = Z * math.sqrt(rate * (1 - rate) / episodes + square / (4 * episodes)) / (1 + square)
    return max(0.0, middle - half), min(1.0, middle + half)


def _cases() -> Iterator[Sequence[str]]:
    """Yield each variant with ``careful`` and ``careless``; without enemies, only with ``careful``."""
    from tltl_runtime.stealth.levels.file import load_level

    for level, variant in variants_of_all():
        for care in KINDS_OF_CARE if load_level(level, variant).enemies else KINDS_OF_CARE[:1]:
            yield level, variant, care


def _chance_barrier(level: StealthLevel, opened: Collection[str]) -> str:
    """Return the barrier that opened by chance; empty if there is none."""
    random_barriers = (name for unlock in level.unlocks for name in unlock.barriers)
    return next((name for name in random_barriers if name in opened), "")


def _summary(episodes: Sequence[tuple[EpisodeSummary, bool]]) -> Record:
    """Return the figures of episodes; the bool of an episode says whether an enemy chased the player."""
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
    level_name, variant_name, care, *count_words = sys.argv[1:]
    count = int(count_words[0]) if count_words else EPISODES.get(variant_name, OTHER_EPISODES)
    print(json.dumps(play_episodes(level_name, variant_name, care, count)))
