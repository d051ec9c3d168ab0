"""``tltlc witness``: show traces that a spec accepts and traces that it rejects."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Literal

import click

from tltlc.interfaces.cli.paths import OutputPath
from tltlc.interfaces.cli.report import Report
from tltlc.interfaces.cli.settings import CompileSettings, search_steps, source_options

if TYPE_CHECKING:
    from tltlc.automaton.fspa import Fspa
    from tltlc.tools.witness.traces import Witness, WitnessKind


@click.command(
    epilog="""\b
Examples:
  tltlc witness leave.tltl                                             two test blocks to paste into the file
  tltlc witness levels.tltl:level_1 --rejecting --as csv > broken.csv
  tltlc witness leave.tltl --cover --as csv -o traces                  every edge of the automaton
"""
)
@click.argument("spec", metavar="SPEC[:NAME]")
@click.option("--accepting", is_flag=True, help="Print a shortest accepted trace.")
@click.option(
    "--rejecting",
    is_flag=True,
    help="Print a shortest trace that violates the spec; if there is none, a shortest rejected trace.",
)
@click.option("--cover", is_flag=True, help="Print traces that together take every reachable edge of the automaton.")
@click.option(
    "--as", "kind", type=click.Choice(("test", "csv")), default="test", help="The format of the traces (default: test)."
)
@click.option(
    "--output",
    "-o",
    "folder",
    metavar="DIR",
    type=OutputPath("folder"),
    help="Write each trace to a file in this folder.",
)
@source_options
def command(
    spec: str,
    accepting: bool,
    rejecting: bool,
    cover: bool,
    kind: Literal["test", "csv"],
    folder: Path | None,
    settings: CompileSettings,
    format: str,  # noqa: A002
) -> int:
    """Print traces that show what a spec means: as `test` blocks for its file, or as CSV with signals.

    Without options, the output is a shortest accepted trace and a shortest trace that violates the spec. The values of
    the signals make the atoms true or false as needed, and each trace is checked by the monitor before it is printed. A
    trace of a spec over infinite traces is a prefix and a cycle; the cycle is written once.
    """
    from tltlc.interfaces.cli.inputs import open_input
    from tltlc.io.writing import write_files
    from tltlc.tools.witness.chosen_traces import chosen_traces
    from tltlc.tools.witness.transitions import Moves

    options: dict[WitnessKind, bool] = {"accepting": accepting, "rejecting": rejecting, "cover": cover}
    kinds = {name for name, is_given in options.items() if is_given} or {"accepting", "rejecting"}
    with Report(format, results=True) as report:
        spec_input = open_input(spec, settings)
        report.add(spec_input.diagnostics)
        files: dict[str, str | bytes] = {}
        for fspa in spec_input.automata:
            traces, warnings = chosen_traces(Moves(fspa), kinds, search_steps(settings))
            report.add(warnings)
            files.update(_trace_texts(fspa, traces, kind, report))
        if folder is not None:
            changed_paths = write_files(folder, files)
            for path in changed_paths:
                report.say(f"wrote {path}")
            if len(changed_paths) < len(files):
                report.say(f"unchanged: {len(files) - len(changed_paths)}")
            return report.status
        if kind == "csv" and len(files) > 1:
            hint = "write them to a folder with -o, or choose one with SPEC:NAME and --accepting or --rejecting"
            raise click.UsageError(
                f"one CSV file cannot contain {len(files)} traces: {hint}", click.get_current_context()
            )
        click.echo("\n".join(str(text) for text in files.values()), nl=False)
    return report.status


def _trace_texts(
    fspa: Fspa, traces: tuple[Witness, ...], kind: Literal["test", "csv"], report: Report
) -> dict[str, str]:
    """Return the text of each trace by file name, as a ``test`` block or as CSV: ``heist_cover_1.csv``.

    If the spec has no atoms, or no signals for CSV, report an error and return an empty dict.
    """
    from tltlc.monitor import Monitor
    from tltlc.tools.witness import captions
    from tltlc.tools.witness import text as trace_text
    from tltlc.tools.witness.blocks import BlockWriter

    if traces and not fspa.atoms:
        report.add([captions.no_atoms_error(fspa)])
        return {}
    if traces and kind == "csv" and not fspa.signals:
        report.add([captions.no_signals_error(fspa)])
        return {}
    covers = sum(trace.kind == "cover" for trace in traces)
    texts: dict[str, str] = {}
    number, blocks, monitor = 0, BlockWriter(fspa), Monitor(fspa)
    for trace in traces:
        number += trace.kind == "cover"
        suffix = f"cover_{number}" if trace.kind == "cover" else trace.kind
        if kind == "csv":
            texts[f"{fspa.name}_{suffix}.csv"] = trace_text.as_csv(fspa, trace, monitor)
            if trace.cycle is not None:
                report.say(f"{fspa.name}, {trace.kind}: {trace_text.cycle_text(trace)}")
        else:
            title = captions.title(fspa, trace, number, covers)
            texts[f"{fspa.name}_{suffix}.txt"] = trace_text.as_test(fspa, trace, title, blocks)
    return texts
