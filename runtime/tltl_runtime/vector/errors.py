"""What is said of a worker that is lost."""

from __future__ import annotations

import signal
from typing import Final

from tltlc.core.record import record

_UNGUARDED: Final = (
    "it ended before it made them: a worker begins by importing the program, so what the program does stands under",
    '`if __name__ == "__main__":`, and the program in a file (python program.py, not python < program.py)',
)
"""The two ways in which a main module cannot be imported."""


@record
class Playing:
    """What an environment was playing when its worker was lost.

    The same episode: reset the environment with ``seed`` (None: it was not reset yet), then ``episode`` - 1 times
    without one.  ``step`` is the step of the episode that was being taken, or the last that was.  ``busy``: it was at
    work.
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
    """How a worker was lost: it ended with ``status`` (negative: that signal), or was ``silent`` for so many seconds.

    ``traceback`` is that of the exception which ended it, if one did; ``starting``: its environments were not made yet.
    """

    worker: int
    status: int | None = None
    silent: float | None = None
    traceback: str = ""
    starting: bool = False

    def __str__(self) -> str:
        if self.silent is not None:
            return f"worker {self.worker} was silent for {self.silent:g} s, and was killed"
        if self.traceback:
            return f"worker {self.worker} ended with an exception"
        if self.status is not None and self.status < 0:
            return f"worker {self.worker} was killed by {_signal_name(-self.status)}"
        return f"worker {self.worker} ended with exit status {self.status}"


class WorkerError(RuntimeError):
    """A worker was lost: how (``loss``), and what its environments were playing (``playing``)."""

    def __init__(self, loss: Loss, playing: tuple[Playing, ...]) -> None:
        super().__init__(report(loss, playing))
        self.loss, self.playing = loss, playing


def report(loss: Loss, playing: tuple[Playing, ...]) -> str:
    """The loss in words: a line for it, one for each environment, and the traceback, or what may be the matter."""
    lines = [f"{loss}; it had", *(f"  {each}" for each in playing), *loss.traceback.splitlines()]
    if loss.starting and loss.status and not loss.traceback:
        lines += _UNGUARDED
    return "\n".join(lines)


def _signal_name(number: int) -> str:
    try:
        return signal.Signals(number).name
    except ValueError:
        return f"signal {number}"
