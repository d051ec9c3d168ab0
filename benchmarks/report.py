"""Write RESULTS.md from the stored records."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from pathlib import Path

from benchmarks import (
    batch,
    bounds_report,
    compile_table,
    edits,
    edits_report,
    engine_report,
    expert,
    expert_report,
    game,
    game_report,
    godot,
    infinite,
    judge,
    mine,
    monitors,
    process,
    safety,
    suite,
    summary,
    table1,
    tables,
    tools,
    training,
    training_report,
    verdicts,
    verdicts_report,
)
from benchmarks.markdown import MISSED, met_or_missed, spread, table
from benchmarks.reference import references
from benchmarks.store import Record, Store

RESULTS = Path(__file__).with_name("RESULTS.md")
CAUSES = Path(__file__).with_name("causes.md")

COMPILE_FACTOR = 3.0
LTLF2DFA_FACTOR = 20.0
PROCESS_FACTOR = 15.0
MONITOR_FACTOR = 0.5
BATCH_STEPS_PER_S = 10e6
BATCH_GPU_MS = 1.0


def render(store: Store) -> str:
    """Return the whole report in Markdown."""
    compiled = store.section(compile_table.SECTION)
    timeout_s = store.section("machine")["options"]["peer_timeout_s"]
    rows = summary.families(compiled, references(), timeout_s)
    goals = list(_goals(store, rows))
    parts = [
        _head(store),
        "## Goals\n\n" + table(("goal", "figure", ""), goals),
        *(
            ["### Why some goals are missed\n\n" + CAUSES.read_text(encoding="utf-8")]
            if any(verdict == MISSED for *_, verdict in goals)
            else []
        ),
        _families(rows, timeout_s),
        _sizes(compiled),
        _large(compiled),
        _process(store.section(process.SECTION)),
        _monitors(store.section(monitors.SECTION)),
        engine_report.section(store),
        tables.section(store.section(tables.SECTION)),
        bounds_report.section(store),
        _batch(store.section(batch.SECTION)),
        game_report.speed_section(store.section(game.SECTION)),
        godot.section(store.section(godot.SECTION)),
        game_report.safety_section(store.section(safety.SECTION)),
        expert_report.section(store.section(expert.SECTION)),
        training_report.section(store.section(training.SECTION)),
        verdicts_report.section(store.section(verdicts.SECTION)),
        suite.section(store.section(suite.SECTION)),
        edits_report.section(store.section(edits.SECTION)),
        table1.section(store.section(table1.SECTION)),
        infinite.section(store.section(infinite.SECTION)),
        mine.section(store.section(mine.SECTION)),
        judge.section(store.section(judge.SECTION)),
        tools.section(store.section(tools.SECTION)),
    ]
    return "\n\n".join(part.strip() for part in parts if part) + "\n"


def _head(store: Store) -> str:
    digests = {
        record["source"]
        for section in (compile_table.SECTION, process.SECTION, monitors.SECTION)
        for record in store.section(section).values()
        if "source" in record
    }
    changed = (
        ""
        if len(digests) <= 2
        else ("\nThe sources changed while this was measured: `python -m benchmarks --fresh` measures one state.\n")
    )
    return f"""
# Benchmarks

