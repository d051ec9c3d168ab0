"""Judge many traces, and print a line for each of them and a summary: ``tltlc monitor SPEC TRACES…``."""

from __future__ import annotations

import json
import sys
from collections.abc import Iterable, Iterator, Sequence
from contextlib import closing
from typing import Final

import click

from tltlc.core.record import record, replace
from tltlc.diagnostics.diagnostic import Diagnostic, TltlError
from tltlc.diagnostics.formats.text import replace_unprintable
from tltlc.interfaces.cli import exits
from tltlc.interfaces.cli.inputs import open_input
from tltlc.interfaces.cli.report import Report
from tltlc.interfaces.cli.settings import CompileSettings
from tltlc.monitor import long_steps
from tltlc.tools.judge.json_values import summary_values, trace_values
from tltlc.tools.judge.pool import judge_files
from tltlc.tools.judge.summary import summary_text, trace_text
from tltlc.tools.judge.trace_files import find_traces
from tltlc.tools.judge.verdict import JudgedTrace

_MOST_NAMED: Final = 3
"""Notes about files name at most this many. Further ones are counted."""


@record
class JudgeOptions:
    """The options of ``tltlc monitor`` for many traces.

    ``workers`` is the number of processes; None for the default. ``episodes`` says whether a trace
    is judged only up to the goal, a violation or the limit (``--episodes``). ``sparse`` says whether a
    missing bool counts as false (``--sparse``). ``as_json`` says whether to print a JSON document (``--json``).
    """

    workers: int | None
    episodes: bool
    sparse: bool
    as_json: bool


def judge_traces(
    spec: str,
    arguments: Sequence[str],
    options: JudgeOptions,
    settings: CompileSettings,
    format: str,  # noqa: A002
) -> int:
    """Judge traces by a spec, print the results, and return the exit status.

    ``spec`` is the first argument of ``tltlc monitor``, and ``arguments`` are files and folders with
    traces. ``format`` is the format of errors and warnings.
    """
    traces: list[JudgedTrace] = []
    with Report(format, results=True) as report:
        spec_input = open_input(spec, settings)
        report.add(spec_input.diagnostics)
        fspa = spec_input.only_automaton()
        files = find_traces(arguments)
        report.add(files.errors)
        if files.others:
            report.say(_others_text(files.others))
        judged = judge_files(
            fspa,
            spec_input.clauses(),
            files.traces,
            options.workers,
            episodes=options.episodes,
            sparse=options.sparse,
        )
        show = _show_json if options.as_json else _show_lines
        try:
            with closing(judged):
                # This keeps the traces before an error.
                traces.extend(show(fspa.name, _with_progress(judged, len(files.traces))))
        except TltlError as error:
            report.add(error.diagnostics)
        # Lines of traces and messages about them would be hard to read in turns.
        for trace in traces:
            report.add(diagnostic for diagnostic in trace.diagnostics if diagnostic.code != long_steps.CODE)
        report.add(_long_steps(traces))
        if options.as_json:
            _end_json(traces, len(files.traces), files.others)
        else:
            missing = len(files.traces) - len(traces)
            print(summary_text(traces) + (f"; {missing} not judged" if missing else ""))
            if not options.episodes and (note := _limit_note(traces, fspa.limit_steps)):
                report.say(note)
        accepted = [trace.verdict is not None and trace.verdict.outcome.accepted for trace in traces]
        return report.status or (exits.CLEAN if all(accepted) else exits.FINDINGS)
    return report.status


def _others_text(others: Sequence[str]) -> str:
    rest = f" and {len(others) - _MOST_NAMED} more" if len(others) > _MOST_NAMED else ""
    return replace_unprintable(f"not traces, by their names: {', '.join(others[:_MOST_NAMED])}{rest}")


def _long_steps(traces: Iterable[JudgedTrace]) -> tuple[Diagnostic, ...]:
    """Return the warning about the steps of the first trace that has one, with the number of other such traces."""
    warnings = [item for trace in traces for item in trace.diagnostics if item.code == long_steps.CODE]
    if len(warnings) < 2:
        return tuple(warnings)
    others = "1 other trace is" if len(warnings) == 2 else f"{len(warnings) - 1} other traces are"
    return (replace(warnings[0], title=f"{warnings[0].title}; {others} alike"),)


def _limit_note(traces: Iterable[JudgedTrace], limit: int | None) -> str:
    """Return a note about traces that are longer than the limit of the spec; empty if there are none."""
    longer = [
        trace.name
        for trace in traces
        if limit is not None and trace.verdict is not None and trace.verdict.samples > limit
    ]
    return limit_note(longer, limit) if longer and limit is not None else ""


def limit_note(longer: Sequence[str], limit: int) -> str:
    """Return a note about the traces ``longer``, which have more steps than the limit of the spec."""
    rest = f" and {len(longer) - _MOST_NAMED} more" if len(longer) > _MOST_NAMED else ""
    names = f"{', '.join(longer[:_MOST_NAMED])}{rest}"
    is_, them = ("is", "it") if len(longer) == 1 else ("are", "them")
    note = f"{names} {is_} longer than the limit of {limit} steps and judged whole: `--episodes` ends {them} there"
    return replace_unprintable(note)


def _with_progress(judged: Iterable[JudgedTrace], total: int) -> Iterator[JudgedTrace]:
    """Yield the traces unchanged, and show a progress bar meanwhile; ``total`` is their number.

    The bar appears only if standard error is a terminal and standard output is not.
    """
    if sys.stdout.isatty() or not sys.stderr.isatty():
        yield from judged
        return
    with click.progressbar(judged, length=total, label="judging traces", file=sys.stderr) as bar:
        yield from bar


def _show_lines(_: str, judged: Iterable[JudgedTrace]) -> Iterator[JudgedTrace]:
    for trace in judged:
        print(replace_unprintable(f"{trace.name}: {trace_text(trace)}"), flush=True)
        yield trace


# --- JSON -----------------------------------------------------------------------------------------


def _show_json(spec: str, judged: Iterable[JudgedTrace]) -> Iterator[JudgedTrace]:
    print(json.dumps({"spec": spec})[:-1] + ', "traces": [', flush=True)
    between = ""
    for trace in judged:
        sys.stdout.write(between + json.dumps(trace_values(trace)))
        sys.stdout.flush()
        between = ",\n"
        yield trace


def _end_json(traces: Sequence[JudgedTrace], total: int, others: Sequence[str]) -> None:
    print("\n], " + json.dumps(summary_values(traces, total, others))[1:])
