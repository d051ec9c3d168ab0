"""Run a training to its end and show its progress on standard error."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import closing, contextmanager

from tltl_runtime.cli.support.training_display import display
from tltl_runtime.cli.support.training_text import kept_ways_text
from tltl_runtime.training.files.found_ways import WaysFile
from tltl_runtime.training.files.report import TrainingReport
from tltl_runtime.training.files.run_file import CHECKPOINT, RUN, TrainingRun
from tltl_runtime.training.run.train import train
from tltl_runtime.vector.errors import WorkerError
from tltlc.api import Diagnostic, TltlError


def train_with_display(run: TrainingRun, *, resume: bool, again: str, began: float | None = None) -> TrainingReport:
    """Train to the end, show the progress, and return the last report.

    ``again`` is the command that resumes a stopped training. The limit of minutes counts from
    ``began``, a time of ``time.perf_counter``; by default, from now.

    Raises:
        TltlError: TLT0871, a worker was lost; errors from training.
    """
    with _worker_errors(run, again), display(run, again) as progress:
        training = train(
            run,
            resume=resume,
            on_measuring=progress.show_measuring,
            on_plan=progress.show_plan,
            on_start=progress.show_start,
            on_made=progress.show_made,
            on_search=progress.show_search,
            on_attempt=progress.show_attempt,
            began=began,
        )
        with closing(training) as reports:
            for last in reports:
                progress.show_report(last)
        return last


def stopped_line(run: TrainingRun, again: str) -> str | None:
    """Say that Ctrl-C has stopped a training, and how to go on; None if the training had not started."""
    if not (run.folder / RUN).exists():
        return None
    if (run.folder / CHECKPOINT).exists():
        before = ""
    elif not run.settings.searches:
        before = " before the first iteration"
    elif kept := _kept_ways(run):
        before = f" during the search, which will go on {kept_ways_text(kept)}"
    else:
        before = " during the search, which will start again"
    return f"stopped{before}; to go on: {again}"


def _kept_ways(run: TrainingRun) -> int:
    """Return how many ways the first search of a training has kept; 0 if its level cannot be read any more."""
    try:
        ways = WaysFile(run).read()
    except TltlError:
        return 0
    return len(ways.demonstrations) if ways else 0


@contextmanager
def _worker_errors(run: TrainingRun, again: str) -> Iterator[None]:
    """Within this context, raise TltlError, TLT0871, if a worker process is lost.

    ``again`` is the command that resumes the training.
    """
    try:
        yield
    except WorkerError as error:
        causes = [str(error.loss), *error.loss.traceback.splitlines()[-1:]]
        played = [f"it played {playing}" for playing in error.playing if playing.busy]
        title = f"the training was interrupted: {': '.join(causes)}"
        proceed = "go on from the last checkpoint" if (run.folder / CHECKPOINT).exists() else "start again"
        own = [f"{diagnostic.help}\n" for diagnostic in error.loss.diagnostics if diagnostic.help]
        help_ = "".join(own) + "; ".join([*played, f"to {proceed}: {again}"])
        raise TltlError([Diagnostic("TLT0871", title, help=help_)]) from error
