"""Evaluate a policy over many episodes, on one core, on several cores or on a Ray cluster."""

from __future__ import annotations

import logging
from collections.abc import Callable, Generator, Iterable, Iterator, Sequence
from contextlib import ExitStack, closing
from functools import partial
from pathlib import Path
from typing import Final, Literal

from tltl_runtime.evaluation.clauses import clause_judge
from tltl_runtime.evaluation.player import (
    EpisodePlayer,
    EpisodeRequest,
    LostEpisode,
    PlayedEpisode,
    PolicyPlayer,
    RecordMode,
    Setup,
)
from tltl_runtime.evaluation.scheduler import ReplayCommand, Result, play_all
from tltl_runtime.evaluation.worker_process import WorkerProcess, close_all
from tltl_runtime.game.level import Level
from tltl_runtime.game.level_name import Variant, parse_variant
from tltl_runtime.game.registry import game_of
from tltl_runtime.policies.compatibility import check_policy
from tltl_runtime.policies.file import read_policy
from tltl_runtime.policies.policy import Policy
from tltl_runtime.spec.episode_summary import EpisodeSummary
from tltl_runtime.spec.task import load_task
from tltl_runtime.vector.cores import cores
from tltl_runtime.wire.lost_episodes import LossLimit, most_lost
from tltlc.api import Diagnostic, Fspa, TltlError

OnLost = Callable[[LostEpisode], None]
"""A callback for each episode that was lost with its game."""

_log: Final = logging.getLogger(__name__)

Pool = int | Literal["ray"]
"""Where to play: in this process (1), in this many worker processes (0: one per core), or on a Ray cluster."""


def log_lost(lost: LostEpisode) -> None:
    """Write to this module's logger that an episode was lost, and what happened to its game."""
    _log.warning("episode %d was lost: %s\n%s", lost.request.index, lost.fault.title, lost.fault.help)


def evaluate(
    policy: Policy | str | Path,
    level: str | None = None,
    variant: str | Variant | None = None,
    *,
    episodes: int,
    seed: int,
    workers: Pool = 1,
    sampled: bool = True,
    spec: str | Path | Fspa | None = None,
) -> Iterator[EpisodeSummary]:
    """Play ``episodes`` episodes with a policy; yield their summaries in order.

    ``policy`` is a policy or the path of its file. ``level``, ``variant`` (of the level) and ``spec``
    default to those that the policy was trained for. If ``level`` is given, the variant defaults to
    ``v0``. If ``sampled``, actions are sampled; otherwise the likeliest action is taken. The episodes
    depend on ``seed``, but not on ``workers``. Worker processes import the main module, so put the code
    of a script under ``if __name__ == "__main__"``. An episode that is lost with its game, which runs in
    another process, has no summary; the logger of this module reports it.

    Raises:
        TltlError: the errors of :func:`set_up`, :func:`results` and ``read_policy``.
    """
    loaded = policy if isinstance(policy, Policy) else read_policy(Path(policy))
    setup = set_up(loaded, level, variant, spec, seed)
    for result in results(setup, [EpisodeRequest(index, sampled) for index in range(episodes)], workers):
        yield result.summary


def set_up(
    policy: Policy,
    level: str | None,
    variant: str | Variant | None,
    spec: str | Path | Fspa | None,
    seed: int,
    recorded: RecordMode | None = None,
) -> Setup:
    """Check the arguments of an evaluation, and return its setup.

    ``level``, ``variant`` and ``spec`` default to those that the policy was trained for. If ``level``
    is given, the variant defaults to ``v0``. ``seed`` is the seed of the evaluation. ``recorded`` says
    which episodes to record; see :class:`~tltl_runtime.evaluation.player.Setup`.

    Raises:
        TltlError: the level, variant or spec does not exist; the level lacks something that the
            spec needs; the errors of :func:`~tltl_runtime.policies.compatibility.check_policy`; TLT0851, the
            spec has no limit.
    """
    card = policy.card
    name = level or card.level
    game = game_of(name)
    variant = variant or (card.variant if level is None else "v0")
    if isinstance(variant, str):
        variant = parse_variant(variant)
    loaded_level = game.load_level(name, variant)
    offered = game.params(loaded_level)
    own = {key: value for key, value in card.params.items() if key not in offered} if spec is None else {}
    task = load_task(card.fspa if spec is None else spec, own, offered=offered)
    check_policy(card, loaded_level, task.fspa)
    game.check_fit(loaded_level, task.fspa, card.fspa if spec is None else spec)
    check_limit(task.fspa)
    source = _source(spec, loaded_level)
    judge = clause_judge(task.fspa, task.params, source)
    return Setup(policy, name, variant, task.fspa, seed, task.params, recorded, clause_judge=judge)


