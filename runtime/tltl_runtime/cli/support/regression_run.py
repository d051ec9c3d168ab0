"""What ``tltlc regress`` does: cases are played, trained for where this is asked for, and reported on."""

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
from tltl_runtime.cli.support.regression_files import REPORTS, Outcome, write_reports
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
from tltl_runtime.regression.verdict.run import Done, check, owned, regress
from tltl_runtime.support.number_text import listed
from tltlc.core.record import record
from tltlc.diagnostics.diagnostic import TltlError
from tltlc.diagnostics.formats.github import workflow_command
from tltlc.interfaces.cli import exits

_MOST_NAMED: Final = 8
"""Of the files on which no case depends, as many are named."""
_MEANT: Final = "v1 and v2 of the shipped levels are changed on purpose: see the page"


@record
class Wanted:
    """What was asked for: the suite as it was named, where its files go, and how it is played.

    ``files`` are those of reports, by their options, ``folder`` is that of the run.  Of a training for each case that
    does not pass, ``minutes`` are the most; None: none is trained.
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
        """The option of the report for which alone standard output is, in place of the text; None: it is for that."""
        return next((option for option, path in self.files.items() if is_output(path)), None)

    @property
    def written(self) -> dict[str, Path]:
        """The files of reports; standard output is none."""
        return {option: path for option, path in self.files.items() if not is_output(path)}


def run(wanted: Wanted) -> int:
    """Judge the cases that are asked for, and report on them; the exit status.

    Where it is asked to end, or an error ends it, it reports on what there is, and KeyboardInterrupt or the error goes
    on.

    Raises:
        TltlError: TLT0005, a file cannot be written; TLT0942, a policy lies where a training goes; what reading the
            suite, playing and training raise.
    """
    check_no_training(wanted.folder)
    check_writable(wanted.written)
    suite = read_suite(wanted.suite or SHIPPED, wanted.baseline)
    check_apart(wanted.written, files_of(suite))
    chosen = _chosen(suite, wanted)
    cases, left_out = chosen.cases, tuple(case.name for case in chosen.left_out)
    if wanted.minutes is not None:
        check_places(suite, cases, wanted.folder)
    references = _references(suite, cases)
    _tell_unnamed(suite, chosen.left_out, references)
    check(suite, cases, references)
    found: list[Done] = []
    with owned(wanted.folder):
        try:
            _play(suite, cases, references, wanted, found)
            _retrain(suite, wanted, found)
        except BaseException as error:
            if isinstance(error, KeyboardInterrupt):
                _stopped(wanted, found, len(cases))
            _tell_too(_outcome(suite, cases, left_out, wanted, found), wanted)
            raise
        _tell(_outcome(suite, cases, left_out, wanted, found), wanted)
    return exits.CLEAN if all(done.report.verdict == "pass" for done in found) else exits.FINDINGS


def _chosen(suite: Suite, wanted: Wanted) -> Selection:
    """The cases to be judged, and those that are left out, which standard error tells."""
    if wanted.changed is None:
        return Selection(suite.cases)
    found = select(suite, wanted.changed)
    if found.unknown:
        click.echo(f"no case depends on {plain(listed(found.unknown, _MOST_NAMED))}", err=True)
    for name, meant in found.slips:
        said = plain(f"there is no file `{name}`: did you mean `{meant}`?")
        click.echo(f"warning: {said}", err=True)
        if wanted.github:
            click.echo(workflow_command("warning", said, {"title": "--changed"}))
    if found.left_out:
        names = plain(", ".join(case.name for case in found.left_out))
        click.echo(f"left out, since none of the named files concerns them: {names}", err=True)
    return found


def _references(suite: Suite, cases: Sequence[Case]) -> tuple[Reference, ...]:
    """The baseline, without which nothing can be played."""
    try:
        return baseline_of(suite)
    except TltlError:
        if cases:
            raise
        return ()


def _tell_unnamed(suite: Suite, left_out: Sequence[Case], references: tuple[Reference, ...]) -> None:
    """Warn of files that have changed, and of which nobody said so."""
    for name, cases in unnamed(suite, left_out, references).items():
        of = plain(listed(cases, _MOST_NAMED))
        said = (
            f"`{plain(name)}` has changed since the baseline, and is not among the files that are named; left out: {of}"
        )
        click.echo(f"warning: {said}", err=True)


def _play(
    suite: Suite, cases: Sequence[Case], references: tuple[Reference, ...], wanted: Wanted, found: list[Done]
) -> None:
    """Play the cases; each that is over is told at once, and added to ``found``."""
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
                click.echo(line, err=wanted.printed is not None)


def _retrain(suite: Suite, wanted: Wanted, found: list[Done]) -> None:
    """Train for the cases in ``found`` that do not pass, where this is asked for."""
    if wanted.minutes is not None:
        again = join([*_again(wanted), "--retrain"])
        asked = Retraining(suite, wanted.folder, wanted.minutes, wanted.workers, again, wanted.fresh)
        retrain_cases(asked, found, to_stderr=wanted.printed is not None)


def _untrained(wanted: Wanted, found: list[Done]) -> int:
    """For how many cases a training is asked for that is not over."""
    return 0 if wanted.minutes is None else sum(done.to_train is not None for done in found)


def _again(wanted: Wanted) -> list[str]:
    """The words of the command that goes on with a run, but for --retrain and its --minutes."""
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


def _stopped(wanted: Wanted, found: list[Done], cases: int) -> None:
    """Say what is left of a run that was ended, and what goes on with it."""
    words = _again(wanted)
    if wanted.minutes is not None:
        words += ["--retrain", "--minutes", f"{wanted.minutes:g}"]
    done = f"{len(found)} of {cases} cases are judged, and kept"
    if len(found) == cases and (left := _untrained(wanted, found)):
        done = f"all cases are judged, and {left} {'are' if left > 1 else 'is'} still to be trained for"
    click.echo(f"stopped: {done}; to go on: {join(words)}", err=True)


def _outcome(
    suite: Suite, cases: Sequence[Case], left_out: tuple[str, ...], wanted: Wanted, found: list[Done]
) -> Outcome:
    """What the run has come to so far."""
    missing = tuple(case.name for case in cases[len(found) :])
    complete = not missing and not _untrained(wanted, found)
    return Outcome(suite, wanted.folder, tuple(found), complete, left_out, missing, wanted.changed or ())


def _tell_too(outcome: Outcome, wanted: Wanted) -> None:
    """Tell of a run that an error has ended, which is not to be hidden by what goes wrong now, too."""
    try:
        _tell(outcome, wanted)
    except Exception as error:
        exits.report(error)


def _are_meant(outcome: Outcome) -> bool:
    """Whether there are findings, and all of variants that were changed."""
    found = {done.report.name for done in outcome.cases if done.report.verdict != "pass"}
    return bool(found) and all(case.variant != case.reference for case in outcome.suite.cases if case.name in found)


def _tell(outcome: Outcome, wanted: Wanted) -> None:
    """Sum up, and write what was asked for."""
    reports = [done.report for done in outcome.cases]
    click.echo(sum_line(reports, outcome.missing), err=wanted.printed is not None)
    if outcome.suite.path == SHIPPED and _are_meant(outcome):
        click.echo(_MEANT, err=wanted.printed is not None)
    if wanted.printed is not None:
        # The bytes of the file that it would be, whatever the letters of the terminal.
        click.echo(REPORTS[wanted.printed](outcome).encode(), nl=False)
    if wanted.github:
        for line in findings_as_commands(outcome.suite, reports, Path(os.environ.get("GITHUB_WORKSPACE") or ".")):
            click.echo(line)
    if page := write_reports(outcome, wanted.written):
        click.echo(f"wrote {quote(str(page))}: open it in a browser", err=True)