`make bench` writes this page. It runs `python -m benchmarks` in the project's environment, with
`benchmarks/requirements.txt` and MONA (Debian package `mona`) installed. A stopped run resumes; `--fresh` discards
earlier results. Unless a section says otherwise, times are CPU times and medians of several runs, and the figures of a
row were measured one after another in the same run. Absolute figures depend on the machine, so compare the ratios.
{changed}
{table(("", ""), store.section("machine")["facts"].items())}
"""


def _goals(store: Store, rows: Sequence[summary.Family]) -> Iterable[Sequence[str]]:
    compiled = store.section(compile_table.SECTION)
    slow = [f"{row.name} {row.to_spot:.1f}" for row in rows if row.to_spot > COMPILE_FACTOR]
    slow_recorded = [f"{row.name} {row.to_spot_recorded:.1f}" for row in rows if row.to_spot_recorded > COMPILE_FACTOR]
    worst = max((row.to_spot for row in rows if not math.isnan(row.to_spot)), default=math.nan)
    yield (
        "formula to minimal automaton within 3 times Spot's estimated median, on every family",
        f"worst family {worst:.1f}"
        + (f"; over 3: {', '.join(slow)}" if slow else "")
        + (f"; over 3 with Spot's times as recorded: {', '.join(slow_recorded)}" if slow_recorded else ""),
        met_or_missed(bool(rows) and not slow),
    )
    for field, task in (
        ("ltlf2dfa_over_minimal", "formula to minimal automaton"),
        ("ltlf2dfa_over_guarded", "formula to minimal automaton with guards as text, which is what LTLf2DFA gives,"),
        ("ltlf2dfa_over_build", "complete build"),
    ):
        ratios = [(getattr(row, field), row.name) for row in rows if getattr(row, field) is not None]
        low = [f"{name} {ratio}" for ratio, name in ratios if ratio.value < LTLF2DFA_FACTOR]
        least = min((ratio.value for ratio, _ in ratios), default=math.nan)
        yield (
            f"{task} at least 20 times faster than LTLf2DFA, on every family",
            f"worst family {least:.0f}" + (f"; under 20: {', '.join(low)}" if low else ""),
            met_or_missed(bool(ratios) and not low),
        )
    small = [record for record in compiled.values() if (record["states_expected"] or 601) <= summary.SOLVED_STATES]
    unsolved = summary.unsolved(compiled)
    slowest = max((record["build_ms"] for record in small if "build_ms" in record), default=math.nan)
    memory = max((record["build_mb"] for record in small if "build_mb" in record), default=math.nan)
    yield (
        "every formula with at most 600 states built completely in under 5 s and 2 GB",
        f"{len(small) - len(unsolved)} of {len(small)}; slowest {slowest / 1e3:.2f} s, most {memory:.0f} MB"
        + (f"; not: {', '.join(unsolved)}" if unsolved else ""),
        met_or_missed(bool(small) and not unsolved),
    )
    whole = store.section(process.SECTION).get("tltlc compile cover_and_hide.tltl", {})
    if "cpu_ratio" in whole:
        cpu, wall = whole["cpu_ratio"][1], whole["wall_ratio"][1]
        yield (
            "`tltlc compile` of one spec at most 15 times a bare `python -c pass`",
            f"{cpu:.1f} of CPU time, {wall:.1f} of wall time",
            met_or_missed(max(cpu, wall) <= PROCESS_FACTOR),
        )
    ratios_by_hand = [
        record["generated_to_hand_written"][1]
        for record in store.section(monitors.SECTION).values()
        if "generated_to_hand_written" in record
    ]
    if ratios_by_hand:
        yield (
            "the generated Python monitor at least 0.5 of the speed of one written by hand, on the paper's specs",
            f"least {min(ratios_by_hand):.2f}",
            met_or_missed(min(ratios_by_hand) >= MONITOR_FACTOR),
        )
    yield from engine_report.goals(store)
    yield from tables.goals(store.section(tables.SECTION))
    yield from bounds_report.goals(store)
    yield from _batch_goals(store.section(batch.SECTION))
    yield from game_report.goals(store)
    yield from godot.goals(store.section(godot.SECTION))
    yield from expert_report.goals(store)
    yield from training_report.goals(store.section(training.SECTION))
    yield from verdicts_report.goals(store.section(verdicts.SECTION))
    yield from suite.goals(store.section(suite.SECTION))
    yield from edits_report.goals(store.section(edits.SECTION))
    yield from table1.goals(store.section(table1.SECTION))
    yield from infinite.goals(store.section(infinite.SECTION))
    yield from mine.goals(store.section(mine.SECTION))
    yield from judge.goals(store.section(judge.SECTION))
    yield from tools.goals(store.section(tools.SECTION))


def _batch_goals(records: dict[str, Record]) -> Iterable[Sequence[str]]:
    rates = {name: record["steps_per_s"]["batch"] for name, record in records.items() if "steps_per_s" in record}
    if rates:
        yield (
            f"batched monitor and reward at least 10 million steps per second on one core, N = {batch.COUNT}",
            ", ".join(f"{rate / 1e6:.1f} million on {name}" for name, rate in rates.items()),
            met_or_missed(min(rates.values()) >= BATCH_STEPS_PER_S),
        )
    record = records.get("cover_and_hide", {})
    if "gpu_ms" in record:
        middle = record["gpu_ms"][1]
        yield (
            f"batched monitor and reward of {record['gpu_count']:,} environments in under 1 ms on a GPU",
            f"{middle:.2f} ms on cover_and_hide",
            met_or_missed(middle < BATCH_GPU_MS),
        )


def _families(rows: Sequence[summary.Family], timeout_s: float) -> str:
    header = (
        "family",
        "formulas",
        "minimal ms",
        "guarded ms",
        "build ms",
        "MONA ms",
        "Spot est. ms",
        "minimal / Spot est.",
        "minimal / Spot recorded",
        "LTLf2DFA / minimal",
        "LTLf2DFA / guarded",
        "LTLf2DFA / build",
        "LTLf2DFA solved",
    )
    body = [
        (
            row.name,
            row.formulas,
            _ms(row.minimal_ms),
            _ms(row.guarded_ms),
            _ms(row.build_ms),
            _ms(row.mona_ms),
            _ms(row.spot_ms),
            _ratio(row.to_spot),
            _ratio(row.to_spot_recorded),
            row.ltlf2dfa_over_minimal or "–",
            row.ltlf2dfa_over_guarded or "–",
            row.ltlf2dfa_over_build or "–",
            f"{row.ltlf2dfa_solved} of {row.ltlf2dfa_tried}",
        )
        for row in rows
    ]
    return f"""
