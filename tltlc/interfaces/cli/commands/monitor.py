"""``tltlc monitor``: print a row per step as it happens, and the verdict of the whole trace."""

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
@click.option("--json", "as_json", is_flag=True, help="One JSON document: `rows`, then `accepted` and `verdict`.")
@source_options
def command(spec: str, trace: str, as_json: bool, settings: CompileSettings, format: str) -> int:  # noqa: A002
    """Run a spec over a recorded trace: CSV with a header of signal names, or JSON lines of objects.

    Prints a row per step (state, verdict, progress, reward, the value of each atom) and the verdict of
    the whole trace.  The exit status is 0 where the trace is accepted, and 1 where it is not.  By a spec about
    infinite traces, a trace is accepted that ends in a goal state.
    """
    from tltlc.monitor import Monitor
    from tltlc.monitor.run import outcome, run
    from tltlc.monitor.traces import read_trace

    if split(spec)[0] == trace == STDIN:
        raise click.UsageError("SPEC and TRACE cannot both be standard input", click.get_current_context())
    judged: TraceOutcome | None = None
    with Report(format, results=True) as report:
        opened = open_input(spec, settings)
        report.add(opened.diagnostics)
        fspa = opened.one()
        monitor = Monitor(fspa)
        with _opened(trace) as lines:
            rows = run(monitor, read_trace(lines, _shown(trace), fspa.signals))
            show = _show_json if as_json else _show_csv
            judged = outcome(show(fspa, _with_notices(rows, monitor.notices, report)))
        (_end_json if as_json else _end_csv)(judged)
    return report.status or (exits.CLEAN if judged and judged.accepted else exits.FINDINGS)


@contextmanager
def _opened(trace: str) -> Iterator[Stream]:
    """Open a trace to read it line by line; raise TLT0001 now, or later while it is read."""
    if trace == STDIN:
        yield _Trace(standard_input(), STDIN_NAME)
        return
    try:
        file = Path(trace).open("rb")  # noqa: SIM115 (closed below; only the opening may fail with TLT0001)
    except (OSError, ValueError) as error:
        raise input_error(trace, error) from None
    with file:
        yield _Trace(file, trace)


class _Trace:
    """A file that raises TLT0001 if reading fails."""

    def __init__(self, file: BinaryIO, name: str) -> None:
        self._file, self._name = file, name

    def readline(self, size: int = -1, /) -> bytes:
        """Return the next line, or its first ``size`` bytes; empty at the end."""
        try:
            return self._file.readline(size)
        except OSError as error:
            raise input_error(self._name, error) from None


def _shown(trace: str) -> str:
    return STDIN_NAME if trace == STDIN else trace


def _with_notices(rows: Iterator[RunStep], notices: list[Diagnostic], report: Report) -> Iterator[RunStep]:
    """Pass the rows on, and report the notices of the monitor as soon as they occur."""
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


def _end_csv(judged: TraceOutcome) -> None:
    accepted = "accepted" if judged.accepted else "not accepted"
    print(f"{accepted}: {judged.verdict} after {judged.steps} step{'' if judged.steps == 1 else 's'}")


def _show_json(fspa: Fspa, rows: Iterator[RunStep]) -> Iterator[RunStep]:
    names = [atom.name for atom in fspa.atoms]
    print(json.dumps({"spec": fspa.name})[:-1] + ', "rows": [', flush=True)
    between = ""
    try:
        for row in rows:
            step = row.step
            shown = {
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
            sys.stdout.write(between + json.dumps(shown))
            sys.stdout.flush()
            between = ",\n"
            yield row
    except TltlError:
        # Complete the JSON document anyway; it says that there is no verdict.
        print('\n], "accepted": null, "verdict": null}', flush=True)
        raise


def _end_json(judged: TraceOutcome) -> None:
    end = {
        "accepted": judged.accepted,
        "verdict": judged.verdict,
        "steps": judged.steps,
        "progress": judged.progress,
        "reward": judged.total_reward,
    }
    print("\n], " + json.dumps(end)[1:])
