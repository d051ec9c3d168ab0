"""``tltlc regress --retrain``: retrain policies on the levels that no longer play as designed."""

from __future__ import annotations

import sys
from collections.abc import Iterator
from contextlib import contextmanager
from math import ceil
from pathlib import Path
from shlex import quote
from typing import Final

import click

from tltl_runtime.cli.support.level_faults import level_faults
from tltl_runtime.cli.support.plain_text import plain_text
from tltl_runtime.cli.support.regression_display import RegressionDisplay
from tltl_runtime.cli.support.training_progress import train_with_display
from tltl_runtime.cli.support.training_text import minutes as minutes_text
from tltl_runtime.evaluation.evaluate import Pool
from tltl_runtime.regression.report.retraining_result import RetrainingResult
from tltl_runtime.regression.retrain.retrain import configure_retraining, is_stored, make_room, retraining_result
from tltl_runtime.regression.suite.suite import SHIPPED, Suite
from tltl_runtime.regression.suite_run import FinishedCase, is_error_of_workers
from tltl_runtime.regression.verdict.baseline import baseline_command
from tltl_runtime.training.files.record import finished_record, write_record
from tltl_runtime.training.files.run_file import RUN, TrainingRun
from tltlc.api import TltlError, cli, record, replace

_UNWRITABLE: Final = "TLT0005"
"""The code of the error about a file that cannot be written. It ends all retraining."""


@record
class Retraining:
    """The options of retraining.

    The training of each case takes at most ``minutes``. Its files go into a folder inside
    ``folder``, the folder of the run. ``again`` is the command that continues a stopped run,
    without --minutes. With ``fresh``, stored trainings are not reused.
    """

    suite: Suite
    folder: Path
    minutes: float
    pool: Pool
    again: str
    fresh: bool


def retrain_cases(options: Retraining, results: list[FinishedCase], *, to_stderr: bool) -> None:
    """Retrain the policy of each case that needs it; print each result and store it in ``results``.

    An error of one case, for example because its level was edited meanwhile, is printed to standard
    error, and the next case follows.

    Raises:
        TltlError: TLT0942, a policy of the suite lies in a folder that retraining needs; TLT0730, TLT0850
            and TLT0852, errors of the workers; TLT0005, a file cannot be written.
    """
    for case in results:
        if reason := case.training_obstacle:
            click.echo(plain_text(f"{case.report.name}: its policy is not trained further, because {reason}"), err=True)
    runs = {
        row: configure_retraining(options.suite, prepared, options.folder, options.minutes, options.pool)
        for row, case in enumerate(results)
        if (prepared := case.case_to_train)
    }
    if options.fresh:
        # Make room in all folders before the first training. If this run is stopped, its continuation then
        # finds no older trainings.
        for row, run in runs.items():
            with _case_errors(results[row].report.name):
                _make_room(options, results[row].report.name, run)
    for row, run in runs.items():
        case = results[row]
        with _case_errors(case.report.name):
            _train(options, case.report.name, run)
            result = _result(options, case, run)
            results[row] = replace(case, report=replace(case.report, retrained=result))
            for line in _lines(options, case.report.name, result):
                click.echo(plain_text(line), err=to_stderr)


@contextmanager
def _case_errors(name: str) -> Iterator[None]:
    """Within this context, print an error of the case ``name`` instead of raising it.

    Errors that affect all cases are raised.
    """
    try:
        with level_faults():
            yield
    except TltlError as error:
        if is_error_of_workers(error) or any(diagnostic.code == _UNWRITABLE for diagnostic in error.diagnostics):
            raise
        click.echo(f"{plain_text(name)}: its training gave no result", err=True)
        cli.show(error.diagnostics, "text", sys.stderr)


def _train(options: Retraining, name: str, run: TrainingRun) -> None:
    """Run the training of the case ``name`` to its end, unless it is already finished.

    A training that was stopped continues.
    """
    exists = (run.folder / RUN).exists()
    kept = exists and is_stored(run)
    if kept and finished_record(run):
        return
    verb = "continues" if kept else "starts from its policy"
    cause = "the earlier one is of another level, policy, spec, seed or settings, or cannot be read"
    reason = f" again, because {cause}" if exists and not kept else ""
    limit = minutes_text(options.minutes)
    click.echo(f"{plain_text(name)}: a training {verb}{reason}; it runs for at most {limit}, in {run.folder}", err=True)
    if exists and not kept:
        _make_room(options, name, run)
    write_record(run, train_with_display(run, resume=kept, again=f"{options.again} --minutes {options.minutes:g}"))


def _make_room(options: Retraining, name: str, run: TrainingRun) -> None:
    """Clear the folder of a new training, and print where an earlier training was moved."""
    if run.folder.is_dir() and (new_folder := make_room(options.suite, run.folder)):
        click.echo(f"{plain_text(name)}: the training that was in {run.folder} is now in {new_folder}", err=True)


def _result(options: Retraining, case: FinishedCase, run: TrainingRun) -> RetrainingResult:
    """Let the retrained policy of a case play, and return the result; show progress on standard error."""
    assert case.prepared is not None
    shown_case = replace(case.prepared.case, name=f"{case.report.name}, retrained")
    with RegressionDisplay("at most") as display:
        return retraining_result(
            options.suite, case, run, options.pool, lambda count, last: display(shown_case, count, last)
        )


def _lines(options: Retraining, name: str, result: RetrainingResult) -> Iterator[str]:
    """Yield the lines that describe the result of a training and what the user can do next."""
    yield f"{name}, retrained: {result.text}"
    policy = quote(str(options.folder / result.policy))
    if result.outcome != "learned":
        if result.trained.end == "minutes":
            longer = 2 * max(options.minutes, result.trained.seconds / 60)
            longer = ceil(longer) if longer > 1 else round(longer, 2)
            yield f"    to train longer: {options.again} --minutes {longer:g}"
    elif options.suite.path == SHIPPED:
        yield f"    the new policy: {policy}"
    else:
        then = baseline_command(options.suite)
        copy = f"copy {policy} next to the suite, name it there as `policy`"
        yield f"    if you intended the change: {copy}, then: {then}"
    if result.episode:
        yield f"    an episode that met the spec: tltlc replay {quote(str(options.folder / result.episode))}"