## Compiling, by family of formulas

*minimal*: from a formula in memory to the minimal automaton, including the normal form, in one process with fresh
tables. *guarded*: the same, with the guard of every edge as a short text, which is what LTLf2DFA's result contains.
*build*: everything that an artefact contains: also all prime implicants of guards, distances, verdicts, labels that
are shortened by proof, and texts in three notations. Each build runs in a fork, so that no run profits from an earlier
one.
*MONA*: the whole process `mona -q -u -w` on a program that `benchmarks/mona.py` writes; the start of the process takes
a few milliseconds. *Spot est.*: an estimate of Spot 2.14's time in process. It is the time recorded in
`benchmarks/reference.tsv`, times MONA's time here, divided by MONA's recorded time (if MONA ran out of time, the median
of these factors is used). *LTLf2DFA*: `to_dfa` of a parsed formula with the MONA process that it starts, in a fork as
above; the columns show the median of the ratios of its time to ours, formula by formula.

Peers are stopped after {timeout_s:g} s on a formula, and this limit then counts as their time (`≥`). After
{compile_table.LTLF2DFA_FAILURES} such formulas, the rest of a family is left out for LTLf2DFA.

{table(header, body)}
"""


def _sizes(compiled: dict[str, Record]) -> str:
    built = [record for record in compiled.values() if "states" in record]
    known = sum(record["states_expected"] is not None for record in built)
    mona_known = sum("mona_states" in record for record in built)
    both = [record for record in built if "ltlf2dfa_states" in record]
    same = sum(record["ltlf2dfa_states"] == record["states"] for record in both)
    one_more = sum(record["ltlf2dfa_states"] == record["states"] + 1 for record in both)
    wrong = summary.wrong_sizes(compiled)
    verdict = f"these differ: {', '.join(wrong)}" if wrong else "all agree"
    return f"""
## Sizes

{len(built)} automata were built. {known} have a reference size, and MONA computed the size of {mona_known}, counted as
ours (`benchmarks/mona.py` explains how): {verdict}. LTLf2DFA's automata have the same size in {same} cases of
{len(both)}, and one state more in {one_more}.
"""


def _large(compiled: dict[str, Record]) -> str:
    large = {
        name: record
        for name, record in compiled.items()
        if (record["states_expected"] or 601) > summary.SOLVED_STATES or name in summary.unsolved(compiled)
    }
    body = [
        (
            name,
            record["states_expected"] or record.get("mona_states") or "?",
            _outcome(record, "minimal"),
            _outcome(record, "build"),
            _mb(record),
            _outcome(record, "mona"),
            _outcome(record, "ltlf2dfa"),
        )
        for name, record in large.items()
    ]
    return f"""
## Large automata

Formulas with more than 600 states or an unknown number of states, and smaller ones that missed their goal. A code is
the error that ends a construction that grows too large: TLT0501 the state budget of 50,000, TLT0502 a guard with too
many primes.

