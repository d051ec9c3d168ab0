"""The game's part of RESULTS.md: goals and tables of speed and safety."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from benchmarks import game, safety
from benchmarks.markdown import met_or_missed, spread, table
from benchmarks.store import Record, Store
from benchmarks.wander import HELD

ENV_FACTOR = 0.5
WORKERS_FACTOR = 1.7
MAP_US = 5.0
SAFE_STEPS = 1_000_000


def goals(store: Store) -> Iterable[Sequence[str]]:
    """Rows of the table of goals, for what was measured."""
    speed = _variants(store.section(game.SECTION), "bare_to_env")
    if speed:
        ratios = {name: record["bare_to_env"][1] for name, record in speed.items()}
        low = [f"{name} {ratio:.2f}" for name, ratio in ratios.items() if ratio < ENV_FACTOR]
        yield (
            "one game with observations at least half as fast as the bare physics of its bodies",
            f"least {min(ratios.values()):.2f}" + (f"; under 0.5: {', '.join(low)}" if low else ""),
            met_or_missed(not low),
        )
        slowest = max(record["map_us"][0] for record in speed.values())
        yield "a look at the semantic map in under 5 µs", f"slowest {slowest:.1f} µs", met_or_missed(slowest < MAP_US)
    for workers in _workers(store.section(game.SECTION)):
        goal = (
            f"two worker processes at least 1.7 times as fast as one, {workers['count']} environments, two free cores"
        )
        if "two_to_one" in workers:
            ratio = workers["two_to_one"][1]
            yield goal, f"{ratio:.2f}", met_or_missed(ratio >= WORKERS_FACTOR)
        else:
            idle, tries = workers["idle_cores"], workers["tries"]
            yield goal, f"not measured: {idle:.1f} cores were idle, at the median of {tries} tries", "–"
    tried = store.section(safety.SECTION)
    if tried:
        steps = sum(record.get("steps", 0) for record in tried.values())
        failed = [f"{name}: {record['failed']}" for name, record in tried.items() if "failed" in record]
        yield (
            "a million random steps over the nine variants without a violation",
            f"{steps:,} steps" + (f"; {'; '.join(failed)}" if failed else ""),
            met_or_missed(steps >= SAFE_STEPS and not failed),
        )


def speed(records: dict[str, Record]) -> str:
    """The section on decisions per second."""
    found = _variants(records, "bare_to_env")
    if not found:
        return ""
    body = [
        (
            name,
            *(f"{record[key]:.0f}" for key in ("bare_us", "env_us", "spec_us")),
            spread(record["bare_to_env"], 2),
            spread(record["bare_to_spec"], 2),
            f"{record['map_us'][0]:.1f}, {record['map_us'][1]:.1f}",
        )
        for name, record in found.items()
    ]
    header = ("variant", "bare µs", "env µs", "with spec µs", "bare / env", "bare / with spec", "map µs")
    return f"""
## The game, microseconds a decision

CPU time of one process, a random action held for {HELD} decisions on average; bare, env and with spec in turns in each
of {game.ROUNDS} rounds of {game.DECISIONS} decisions. *Bare*: Bullet with the bodies of the level, the player's
velocity set and nine physics steps made. *Env*: all of the game, and the observation. *With spec*: the automaton and
its reward too, and the resets of the episodes that it ends. *Map*: a look at the semantic map, and one with its
layers made.

{table(header, body)}
{"".join(map(_two_beside_one, _workers(records)))}"""


def safe(records: dict[str, Record]) -> str:
    """The section on safety."""
    found = _variants(records, "steps")
    if not found:
        return ""
    body = [
        (name, *(f"{record[key]:,}" for key in ("steps", "episodes", "checks")), f"{record['deepest_m']:.3f}")
        for name, record in found.items()
    ]
    return f"""
## Random steps without a violation

Held random actions, half of the episodes from the start of the level and half from anywhere on its floors. After each
step: numbers finite, player and enemies inside the bounds, the observation in its space, no body more than
{safety.DEEPEST} m inside a box (the player's radius is 0.3 m). *Checks*: all walls by rays and all collision filters,
at each reset and each end of an episode. *Deepest*: how far the player's body ever reached into a box.

{table(("variant", "steps", "episodes", "checks", "deepest m"), body)}
"""


def _workers(records: dict[str, Record]) -> list[Record]:
    """The records of worker processes."""
    return [record for name, record in records.items() if name.startswith(game.WORKERS) and "count" in record]


def _two_beside_one(record: Record) -> str:
    if "two_to_one" not in record:
        return ""
    one, two = record["decisions_per_s"]
    ratio = spread(record["two_to_one"], 2)
    return f"""
{record["count"]} environments of {game.WORKERS_LEVEL} with their spec, decisions per second of wall time: {one:,} with
one worker process, {two:,} with two; ratio {ratio} over {record["rounds"]} rounds in which two cores were free.
"""


def _variants(records: dict[str, Record], key: str) -> dict[str, Record]:
    return {name: record for name, record in records.items() if key in record}
