"""``tltlc regress``: play cases, retrain policies if requested, and report."""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from contextlib import closing
from pathlib import Path
from shlex import join, quote
from typing import Final

import click

from tltl_runtime.cli.support.printable import plain
from tltl_runtime.cli.support.regression_display import RegressionDisplay
from tltl_runtime.cli.support.regression_files import REPORTS, SuiteRun, write_reports
from tltl_runtime.cli.support.regression_text import case_lines, sum_line
from tltl_runtime.cli.support.retraining import Retraining, retrain_cases
from tltl_runtime.cli.support.writable_paths import check_apart, check_no_training, check_writable, is_output
from tltl_runtime.evaluation.evaluate import Pool
from tltl_runtime.regression.report.github import findings_as_commands
from tltl_runtime.regression.retrain.retrain import check_places
from tltl_runtime.regression.suite.dependencies import Selection, files_of, select
from tltl_runtime.regression.suite.suite import SHIPPED, Case, Suite, read_suite
from tltl_runtime.regression.suite.unnamed_changes import unnamed
from tltl_runtime.regression.verdict.baseline import Reference, baseline_of
from tltl_runtime.regression.verdict.suite_run import Done, check, lock_run, regress
from tltl_runtime.support.number_text import listed
from tltlc.api import TltlError, cli, record, workflow_command

_MOST_NAMED: Final = 8
"""The most files that are named of those on which no case depends."""
_MEANT: Final = "v1 and v2 of the shipped levels are changed on purpose: see the page"


@record
class RegressOptions:
    """The options of ``tltlc regress``.

    ``files`` are the files of reports, by their options.  ``folder`` is the folder of the run.
    ``minutes`` limits the retraining of each case that does not pass; None: no retraining.
    """

    suite: Path | None
    changed: tuple[str, ...] | None
    folder: Path
    files: Mapping[str, Path]
    github: bool
    fresh: bool
    workers: Pool
    baseline: Path | None
    minutes: float | None

    @property
    def printed(self) -> str | None:
        """The option of the report that is printed to standard output in place of the text, or None."""
        return next((option for option, path in self.files.items() if is_output(path)), None)

    @property
    def written(self) -> dict[str, Path]:
        """The files of reports, without standard output."""
        return {option: path for option, path in self.files.items() if not is_output(path)}


def run(wanted: RegressOptions) -> int:
    """Judge the requested cases, report on them, and return the exit status.

    On KeyboardInterrupt or an error, report on the finished cases and raise the exception again.

    Raises:
        TltlError: TLT0005, a file cannot be written; TLT0942, a policy lies in the folder of a training;
            errors from reading the suite, playing and training.
    """
    check_no_training(wanted.folder)
    check_writable(wanted.written)
    suite = read_suite(wanted.suite or SHIPPED, wanted.baseline)
    check_apart(wanted.written, files_of(suite))
    selection = _chosen(suite, wanted)
    cases, left_out = selection.cases, tuple(case.name for case in selection.left_out)
    if wanted.minutes is not None:
        check_places(suite, cases, wanted.folder)
    references = _references(suite, cases)
    _tell_unnamed(suite, selection.left_out, references)
    check(suite, cases, references)
    results: list[Done] = []
    with lock_run(wanted.folder):
        try:
            _play(suite, cases, references, wanted, results)
            _retrain(suite, wanted, results)
        except BaseException as error:
            if isinstance(error, KeyboardInterrupt):
                _stopped(wanted, results, len(cases))
            _tell_too(_outcome(suite, cases, left_out, wanted, results), wanted)
            raise
        _tell(_outcome(suite, cases, left_out, wanted, results), wanted)
    return cli.exits.CLEAN if all(done.report.verdict == "pass" for done in results) else cli.exits.FINDINGS


def _chosen(suite: Suite, wanted: RegressOptions) -> Selection:
    """Select the cases to judge; print to standard error which are left out."""
    if wanted.changed is None:
        return Selection(suite.cases)
    selection = select(suite, wanted.changed)
    if selection.unknown:
        click.echo(f"no case depends on {plain(listed(selection.unknown, _MOST_NAMED))}", err=True)
    for name, suggestion in selection.slips:
        message = plain(f"there is no file `{name}`: did you mean `{suggestion}`?")
        click.echo(f"warning: {message}", err=True)
        if wanted.github:
            click.echo(workflow_command("warning", message, {"title": "--changed"}))
    if selection.left_out:
        names = plain(", ".join(case.name for case in selection.left_out))
        click.echo(f"left out, since none of the named files concerns them: {names}", err=True)
    return selection


def _references(suite: Suite, cases: Sequence[Case]) -> tuple[Reference, ...]:
    """Read the baseline; errors count only if there are cases to play."""
    try:
        return baseline_of(suite)
    except TltlError:
        if cases:
            raise
        return ()


