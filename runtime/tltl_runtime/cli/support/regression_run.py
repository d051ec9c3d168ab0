"""``tltlc regress``: play cases, retrain policies if requested, and report."""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from contextlib import closing
from pathlib import Path
from shlex import join, quote
from typing import Final

import click

from tltl_runtime.cli.support.plain_text import plain_text
from tltl_runtime.cli.support.regression_display import RegressionDisplay
from tltl_runtime.cli.support.regression_files import REPORTS, SuiteRun, write_reports
from tltl_runtime.cli.support.regression_text import report_lines, summary_line
from tltl_runtime.cli.support.trace_options import spec_label, threshold_option
from tltl_runtime.cli.support.writable_paths import check_apart, check_no_training, check_writable, is_standard_output
from tltl_runtime.evaluation.evaluate import Pool
from tltl_runtime.regression.report.github import workflow_commands
from tltl_runtime.regression.suite.dependencies import Selection, files_of, select
from tltl_runtime.regression.suite.suite import DEFAULT_ERROR, SHIPPED, Case, Suite, SuiteCase, played, read_suite
from tltl_runtime.regression.suite.thresholds import Thresholds
from tltl_runtime.regression.suite.trace_case import TraceCase
from tltl_runtime.regression.suite_run import FinishedCase, check_references, lock_run, regress
from tltl_runtime.regression.verdict.baseline import Reference, baseline_of
from tltl_runtime.regression.verdict.unnamed_changes import unnamed_changes
from tltl_runtime.spec.task import read_spec
from tltl_runtime.support.number_text import short_list
from tltl_runtime.support.path_text import path_text
from tltlc.api import Diagnostic, TltlError, cli, fileio, record, replace, traces, workflow_command

_MOST_NAMED: Final = 8
"""The most files that a message names."""
_EXPECTED_NOTE: Final = "v1 and v2 of the shipped levels are changed on purpose: see the page"


@record
class RegressOptions:
    """The options of ``tltlc regress``.

    With ``--spec``, ``spec`` judges the recorded traces ``now``, and ``baseline`` has the traces to
    compare them with; there is no suite. ``judged_as`` is ``episodes`` or ``traces``. ``thresholds`` are
    the thresholds that options set. ``changed`` are the files that ``--changed`` names; None without
    this option. ``folder`` is the folder of the run. ``files`` maps the option of each requested report,
    such as ``--json``, to the file to write. ``minutes`` limits the retraining of each case that does
    not pass; None means no retraining. A value that was not given is None.
    """

    suite: Path | None
    spec: str | None
    now: Path | None
    judged_as: str | None
    thresholds: Mapping[str, float]
    changed: tuple[str, ...] | None
    folder: Path
    files: Mapping[str, Path]
    github: bool
    fresh: bool
    workers: Pool
    baseline: Path | None
    minutes: float | None

    @property
    def printed_option(self) -> str | None:
        """The option whose report goes to standard output, such as ``--json``; None if the text goes there."""
        return next((option for option, path in self.files.items() if is_standard_output(path)), None)

    @property
    def report_files(self) -> dict[str, Path]:
        """The files to write, by the options of their reports; standard output is left out."""
        return {option: path for option, path in self.files.items() if not is_standard_output(path)}


def run(options: RegressOptions) -> int:
    """Judge the requested cases, report on them, and return the exit status.

    On KeyboardInterrupt or an error, report on the finished cases and raise the exception again.

    Raises:
        TltlError: TLT0005, a file cannot be written; TLT0942, a policy of the suite lies in a folder that
            retraining needs; errors from reading the suite, playing and training.
    """
    check_no_training(options.folder)
    check_writable(options.report_files)
    suite = _suite(options)
    check_apart(options.report_files, files_of(suite))
    selection = _select_cases(suite, options)
    cases, left_out = selection.cases, tuple(case.name for case in selection.left_out)
    if options.minutes is not None:
        # Retraining needs torch; judging does not.
        from tltl_runtime.regression.retrain.retrain import check_policy_folders

        check_policy_folders(suite, played(cases), options.folder)
    references = _references(suite, played(cases))
    _warn_unnamed(suite, selection.left_out, references)
    check_references(suite, cases, references)
    results: list[FinishedCase] = []
    with lock_run(options.folder):
        try:
            try:
                _play(suite, cases, references, options, results)
            finally:
                _print_cases(suite, options, results)
            _retrain(suite, options, results)
        except BaseException as error:
            if isinstance(error, KeyboardInterrupt):
                _print_stopped(options, results, len(cases))
            _report_after_error(_outcome(suite, cases, left_out, options, results), options)
            raise
        _report(_outcome(suite, cases, left_out, options, results), options)
    return cli.exits.CLEAN if all(case.report.verdict == "pass" for case in results) else cli.exits.FINDINGS


