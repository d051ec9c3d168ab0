"""``tltlc regress``: which levels still play as designed, and where and why not."""

from __future__ import annotations

import os
from collections.abc import Sequence
from contextlib import closing
from pathlib import Path
from shlex import join, quote
from typing import TYPE_CHECKING, Any, Final

import click

from tltl_runtime.commands.changed_option import ChangedCommand
from tltl_runtime.commands.ending import requests_heard
from tltl_runtime.commands.learning import learning_for
from tltl_runtime.commands.options import output_folder
from tltl_runtime.commands.plain import plain
from tltl_runtime.commands.workers import all_cores_option
from tltl_runtime.commands.writable import check_writable
from tltlc.cli import exits
from tltlc.cli.report import Report
from tltlc.record import record

if TYPE_CHECKING:
    from tltl_runtime.commands.regression_files import Outcome
    from tltl_runtime.regression.baseline import Reference
    from tltl_runtime.regression.dependencies import Selection
    from tltl_runtime.regression.run import Done
    from tltl_runtime.regression.suite import Case, Suite

_MINUTES: Final = 10.0
"""Of a training with --retrain, where nothing else is said."""
_MOST_NAMED: Final = 8
"""Of the files on which no case depends, as many are named."""


def _file(*, dash: bool = False) -> click.Path:
    return click.Path(path_type=Path, allow_dash=dash, dir_okay=False)


@record
class _Wanted:
    """What was asked for: the suite as it was named, where its files go, and how it is played."""

    suite: Path | None
    changed: tuple[str, ...] | None
    folder: Path
    json_file: Path | None
    junit_file: Path | None
    html_file: Path | None
    github: bool
    fresh: bool
    workers: Any
    baseline: Path | None
    minutes: float | None
    """Of a training for each case that does not pass, at the most; None: none is trained."""

    @property
    def is_json(self) -> bool:
        """Whether standard output is for the report as JSON alone."""
        return str(self.json_file) == "-"