{table(("formula", "states", "minimal", "build", "MB", "MONA", "LTLf2DFA"), body)}
"""


def _process(records: dict[str, Record]) -> str:
    body = [
        (
            f"`{name}`",
            _ms(record["cpu_ms"]),
            _ms(record["wall_ms"]),
            _ms(record["bare_cpu_ms"]),
            spread(record["cpu_ratio"]),
            spread(record["wall_ratio"]),
        )
        for name, record in records.items()
        if "cpu_ratio" in record
    ]
    whole = records.get("tltlc compile cover_and_hide.tltl", {})
    imports = ", ".join(f"`{module}` {ms:.1f}" for module, ms in whole.get("imports", []))
    return f"""
## The whole process

Each command and a bare `python -c pass` run in turns, in {process.ROUNDS} pairs. Python stores compiled modules, as for
an installed package. The ratios are those of pairs: the median, and the quartiles in brackets.

{table(("command", "CPU ms", "wall ms", "bare CPU ms", "CPU ratio", "wall ratio"), body)}

The slowest imports of the first command, in milliseconds of the module itself (with Python's tracing on):
{imports or "–"}.
"""


def _monitors(records: dict[str, Record]) -> str:
    monitor_names = list(
        dict.fromkeys(monitor_name for record in records.values() for monitor_name in record.get("steps_per_s", {}))
    )
    body = [
        (
            name,
            record["samples"],
            *(
                f"{record['steps_per_s'][monitor_name]:,}" if monitor_name in record["steps_per_s"] else "–"
                for monitor_name in monitor_names
            ),
            spread(record["generated_to_hand_written"], 2),
        )
        for name, record in records.items()
        if "steps_per_s" in record
    ]
    return f"""
## Monitors, steps per second

Each figure is the median of {monitors.ROUNDS} rounds over the recorded trace of one of the paper's specs; in a round,
all monitors run one after another. *generated*: `NAME_monitor.py`. *hand_written*: `benchmarks/handwritten/NAME.py`,
plain Python for the same automaton with every field of a step (state, label, verdict, acceptance, end, progress,
reward, robustness, limiting atom), which is compared on the trace before it is timed. It computes only the predicates
that its state needs, and gives no notices of clamped values. *tltlc.monitor*: the monitor behind `tltlc monitor`,
which runs any automaton. *RTAMT* and *Reelay* compute the robustness of each prefix by the past-time form of the
formula (`benchmarks/peer_monitors.py`) and nothing else, and get the values of the predicates as input. At each step,
the sign of their answers was compared with acceptance.

{table(("spec", "samples", *monitor_names, "generated / hand_written"), body)}
"""


def _batch(records: dict[str, Record]) -> str:
    body = [
        (
            name,
            f"{record['steps_per_s']['batch']:,}",
            f"{record['steps_per_s']['scalar']:,}",
            spread(record["batch_to_scalar"]),
            f"{spread(record['gpu_ms'], 2)} ({record['gpu']})" if "gpu_ms" in record else "–",
        )
        for name, record in records.items()
        if "steps_per_s" in record
    ]
    if not body:
        return ""
    return f"""
## Many automata at once, steps per second

`tltl_runtime.spec.batch` on one core, for N = {batch.COUNT:,} environments in different states, in float64, and
`tltlc.monitor`, one sample at a time. Both run in turns in each of {batch.ROUNDS} rounds, and their results were
compared before. A step computes atoms, transition, progress, reward and the end of the episode from signals in one
tensor. On a GPU: wall time of one call for {batch.GPU_COUNT:,} environments.

{table(("spec", "batch", "tltlc.monitor", "batch / tltlc.monitor", "GPU, ms a call"), body)}
"""


def _outcome(record: Record, side: str) -> str:
    if f"{side}_ms" in record:
        ms = record[f"{side}_ms"]
        return f"{ms / 1e3:.2f} s" if ms >= 1000 else f"{_ms(ms)} ms"
    return str(record.get(f"{side}_failed", "–"))


def _mb(record: Record) -> str:
    known = record.get("build_mb", record.get("minimal_mb"))
    return "–" if known is None else f"{known:.0f}"


def _ms(value: float) -> str:
    return "–" if math.isnan(value) else f"{value:.2f}" if value < 10 else f"{value:.0f}"


def _ratio(value: float) -> str:
    return "–" if math.isnan(value) else f"{value:.1f}"
