"""A training to its end, with how it goes on standard error."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import closing, contextmanager

from tltl_runtime.cli.support.training_display import display
from tltl_runtime.training.run.report import Report
from tltl_runtime.training.run.run import CHECKPOINT, RUN, Run
from tltl_runtime.training.run.train import train
from tltl_runtime.vector.errors import WorkerError
from tltlc.diagnostics.diagnostic import Diagnostic, TltlError


def train_shown(run: Run, *, resume: bool, again: str) -> Report:
    """Train to the end, showing how it goes; the last report.  ``again`` is the command that goes on after a stop.

    Raises:
        TltlError: TLT0871, a worker was lost; what training raises.
    """
    with _broken_off(again), display(run, again) as shown:
        training = train(run, resume=resume, searching=shown.searched, recording=shown.recorded)
        with closing(training) as reports:
            for last in reports:
                shown.trained(last)
        return last


def stopped_line(run: Run, again: str) -> str | None:
    """What is told of a training that Ctrl-C has stopped; None where it had not begun."""
    if not (run.folder / RUN).exists():
        return None
    before = "in the search, which then begins anew" if run.settings.searches else "before the first iteration"
    return f"stopped{'' if (run.folder / CHECKPOINT).exists() else f' {before}'}; to go on: {again}"


@contextmanager
def _broken_off(again: str) -> Iterator[None]:
    """TLT0871 where a worker is lost."""
    try:
        yield
    except WorkerError as error:
        why = [str(error.loss), *error.loss.traceback.splitlines()[-1:]]
        played = [f"it played {each}" for each in error.playing if each.busy]
        title = f"the training broke off: {': '.join(why)}"
        help_ = "; ".join([*played, f"to go on from the last checkpoint: {again}"])
        raise TltlError([Diagnostic("TLT0871", title, help=help_)]) from error
