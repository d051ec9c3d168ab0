"""The page on traces describes what the readers do."""

from __future__ import annotations

import io
import re
from pathlib import Path

from tests.docs.blocks import DOCS, ROOT
from tltlc.backends import targets
from tltlc.io.limits import TRACE_LINE
from tltlc.monitor.trace_rows import TraceLines, TraceTable, cell_number, read_rows
from tltlc.monitor.traces import read_trace
from tltlc.resolve.spec import Signal
from tltlc.tools.conformance import odd_traces

TEXT = (DOCS / "traces.md").read_text(encoding="utf-8")


def cells(outcome: str) -> list[str]:
    """Return the values listed for this outcome in the table."""
    rows = [row.split("|") for row in TEXT.splitlines() if row.startswith("| `")]
    row = next(row for row in rows if re.match(rf"{re.escape(outcome)}(?![.\d])", row[2].strip()))
    return re.findall(r"`([^`]+)`", row[1])


def number(cell: str) -> float | None:
    trace = read_rows(TraceLines(io.BytesIO(f"x\n{cell}\n".encode()), "trace"))
    assert isinstance(trace, TraceTable)
    ((cell_text,),) = trace.rows
    return cell_number(cell_text)


def test_the_values_are_read_as_documented() -> None:
    for outcome, value in (("5", 5.0), ("0.5", 0.5), ("1", 1.0), ("0", 0.0)):
        values = cells(outcome)
        assert [number(cell) for cell in values] == [value] * len(values), outcome
    assert all(str(number(cell)) in ("inf", "-inf", "nan") for cell in cells("not finite"))
    assert all(number(cell) is None for cell in cells("an error"))


def test_both_examples_on_the_page_are_the_same_trace() -> None:
    signals = [Signal(f"distance({name})", "length", 0.0, None) for name in ("key", "door")]
    signals.append(Signal("seen", "bool", 0.0, 1.0))
    examples = re.findall(r"```text\n(.*?)```", TEXT, re.DOTALL)
    first, second = ([*read_trace(io.BytesIO(text.encode()), "trace", signals)] for text in examples)
    assert len(first) == 2
    assert first == second


def test_the_limits_are_those_of_the_readers() -> None:
    assert f"at most {TRACE_LINE.size:,} bytes" in TEXT
    assert f"nest at most {TRACE_LINE.depth} deep" in TEXT
    assert f"fewer than {TRACE_LINE.values:,} commas" in TEXT
    templates = ROOT / "tltlc" / "backends" / "templates"
    for name in (
        "monitor.h",
        "monitor_program.cs",
        "monitor.lua",
        "monitor.mjs",
        "monitor.rs",
        "monitor.py",
        "monitor_main.gd",
    ):
        text = Path(templates / f"{name}.txt").read_text(encoding="utf-8")
        assert re.search(rf"(?i)row_?bytes_?(: \w+)? = {TRACE_LINE.size}\b", text), name


def test_the_languages_and_the_cases_are_named() -> None:
    monitors = {"c", "csharp", "gdscript", "gdscript3", "javascript", "lua", "rust", "python"}
    assert monitors <= set(targets())
    assert all(f"`{name}`" in TEXT for name in (*monitors, *odd_traces.CASES))
