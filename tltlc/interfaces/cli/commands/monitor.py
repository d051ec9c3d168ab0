"""``tltlc monitor``: print a row for each step of a trace while reading it, and then the verdict."""

from __future__ import annotations

import csv
import io
import json
import sys
from collections.abc import Iterable, Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, BinaryIO, Literal, TextIO

import click

from tltlc.diagnostics.diagnostic import Diagnostic, TltlError
from tltlc.interfaces.cli import exits
from tltlc.interfaces.cli.inputs import open_input
from tltlc.interfaces.cli.numbers import WholeRange
from tltlc.interfaces.cli.report import Report
from tltlc.interfaces.cli.settings import CompileSettings, source_options
from tltlc.io.spec_file import ARTEFACT_ENDING, STDIN, STDIN_NAME, input_error, input_kind, split, standard_input

if TYPE_CHECKING:
    from tltlc.interfaces.cli.trace_failure import TraceFailure
    from tltlc.monitor.monitor import Monitor
    from tltlc.monitor.run import RunStep, TraceOutcome
    from tltlc.monitor.trace_rows import Stream
    from tltlc.resolve.spec import Signal


Output = Literal["json", "csv", "table"]


@click.command(
    epilog="""\b
Examples:
  tltlc monitor leave.tltl run.csv
  tltlc monitor levels.tltl:level_1 run.jsonl --json
  my_game --log | tltlc monitor level_1.tltl -       while the game runs
  tltlc monitor level_1.tltl traces/ more/*.csv      a line for each trace, and a summary
"""
)
@click.argument("spec", metavar="SPEC[:NAME]")
@click.argument("traces", metavar="TRACE...", nargs=-1, required=True)
@click.option("--json", "as_json", is_flag=True, help="Print one JSON document.")
@click.option(
    "--table/--csv",
    "as_table",
    default=None,
    help="Print the steps as a table with three digits (default on a terminal), or as CSV with all digits (default in"
    " files and pipes).",
)
@click.option("--summary", is_flag=True, help="Print a line for each trace and a summary, even for a single trace.")
@click.option(
    "--episodes",
    is_flag=True,
    help="Judge each trace as an episode, which ends at the goal, at a violation or at the limit. Implies --summary.",
)
@click.option(
    "--sparse",
    is_flag=True,
    help="Count a bool that a sample does not have as false: for traces that have only the events that happened.",
)
@click.option(
    "--workers",
    metavar="N",
    type=WholeRange(1, 1000),
    help="Judge the traces in this many processes (default: one for each core, and one for few traces).",
)
@source_options
def command(
    spec: str,
    traces: tuple[str, ...],
    as_json: bool,
    as_table: bool | None,
    summary: bool,
    episodes: bool,
    sparse: bool,
    workers: int | None,
    settings: CompileSettings,
    format: str,  # noqa: A002
) -> int:
    """Judge recorded traces by a spec. A TRACE is CSV with a header of signal names, JSON lines, Parquet, or a tape.

    For one file, the output has one row per step (state, verdict, progress, reward, value of each atom) and the
    verdict of the whole trace; beside CSV, the verdict goes to standard error. If the trace ends too early, the
    output names the clauses that are not met, and what they look at. If it fails, the verdict says at which step,
    which clause it breaks there, which atoms decide it, and which clauses it breaks later. For several files or a
    folder, the output has one line per trace, and a summary that says which clauses the failed traces break or
    leave undone. In a folder, files that end in .csv, .jsonl, .tape.jsonl.gz or .parquet are traces; a tape beside
    a trace with the same name is the same play, and is left out. A spec over infinite traces accepts a trace that
    ends in a goal state. The exit status is 0 if all traces are accepted, and 1 otherwise.
    """
    from tltlc.io.files import is_dir

    if split(spec)[0] == STDIN and STDIN in traces:
        raise click.UsageError("SPEC and TRACE cannot both be standard input", click.get_current_context())
    for trace in traces:
        if trace.endswith((".tltl", ARTEFACT_ENDING)):
            message = f"`{trace}` is a spec, not a trace: `tltlc monitor` takes one spec"
            raise click.UsageError(message, click.get_current_context())
    if len(traces) == 1 and not (summary or episodes) and (traces[0] == STDIN or not is_dir(traces[0])):
        as_table = sys.stdout.isatty() if as_table is None else as_table
        output: Output = "json" if as_json else "table" if as_table else "csv"
        return _judge_steps(spec, traces[0], settings, format, output, sparse=sparse)
    if STDIN in traces:
        raise click.UsageError("a summary needs traces in files, not standard input", click.get_current_context())
    from tltlc.interfaces.cli.judged_traces import JudgeOptions, judge_traces

    return judge_traces(spec, traces, JudgeOptions(workers, episodes, sparse, as_json), settings, format)


