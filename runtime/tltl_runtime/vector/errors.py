"""Errors and reports about lost workers."""

from __future__ import annotations

import signal
from typing import Final

from tltlc.api import Diagnostic, record

_NO_MAIN_GUARD: Final = (
    "it ended before it made them: a worker first imports the program, so put the work of the program under",
    '`if __name__ == "__main__":`, and put the program into a file (python program.py, not python < program.py)',
)
"""A hint for the report on a worker that ended before it had made its environments.

The likely cause is that the worker could not import the main module.
"""


@record
class Playing:
    """The episode that an environment was playing when its worker was lost.

    ``env`` is the index of the environment, and ``name`` its name. To get the same episode again,
    reset the environment with ``seed``, then ``episode`` - 1 times without a seed. ``seed`` is None
    if the environment was not reset yet. ``busy`` says whether the environment was in a reset or a
    step when the worker was lost. ``step`` is the number of that step or, if there was none, of the
    last finished step.
    """

    env: int
    name: str
    seed: int | None
    episode: int
    step: int
    busy: bool

    def __str__(self) -> str:
        seed = "not reset yet" if self.seed is None else f"seed {self.seed}, episode {self.episode}, step {self.step}"
        return f"env {self.env}: {self.name}, {seed}" + (" (at work)" if self.busy else "")


@record
class Loss:
    """The loss of a worker: which worker, and how it ended.

    ``worker`` is the index of the worker. ``status`` is the exit status of its process; if it is
    negative, the signal ``-status`` ended the process. It is None for an actor of Ray, and for a
    process that had to be killed. ``silent`` is the number of seconds for which the worker was silent
    before it was killed; None if it was lost in another way. ``traceback`` belongs to the exception
    that ended the worker, and ``diagnostics`` are those of this exception, if it is a TltlError; both are
    empty if there was none. ``starting`` says that the worker had not made its environments yet.
    """

    worker: int
    status: int | None = None
    silent: float | None = None
    traceback: str = ""
    starting: bool = False
    diagnostics: tuple[Diagnostic, ...] = ()

    def __str__(self) -> str:
        if self.silent is not None:
            return f"worker {self.worker} was silent for {self.silent:g} s, and was killed"
        if self.traceback:
            return f"worker {self.worker} ended with an exception"
        if self.status is None:
            return f"worker {self.worker} closed its connection without ending, and was killed"
        if self.status < 0:
            return f"worker {self.worker} was killed by {_signal_name(-self.status)}"
        return f"worker {self.worker} ended with exit status {self.status}"


class WorkerError(RuntimeError):
    """Raised if a worker is lost. ``loss`` says how, and ``playing`` what its environments were playing."""

    def __init__(self, loss: Loss, playing: tuple[Playing, ...]) -> None:
        super().__init__(report(loss, playing))
        self.loss, self.playing = loss, playing


def report(loss: Loss, playing: tuple[Playing, ...]) -> str:
    """Return the report on a lost worker, as text.

    It has a line for the worker, a line for each environment, and the traceback or a likely cause.
    """
    lines = [f"{loss}; its environments were", *(f"  {env}" for env in playing), *loss.traceback.splitlines()]
    if loss.starting and loss.status and not loss.traceback:
        lines += _NO_MAIN_GUARD
    return "\n".join(lines)


def _signal_name(number: int) -> str:
    try:
        return signal.Signals(number).name
    except ValueError:
        return f"signal {number}"
