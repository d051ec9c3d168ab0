"""The sections of RESULTS.md on the speed and safety of the game, and their goals."""

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
    """Yield the rows of the table of goals for what was measured."""
    speed = _records_with(store.section(game.SECTION), "bare_to_env")
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
    safety_records = store.section(safety.SECTION)
    if safety_records:
        steps = sum(record.get("steps", 0) for record in safety_records.values())
        failed = [f"{name}: {record['failed']}" for name, record in safety_records.items() if "failed" in record]
        yield (
            "a million random steps over the nine variants without a violation",
            f"{steps:,} steps" + (f"; {'; '.join(failed)}" if failed else ""),
            met_or_missed(steps >= SAFE_STEPS and not failed),
        )


def speed_section(records: dict[str, Record]) -> str:
    """Return the section on decisions per second; empty without measurements."""
    measured = _records_with(records, "bare_to_env")
    if not measured:
        return ""
    body = [
        (
            name,
            *(f"{record[key]:.0f}" for key in ("bare_us", "env_us", "spec_us")),
            spread(record["bare_to_env"], 2),
            spread(record["bare_to_spec"], 2),
            f"{record['map_us'][0]:.1f}, {record['map_us'][1]:.1f}",
        )
        for name, record in measured.items()
    ]
    header = ("variant", "bare µs", "env µs", "with spec µs", "bare / env", "bare / with spec", "map µs")
    return f"""
## The game, microseconds a decision

CPU time of one process. A random action is held for {HELD} decisions on average; bare, env and with spec run in turns
in each of {game.ROUNDS} rounds of {game.DECISIONS} decisions. *Bare*: Bullet with the bodies of the level; a decision
sets the player's velocity and makes nine physics steps. *Env*: the whole game, and the observation. *With spec*: also
the automaton, its reward, and the resets after the episodes that it ends. *Map*: the time to compute the semantic
map, without and with its layers.

{table(header, body)}
{"".join(map(_workers_text, _workers(records)))}"""


def safety_section(records: dict[str, Record]) -> str:
    """Return the section on safety; empty without measurements."""
    measured = _records_with(records, "steps")
    if not measured:
        return ""
    body = [
        (name, *(f"{record[key]:,}" for key in ("steps", "episodes", "checks")), f"{record['deepest_m']:.3f}")
        for name, record in measured.items()
    ]
    return f"""
## Random steps without a violation

The player holds random actions. Half of the episodes begin at the start of the level, half anywhere on its floors.
After each step, these checks are made: numbers are finite, player and enemies are inside the bounds, the observation is
in its space, and no body is more than {safety.DEEPEST} m inside a box (the player's radius is 0.3 m). *Checks*: all
walls by rays and all collision filters, at each reset and each end of an episode. *Deepest*: how far the player's body
ever reached into a box.

{table(("variant", "steps", "episodes", "checks", "deepest m"), body)}
"""


def _workers(records: dict[str, Record]) -> list[Record]:
    """Return the records of worker processes."""
    return [record for name, record in records.items() if name.startswith(game.WORKERS) and "count" in record]


def _workers_text(record: Record) -> str:
    if "two_to_one" not in record:
        return ""
    one, two = record["decisions_per_s"]
    ratio = spread(record["two_to_one"], 2)
    return f"""
{record["count"]} environments of {game.WORKERS_LEVEL} with their spec, decisions per second of wall time: {one:,} with
one worker process, {two:,} with two; ratio {ratio} over {record["rounds"]} rounds in which two cores were free.
"""


def _records_with(records: dict[str, Record], key: str) -> dict[str, Record]:
    return {name: record for name, record in records.items() if key in record}