def _judge_steps(
    spec: str,
    trace: str,
    settings: CompileSettings,
    format: str,  # noqa: A002
    output: Output,
    *,
    sparse: bool,
) -> int:
    """Judge one trace, and print a row for each step while reading it; return the exit status."""
    from tltlc.interfaces.cli.trace_failure import TraceFailure
    from tltlc.monitor import Monitor
    from tltlc.monitor.long_steps import LongSteps, shortest_time
    from tltlc.monitor.run import outcome, run
    from tltlc.monitor.traces import read_trace

    result: TraceOutcome | None = None
    with Report(format, results=True) as report:
        spec_input = open_input(spec, settings)
        report.add(spec_input.diagnostics)
        fspa = spec_input.only_automaton()
        monitor, steps = Monitor(fspa), LongSteps(shortest_time(fspa))
        with _open_trace(trace) as lines:
            samples = read_trace(
                _as_text(lines, trace, fspa.signals),
                _trace_name(trace),
                fspa.signals,
                fspa.clock_s,
                input_kind(trace),
                clock_varies=fspa.clock_varies,
                sparse=sparse,
            )
            failure = TraceFailure(monitor, spec_input)
            rows = run(monitor, failure.watched(steps.watched(samples)))
            show = {"json": _show_json, "csv": _show_csv, "table": _show_table}[output]
            try:
                result = outcome(show(monitor, failure.noted(_with_notices(rows, monitor.notices, report))))
            except TltlError:
                if output == "json":
                    _break_json(failure)
                else:
                    _print_lines(failure.lines("before the error"), _judgement_stream(output))
                raise
        if output == "json":
            _end_json(result, failure)
        else:
            _print_lines(_judgement(result, monitor, failure), _judgement_stream(output))
        report.add(steps.warnings())
        if result and fspa.limit_steps is not None and result.steps > fspa.limit_steps:
            from tltlc.interfaces.cli.judged_traces import limit_note

            report.say(limit_note([_trace_name(trace)], fspa.limit_steps))
    return report.status or (exits.CLEAN if result and result.accepted else exits.FINDINGS)


@contextmanager
def _open_trace(trace: str) -> Iterator[_OpenTrace]:
    """Open a trace for reading within the context; raise TLT0001 if opening or reading fails."""
    if trace == STDIN:
        yield _OpenTrace(standard_input(), STDIN_NAME)
        return
    try:
        file = Path(trace).open("rb")  # noqa: SIM115 (closed below; only the opening may fail with TLT0001)
    except (OSError, ValueError) as error:
        raise input_error(trace, error) from None
    with file:
        yield _OpenTrace(file, trace)


def _as_text(lines: _OpenTrace, trace: str, signals: Sequence[Signal]) -> Stream:
    """Return a trace as a stream of text lines; a trace in Parquet or gzip is read at once and converted."""
    from tltlc.monitor.packed import is_packed
    from tltlc.monitor.parquet import as_text, is_parquet

    start = lines.start()
    needs_all = is_parquet(start, trace) or is_packed(start)
    return io.BytesIO(as_text(lines.read(), trace, signals)) if needs_all else lines


