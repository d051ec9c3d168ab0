"""The expert's part of RESULTS.md."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from benchmarks import expert
from benchmarks.markdown import met_or_missed, table
from benchmarks.store import Record, Store

CAREFUL_RATE = 0.95
CARELESS_RATE = 0.2


def goals(store: Store) -> Iterable[Sequence[str]]:
    """Rows of the table of goals, for what was played."""
    records = store.section(expert.SECTION)
    careful = {name: _rate(record) for name, record in records.items() if name.endswith(" v0 careful") and _is(record)}
    if careful:
        yield (
            "the careful expert finishes each v0 level in at least 95 % of its episodes",
            ", ".join(f"{name.split()[0]} {rate:.0%}" for name, rate in careful.items()),
            met_or_missed(min(careful.values()) >= CAREFUL_RATE),
        )
    careless = {
        f"{name.split()[0]}{f', {barrier}' if barrier else ''}": part["successes"] / part["episodes"]
        for name, record in records.items()
        if name.endswith(" v0 careless") and _is(record)
        for barrier, part in record["barriers"].items()
        if part["chased"] > 0.5
    }
    if careless:
        yield (
            "where guards are, who minds none of them fails in most v0 episodes",
            ", ".join(f"{name} {rate:.0%}" for name, rate in careless.items()),
            met_or_missed(max(careless.values()) < CARELESS_RATE),
        )


def section(records: dict[str, Record]) -> str:
    """The section on the scripted expert."""
    body = [
        (f"{level} {variant}", care, barrier or "–", part["episodes"], *_figures(part), f"{record['cpu_s']:.1f}")
        for name, record in records.items()
        if _is(record)
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

Who plays is `tltlc demonstrate`'s player, once careful and once minding no enemies; seeds from 0 on. *Opened*: the
barrier that chance has opened. *Success*: the rate with its Wilson interval. *Progress*, *reward* (of an episode) and
*decisions* are means, *chased* the share of episodes in which an enemy gave chase, *s* the CPU time an episode takes.

{table(header, body)}
"""


def _is(record: Record) -> bool:
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
