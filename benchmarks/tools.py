"""Measure the tools: whole commands as multiples of ``compile``, and a keystroke in an editor."""

from __future__ import annotations

import os
import tempfile
import time
from collections.abc import Callable, Iterable, Mapping, Sequence
from functools import partial
from importlib.util import find_spec
from pathlib import Path
from typing import Any, Final

from benchmarks.markdown import met_or_missed, spread, table
from benchmarks.measure import cpu_times_ms, median, quartiles, run
from benchmarks.process import TIMEOUT_S, TLTLC, with_bytecode
from benchmarks.specs import PAPER_SPECS, source
from benchmarks.store import ROOT, Record, Store, measure_missing, source_digest

SECTION = "tools"
ROUNDS: Final = 15
KEYSTROKES: Final = 25
PAUSE_S: Final = 0.2
"""Seconds between two keystrokes."""
FACTORS: Final[Mapping[str, float]] = {"lint": 3.0, "explain": 3.0}
"""A command may take this many times as long as ``compile``."""
KEYSTROKE_MS: Final = 100.0
_KEYSTROKE: Final = "a keystroke"
_QUIET_S: Final = 2.0


def measure(store: Store, _: float, say: Callable[[str], None]) -> None:
    """Measure the commands on the paper's specs, and the language server, unless the store has records of this code."""
    code = {"source": source_digest("tltlc")}
    measure_missing(
        store, SECTION, PAPER_SPECS, lambda name: {**_commands(name), **code}, say, field="ratio", current=code
    )
    if find_spec("pygls") is None:
        say(f"{SECTION}: the language server is left out, since pygls is not installed (the extra `lsp`)")
        return
    measure_missing(
        store, SECTION, [_KEYSTROKE], lambda _: {**_keystrokes(), **code}, say, field="server_ms", current=code
    )


def _commands(name: str) -> Record:
    """Return the CPU time of each command, and its ratio to that of ``compile`` in the same round."""
    path = str(source(name))
    with tempfile.TemporaryDirectory() as folder:
        lines: dict[str, Sequence[str]] = {
            "compile": ("compile", path, "-o", folder),
            "lint": ("lint", path),
            "explain": ("explain", path),
            "fmt": ("fmt", "--check", path),
            "diff": ("diff", path, path),
            "witness": ("witness", f"{path}:{name}"),
        }
        environment = with_bytecode(Path(folder))
        times: dict[str, list[float]] = {command: [] for command in lines}
        # The first round compiles modules and warms the file system's cache; it does not count.
        for number in range(ROUNDS + 1):
            for command, arguments in lines.items():
                process_run = run([*TLTLC, *arguments], TIMEOUT_S, cwd=ROOT, environment=environment)
                if process_run.status != 0:
                    return {"failed": f"{command}: exit status {process_run.status}"}
                times[command] += [process_run.cpu_ms] if number else []
    compile_times = times.pop("compile")
    return {
        "rounds": ROUNDS,
        "compile_ms": median(compile_times),
        "cpu_ms": {command: median(command_times) for command, command_times in times.items()},
        "ratio": {
            command: quartiles([ours / theirs for ours, theirs in zip(command_times, compile_times, strict=True)])
            for command, command_times in times.items()
        },
    }


def _keystrokes() -> Record:
    """Return the wall time from a change to the answer of a language server, and the CPU time of a bare parse."""
    from tests.interfaces.lsp.client import Client
    from tests.interfaces.lsp.test_speed import TEXT
    from tltlc.core.source import SourceFile
    from tltlc.grammar.parser import parse

    with tempfile.TemporaryDirectory() as folder:
        client = Client()
        try:
            uri = client.open(Path(folder, "many.tltl"), TEXT)
            while not client.is_quiet(_QUIET_S):
                pass
            times: list[float] = []
            start_ms = _cpu_ms(client.process.pid)
            for version in range(2, KEYSTROKES + 2):
                time.sleep(PAUSE_S)
                wrong = f"neer{version}"
                start = time.perf_counter()
                client.change(uri, f"{TEXT}spec wrong = {wrong}\n", version)
                client.diagnostics(uri, partial(_names_word, wrong))
                times.append((time.perf_counter() - start) * 1e3)
            spent_ms = (_cpu_ms(client.process.pid) - start_ms) / KEYSTROKES
        finally:
            client.kill()
    parses = cpu_times_ms(lambda: parse(SourceFile("many.tltl", TEXT)), runs=KEYSTROKES, enough_s=60.0)
    return {
        "lines": TEXT.count("\n"),
        "keystrokes": KEYSTROKES,
        "answer_ms": quartiles(times),
        "server_ms": spent_ms,
        "parse_ms": quartiles(parses),
    }


def _cpu_ms(process: int) -> float:
    """Return the CPU time of a process so far, in milliseconds."""
    fields = Path(f"/proc/{process}/stat").read_text(encoding="ascii").rpartition(")")[2].split()
    return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK") * 1e3


def _names_word(wrong: str, diagnostics: Iterable[Mapping[str, Any]]) -> bool:
    return any(wrong in diagnostic["message"] for diagnostic in diagnostics)


def goals(records: Mapping[str, Record]) -> Iterable[Sequence[str]]:
    """Yield the rows of the table of goals for what was measured."""
    measured = _specs(records)
    for command, factor in FACTORS.items() if len(measured) == len(PAPER_SPECS) else ():
        worst = max(record["ratio"][command][1] for record in measured.values())
        figure = ", ".join(f"{record['ratio'][command][1]:.1f} on {name}" for name, record in measured.items())
        yield (
            f"`tltlc {command}` under {factor:g} times `tltlc compile` of the same file",
            figure,
            met_or_missed(worst < factor),
        )
    record = records.get(_KEYSTROKE, {})
    if "server_ms" in record:
        middle = record["answer_ms"][1]
        goal = f"a keystroke in {record['lines']} lines answered by the language server in under {KEYSTROKE_MS:g} ms"
        figure = f"{middle:.0f} ms; of CPU time {record['server_ms']:.0f}, a bare parse {record['parse_ms'][1]:.0f}"
        yield goal, figure, met_or_missed(middle < KEYSTROKE_MS)


def section(records: Mapping[str, Record]) -> str:
    """Return the section on tools; empty without measurements."""
    measured = _specs(records)
    if not measured:
        return ""
    commands = list(next(iter(measured.values()))["ratio"])
    body = [
        (name, f"{record['compile_ms']:.0f}", *(spread(record["ratio"][command]) for command in commands))
        for name, record in measured.items()
    ]
    return f"""
## The language's tools

CPU time of whole processes, as a multiple of the time of `tltlc compile` of the same file (which writes three files) in
the same round: the median of {ROUNDS} rounds, and the quartiles in brackets. `diff` compares the file with itself,
which takes the work for both directions; `fmt` is `fmt --check`.

{table(("spec", "compile, ms", *commands), body)}
{_editor(records.get(_KEYSTROKE, {}))}"""


def _editor(record: Mapping[str, Any]) -> str:
    if "server_ms" not in record:
        return ""
    return f"""
A keystroke: {spread(record["answer_ms"], 0)} ms of wall time from a change of a file of {record["lines"]} lines to the
resulting diagnostics of a `tltlc lsp` that has built all automata before ({record["keystrokes"]} changes, one every
{PAUSE_S:g} s). CPU time of the server for each: {record["server_ms"]:.0f} ms; of a bare parse of that file:
{spread(record["parse_ms"], 0)} ms.
"""


def _specs(records: Mapping[str, Record]) -> dict[str, Record]:
    return {name: records[name] for name in PAPER_SPECS if "ratio" in records.get(name, {})}