class _OpenTrace:
    """A trace file, open for reading; its methods raise TLT0001 if reading fails."""

    def __init__(self, file: BinaryIO, name: str) -> None:
        self._file, self._name = file, name

    def start(self) -> bytes:
        """Return the first bytes without consuming them; ``b""`` for a stream that cannot look ahead."""
        try:
            return self._file.peek(5) if isinstance(self._file, io.BufferedReader) else b""
        except OSError as error:
            raise input_error(self._name, error) from None

    def read(self) -> bytes:
        """Return all bytes of the file."""
        try:
            return self._file.read()
        except OSError as error:
            raise input_error(self._name, error) from None

    def readline(self, size: int = -1, /) -> bytes:
        """Return the next line, or at most ``size`` bytes of it; ``b""`` at the end of the file."""
        try:
            return self._file.readline(size)
        except OSError as error:
            raise input_error(self._name, error) from None


def _trace_name(trace: str) -> str:
    return STDIN_NAME if trace == STDIN else trace


def _with_notices(rows: Iterator[RunStep], notices: list[Diagnostic], report: Report) -> Iterator[RunStep]:
    """Yield the rows unchanged. Before each row, report the monitor's notices about it, and clear ``notices``."""
    for row in rows:
        report.add(notices)
        notices.clear()
        yield row


def _show_csv(monitor: Monitor, rows: Iterator[RunStep]) -> Iterator[RunStep]:
    from tltlc.monitor.run import cells, header

    write = csv.writer(sys.stdout, lineterminator="\n").writerow
    write(header(monitor.fspa))
    for row in rows:
        write(cells(row))
        sys.stdout.flush()
        yield row


def _show_table(monitor: Monitor, rows: Iterator[RunStep]) -> Iterator[RunStep]:
    from shutil import get_terminal_size

    from tltlc.interfaces.cli.step_table import StepTable

    table = StepTable(monitor.fspa, get_terminal_size().columns)
    _print_lines(table.head())
    for row in rows:
        cause = monitor.failure.cause if monitor.failure else None
        atoms = (cause.atom, *(atom for atom, _ in cause.prime)) if cause and cause.atom is not None else ()
        _print_lines(table.rows(row, atoms))
        yield row
    if table.left_out:
        more = "1 more atom does" if table.left_out == 1 else f"{table.left_out} more atoms do"
        print(f"{more} not fit beside these: `--csv` shows all")


def _judgement_stream(output: Output) -> TextIO:
    """Return where the judgement goes: beside a table, or away from CSV, which other programs read."""
    return sys.stderr if output == "csv" else sys.stdout


def _print_lines(lines: Iterable[str], stream: TextIO | None = None) -> None:
    from tltlc.diagnostics.formats.text import replace_unprintable

    for line in lines:
        print(replace_unprintable(line), file=stream or sys.stdout, flush=True)


def _judgement(result: TraceOutcome, monitor: Monitor, failure: TraceFailure) -> Iterator[str]:
    """Yield the lines with the verdict of the trace; if it is not accepted, also why, and what remains."""
    from tltlc.automaton.text import label_text
    from tltlc.monitor.failure_words import shortened

    if monitor.failure is not None:
        yield from failure.lines("not accepted", result.steps)
        return
    if not result.accepted:
        yield from failure.open_lines()
        yield f"what remains: {shortened(label_text(monitor.fspa, monitor.state))}"
    steps = f"{result.steps} step{'' if result.steps == 1 else 's'}"
    yield f"{'accepted' if result.accepted else 'not accepted'}: {result.verdict} after {steps}"


def _show_json(monitor: Monitor, rows: Iterator[RunStep]) -> Iterator[RunStep]:
    from tltlc.tools.judge.json_values import step_values

    fspa = monitor.fspa
    print(json.dumps({"spec": fspa.name})[:-1] + ', "rows": [', flush=True)
    between = ""
    for row in rows:
        sys.stdout.write(between + json.dumps(step_values(fspa, row)))
        sys.stdout.flush()
        between = ",\n"
        yield row


def _break_json(failure: TraceFailure) -> None:
    """Complete the JSON document after an error: it says that there is no verdict, and what had failed before."""
    end = {"accepted": None, "verdict": None, "failure": failure.values()}
    print("\n], " + json.dumps(end)[1:], flush=True)


def _end_json(result: TraceOutcome, failure: TraceFailure) -> None:
    from tltlc.tools.judge.json_values import outcome_values

    print("\n], " + json.dumps({**outcome_values(result), "failure": failure.values()})[1:])
