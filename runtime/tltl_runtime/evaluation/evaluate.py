"""Evaluations: a policy plays many episodes, on one core, on several or on a Ray cluster."""

from __future__ import annotations

from collections.abc import Callable, Generator, Iterator, Sequence
from contextlib import ExitStack, closing
from functools import partial
from pathlib import Path
from typing import Literal

from tltl_runtime.evaluation.local import Process
from tltl_runtime.evaluation.play import Played
from tltl_runtime.evaluation.player import Player, Plays, Recorded, Result, Setup, Task
from tltl_runtime.evaluation.spread import Alone, spread
from tltl_runtime.policies.file import read_policy
from tltl_runtime.policies.fit import check_policy
from tltl_runtime.policies.policy import Policy
from tltl_runtime.spec.task import load_task
from tltl_runtime.stealth.capabilities.vocabulary import params as level_params
from tltl_runtime.stealth.env import check_fit
from tltl_runtime.stealth.levels.file import load_level
from tltl_runtime.vector.cores import cores
from tltlc.automaton.fspa import Fspa
from tltlc.diagnostics.diagnostic import Diagnostic, TltlError

Pool = int | Literal["ray"]
"""This process (1), so many others (0: one for each core), or those of a Ray cluster."""


def evaluate(
    policy: Policy | str | Path,
    level: str | None = None,
    variant: str | None = None,
    *,
    episodes: int,
    seed: int,
    workers: Pool = 1,
    sampled: bool = True,
    spec: str | Path | Fspa | None = None,
) -> Iterator[Played]:
    """Have a policy play ``episodes``, and tell how each went, in their order and as soon as they are over.

    ``level``, ``variant`` and ``spec`` are by default those that the policy was trained for; the variant of another
    level is ``v0``.  The episodes are the same whichever ``workers`` play.  A process starts by importing the main
    module, so a script's own work stands under ``if __name__ == "__main__"``.

    Raises:
        TltlError: what :func:`set_up`, :func:`results` and ``read_policy`` raise.
    """
    read = policy if isinstance(policy, Policy) else read_policy(Path(policy))
    setup = set_up(read, level, variant, spec, seed)
    for result in results(setup, [Task(index, sampled) for index in range(episodes)], workers):
        yield result.played


def set_up(
    policy: Policy,
    level: str | None,
    variant: str | None,
    spec: str | Path | Fspa | None,
    seed: int,
    recorded: Recorded | None = None,
) -> Setup:
    """An evaluation that can be played.

    Raises:
        TltlError: there is no such level, variant or spec; what the spec asks of the level and does not get; what
            :func:`~tltl_runtime.policies.fit.check_policy` finds; TLT0851, the spec has no limit.
    """
    card = policy.card
    name = level or card.level
    chosen = variant or (card.variant if level is None else "v0")
    place = load_level(name, chosen)
    offered = level_params(place)
    own = {key: value for key, value in card.params.items() if key not in offered} if spec is None else {}
    task = load_task(card.fspa if spec is None else spec, own, offered=offered)
    check_policy(card, place, task.fspa)
    check_fit(place, task.fspa, card.fspa if spec is None else spec)
    check_limit(task.fspa)
    return Setup(policy, name, chosen, task.fspa, seed, task.params, recorded)


def check_limit(fspa: Fspa) -> None:
    """Raise TltlError, TLT0851, where a spec has no limit."""
    if fspa.limit_steps is None:
        title = f"`{fspa.name}` has no limit, so an episode may go on for ever"
        raise TltlError([Diagnostic("TLT0851", title, help="write `limit 60 s` or the like in the spec")])


def results(
    setup: Setup,
    tasks: Sequence[Task],
    workers: Pool = 1,
    waiting: Callable[[float], None] = lambda left: None,
    alone: Alone | None = None,
) -> Generator[Result]:
    """Play the tasks and give their results in order; closing the iterator ends the workers.

    Where no core of a Ray cluster is free, ``waiting`` is told for how many more seconds one is waited for.  Where a
    worker is lost, ``alone`` is the command that plays its episode, by default ``tltlc evaluate``.

    Raises:
        TltlError: TLT0850, a worker was lost; TLT0730, Ray is asked for and is not installed; TLT0852, there is no
            cluster, or no worker starts there in time; what the making of an environment raises.
        ValueError: a number of workers below 0.
    """
    if workers != "ray":
        yield from results_here(partial(Player, setup), tasks, workers, setup.seed, alone)
        return
    from tltl_runtime.evaluation.ray_pool import ray_workers

    with ray_workers(setup, len(tasks), waiting) as team:
        yield from spread(team, tasks, setup.seed, alone)


def results_here(
    make: Callable[[], Plays], tasks: Sequence[Task], workers: int, seed: int, alone: Alone | None = None
) -> Generator[Result]:
    """As :func:`results`, on this machine, played by what ``make`` makes in each process, to which it is pickled.

    Raises:
        TltlError: TLT0850, a worker was lost while it played an episode of the evaluation's ``seed``; what playing
            raises.
        ValueError: a number of workers below 0.
    """
    if workers == 1:
        with closing(make()) as player:
            for task in tasks:
                yield player.play(task)
        return
    if workers < 0:
        raise ValueError(f"there are no {workers} workers")
    with ExitStack() as stack:
        team = [Process(make) for _ in range(min(workers or cores(), len(tasks)))]
        for each in team:
            stack.callback(each.close)
        yield from spread(team, tasks, seed, alone)