@click.command(
    cls=ChangedCommand,
    epilog="""\b
Examples:
  tltlc regress
  tltlc regress suite.toml --html report.html
  tltlc regress suite.toml --json - > report.json
  tltlc regress suite.toml --changed assets/guard.toml
  tltlc regress suite.toml --retrain --minutes 20
  tltlc regress suite.toml --junit report.xml --github --changed $(git diff --no-renames --name-only main)
""",
)
@click.argument("suite", metavar="[SUITE]", required=False, type=click.Path(path_type=Path))
@click.option(
    "--changed",
    metavar="ASSET…",
    multiple=True,
    help="Only the cases that depend on one of these files; it takes every word up to the next option.",
)
@click.option(
    "--json",
    "json_file",
    metavar="FILE",
    type=_file(dash=True),
    help="Write the report as JSON, too; `-` prints it in place of the text.",
)
@click.option("--junit", "junit_file", metavar="FILE", type=_file(), help="Write it as JUnit XML, too.")
@click.option("--html", "html_file", metavar="FILE", type=_file(), help="Write the page here, too.")
@click.option("--github", is_flag=True, help="Print findings as annotations of GitHub Actions, too.")
@click.option(
    "--baseline",
    metavar="FILE",
    type=_file(),
    help="What they are judged against (default: SUITE.baseline.json, beside the suite).",
)
@click.option("--fresh", is_flag=True, help="Play cases again of which nothing has changed since they were played.")
@click.option(
    "--retrain",
    is_flag=True,
    help="Train for the cases that do not pass, to see whether their levels are feasible after all.",
)
@click.option(
    "--minutes",
    metavar="M",
    type=click.FloatRange(min=0, min_open=True, max=1_000_000),
    help=f"Of each training, at the most (default: {_MINUTES:g}).",
)
@all_cores_option
@output_folder("The folder for the page and for what was played (default: regression/SUITE).")
def command(
    suite: Path | None,
    changed: tuple[str, ...],
    json_file: Path | None,
    junit_file: Path | None,
    html_file: Path | None,
    github: bool,
    baseline: Path | None,
    fresh: bool,
    retrain: bool,
    minutes: float | None,
    workers: Any,
    folder: Path | None,
) -> int:
    """Have trained policies play the cases of a suite, and report which levels still play as designed.

    SUITE is a TOML file; without one, the levels that come with tltlc are played in all of their variants.  A case of
    which nothing has changed since it was played is not played again.  The exit status is 0 where all cases pass, and
    1 where one is to be reviewed or fails; what --retrain finds changes neither.
    """
    if github and str(json_file) == "-":
        raise click.UsageError("--github and `--json -` both need standard output: write the JSON to a file")
    if minutes is not None and not retrain:
        raise click.UsageError("--minutes are those of --retrain")
    named = tuple(filter(None, changed)) if changed else None
    place = folder or _default_folder(suite)
    wanted = _Wanted(
        suite,
        named,
        place,
        json_file,
        junit_file,
        html_file,
        github,
        fresh,
        workers,
        baseline,
        (minutes or _MINUTES) if retrain else None,
    )
    with Report() as report, learning_for("`tltlc regress`"), requests_heard():
        from tltl_runtime.regression.baseline import baseline_of
        from tltl_runtime.regression.run import check, owned
        from tltl_runtime.regression.suite import SHIPPED, read_suite

        check_writable({"--json": None if wanted.is_json else json_file, "--junit": junit_file, "--html": html_file})
        read = read_suite(suite or SHIPPED, baseline)
        cases, left_out = _chosen(read, named)
        references = baseline_of(read) if cases else ()
        check(read, cases, references)
        found: list[Done] = []
        with owned(place):
            if fresh and retrain:
                from tltl_runtime.regression.retrain import forget_trainings

                # At once, so that a run that is stopped goes on with fresh ones.
                forget_trainings(read, cases, place)
            try:
                _play(read, cases, references, wanted, found)
                _retrain(read, wanted, found)
            except KeyboardInterrupt:
                _stopped(wanted, found, len(cases))
                raise
            finally:
                _tell(_outcome(read, found, cases, left_out, wanted), wanted)
        return exits.CLEAN if all(done.report.verdict == "pass" for done in found) else exits.FINDINGS
    return report.status


def _default_folder(suite: Path | None) -> Path:
    """The suite's place as seen from here, without its ending: "regression/levels/game" for `levels/game.toml`."""
    if suite is None:
        return Path("regression", "shipped")
    try:
        path = Path(os.path.relpath(suite))
    except ValueError:  # Windows: on another drive
        path = Path(suite.name)
    return Path("regression", *(part for part in path.parent.parts if part != os.pardir), path.stem)


def _chosen(suite: Suite, changed: Sequence[str] | None) -> tuple[tuple[Case, ...], tuple[str, ...]]:
    """The cases to be judged, and the names of those that are left out, which standard error tells."""
    if changed is None:
        return suite.cases, ()
    from tltl_runtime.regression.dependencies import select

    found: Selection = select(suite, changed)
    if found.unknown:
        more = f" and {count} more" if (count := len(found.unknown) - _MOST_NAMED) > 0 else ""
        click.echo(f"no case depends on {plain(', '.join(found.unknown[:_MOST_NAMED]))}{more}", err=True)
    left_out = tuple(case.name for case in found.left_out)
    if left_out:
        click.echo(f"left out, since nothing has changed that they depend on: {plain(', '.join(left_out))}", err=True)
    return found.cases, left_out


