"""``tltlc monitor``: print a row for each step of a trace, as it is read, and then the verdict."""

from __future__ import annotations

import csv
import json
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, BinaryIO

import click

from tltlc.diagnostics.diagnostic import Diagnostic, TltlError
from tltlc.interfaces.cli import exits
from tltlc.interfaces.cli.inputs import open_input
from tltlc.interfaces.cli.report import Report
from tltlc.interfaces.cli.settings import CompileSettings, source_options
from tltlc.io.spec_file import STDIN, STDIN_NAME, input_error, split, standard_input

if TYPE_CHECKING:
    from tltlc.automaton.fspa import Fspa
    from tltlc.monitor.run import RunStep, TraceOutcome
    from tltlc.monitor.trace_rows import Stream


@click.command(
    epilog="""\b
Examples:
  tltlc monitor cover_and_hide.tltl run.csv
  tltlc monitor levels.tltl:level_1 run.jsonl --json
  my_game --log | tltlc monitor level_1.tltl -       while the game runs
"""
)
@click.argument("spec", metavar="SPEC[:NAME]")
@click.argument("trace", metavar="TRACE")
@click.option("--json", "as_json", is_flag=True, help="Print one JSON document with `rows`, `accepted` and `verdict`.")
@source_options
def command(spec: str, trace: str, as_json: bool, settings: CompileSettings, format: str) -> int:  # noqa: A002
    """Judge a recorded trace by a spec. TRACE is CSV with a header of signal names, or JSON lines with objects.

    The output has one row per step (state, verdict, progress, reward, value of each atom) and the verdict of the whole
    trace. The exit status is 0 if the trace is accepted, and 1 otherwise. A spec over infinite traces accepts a trace
    that ends in a goal state.
    """
    from tltlc.monitor import Monitor
    from tltlc.monitor.run import outcome, run
    from tltlc.monitor.traces import read_trace

    if split(spec)[0] == trace == STDIN:
        raise click.UsageError("SPEC and TRACE cannot both be standard input", click.get_current_context())
    result: TraceOutcome | None = None
    with Report(format, results=True) as report:
        spec_input = open_input(spec, settings)
        report.add(spec_input.diagnostics)
        fspa = spec_input.only_automaton()
        monitor = Monitor(fspa)
        with _open_trace(trace) as lines:
            rows = run(monitor, read_trace(lines, _trace_name(trace), fspa.signals))
            show = _show_json if as_json else _show_csv
            result = outcome(show(fspa, _with_notices(rows, monitor.notices, report)))
        (_end_json if as_json else _end_csv)(result)
    return report.status or (exits.CLEAN if result and result.accepted else exits.FINDINGS)


@contextmanager
def _open_trace(trace: str) -> Iterator[Stream]:
    """Open a trace to read it line by line; opening and reading raise TLT0001 if they fail."""
    if trace == STDIN:
        yield _OpenTrace(standard_input(), STDIN_NAME)
        return
    try:
        file = Path(trace).open("rb")  # noqa: SIM115 (closed below; only the opening may fail with TLT0001)
    except (OSError, ValueError) as error:
        raise input_error(trace, error) from None
    with file:
        yield _OpenTrace(file, trace)


class _OpenTrace:
    """A file that raises TLT0001 if reading fails."""

    def __init__(self, file: BinaryIO, name: str) -> None:
        self._file, self._name = file, name

    def readline(self, size: int = -1, /) -> bytes:
        """Return the next line, or its first ``size`` bytes; empty at the end."""
        try:
            return self._file.readline(size)
        except OSError as error:
            raise input_error(self._name, error) from None


def _trace_name(trace: str) -> str:
    return STDIN_NAME if trace == STDIN else trace


def _with_notices(rows: Iterator[RunStep], notices: list[Diagnostic], report: Report) -> Iterator[RunStep]:
    """Yield the rows unchanged. Before each row, report the monitor's notices about it."""
    for row in rows:
        report.add(notices)
        notices.clear()
        yield row


def _show_csv(fspa: Fspa, rows: Iterator[RunStep]) -> Iterator[RunStep]:
    from tltlc.monitor.run import cells, header

    write = csv.writer(sys.stdout, lineterminator="\n").writerow
    write(header(fspa))
    for row in rows:
        write(cells(row))
        sys.stdout.flush()
        yield row


def _end_csv(result: TraceOutcome) -> None:
    accepted = "accepted" if result.accepted else "not accepted"
    print(f"{accepted}: {result.verdict} after {result.steps} step{'' if result.steps == 1 else 's'}")


def _show_json(fspa: Fspa, rows: Iterator[RunStep]) -> Iterator[RunStep]:
    names = [atom.name for atom in fspa.atoms]
    print(json.dumps({"spec": fspa.name})[:-1] + ', "rows": [', flush=True)
    between = ""
    try:
        for row in rows:
            step = row.step
            row_values = {
                "step": row.number,
                "state": step.state,
                "label": step.label,
                "verdict": step.verdict,
                "accepting": step.accepting,
                "done": step.done,
                "progress": step.progress,
                "reward": step.reward,
                "atoms": dict(zip(names, row.values, strict=True)),
            }
            sys.stdout.write(between + json.dumps(row_values))
            sys.stdout.flush()
            between = ",\n"
            yield row
    except TltlError:
        # Complete the JSON document even after an error. It then says that there is no verdict.
        print('\n], "accepted": null, "verdict": null}', flush=True)
        raise


def _end_json(result: TraceOutcome) -> None:
    end = {
        "accepted": result.accepted,
        "verdict": result.verdict,
        "steps": result.steps,
        "progress": result.progress,
        "reward": result.total_reward,
    }
    print("\n], " + json.dumps(end)[1:])
