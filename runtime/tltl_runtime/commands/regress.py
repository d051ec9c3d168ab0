"""``tltlc regress``: which levels still play as designed, and where and why not."""

from __future__ import annotations

import json
from contextlib import closing
from pathlib import Path
from typing import Any

import click

from tltl_runtime.commands.ending import requests_heard
from tltl_runtime.commands.learning import learning_for
from tltl_runtime.commands.level_faults import level_faults
from tltl_runtime.commands.options import output_folder
from tltl_runtime.commands.workers import WorkersType
from tltlc.cli import exits
from tltlc.cli.report import Report


@click.command(
    epilog="""\b
Examples:
  tltlc regress
  tltlc regress suite.toml --html report.html
  tltlc regress suite.toml --json - > report.json
"""
)
@click.argument("suite", metavar="[SUITE]", required=False, type=click.Path(path_type=Path))
@click.option(
    "--json",
    "json_file",
    metavar="FILE",
    type=click.Path(path_type=Path, allow_dash=True, dir_okay=False),
    help="Write the report as JSON, too; `-` prints it in place of the text.",
)
@click.option(
    "--workers",
    metavar="N|ray",
    type=WorkersType(),
    default=0,
    help="Processes that play (default: one a core), or those of a Ray cluster.",
)
@output_folder("The folder for what was played (default: regression/SUITE).")
@level_faults()
def command(suite: Path | None, json_file: Path | None, workers: Any, folder: Path | None) -> int:
    """Have trained policies play the cases of a suite, and report which levels still play as designed.

    SUITE is a TOML file; without one, the levels that come with tltlc are played in all of their variants.  The exit
    status is 0 where all cases pass, and 1 where one is to be reviewed or fails.
    """
    with Report() as report, learning_for("`tltlc regress`"), requests_heard():
        from tltl_runtime.commands.regression_text import case_lines, sum_line
        from tltl_runtime.regression.baseline import baseline_path, read_baseline
        from tltl_runtime.regression.document import document
        from tltl_runtime.regression.run import regress
        from tltl_runtime.regression.suite import SHIPPED, read_suite
        from tltlc.writing import write_file

        read = read_suite(suite or SHIPPED)
        references = read_baseline(baseline_path(read.path))
        place = folder or Path("regression") / (suite.stem if suite else "shipped")
        width = max(len(case.name) for case in read.cases)
        as_json = str(json_file) == "-"
        reports = []
        with closing(regress(read, read.cases, references, place, workers, lambda *_: None)) as running:
            for done in running:
                reports.append(done.report)
                for line in case_lines(done.report, width, kept=done.kept):
                    click.echo(line, err=as_json)
        click.echo(sum_line(reports), err=as_json)
        if json_file:
            text = json.dumps(document(read, reports, complete=True), indent=2, ensure_ascii=False) + "\n"
            if as_json:
                click.echo(text, nl=False)
            else:
                write_file(json_file, text, "name another place with --json")
        return exits.CLEAN if all(each.verdict == "pass" for each in reports) else exits.FINDINGS
    return report.status
