"""``tltlc baseline``: the figures that a suite is judged against."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import click

from tltl_runtime.commands.ending import requests_heard
from tltl_runtime.commands.learning import learning_for
from tltl_runtime.commands.level_faults import level_faults
from tltl_runtime.commands.options import output_file
from tltl_runtime.commands.plain import plain
from tltl_runtime.commands.workers import all_cores_option
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
@all_cores_option
@level_faults()
def command(suite: Path | None, path: Path | None, workers: Any) -> int:
    """Record the figures of the policies of a suite on the levels as they are now, for `tltlc regress`.

    Of each level that is the variant with which its cases are compared, by default the first one.
    """
    with Report() as report, learning_for("`tltlc baseline`"), requests_heard():
        from tltl_runtime.commands.regression_display import RegressionDisplay
        from tltl_runtime.regression.baseline import baseline_path, write_baseline
        from tltl_runtime.regression.baseline_run import record_baseline
        from tltl_runtime.regression.suite import SHIPPED, read_suite
        from tltlc.writing import replaced

        read = read_suite(suite or SHIPPED)
        wrote = path or baseline_path(read.path)
        references = []
        try:
            # The place may refuse: better to know before minutes of play.
            with replaced(wrote, "name another place with --output") as temporary, RegressionDisplay() as display:
                for each in record_baseline(read, workers, display):
                    display.over()
                    references.append(each)
                    passed, count = sum(account.success for account in each.accounts), len(each.accounts)
                    met = f"{each.played.spec} met in {passed} of {count} episodes"
                    click.echo(plain(f"{each.played.level}:{each.played.variant}: {met}"))
                write_baseline(temporary, tuple(references))
        except KeyboardInterrupt:
            click.echo(f"stopped: nothing was written, and `{wrote}` is as it was", err=True)
            raise
        click.echo(f"wrote {wrote}", err=True)
        return exits.CLEAN
    return report.status
