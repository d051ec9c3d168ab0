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
from tltl_runtime.cli.support.printable import plain
from tltl_runtime.cli.support.regression_display import RegressionDisplay
from tltl_runtime.cli.support.training_progress import train_shown
from tltl_runtime.cli.support.training_text import minutes as said_minutes
from tltl_runtime.evaluation.evaluate import Pool
from tltl_runtime.regression.retrain.retrain import is_kept, make_room, retrained, retraining
from tltl_runtime.regression.retrain.retrained import Retrained
from tltl_runtime.regression.suite.suite import SHIPPED, Suite
from tltl_runtime.regression.verdict.baseline import baseline_command
from tltl_runtime.regression.verdict.suite_run import NOT_THE_CASE, Done
from tltl_runtime.training.run.record import finished_record, write_record
from tltl_runtime.training.run.run_file import RUN, TrainingRun
from tltlc.api import TltlError, cli, record, replace

_NOT_THE_CASE: Final = NOT_THE_CASE | {"TLT0005"}
"""Codes of errors of the workers or of the folder, which are no faults of a case."""


@record
class Retraining:
    """The options of retraining: at most ``minutes`` for each case, below the ``folder`` of the run.

    ``again`` is the command that continues a stopped run, without --minutes.  With ``fresh``, stored
    trainings are not reused.
    """

    suite: Suite
    folder: Path
    minutes: float
    pool: Pool
    again: str
    fresh: bool


def retrain_cases(asked: Retraining, results: list[Done], *, to_stderr: bool) -> None:
    """Train for each case that needs it; print each result at once and store it in ``results``.

    Errors of one case, for example a level that was edited meanwhile, are printed to standard error, and
    the next case continues.

    Raises:
        TltlError: TLT0942, a policy lies in the folder of a training; TLT0730, TLT0850 and TLT0852,
            errors of the workers; TLT0005, a file cannot be written.
    """
    for done in results:
        if why := done.useless_training:
            click.echo(plain(f"{done.report.name}: its policy is not trained further, since {why}"), err=True)
    runs = {
        row: retraining(asked.suite, ready, asked.folder, asked.minutes, asked.pool)
        for row, done in enumerate(results)
        if (ready := done.to_train)
    }
    if asked.fresh:
        # Clear all folders first, so that a stopped run does not continue with old trainings.
        for row, run in runs.items():
            with _one_case(results[row].report.name):
                _make_room(asked, results[row].report.name, run)
    for row, run in runs.items():
        done = results[row]
        with _one_case(done.report.name):
            _train(asked, done.report.name, run)
            outcome = _played(asked, done, run)
            results[row] = replace(done, report=replace(done.report, retrained=outcome))
            for line in _lines(asked, done.report.name, outcome):
                click.echo(plain(line), err=to_stderr)


@contextmanager
def _one_case(name: str) -> Iterator[None]:
    """Print errors of a case; raise TltlError for errors that affect all cases."""
    try:
        with level_faults():
            yield
    except TltlError as error:
        if _NOT_THE_CASE & {diagnostic.code for diagnostic in error.diagnostics}:
            raise
        click.echo(f"{plain(name)}: nothing can be said of its training", err=True)
        cli.show(error.diagnostics, "text", sys.stderr)


def _train(asked: Retraining, name: str, run: TrainingRun) -> None:
    """Start or continue the training to its end, unless it is already finished."""
    exists = (run.folder / RUN).exists()
    kept = exists and is_kept(run)
    if kept and finished_record(run):
        return
    verb = "goes on" if kept else "begins with its policy"
    cause = "what is kept is of another level, policy, spec, seed or settings, or cannot be read"
    reason = f", anew, since {cause}" if exists and not kept else ""
    limit = said_minutes(asked.minutes)
    click.echo(f"{plain(name)}: a training {verb}{reason}, for {limit} at the most, in {run.folder}", err=True)
    if exists and not kept:
        _make_room(asked, name, run)
    write_record(run, train_shown(run, resume=kept, again=f"{asked.again} --minutes {asked.minutes:g}"))


def _make_room(asked: Retraining, name: str, run: TrainingRun) -> None:
    """Make room for a new training, and print where an earlier one was moved."""
    if run.folder.is_dir() and (moved_to := make_room(asked.suite, run.folder)):
        click.echo(f"{plain(name)}: the training that was in {run.folder} is now in {moved_to}", err=True)


def _played(asked: Retraining, done: Done, run: TrainingRun) -> Retrained:
    """Return the result of the training, showing the progress of its episodes on standard error."""
    assert done.ready is not None
    case = replace(done.ready.case, name=f"{done.report.name}, trained anew")
    with RegressionDisplay("at most") as display:
        return retrained(asked.suite, done, run, asked.pool, lambda count, last: display(case, count, last))


def _lines(asked: Retraining, name: str, outcome: Retrained) -> Iterator[str]:
    """The result of a training and the next steps, as lines."""
    yield f"{name}, trained anew: {outcome.text}"
    policy = quote(str(asked.folder / outcome.policy))
    if outcome.outcome != "learned":
        if outcome.trained.end == "minutes":
            longer = 2 * max(asked.minutes, outcome.trained.seconds / 60)
            longer = ceil(longer) if longer > 1 else round(longer, 2)
            yield f"    to train longer: {asked.again} --minutes {longer:g}"
    elif asked.suite.path == SHIPPED:
        yield f"    the new policy: {policy}"
    else:
        then = baseline_command(asked.suite)
        yield f"    where the change was meant: copy {policy} beside the suite, name it there as `policy`, then: {then}"
    if outcome.episode:
        yield f"    an episode that met the spec: tltlc replay {quote(str(asked.folder / outcome.episode))}"