def _suite(options: RegressOptions) -> Suite:
    """Return the suite that the options name; for ``--spec``, a suite with a single case.

    Raises:
        TltlError: the suite or the spec cannot be read; TLT0001, a path does not exist or has no trace.
        UsageError: an option has no effect on this suite.
    """
    if options.spec is None:
        suite = read_suite(options.suite or SHIPPED, options.baseline)
        _check_has_played_cases(suite, options)
        return suite
    assert options.now is not None
    assert options.baseline is not None
    read_spec(options.spec)
    file, _ = fileio.split_spec_name(options.spec)
    for option, path in (("--now", options.now), ("--baseline", options.baseline)):
        if not fileio.exists(path):
            title, help_ = (
                f"there is no `{path_text(path)}`",
                f"name a recorded trace, or a folder of them, with {option}",
            )
            raise TltlError([Diagnostic("TLT0001", title, help=help_)])
        if errors := traces.find_traces([str(path)]).errors:
            raise TltlError(errors)
    case = TraceCase(
        name=spec_label(options.spec),
        spec=options.spec,
        traces=(str(options.now),),
        baseline=(str(options.baseline),),
        thresholds=Thresholds(**options.thresholds),
        as_episodes=options.judged_as != "traces",
    )
    return Suite(Path(file), 0, DEFAULT_ERROR, (case,), options.baseline)


def _check_has_played_cases(suite: Suite, options: RegressOptions) -> None:
    """Raise UsageError for an option that has no effect because all cases of the suite are recorded traces."""
    given = {"--baseline": options.baseline is not None, "--retrain": options.minutes is not None}
    if not suite.played_cases and (used := next((name for name, is_given in given.items() if is_given), None)):
        why = "no policy plays in this suite: all of its cases are recorded traces"
        raise click.UsageError(f"{used} has no effect, because {why}")


def _select_cases(suite: Suite, options: RegressOptions) -> Selection:
    """Select the cases to judge; print to standard error which ones are left out."""
    if options.changed is None:
        return Selection(suite.cases)
    selection = select(suite, options.changed)
    if selection.unknown:
        click.echo(f"no case depends on {plain_text(short_list(selection.unknown, _MOST_NAMED))}", err=True)
    for name, suggestion in selection.suggestions:
        message = plain_text(f"there is no file `{name}`: did you mean `{suggestion}`?")
        click.echo(f"warning: {message}", err=True)
        if options.github:
            click.echo(workflow_command("warning", message, {"title": "--changed"}))
    if selection.left_out:
        names = plain_text(", ".join(case.name for case in selection.left_out))
        depends = "it depends" if len(selection.left_out) == 1 else "they depend"
        click.echo(f"left out, because {depends} on none of the named files: {names}", err=True)
    return selection


def _references(suite: Suite, cases: Sequence[Case]) -> tuple[Reference, ...]:
    """Return the references (recorded episodes) of the suite's baseline.

    If the baseline cannot be read, but there are no ``cases`` to play, the result is empty.

    Raises:
        TltlError: the errors of reading the baseline, if there are cases to play.
    """
    try:
        return baseline_of(suite)
    except TltlError:
        if cases:
            raise
        return ()


def _warn_unnamed(suite: Suite, left_out: Sequence[SuiteCase], references: tuple[Reference, ...]) -> None:
    """Warn about files that have changed since the baseline, but that ``--changed`` does not name."""
    for name, cases in unnamed_changes(suite, left_out, references).items():
        names = plain_text(short_list(cases, _MOST_NAMED))
        message = (
            f"`{plain_text(name)}` has changed since the baseline, but --changed does not name it; left out: {names}"
        )
        click.echo(f"warning: {message}", err=True)


def _play(
    suite: Suite,
    cases: Sequence[SuiteCase],
    references: tuple[Reference, ...],
    options: RegressOptions,
    results: list[FinishedCase],
) -> None:
    """Judge the cases; add each finished case to ``results``, and print its verdict to standard error."""
    with (
        RegressionDisplay("at most") as display,
        closing(
            regress(
                suite,
                cases,
                references,
                options.folder,
                options.workers,
                display,
                display.show_traces,
                fresh=options.fresh,
            )
        ) as finished_cases,
    ):
        for case in finished_cases:
            results.append(case)
            display.show_verdict(case.report.name, case.report.verdict)
            if case.traces is not None and (others := (*case.traces.now.others, *case.traces.before.others)):
                names = plain_text(short_list(others, _MOST_NAMED))
                click.echo(f"{plain_text(case.report.name)}: not traces, by their names: {names}", err=True)


def _print_cases(suite: Suite, options: RegressOptions, results: Sequence[FinishedCase]) -> None:
    """Print the result of the suite in a sentence, and the lines of each finished case, failures first."""
    for line in report_lines(results, len(suite.cases) - len(results)):
        click.echo(line, err=options.printed_option is not None)