def _play(
    suite: Suite, cases: Sequence[Case], references: tuple[Reference, ...], wanted: _Wanted, found: list[Done]
) -> None:
    """Play the cases; each that is over is told at once, and added to ``found``."""
    from tltl_runtime.commands.regression_display import RegressionDisplay
    from tltl_runtime.commands.regression_text import case_lines
    from tltl_runtime.regression.run import regress

    width = max((len(plain(case.name)) for case in cases), default=0)
    with (
        RegressionDisplay("at most") as display,
        closing(
            regress(suite, cases, references, wanted.folder, wanted.workers, display, fresh=wanted.fresh)
        ) as running,
    ):
        for done in running:
            found.append(done)
            display.over()
            for line in case_lines(done.report, width, kept=done.kept):
                click.echo(line, err=wanted.is_json)


def _retrain(suite: Suite, wanted: _Wanted, found: list[Done]) -> None:
    """Train for the cases in ``found`` that do not pass, where this is asked for."""
    if wanted.minutes is None:
        return
    from tltl_runtime.commands.retrain import Retraining, retrain_cases

    again = join([*_again(wanted), "--retrain"])
    asked = Retraining(suite, wanted.folder, wanted.minutes, wanted.workers, again)
    retrain_cases(asked, found, to_stderr=wanted.is_json)


def _again(wanted: _Wanted) -> list[str]:
    """The words of the command that goes on with a run, but for --retrain and its --minutes."""
    options = {
        "--out": wanted.folder,
        "--baseline": wanted.baseline,
        "--json": wanted.json_file,
        "--junit": wanted.junit_file,
        "--html": wanted.html_file,
        "--workers": wanted.workers or None,
    }
    words = ["tltlc", "regress", *([str(wanted.suite)] if wanted.suite else [])]
    for name, value in options.items():
        words += [] if value is None else [name, str(value)]
    words += ["--github"] if wanted.github else []
    return words if wanted.changed is None else [*words, "--changed", *wanted.changed]


def _stopped(wanted: _Wanted, found: list[Done], cases: int) -> None:
    """Say what is left of a run that was ended, and what goes on with it."""
    words = _again(wanted)
    if wanted.minutes is not None:
        words += ["--retrain", "--minutes", f"{wanted.minutes:g}"]
    done = f"{len(found)} of {cases} cases are judged, and kept"
    if len(found) == cases and (left := _wanting(wanted, found)):
        done = f"all cases are judged, and {left} {'are' if left > 1 else 'is'} still to be trained for"
    click.echo(f"stopped: {done}; to go on: {join(words)}", err=True)


def _wanting(wanted: _Wanted, found: list[Done]) -> int:
    """For how many cases a training is asked for that is not over."""
    if wanted.minutes is None:
        return 0
    from tltl_runtime.commands.retrain import wanting

    return wanting(found)


def _outcome(
    suite: Suite, found: list[Done], cases: Sequence[Case], left_out: tuple[str, ...], wanted: _Wanted
) -> Outcome:
    from tltl_runtime.commands.regression_files import Outcome

    missing = tuple(case.name for case in cases[len(found) :])
    return Outcome(suite, tuple(found), not missing and not _wanting(wanted, found), left_out, missing)


def _tell(outcome: Outcome, wanted: _Wanted) -> None:
    """Sum up, and write what was asked for; the page, which takes longest, at the end."""
    from tltl_runtime.commands.regression_files import json_text, write_page, write_reports
    from tltl_runtime.commands.regression_text import sum_line

    reports = [done.report for done in outcome.cases]
    click.echo(sum_line(reports, outcome.missing), err=wanted.is_json)
    if wanted.is_json:
        click.echo(json_text(outcome), nl=False)
    if wanted.github:
        from tltl_runtime.regression.github import findings_as_commands

        for line in findings_as_commands(outcome.suite, reports, Path(os.environ.get("GITHUB_WORKSPACE") or ".")):
            click.echo(line)
    write_reports(outcome, None if wanted.is_json else wanted.json_file, wanted.junit_file)
    if outcome.cases or wanted.html_file:
        page = write_page(outcome, wanted.folder, wanted.html_file)
        click.echo(f"wrote {quote(str(page))}: open it in a browser", err=True)
