"""The section of RESULTS.md on monitors in the languages of game engines."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from typing import Any, Final

from benchmarks import engine_speed, monitors
from benchmarks.engines.engine import engines
from benchmarks.markdown import met_or_missed, table
from benchmarks.specs import PAPER_SPECS
from benchmarks.store import Record, Store

FACTOR: Final = 0.9


def goals(store: Store) -> Iterable[Sequence[str]]:
    """Yield the row of the table of goals, if anything was measured."""
    ratios = {
        name: record["generated_to_by_hand"][1]
        for name, record in store.section(engine_speed.SECTION).items()
        if "generated_to_by_hand" in record
    }
    if not ratios:
        return
    low = [f"{name} {ratio:.2f}" for name, ratio in ratios.items() if ratio < FACTOR]
    yield (
        f"generated monitors for engines at least {FACTOR:g} of the speed of ones written by hand in the same language",
        f"least {min(ratios.values()):.2f}" + (f"; under {FACTOR:g}: {', '.join(low)}" if low else ""),
        met_or_missed(not low),
    )


def section(store: Store) -> str:
    """Return the section on monitors in the languages of engines; empty without measurements."""
    records = store.section(engine_speed.SECTION)
    languages = {engine.name: engine.title for engine in engines()}
    speeds = [(_title(name, title, records), *_speeds(name, records)) for name, title in languages.items()]
    if all(cell == "–" for _, *cells in speeds for cell in cells):
        return ""
    python = store.section(monitors.SECTION)
    speeds += [(f"Python, {author}", *_python(author, python)) for author in ("generated", "RTAMT", "Reelay")]
    sizes = [row for name, title in languages.items() for row in _sizes(name, title, records)]
    return f"""
## Monitors for engines, steps per second

`python -m benchmarks --only {engine_speed.SECTION}` compares the monitors that `tltlc compile -t` writes for engines
with handwritten ones in the same language (`benchmarks/handwritten/LANGUAGE`). A good programmer would write those
for the same interface: they compute every field of a step, and refuse numbers that are missing or not finite, and
exclusive atoms that hold at once. Generated monitors also refuse bools that are missing, but not in C and C++, where
they are compiled with `-DTLTL_SPARSE`. They compute only the predicates that their state needs, and give no notices of
clamped values. One driver steps both over the recorded trace of the spec, in {monitors.ROUNDS} rounds. C, C++, C# and
Rust are compiled with optimisation, and no compiler sees the trace. Before that, each field of each step was
compared. A cell has the millions of steps per second of the generated monitor (CPU time), and in brackets the median
of the ratios, generated to handwritten. GDScript is that of Godot 3, because Godot 4 does not run here; the monitor
for Godot 4 differs in a few lines.

{table(("language", *PAPER_SPECS), speeds)}

Python's figures are those of the section above. RTAMT and Reelay compute less, as explained there. They are not
measured in C++: RTAMT's package has no C++ library, and Reelay's sources build only if CMake can download Boost.

Sizes in KB, for {", ".join(PAPER_SPECS)}: the generated file, with the program at its end that reads a trace; the
same without lines that contain only a comment; and the compiled size of what a game uses (begin, step and the message
for an invalid sample), generated and handwritten. The compiled size is that of code and constants of an object file in
C, C++ and Rust, of a library in C#, and of stripped bytecode, with the program, in Lua.

{table(("language", "file", "without comments", "compiled by", "generated", "by hand"), sizes)}
{_left_out(records)}
"""


def _title(name: str, title: str, records: Mapping[str, Record]) -> str:
    versions = {record["version"] for record in _records_of(name, records) if "version" in record}
    return " ".join([title, *sorted(versions)])


def _speeds(name: str, records: Mapping[str, Record]) -> list[str]:
    return [
        f"{_millions(record['steps_per_s']['generated'])} ({record['generated_to_by_hand'][1]:.2f})"
        if "steps_per_s" in record
        else "–"
        for record in _records_of(name, records)
    ]


def _python(author: str, records: Mapping[str, Record]) -> list[str]:
    cells = []
    for spec in PAPER_SPECS:
        record = records.get(spec, {})
        rate = record.get("steps_per_s", {}).get(author)
        ratio = f" ({record['generated_to_hand_written'][1]:.2f})" if author == "generated" and rate else ""
        cells.append("–" if rate is None else f"{_millions(rate)}{ratio}")
    return cells


def _sizes(name: str, title: str, records: Mapping[str, Record]) -> list[tuple[str, ...]]:
    """Return a row for each kind of compiled output, or one row if nothing is compiled."""
    measured = [record for record in _records_of(name, records) if "bytes" in record]
    if len(measured) < len(PAPER_SPECS):
        return []
    file = [_kilobytes(measured, "bytes", kind) for kind in ("file", "without comments")]
    kinds = measured[0]["compiled"].get("generated", {})
    if not kinds:
        return [(title, *file, "–", "–", "–")]
    return [
        (title, *file, kind, *(_kilobytes(measured, "compiled", author, kind) for author in ("generated", "by_hand")))
        for kind in kinds
    ]


def _kilobytes(records: Iterable[Record], *path: str) -> str:
    sizes: list[float] = []
    for record in records:
        value: Any = record
        for key in path:
            value = value[key]
        sizes.append(value / 1000)
    return " / ".join(f"{size:.1f}" for size in sizes)


def _left_out(records: Mapping[str, Record]) -> str:
    reasons = sorted({record["left_out"] for record in records.values() if "left_out" in record})
    failed = [f"{name} ({record['failed']})" for name, record in records.items() if "failed" in record]
    texts = [f"Left out: {'; '.join(reasons)}."] if reasons else []
    texts += [f"Failed: {', '.join(failed)}."] if failed else []
    return "\n" + " ".join(texts) if texts else ""


def _records_of(name: str, records: Mapping[str, Record]) -> list[Record]:
    return [records.get(f"{name} {spec}", {}) for spec in PAPER_SPECS]


def _millions(rate: float) -> str:
    return f"{rate / 1e6:.2f}" if rate < 1e7 else f"{rate / 1e6:.0f}"
