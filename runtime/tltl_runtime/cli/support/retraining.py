"""``tltlc regress --retrain``: policies are trained on the levels that they do not play as designed any more."""

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
from tltl_runtime.regression.verdict.run import NOT_THE_CASE, Done
from tltl_runtime.training.run.record import ended_as, write_record
from tltl_runtime.training.run.run import RUN, Run
from tltlc.core.record import record, replace
from tltlc.diagnostics.diagnostic import TltlError
from tltlc.interfaces.cli.report import show

_NOT_THE_CASE: Final = NOT_THE_CASE | {"TLT0005"}
"""Codes of what is wrong with the workers, or with the folder."""


@record
class Retraining:
    """How cases are trained anew: for so many ``minutes`` each at the most, below the ``folder`` of the run.

    ``again`` is the command that goes on after a stop, but for its --minutes; ``fresh``: nothing that is kept counts.
    """

    suite: Suite
    folder: Path
    minutes: float
    pool: Pool
    again: str
    fresh: bool


def retrain_cases(asked: Retraining, found: list[Done], *, to_stderr: bool) -> None:
    """Train for each case that needs it, one after the other; what it came to is told at once, and put into ``found``.

    What is wrong with one case, such as a level that was edited meanwhile, is told on standard error, and the others go
    on.

    Raises:
        TltlError: TLT0942, a policy lies where a training goes; TLT0730, TLT0850 and TLT0852 of the workers; TLT0005.
    """
    for done in found:
        if why := done.useless_training:
            click.echo(plain(f"{done.report.name}: its policy is not trained further, since {why}"), err=True)
    runs = {
        row: retraining(asked.suite, ready, asked.folder, asked.minutes, asked.pool)
        for row, done in enumerate(found)
        if (ready := done.to_train)
    }
    if asked.fresh:
        # All at once, so that a run that is stopped goes on with fresh ones.
        for row, run in runs.items():
            with _one_case(found[row].report.name):
                _make_room(asked, found[row].report.name, run)
    for row, run in runs.items():
        done = found[row]
        with _one_case(done.report.name):
            _train(asked, done.report.name, run)
            outcome = _played(asked, done, run)
            found[row] = replace(done, report=replace(done.report, retrained=outcome))
            for line in _lines(asked, done.report.name, outcome):
                click.echo(plain(line), err=to_stderr)


@contextmanager
def _one_case(name: str) -> Iterator[None]:
    """Tell what is wrong with a case; raises TltlError for what would be wrong with the others, too."""
    try:
        with level_faults():
            yield
    except TltlError as error:
        if _NOT_THE_CASE & {each.code for each in error.diagnostics}:
            raise
        click.echo(f"{plain(name)}: nothing can be said of its training", err=True)
        show(error.diagnostics, "text", sys.stderr)


def _train(asked: Retraining, name: str, run: Run) -> None:
    """Train to the end, or go on, unless the training is over already."""
    there = (run.folder / RUN).exists()
    kept = there and is_kept(run)
    if kept and ended_as(run):
        return
    how = "goes on" if kept else "begins with its policy"
    other = "what is kept is of another level, policy, spec, seed or settings, or cannot be read"
    why = f", anew, since {other}" if there and not kept else ""
    limit = said_minutes(asked.minutes)
    click.echo(f"{plain(name)}: a training {how}{why}, for {limit} at the most, in {run.folder}", err=True)
    if there and not kept:
        _make_room(asked, name, run)
    write_record(run, train_shown(run, resume=kept, again=f"{asked.again} --minutes {asked.minutes:g}"))


def _make_room(asked: Retraining, name: str, run: Run) -> None:
    """Have the folder be free for a new training, and say where an earlier one is then."""
    if run.folder.is_dir() and (aside := make_room(asked.suite, run.folder)):
        click.echo(f"{plain(name)}: the training that was in {run.folder} is now in {aside}", err=True)


def _played(asked: Retraining, done: Done, run: Run) -> Retrained:
    """What the training came to, with how far its episodes are on standard error."""
    assert done.ready is not None
    case = replace(done.ready.case, name=f"{done.report.name}, trained anew")
    with RegressionDisplay("at most") as display:
        return retrained(asked.suite, done, run, asked.pool, lambda count, last: display(case, count, last))


def _lines(asked: Retraining, name: str, outcome: Retrained) -> Iterator[str]:
    """What a training came to, and what to do now."""
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
