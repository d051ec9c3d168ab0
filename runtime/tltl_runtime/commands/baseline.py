"""``tltlc baseline``: the figures that a suite is judged against."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import click

from tltl_runtime.commands.ending import requests_heard
from tltl_runtime.commands.learning import learning_for
from tltl_runtime.commands.level_faults import level_faults
from tltl_runtime.commands.options import output_file
from tltl_runtime.commands.workers import WorkersType
from tltlc.cli import exits
from tltlc.cli.report import Report


@click.command(
    epilog="""\b
Examples:
  tltlc baseline suite.toml
"""
)
@click.argument("suite", metavar="[SUITE]", required=False, type=click.Path(path_type=Path))
@output_file("FILE", "Where to write it (default: SUITE.baseline.json, beside the suite).")
@click.option(
    "--workers",
    metavar="N|ray",
    type=WorkersType(),
    default=0,
    help="Processes that play (default: one a core), or those of a Ray cluster.",
)
@level_faults()
def command(suite: Path | None, path: Path | None, workers: Any) -> int:
    """Record the figures of the policies of a suite on the levels as they are now, for `tltlc regress`.

    Of each level that is the variant with which its cases are compared, by default the first one.
    """
    with Report() as report, learning_for("`tltlc baseline`"), requests_heard():
        from tltl_runtime.regression.baseline import baseline_path, write_baseline
        from tltl_runtime.regression.run import record_baseline
        from tltl_runtime.regression.suite import SHIPPED, read_suite

        read = read_suite(suite or SHIPPED)
        references = tuple(record_baseline(read, workers, lambda *_: None))
        for each in references:
            passed, count = sum(account.success for account in each.accounts), len(each.accounts)
            click.echo(
                f"{each.played.level}:{each.played.variant}: {each.played.spec} met in {passed} of {count} episodes"
            )
        wrote = path or baseline_path(read.path)
        write_baseline(wrote, references)
        click.echo(f"wrote {wrote}", err=True)
        return exits.CLEAN
    return report.status