def _retrain(suite: Suite, options: RegressOptions, results: list[FinishedCase]) -> None:
    """Retrain the policies of the cases in ``results`` that do not pass, if ``--retrain`` is given."""
    if options.minutes is not None:
        from tltl_runtime.cli.support.retraining import Retraining, retrain_cases

        resume_command = join([*_resume_words(options), "--retrain"])
        retraining = Retraining(suite, options.folder, options.minutes, options.workers, resume_command, options.fresh)
        retrain_cases(retraining, results, to_stderr=options.printed_option is not None)


def _untrained_count(options: RegressOptions, results: list[FinishedCase]) -> int:
    """Return the number of cases whose retraining is requested but not finished."""
    return 0 if options.minutes is None else sum(case.case_to_train is not None for case in results)


def _resume_words(options: RegressOptions) -> list[str]:
    """Return the words of the command that continues a run, without --retrain and --minutes."""
    values = {
        "--spec": options.spec,
        "--now": options.now,
        "--out": options.folder,
        "--baseline": options.baseline,
        **{option: options.files.get(option) for option in REPORTS},
        "--workers": options.workers or None,
    }
    words = ["tltlc", "regress", *([str(options.suite)] if options.suite else [])]
    for name, value in values.items():
        words += [] if value is None else [name, str(value)]
    words += [] if options.judged_as is None else ["--judged-as", options.judged_as]
    words += [word for name, value in options.thresholds.items() for word in (threshold_option(name), repr(value))]
    words += ["--github"] if options.github else []
    return words if options.changed is None else [*words, "--changed", *options.changed]


def _print_stopped(options: RegressOptions, results: list[FinishedCase], cases: int) -> None:
    """Print the progress of a stopped run and the command that continues it."""
    words = _resume_words(options)
    if options.minutes is not None:
        words += ["--retrain", "--minutes", f"{options.minutes:g}"]
    progress = f"{len(results)} of {cases} cases are judged and kept"
    if len(results) == cases and (untrained := _untrained_count(options, results)):
        progress = f"all cases are judged, but {untrained} still need{'s' * (untrained == 1)} a training"
    click.echo(f"stopped: {progress}; to go on: {join(words)}", err=True)


def _outcome(
    suite: Suite,
    cases: Sequence[SuiteCase],
    left_out: tuple[str, ...],
    options: RegressOptions,
    results: list[FinishedCase],
) -> SuiteRun:
    """Return the outcome of the run so far."""
    missing = tuple(case.name for case in cases[len(results) :])
    complete = not missing and not _untrained_count(options, results)
    return SuiteRun(suite, options.folder, tuple(results), complete, left_out, missing, options.changed or ())


def _report_after_error(outcome: SuiteRun, options: RegressOptions) -> None:
    """Report on a run that an error has ended.

    If the report fails, too, print that error and raise nothing, because the caller raises the error
    that ended the run.
    """
    try:
        _report(outcome, options)
    except Exception as error:
        cli.exits.report(error)


def _are_expected(outcome: SuiteRun) -> bool:
    """Whether cases do not pass, and all of these play another variant than their baseline.

    Such cases are expected not to pass.
    """
    findings = {case.report.name for case in outcome.cases if case.report.verdict != "pass"}
    return bool(findings) and all(
        not case.plays_reference for case in outcome.suite.played_cases if case.name in findings
    )


def _report(outcome: SuiteRun, options: RegressOptions) -> None:
    """Print the summary and write the requested reports; show how many films of the page are drawn."""
    with RegressionDisplay() as display:
        _write_and_print(replace(outcome, on_film=display.show_films), options, display)


def _write_and_print(outcome: SuiteRun, options: RegressOptions, display: RegressionDisplay) -> None:
    reports = [case.report for case in outcome.cases]
    click.echo(summary_line(reports, outcome.missing), err=options.printed_option is not None)
    if outcome.suite.path == SHIPPED and _are_expected(outcome):
        click.echo(_EXPECTED_NOTE, err=options.printed_option is not None)
    if options.printed_option is not None:
        # Print the bytes that the file would have, whatever the encoding of the terminal is.
        text = REPORTS[options.printed_option](outcome)
        display.clear()
        click.echo(text.encode(), nl=False)
    if options.github:
        root = Path(os.environ.get("GITHUB_WORKSPACE") or ".")
        not_judged = len(outcome.missing) + len(outcome.left_out)
        for line in workflow_commands(outcome.suite, reports, root, not_judged):
            click.echo(line)
    page = write_reports(outcome, options.report_files)
    display.clear()
    if page:
        click.echo(f"wrote {quote(str(page))}: open it in a browser", err=True)
