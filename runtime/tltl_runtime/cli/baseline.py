"""``tltlc baseline``: the figures that a suite is judged against."""

from __future__ import annotations

from contextlib import suppress
from pathlib import Path
from shlex import join
from typing import TYPE_CHECKING, Any

import click

from tltl_runtime.cli.support.closed_output import on_without_readers
from tltl_runtime.cli.support.learning import learning_for
from tltl_runtime.cli.support.level_faults import level_faults
from tltl_runtime.cli.support.options import output_file
from tltl_runtime.cli.support.printable import plain
from tltl_runtime.cli.support.suite_argument import check_there
from tltl_runtime.cli.support.worker_options import all_cores_option
from tltl_runtime.cli.support.writable_paths import check_apart, check_writable
from tltlc.diagnostics.diagnostic import TltlError
from tltlc.interfaces.cli import exits
from tltlc.interfaces.cli.report import Report
from tltlc.io.files import exists, is_file

if TYPE_CHECKING:
    from tltl_runtime.regression.suite.suite import Case, Suite
    from tltl_runtime.regression.verdict.baseline import Reference
    from tltl_runtime.regression.verdict.baseline_run import Compared


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
@click.option("--fresh", is_flag=True, help="Play again what the file has already, and nothing has changed of.")
@all_cores_option
@level_faults()
def command(suite: Path | None, path: Path | None, fresh: bool, workers: Any) -> int:
    """Record the figures of the policies of a suite on the levels as they are now, for `tltlc regress`.

    Of each level that is the variant with which its cases are compared, by default the first one.  What the file has
    already is not played again where level, policy, spec, seed, versions and code are as they were.  Without SUITE, the
    levels that come with tltlc are played, and `shipped.baseline.json` is written.
    """
    with Report() as report, learning_for("`tltlc baseline`"), on_without_readers():
        check_there(suite)
        from tltl_runtime.cli.support.regression_display import RegressionDisplay
        from tltl_runtime.regression.suite.dependencies import files_of
        from tltl_runtime.regression.suite.suite import SHIPPED, read_suite
        from tltl_runtime.regression.verdict.baseline import written_to
        from tltl_runtime.regression.verdict.baseline_run import kept_at, write_recorded

        read = read_suite(suite or SHIPPED)
        wrote = path or written_to(read.path)
        check_apart({"--output": wrote}, files_of(read) - {read.baseline.resolve()})
        check_writable({"--output": wrote})
        there, older = exists(wrote), _older(wrote)
        try:
            with RegressionDisplay() as display:
                for each in write_recorded(read, wrote, workers, display, older, fresh=fresh):
                    display.over()
                    _tell(read, each, older, fresh=fresh)
        except KeyboardInterrupt:
            click.echo(f"stopped: {_left(wrote, kept_at(wrote), there=there)}", err=True)
            raise
        click.echo(f"wrote {wrote}", err=True)
        if wrote.resolve() != read.baseline.resolve():
            words = ["tltlc", "regress", *([str(suite)] if suite else []), "--baseline", str(wrote)]
            click.echo(f"to judge by it: {join(words)}", err=True)
        return exits.CLEAN
    return report.status


def _older(path: Path) -> tuple[Reference, ...]:
    """What is in the file that is to be written, if that is a baseline."""
    from tltl_runtime.regression.verdict.baseline import read_baseline

    with suppress(TltlError):
        return read_baseline(path) if is_file(path) else ()
    return ()


def _left(path: Path, partial: Path | None, *, there: bool) -> str:
    """What a recording that was stopped has left, and what goes on with it; ``there``: there was a file before."""
    from tltl_runtime.stealth.levels.made_for import shown

    if partial and not there:
        return f"no `{path}` was written; what is over is kept in `{shown(partial)}`: the same command goes on with it"
    return f"`{path}` is as it was; the same command {'goes on with what is over' if partial else 'begins anew'}"


def _tell(suite: Suite, compared: Compared, older: tuple[Reference, ...], *, fresh: bool) -> None:
    """Say what was recorded, and which cases do not pass by it even where nothing has changed."""
    from tltl_runtime.regression.verdict.baseline_run import verdict_as_it_is

    reference = compared.reference
    played, passed, count = reference.played, _passed(reference), len(reference.accounts)
    before = _before(reference, older)
    if reference in older and not fresh:
        beside = "  (as before)"
    else:
        beside = f"; before: {_passed(before)} of {len(before.accounts)}" if before else ""
    click.echo(plain(f"{played.level}:{played.variant}: {played.spec} met in {passed} of {count} episodes") + beside)
    if compared.outdated:
        click.echo(plain(f"    {compared.outdated}"), err=True)
    for case in compared.cases:
        verdict = verdict_as_it_is(suite, case, reference) if case.variant == case.reference else "pass"
        if verdict != "pass":
            advice = _advice(passed / count, case, suite.error / len(suite.cases))
            click.echo(plain(f"    `{case.name}` is `{verdict}` even if nothing changes: {advice}"), err=True)


def _passed(reference: Reference) -> int:
    return sum(each.success for each in reference.accounts)


def _before(reference: Reference, older: tuple[Reference, ...]) -> Reference | None:
    """What an older baseline has of the same level, variant and spec, of another policy only if that was the one."""
    names = ("level", "variant", "place", "spec")
    played = reference.played
    same = [each for each in older if all(getattr(each.played, key) == getattr(played, key) for key in names)]
    its = [each for each in same if each.played.policy == played.policy]
    return its[0] if its else same[0] if len(same) == 1 else None


def _advice(pass_rate: float, case: Case, error: float) -> str:
    """What makes a case pass of whose baseline's episodes this share met the spec."""
    if pass_rate == 1.0:
        from tltl_runtime.regression.verdict.baseline_run import enough_episodes

        enough = enough_episodes(case.thresholds.pass_rate, error)
        return f"{case.episodes} `episodes` are too few to be certain, give it {enough} at least"
    if pass_rate < case.thresholds.pass_rate:
        return "train its policy further, or lower its `pass_rate`"
    return "train its policy further, lower its `pass_rate`, or give it more `episodes`"
