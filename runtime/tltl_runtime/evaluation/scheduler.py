"""Distribute episodes over workers and collect the results in order."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import FIRST_COMPLETED, Future, wait
from typing import Protocol

from tltl_runtime.evaluation.play import episode_seed
from tltl_runtime.evaluation.player import CHOICES, EpisodeRequest, LostEpisode, PlayedEpisode
from tltlc.api import Diagnostic, TltlError

Result = PlayedEpisode | LostEpisode
"""The result of a request: the episode was played, or was lost with its game."""


class WorkerLostError(Exception):
    """Raised if a worker ended before it had played its episode; the message says how it ended."""


class EpisodeWorker(Protocol):
    """The interface of a worker that plays one episode at a time, for example in another process."""

    def play(self, request: EpisodeRequest) -> Future[Result]:
        """Start to play the requested episode; return a future of its result.

        The future raises the exception that the episode raised, or :class:`WorkerLostError`.
        """

    def close(self) -> None:
        """End the worker and free its resources."""


ReplayCommand = Callable[[EpisodeRequest], str]
"""A function that returns a shell command that plays only the requested episode."""


def play_all(
    workers: Sequence[EpisodeWorker],
    requests: Sequence[EpisodeRequest],
    seed: int,
    replay_command: ReplayCommand | None = None,
) -> Iterator[Result]:
    """Give each free worker the next request; yield the episodes in the order of the requests.

    If an episode raises an error, or its worker is lost, all episodes that are already played are
    yielded before the error is raised, even if earlier episodes are missing.

    Raises:
        TltlError: TLT0850, a worker was lost; the message names its episode and the evaluation's
            ``seed``, and the help shows the command that ``replay_command`` returns, by default a
            ``tltlc evaluate`` command.
        Exception: the error that an episode raised.
    """
    remaining = iter(enumerate(requests))
    running: dict[Future[Result], tuple[EpisodeWorker, int]] = {}
    results: dict[int, Result] = {}
    for worker, (index, request) in zip(workers, remaining, strict=False):
        running[worker.play(request)] = worker, index
    for index_to_yield in range(len(requests)):
        while index_to_yield not in results:
            done, _ = wait(running, return_when=FIRST_COMPLETED)
            ended = [(future, *running.pop(future)) for future in done]
            results |= {index: future.result() for future, _, index in ended if future.exception() is None}
            for future, worker, index in ended:
                if (error := future.exception()) is not None:
                    yield from (results[played] for played in sorted(results))
                    if isinstance(error, WorkerLostError):
                        raise _lost_worker_error(error, requests[index], seed, replay_command) from error
                    raise error
                for next_index, request in remaining:
                    running[worker.play(request)] = worker, next_index
                    break
        yield results.pop(index_to_yield)


def _lost_worker_error(
    error: WorkerLostError, request: EpisodeRequest, seed: int, replay_command: ReplayCommand | None
) -> TltlError:
    title = (
        f"a worker was lost while it played episode {request.index} of seed {seed}, {CHOICES[request.sampled]} "
        f"(seed {episode_seed(seed, request.index)} of the level): {error}"
    )
    if replay_command:
        help_ = f"to play only that episode: {replay_command(request)}"
    else:
        options = f"--seed {seed} --first {request.index} --episodes 1 --workers 1"
        help_ = f"`tltlc evaluate` plays only that episode with `{options}`"
    return TltlError([Diagnostic("TLT0850", title, help=help_)])
