"""The section of RESULTS.md on the scripted expert."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from benchmarks import expert
from benchmarks.markdown import met_or_missed, table
from benchmarks.store import Record, Store

CAREFUL_RATE = 0.95
CARELESS_RATE = 0.2


def goals(store: Store) -> Iterable[Sequence[str]]:
    """Yield the rows of the table of goals for what was measured."""
    records = store.section(expert.SECTION)
    careful = {
        name: _rate(record)
        for name, record in records.items()
        if name.endswith(" v0 careful") and _has_episodes(record)
    }
    if careful:
        yield (
            "the careful expert finishes each v0 level in at least 95 % of its episodes",
            ", ".join(f"{name.split()[0]} {rate:.0%}" for name, rate in careful.items()),
            met_or_missed(min(careful.values()) >= CAREFUL_RATE),
        )
    careless = {
        f"{name.split()[0]}{f', {barrier}' if barrier else ''}": part["successes"] / part["episodes"]
        for name, record in records.items()
        if name.endswith(" v0 careless") and _has_episodes(record)
        for barrier, part in record["barriers"].items()
        if part["chased"] > 0.5
    }
    if careless:
        yield (
            "where there are guards, an expert that ignores them fails in most v0 episodes",
            ", ".join(f"{name} {rate:.0%}" for name, rate in careless.items()),
            met_or_missed(max(careless.values()) < CARELESS_RATE),
        )


def section(records: dict[str, Record]) -> str:
    """Return the section on the scripted expert; empty without measurements."""
    body = [
        (f"{level} {variant}", care, barrier or "–", part["episodes"], *_figures(part), f"{record['cpu_s']:.1f}")
        for name, record in records.items()
        if _has_episodes(record)
        for level, variant, care in [name.split()]
        for barrier, part in record["barriers"].items()
    ]
    if not body:
        return ""
    header = (
        "level",
        "expert",
        "opened",
        "episodes",
        "success (95 %)",
        "progress",
        "reward",
        "decisions",
        "chased",
        "s",
    )
    return f"""
## The scripted expert

The player is that of `tltlc demonstrate`, once careful and once ignoring enemies, with seeds from 0. *Opened*: the
barrier that opened by chance. *Success*: the rate, with its Wilson interval. *Progress*, *reward* (of an episode) and
*decisions* are means. *Chased* is the share of episodes in which an enemy chased the player, and *s* the CPU time of an
episode.

{table(header, body)}
"""


def _has_episodes(record: Record) -> bool:
    return "barriers" in record


def _rate(record: Record) -> float:
    parts = record["barriers"].values()
    return float(sum(part["successes"] for part in parts) / sum(part["episodes"] for part in parts))


def _figures(part: Record) -> tuple[str, ...]:
    low, high = expert.wilson(part["successes"], part["episodes"])
    return (
        f"{part['successes'] / part['episodes']:.2f} ({low:.2f}–{high:.2f})",
        f"{part['progress']:.2f}",
        f"{part['reward']:.2f}",
        f"{part['length']:.0f}",
        f"{part['chased']:.2f}",
    )
