"""``tltlc baseline``: the figures that a suite is judged against."""

from __future__ import annotations

from pathlib import Path
from shlex import join
from typing import TYPE_CHECKING, Any

import click

from tltl_runtime.commands.ending import requests_heard
from tltl_runtime.commands.learning import learning_for
from tltl_runtime.commands.level_faults import level_faults
from tltl_runtime.commands.options import output_file
from tltl_runtime.commands.plain import plain
from tltl_runtime.commands.workers import all_cores_option
from tltl_runtime.commands.writable import check_apart
from tltlc.cli import exits
from tltlc.cli.report import Report

if TYPE_CHECKING:
    from tltl_runtime.regression.baseline_run import Compared
    from tltl_runtime.regression.suite import Case, Suite


@click.command(
    epilog="""\b
Examples:
  tltlc baseline suite.toml
  tltlc baseline suite.toml --output tonight.json
  tltlc regress suite.toml --baseline tonight.json
"""
)
@click.argument("suite", metavar="[SUITE]", required=False, type=click.Path(path_type=Path))
@output_file("FILE", "Where to write it (default: SUITE.baseline.json, beside the suite).")
@all_cores_option
@level_faults()
def command(suite: Path | None, path: Path | None, workers: Any) -> int:
    """Record the figures of the policies of a suite on the levels as they are now, for `tltlc regress`.

    Of each level that is the variant with which its cases are compared, by default the first one.  Without SUITE, the
    levels that come with tltlc are played, and `shipped.baseline.json` is written.
    """
    with Report() as report, learning_for("`tltlc baseline`"), requests_heard():
        from tltl_runtime.commands.regression_display import RegressionDisplay
        from tltl_runtime.regression.baseline import written_to
        from tltl_runtime.regression.baseline_run import kept_at, write_recorded
        from tltl_runtime.regression.dependencies import files_of
        from tltl_runtime.regression.suite import SHIPPED, read_suite

        read = read_suite(suite or SHIPPED)
        wrote = path or written_to(read.path)
        check_apart({"--output": wrote}, files_of(read) - {read.baseline.resolve()})
        try:
            with RegressionDisplay() as display:
                for each in write_recorded(read, wrote, workers, display):
                    display.over()
                    _tell(read, each)
        except KeyboardInterrupt:
            again = "goes on with what is over" if kept_at(wrote) else "begins anew"
            click.echo(f"stopped: `{wrote}` is as it was; the same command {again}", err=True)
            raise
        click.echo(f"wrote {wrote}", err=True)
        if wrote.resolve() != read.baseline.resolve():
            words = ["tltlc", "regress", *([str(suite)] if suite else []), "--baseline", str(wrote)]
            click.echo(f"to judge by it: {join(words)}", err=True)
        return exits.CLEAN
    return report.status


def _tell(suite: Suite, compared: Compared) -> None:
    """Say what was recorded, and which cases do not pass by it even where nothing has changed."""
    from tltl_runtime.regression.baseline_run import verdict_as_it_is

    reference = compared.reference
    played, passed, count = reference.played, sum(each.success for each in reference.accounts), len(reference.accounts)
    click.echo(plain(f"{played.level}:{played.variant}: {played.spec} met in {passed} of {count} episodes"))
    if compared.outdated:
        click.echo(plain(f"    {compared.outdated}"), err=True)
    for case in compared.cases:
        verdict = verdict_as_it_is(suite, case, reference) if case.variant == case.reference else "pass"
        if verdict != "pass":
            advice = _advice(passed / count, case)
            click.echo(plain(f"    `{case.name}` is `{verdict}` even if nothing changes: {advice}"), err=True)


def _advice(pass_rate: float, case: Case) -> str:
    """What makes a case pass of whose baseline's episodes this share met the spec."""
    if pass_rate == 1.0:
        return f"give it more `episodes` than {case.episodes}, which are too few to be certain"
    if pass_rate < case.thresholds.pass_rate:
        return "train its policy further, or lower its `pass_rate`"
    return "train its policy further, lower its `pass_rate`, or give it more `episodes`"
