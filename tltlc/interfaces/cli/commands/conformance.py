"""``tltlc conformance``: write specs, traces and expected results, to check any monitor with them."""

from __future__ import annotations

from pathlib import Path

import click

from tltlc.interfaces.cli.paths import OutputPath


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
    help="The folder for the files.",
)
def command(folder: Path) -> int:
    """Write specs, traces and the results that a monitor must give, to check the monitors of an engine.

    DIR/README.md explains the check; DIR/index.json is for programs. Each run writes the same files. DIR must be new,
    empty, or the output of an earlier run.
    """
    from tltlc.interfaces.cli.folders import is_free, occupied_folder_error
    from tltlc.interfaces.cli.report import Report
    from tltlc.io.writing import write_files
    from tltlc.tools.conformance.corpus import CASES, files, is_corpus

    with Report() as report:
        if not is_free(folder) and not is_corpus(folder):
            raise occupied_folder_error(folder, "name another folder with -o, or an empty one")
        contents = files()
        write_files(folder, contents, over_inputs=True)
        report.say(f"wrote {len(CASES)} cases, {len(contents)} files, to {folder}: see {folder / 'README.md'}")
    return report.status
