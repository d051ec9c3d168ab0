"""Episodes spread over workers, and their results in order."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import FIRST_COMPLETED, Future, wait
from typing import Protocol

from tltl_runtime.evaluation.play import episode_seed
from tltl_runtime.evaluation.player import CHOICES, Result, Task
from tltlc.diagnostics.diagnostic import Diagnostic, TltlError


class LostError(Exception):
    """A worker ended in the middle of its work; the message says how."""


class Worker(Protocol):
    """Who plays one episode at a time, somewhere."""

    def play(self, task: Task) -> Future[Result]:
        """Begin an episode; the future raises what the game raised, or :class:`LostError`."""

    def close(self) -> None:
        """Free what there is to free."""


Alone = Callable[[Task], str]
"""The command that plays one episode alone."""


def spread(workers: Sequence[Worker], tasks: Sequence[Task], seed: int, alone: Alone | None = None) -> Iterator[Result]:
    """Have the workers play, each the next task as soon as it is free; results in the order of the tasks.

    Where a task fails, the results that are there already come before the error, and those of others may be missing
    among them.

    Raises:
        TltlError: TLT0850, a worker was lost; it says which episode of the evaluation's ``seed`` it played.
    """
    left = iter(enumerate(tasks))
    running: dict[Future[Result], tuple[Worker, int]] = {}
    found: dict[int, Result] = {}
    for worker, (place, task) in zip(workers, left, strict=False):
        running[worker.play(task)] = worker, place
    for wanted in range(len(tasks)):
        while wanted not in found:
            done, _ = wait(running, return_when=FIRST_COMPLETED)
            ended = [(future, *running.pop(future)) for future in done]
            found |= {place: future.result() for future, _, place in ended if future.exception() is None}
            for future, worker, place in ended:
                if (error := future.exception()) is not None:
                    yield from (found[each] for each in sorted(found))
                    if isinstance(error, LostError):
                        raise _lost(error, tasks[place], seed, alone) from error
                    raise error
                for next_place, task in left:
                    running[worker.play(task)] = worker, next_place
                    break
        yield found.pop(wanted)


def _lost(error: LostError, task: Task, seed: int, alone: Alone | None) -> TltlError:
    title = (
        f"a worker was lost while it played episode {task.index} of seed {seed}, {CHOICES[task.sampled]} "
        f"(seed {episode_seed(seed, task.index)} of the level): {error}"
    )
    if alone:
        help_ = f"to play that one alone: {alone(task)}"
    else:
        help_ = f"`tltlc evaluate` plays that one alone: `--seed {seed} --first {task.index} --episodes 1 --workers 1`"
    return TltlError([Diagnostic("TLT0850", title, help=help_)])
