"""The section of RESULTS.md on bounds that are timers."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from typing import Any, Final

from benchmarks import bounds
from benchmarks.bounds_specs import NAMES
from benchmarks.markdown import met_or_missed, spread, table
from benchmarks.store import Record, Store

_TITLES: Final = {
    "generated": "C, generated",
    "no_registers": "C, generated, no registers to read",
    "generated_verdict": "C, generated, state and verdict only",
    "without_timers": "C, generated, timers as signals",
    "by_hand": "C by hand, every field",
    "verdict_only": "C by hand, verdict only",
}
_LEAN: Final = "with timers and no registers to read"
_RICHER: Final = {
    "no_registers_to": ("to", "with them"),
    "generated_verdict_to": ("no_registers_to", "with every field"),
}
"""For the ratios of a monitor, those of one that offers more, and what it offers."""
_FACTORS: Final = (
    ("to", "without_timers", 0.8, "with timers", "of the same monitor whose timers are signals"),
    ("no_registers_to", "by_hand", 0.9, _LEAN, "of C written by hand that computes every field"),
    (
        "generated_verdict_to",
        "verdict_only",
        0.9,
        "with timers that finds only state and verdict",
        "of C written by hand that computes the verdict only, as Copilot and R2U2 do",
    ),
)


def goals(store: Store) -> Iterable[Sequence[str]]:
    """Yield the rows of the table of goals, as far as they were measured."""
    records = store.section(bounds.SECTION)
    compiled = records.get("compile", {})
    if "rounds" in compiled:
        yield from _compile_goals(compiled)
    measured = {name: records[name] for name in NAMES if "generated_verdict_to" in records.get(name, {})}
    if not measured:
        return
    for ratios_of, author, least, what, text in _FACTORS:
        ratios = {name: record[ratios_of][author][1] for name, record in measured.items()}
        yield (
            f"a generated C monitor {what} at least {least:g} of the speed {text}",
            ", ".join(
                f"{name} {ratio:.2f}{_richer(measured[name], ratios_of, author)}" for name, ratio in ratios.items()
            ),
            met_or_missed(min(ratios.values()) >= least),
        )
    ratios = {
        f"{name} {ratio:.1f} times {peer}": ratio
        for name, record in measured.items()
        for peer, ratio in _to_peers(record, record["python_steps_per_s"]["generated"]).items()
    }
    if ratios:
        yield (
            "the generated Python monitor with timers faster than RTAMT and Reelay",
            ", ".join(ratios),
            met_or_missed(min(ratios.values()) > 1),
        )


def _compile_goals(record: Record) -> Iterable[Sequence[str]]:
    ratio, sizes, times = record["bounded_to_unbounded"][1], record["bytes"], record["cpu_ms"]
    yield (
        "two deadlines of 5 s at 60 Hz compiled in at most 2 times the time of the same spec without bounds",
        f"{ratio:.2f}",
        met_or_missed(ratio <= 2),
    )
    artefact, header = sizes["deadlines"]["artefact"], sizes["deadlines"]["C"]
    yield (
        "their artefact under 30 KB, their C header under 80 KB",
        f"{_kb(artefact)} and {_kb(header)} KB",
        met_or_missed(artefact < 30_000 and header < 80_000),
    )
    yield (
        "ten deadlines of 10 min at 60 Hz compiled in under 2 s",
        f"{times['ten'] / 1e3:.2f} s",
        met_or_missed(times["ten"] < 2000),
    )
    yield (
        "`tltlc compile examples/metroidvania.tltl` for C, C# and GDScript in under 0.3 s of CPU time",
        f"{record['command_cpu_ms'] / 1e3:.2f} s",
        met_or_missed(record["command_cpu_ms"] < 300),
    )
    whole = sum(sizes["metroidvania"][language] for language in ("C", "C#", "GDScript"))
    yield (
        "its monitors in C, C# and GDScript under 300 KB together",
        f"{_kb(whole)} KB",
        met_or_missed(whole < 300_000),
    )


def section(store: Store) -> str:
    """Return the section on bounds; empty without measurements."""
    records = store.section(bounds.SECTION)
    compiled = records.get("compile", {})
    measured = {name: records[name] for name in NAMES if "python_steps_per_s" in records.get(name, {})}
    if "rounds" not in compiled or not measured:
        return ""
    specs = [
        (name, compiled["states"][name], f"{compiled['cpu_ms'][name]:.1f}", *map(_kb, sizes.values()))
        for name, sizes in compiled["bytes"].items()
    ]
    return f"""
## Bounds as timers