def _source(spec: str | Path | Fspa | None, level: Level) -> str | None:
    """Return where the source text of a spec may be: the spec itself, or the spec that the level is made for."""
    if spec is None or isinstance(spec, Fspa):
        return level.spec.text if level.spec else None
    return str(spec)


def check_limit(fspa: Fspa) -> None:
    """Check that a spec has a limit of steps, so that every episode ends.

    Raises:
        TltlError: TLT0851, the spec has no limit.
    """
    if fspa.limit_steps is None:
        title = f"`{fspa.name}` has no limit, so an episode may go on for ever"
        raise TltlError([Diagnostic("TLT0851", title, help="write a limit in the spec, such as `limit 400 steps`")])


def results(
    setup: Setup,
    requests: Sequence[EpisodeRequest],
    workers: Pool = 1,
    waiting: Callable[[float], None] = lambda left: None,
    replay_command: ReplayCommand | None = None,
    on_lost: OnLost = log_lost,
) -> Generator[PlayedEpisode]:
    """Play the requested episodes and yield them in order. Closing the iterator ends the workers.

    An episode that is lost with its game, which runs in another process, is not yielded: ``on_lost`` is
    called with it in its place, and the next episode starts the game again.

    While no core of a Ray cluster is free, ``waiting`` is called now and then with the seconds that
    are left to wait. If a worker is lost, the error shows a shell command that plays only the lost
    episode. ``replay_command`` returns this command; by default, it is a ``tltlc evaluate`` command.

    Raises:
        TltlError: TLT0850, a worker was lost; TLT0730, Ray is requested and not installed; TLT0852,
            there is no cluster, or no worker starts there in time; errors while an environment is
            made.
        WireError: too many episodes were lost with their games; the error is that of the last one.
        ValueError: ``workers`` is below 0.
    """
    if workers != "ray":
        modules = game_of(setup.level).modules
        make = partial(PolicyPlayer, setup)
        yield from local_results(make, requests, workers, setup.seed, replay_command, modules=modules, on_lost=on_lost)
        return
    from tltl_runtime.evaluation.ray_pool import ray_workers

    with ray_workers(setup, len(requests), waiting) as team:
        yield from _without_lost(play_all(team, requests, setup.seed, replay_command), len(requests), on_lost)


def local_results(
    make: Callable[[], EpisodePlayer],
    requests: Sequence[EpisodeRequest],
    workers: int,
    seed: int,
    replay_command: ReplayCommand | None = None,
    *,
    modules: Sequence[str] = (),
    on_lost: OnLost = log_lost,
) -> Generator[PlayedEpisode]:
    """Play the requested episodes on this machine and yield them in order, like :func:`results`.

    ``make`` returns an object that plays episodes. Each process calls it once. If there are worker
    processes, ``make`` must be picklable, and ``modules`` are the names of the modules that such an
    object needs.

    Raises:
        TltlError: TLT0850, a worker was lost (the message names its episode and the evaluation's
            ``seed``); errors while an episode is played.
        WireError: too many episodes were lost with their games; the error is that of the last one.
        ValueError: ``workers`` is below 0.
    """
    if workers == 1:
        with closing(make()) as player:
            yield from _without_lost(map(player.play, requests), len(requests), on_lost)
        return
    if workers < 0:
        raise ValueError(f"the number of workers must be at least 0, not {workers}")
    with ExitStack() as stack:
        team: list[WorkerProcess] = []
        stack.callback(close_all, team)
        team.extend(WorkerProcess(make, modules) for _ in range(min(workers or cores(), len(requests))))
        yield from _without_lost(play_all(team, requests, seed, replay_command), len(requests), on_lost)


def _without_lost(played: Iterable[Result], count: int, on_lost: OnLost) -> Iterator[PlayedEpisode]:
    """Yield the episodes that were not lost; ``count`` is the number of all, if all are played.

    Raises WireError if too many were lost.
    """
    limit = LossLimit(most_lost(count))
    for result in played:
        if isinstance(result, LostEpisode):
            on_lost(result)
            limit.add_lost(result.fault)
        else:
            limit.add_played()
            yield result