def _tell_unnamed(suite: Suite, left_out: Sequence[Case], references: tuple[Reference, ...]) -> None:
    """Warn about files that have changed but were not named as changed."""
    for name, cases in unnamed(suite, left_out, references).items():
        names = plain(listed(cases, _MOST_NAMED))
        message = (
            f"`{plain(name)}` has changed since the baseline, and is not among the files that are named; "
            f"left out: {names}"
        )
        click.echo(f"warning: {message}", err=True)


def _play(
    suite: Suite, cases: Sequence[Case], references: tuple[Reference, ...], wanted: RegressOptions, results: list[Done]
) -> None:
    """Play the cases; print each finished case at once and add it to ``results``."""
    width = max((len(plain(case.name)) for case in cases), default=0)
    with (
        RegressionDisplay("at most") as display,
        closing(
            regress(suite, cases, references, wanted.folder, wanted.workers, display, fresh=wanted.fresh)
        ) as running,
    ):
        for done in running:
            results.append(done)
            display.over()
            for line in case_lines(done.report, width, kept=done.kept):
                click.echo(line, err=wanted.printed is not None)


def _retrain(suite: Suite, wanted: RegressOptions, results: list[Done]) -> None:
    """Retrain for the cases in ``results`` that do not pass, if requested."""
    if wanted.minutes is not None:
        again = join([*_again(wanted), "--retrain"])
        options = Retraining(suite, wanted.folder, wanted.minutes, wanted.workers, again, wanted.fresh)
        retrain_cases(options, results, to_stderr=wanted.printed is not None)


def _untrained(wanted: RegressOptions, results: list[Done]) -> int:
    """The number of cases whose requested training is not finished."""
    return 0 if wanted.minutes is None else sum(done.to_train is not None for done in results)


def _again(wanted: RegressOptions) -> list[str]:
    """The words of the command that continues a run, without --retrain and --minutes."""
    options = {
        "--out": wanted.folder,
        "--baseline": wanted.baseline,
        **{option: wanted.files.get(option) for option in REPORTS},
        "--workers": wanted.workers or None,
    }
    words = ["tltlc", "regress", *([str(wanted.suite)] if wanted.suite else [])]
    for name, value in options.items():
        words += [] if value is None else [name, str(value)]
    words += ["--github"] if wanted.github else []
    return words if wanted.changed is None else [*words, "--changed", *wanted.changed]


def _stopped(wanted: RegressOptions, results: list[Done], cases: int) -> None:
    """Print the progress of a stopped run and the command that continues it."""
    words = _again(wanted)
    if wanted.minutes is not None:
        words += ["--retrain", "--minutes", f"{wanted.minutes:g}"]
    progress = f"{len(results)} of {cases} cases are judged, and kept"
    if len(results) == cases and (untrained := _untrained(wanted, results)):
        progress = f"all cases are judged, and {untrained} {'are' if untrained > 1 else 'is'} still to be trained for"
    click.echo(f"stopped: {progress}; to go on: {join(words)}", err=True)


def _outcome(
    suite: Suite, cases: Sequence[Case], left_out: tuple[str, ...], wanted: RegressOptions, results: list[Done]
) -> SuiteRun:
    """The outcome of the run so far."""
    missing = tuple(case.name for case in cases[len(results) :])
    complete = not missing and not _untrained(wanted, results)
    return SuiteRun(suite, wanted.folder, tuple(results), complete, left_out, missing, wanted.changed or ())


def _tell_too(outcome: SuiteRun, wanted: RegressOptions) -> None:
    """Report on a run that an error has ended.  A further error is printed, so that it does not hide the first."""
    try:
        _tell(outcome, wanted)
    except Exception as error:
        cli.exits.report(error)


def _are_meant(outcome: SuiteRun) -> bool:
    """Whether there are findings, and all of them concern changed variants."""
    findings = {done.report.name for done in outcome.cases if done.report.verdict != "pass"}
    return bool(findings) and all(
        case.variant != case.reference for case in outcome.suite.cases if case.name in findings
    )


def _tell(outcome: SuiteRun, wanted: RegressOptions) -> None:
    """Print the summary and write the requested reports."""
    reports = [done.report for done in outcome.cases]
    click.echo(sum_line(reports, outcome.missing), err=wanted.printed is not None)
    if outcome.suite.path == SHIPPED and _are_meant(outcome):
        click.echo(_MEANT, err=wanted.printed is not None)
    if wanted.printed is not None:
        # Print the bytes that the file would have, whatever the encoding of the terminal is.
        click.echo(REPORTS[wanted.printed](outcome).encode(), nl=False)
    if wanted.github:
        for line in findings_as_commands(outcome.suite, reports, Path(os.environ.get("GITHUB_WORKSPACE") or ".")):
            click.echo(line)
    if page := write_reports(outcome, wanted.written):
        click.echo(f"wrote {quote(str(page))}: open it in a browser", err=True)