`python -m benchmarks --only {bounds.SECTION}`. *deadlines* is `keep alarm implies eventually within 5 s hidden` and
`keep hidden implies eventually within 5 s out`, *unbounded* the same without bounds, *ten* has ten such clauses of
10 minutes, and *metroidvania* is the example of this name; all at 60 Hz. Compiling is from text to artefact, in a fork
as above, the median of {compiled["rounds"]} rounds. The ratio of deadlines to unbounded is
{spread(compiled["bounded_to_unbounded"], 2)}. Sizes are in KB, with comments and the program that reads a trace.

{table(("spec", "states", "CPU ms", *next(iter(compiled["bytes"].values()))), specs)}

Monitors in millions of steps per second, on a trace of {bounds.SAMPLES:,} samples that breaks no rule: medians of
{bounds.ROUNDS} rounds for C, and of {bounds.PYTHON_ROUNDS} for Python, and in brackets the medians of the ratios of the
first, second and third row to this one. The second is compiled with `-DTLTL_NO_REGISTERS`: a game cannot read its
registers, as it cannot read those of a handwritten one. The third is compiled with `-DTLTL_VERDICT_ONLY`: its results
have only state and verdict. All are compiled with `-O2 -falign-functions=64`, and generated ones with `-DTLTL_SPARSE`:
no handwritten monitor refuses a sample with a missing bool. *timers as signals* is the same automaton whose timers are
Boolean signals: it counts nothing.
Both handwritten monitors keep a counter per clause (`benchmarks/handwritten/c/bounds`). One computes nothing but the
verdict, as Copilot and R2U2 do; the other every field of a step, with robustness and limiting atom. All verdicts were
compared with those of `tltlc.monitor` at each step of this trace and of {bounds.RANDOM_TRACES} random ones, and all
fields of the generated monitor with those of the handwritten one that has them.
RTAMT (robustness, in Python) and Reelay (Boolean, in C++ behind a Python interface, through which it gets a dictionary
per sample) get the formulas in past-time logic (`benchmarks/bounded_peers.py`). The sign of their answers was compared
with acceptance at each step of the trace and of {bounds.PEER_TRACES} random ones. RTAMT 0.4.10 judges wrongly where a
formula has equal parts with memory, so each place where a signal is read has its own threshold.

{table(("monitor", *measured), _speeds(measured))}
{_left_out(measured)}
"""


def _speeds(records: Mapping[str, Record]) -> Iterable[Sequence[str]]:
    for author, title in _TITLES.items():
        yield title, *(_c_cell(record, author) for record in records.values())
    yield "Python, generated", *(_millions(record["python_steps_per_s"]["generated"]) for record in records.values())
    for peer in ("RTAMT", "Reelay"):
        yield f"Python, {peer}", *(_peer_cell(record, peer) for record in records.values())


def _richer(record: Record, ratios_of: str, author: str) -> str:
    """Return the ratio of the monitor that offers more, in brackets; nothing if none does."""
    if ratios_of not in _RICHER:
        return ""
    richer, what = _RICHER[ratios_of]
    return f" ({record[richer][author][1]:.2f} {what})"


def _c_cell(record: Record, author: str) -> str:
    if author not in record.get("c_steps_per_s", {}):
        return "–"
    ratios = [record[of][author][1] for of in ("to", *_RICHER) if author in record.get(of, {})]
    cell = _millions(record["c_steps_per_s"][author])
    return f"{cell} ({', '.join(f'{ratio:.2f}' for ratio in ratios)})" if ratios else cell


def _peer_cell(record: Record, peer: str) -> str:
    rates = record["python_steps_per_s"]
    if peer not in rates:
        return "–"
    in_c = _to_peers(record, record["c_steps_per_s"]["generated"]) if "c_steps_per_s" in record else {}
    return f"{_millions(rates[peer])} (Python generated {rates['generated'] / rates[peer]:.1f} times as fast" + (
        f", C generated {in_c[peer]:,.0f} times)" if in_c else ")"
    )


def _to_peers(record: Record, rate: float) -> dict[str, float]:
    rates: dict[str, Any] = record["python_steps_per_s"]
    return {peer: rate / rates[peer] for peer in ("RTAMT", "Reelay") if peer in rates}


def _left_out(records: Mapping[str, Record]) -> str:
    reasons = sorted({f"{what} ({why})" for record in records.values() for what, why in record["left_out"].items()})
    return f"\nLeft out: {', '.join(reasons)}." if reasons else ""


def _kb(size: float) -> str:
    return f"{size / 1000:.1f}"


def _millions(rate: float) -> str:
    return f"{rate / 1e6:.4f}" if rate < 1e5 else f"{rate / 1e6:.2f}" if rate < 1e7 else f"{rate / 1e6:.0f}"
