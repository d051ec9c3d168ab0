"""``tltlc conformance``: specs, traces and expected rows, for monitors in any language to be checked against."""

from __future__ import annotations

from pathlib import Path

import click

from tltlc.cli.paths import OutputPath


@click.command(
    epilog="""\b
Examples:
  tltlc conformance -o corpus
  tltlc compile corpus/until/until.fspa.json -t python -o build
  python build/until_monitor.py --full corpus/until/until.1.csv
"""
)
@click.option(
    "--output",
    "-o",
    "folder",
    metavar="DIR",
    type=OutputPath("folder"),
    default="conformance",
    show_default=True,
    help="Write here.",
)
def command(folder: Path) -> int:
    """Write specs and traces with what a monitor must say of them, to check an engine's build.

    DIR/README.md says how; DIR/index.json is for programs.  The files are the same at each run.
    """
    from tltlc.cli.report import Report
    from tltlc.conformance.corpus import CASES, files
    from tltlc.writing import write_files

    with Report() as report:
        made = files()
        write_files(folder, made)
        report.say(f"wrote {len(CASES)} cases, {len(made)} files, to {folder}: see {folder / 'README.md'}")
    return report.status
