"""A training from its beginning, or from its checkpoint, to its end."""

from __future__ import annotations

import time
from collections.abc import Callable, Generator, Mapping
from contextlib import ExitStack, closing
from math import isfinite

import numpy as np
import torch
from rsl_rl.algorithms import PPO
from torch import Tensor

from tltl_runtime.evaluation.evaluate import evaluate
from tltl_runtime.policies.file import write_policy
from tltl_runtime.policies.threads import threads
from tltl_runtime.training.available import class_of, device_of
from tltl_runtime.training.checkpoint import Best, Checkpoint, copied, read_checkpoint, write_checkpoint
from tltl_runtime.training.distributed import Peers, cores, joined
from tltl_runtime.training.environment import TrainingEnv
from tltl_runtime.training.folder import held
from tltl_runtime.training.metrics import Metrics
from tltl_runtime.training.policy import policy_of
from tltl_runtime.training.report import Report, StopReason
from tltl_runtime.training.restarts import Restarts
from tltl_runtime.training.run import CHECKPOINT, POLICY, RUN, Run, identity, read_run, write_run
from tltl_runtime.training.runner import Iteration, Runner
from tltl_runtime.training.search import Search, Searched, Way
from tltl_runtime.training.settings import rsl_config
from tltl_runtime.training.starts import Replayed
from tltl_runtime.training.windows import Windows
from tltl_runtime.vector import WorkerVectorEnv, make_vec
from tltl_runtime.vector.env import TLTL_INFO
from tltlc.diagnostics.diagnostic import Diagnostic, TltlError
from tltlc.record import replace

_OF_TORCH, _OF_ENVIRONMENTS, _OF_SEARCH, _OF_STARTS, _OF_CONFIRMATION = range(5)
"""The streams of random numbers of a process."""


def train(
    run: Run, *, resume: bool = False, searching: Callable[[Searched], None] = lambda searched: None
) -> Generator[Report]:
    """Train in ``run.folder``, with a report after each iteration; the last one says why it ends.

    The folder gets ``run.json``, ``checkpoint.pt``, ``policy.safetensors`` and the measurements of
    :class:`~tltl_runtime.training.metrics.Metrics`, each before the report that tells of it.  Whatever ends it, Ctrl-C
    and closing the iterator too, leaves a checkpoint of the last whole iteration; a process that is killed loses what
    came after the last one.  With ``resume`` the training goes on from there; one that is over gives its last report.

    A search for ways to meet the spec comes first, which tells ``searching`` how far it is.

    Equal runs give equal numbers, and so do equal checkpoints that are resumed.  With torchrun each process trains with
    environments of its own, and all report the same but for losses, times and searches, which are each one's own; the
    first alone writes.

    Raises:
        TltlError: TLT0005, a file cannot be written; TLT0854, the environment gave values that are no numbers; TLT0862,
            there is no such device or class; TLT0864, the checkpoint cannot be resumed from; TLT0865, another process
            trains in the folder; TLT0866, a loss is no number any more; TLT0867, the folder holds a training and
            ``resume`` is false.
        WorkerError: a process that plays was lost.
    """
    runner = class_of("runner", run.settings.classes.runner, Runner)
    class_of("algorithm", run.settings.classes.algorithm, PPO)
    with ExitStack() as stack:
        own, device = stack.enter_context(joined(device_of(run.settings.device)))
        begun = None
        if own.rank == 0:
            stack.enter_context(held(run.folder))
            begun = _begun(run, resume)
        begun = own.broadcast(begun)
        stack.enter_context(threads(1))
        played = stack.enter_context(closing(_environments(run)))
        env, searched = _prepared(run, own, device, played, begun, searching)
        torch.manual_seed(int(_stream(run, own, _OF_TORCH, 0).generate_state(1)[0]))
        config = rsl_config(run.settings, env.shapes, env.branches)
        yield from _Training(run, own, runner(env, config, None, device), begun, searched).reports()


class _Training:
    """A training of this process as one of ``own``; ``state`` is that after the last whole iteration."""

    def __init__(
        self, run: Run, own: Peers, runner: Runner, begun: Checkpoint | None, searched: Searched | None
    ) -> None:
        self._run, self._own, self._runner = run, own, runner
        self._stop = run.settings.stop
        self._windows = Windows(self._stop.windows, self._stop.episodes, run.fspa.limit_steps)
        if begun is not None:
            runner.alg.load(begun.algorithm, None, strict=True)
            runner.current_learning_iteration = begun.iteration
            self._windows.load(begun.window)
            self._fade_entropy()
            if own.rank < len(begun.processes):
                _set_own(begun.processes[own.rank], runner)
        self._state = begun or Checkpoint(
            run=identity(run),
            iteration=0,
            losses={},
            steps=0,
            seconds=searched.seconds if searched else 0.0,
            replayed=0,
            searched=searched,
            algorithm=copied(runner.alg.save()),
            processes=tuple(own.gather(_own(runner))),
            window=(),
            best=None,
            met=False,
        )
        self._seconds_before, self._began = self._state.seconds, time.perf_counter()
        self._replayed_before = self._state.replayed
        self._saved, self._saved_at, self._saved_best = self._state, self._began, self._state.best

    def reports(self) -> Generator[Report]:
        """Train to the end."""
        metrics = None
        try:
            if self._own.rank == 0:
                metrics = Metrics(
                    self._run.folder, self._run.fspa, after=self._state.iteration, steps=self._state.steps
                )
            if self._state.iteration and (reason := self._reason()):
                yield self._over(reason)
                return
            if self._state.iteration == 0:
                # Whoever is killed soon need not search again.
                self._write_checkpoint()
            for iteration in self._runner.iterations():
                yield (report := self._after(iteration, metrics))
                if report.stop:
                    return
        finally:
            try:
                self._save()
            finally:
                if metrics:
                    metrics.close()

    def _over(self, reason: StopReason) -> Report:
        """The report of a training that is over as soon as it is resumed."""
        if self._own.rank == 0 and not (self._run.folder / POLICY).exists():
            # A limit that is lower now ends it before any policy was the best.
            self._write_policy()
        iteration = Iteration(self._state.iteration, 0, (), dict(self._state.losses), 0.0, 0.0)
        return self._report(iteration, reason, checkpointed=False)

    def _after(self, iteration: Iteration, metrics: Metrics | None) -> Report:
        """Take up what an iteration gave, and write what is due."""
        seconds = self._seconds_before + time.perf_counter() - self._began
        # What all decide upon must be the same for all: the first process has the clock.
        told = self._own.gather((iteration, seconds, _own(self._runner), self._runner.env.replayed))
        for theirs, *_ in told:
            _check_losses(theirs)
        finished = tuple(each for theirs, *_ in told for each in theirs.finished)
        iteration = replace(iteration, finished=finished, steps=iteration.steps * self._own.count)
        self._windows.add(finished)
        self._fade_entropy()
        after = replace(
            self._state,
            iteration=iteration.number,
            losses=iteration.losses,
            steps=self._state.steps + iteration.steps,
            seconds=told[0][1],
            replayed=self._replayed_before + sum(each for *_, each in told),
            processes=tuple(each for _, _, each, _ in told),
            algorithm=copied(self._runner.alg.save()),
            window=tuple(self._windows.state()),
            best=self._best(),
        )
        if self._windows.met:
            after = replace(after, met=self._own.broadcast(self._own.rank > 0 or self._is_confirmed(after)))
        before, self._state = self._state, after
        reason = self._reason()
        due = bool(reason) or time.perf_counter() - self._saved_at >= self._run.settings.checkpoint_s
        report = self._report(iteration, reason, checkpointed=due)
        if metrics:
            try:
                metrics.add(report)
            except BaseException:
                # An iteration counts once it is measured: of one that is not, no checkpoint may tell.
                self._state = before
                raise
        if due:
            self._save()
        return report

    def _fade_entropy(self) -> None:
        """Reward undecided actions the less, the more often the spec is met: then there is less to try."""
        ppo = self._run.settings.ppo
        if ppo.entropy_schedule == "fading":
            self._runner.alg.entropy_coef = ppo.entropy * (1 - self._windows.window.pass_rate)

    def _best(self) -> Best | None:
        """The best policy so far: that which played the last window, where none before it did better."""
        best, score = self._state.best, self._windows.score
        if score is None or (best is not None and score < best.score and not self._windows.met):
            return best
        # The rollout was played with the weights from before the update that followed it.
        return Best(score, self._state.algorithm["actor_state_dict"])

    def _is_confirmed(self, state: Checkpoint) -> bool:
        """Whether the policy that is kept meets the spec throughout as many fresh episodes as the windows have.

        These were played by the policies of several iterations, and chance, too, makes windows without a failure.
        """
        assert state.best is not None
        run = self._run
        policy = policy_of(run, self._runner.env, state.best.actor)
        seed = int(_stream(run, self._own, _OF_CONFIRMATION, state.iteration).generate_state(1)[0])
        count = self._stop.windows * self._stop.episodes
        played = evaluate(policy, run.level, run.variant, episodes=count, seed=seed, spec=run.fspa)
        return all(each.success for each in played)

    def _reason(self) -> StopReason | None:
        """Why the training is over, if it is."""
        if self._state.met:
            return "met"
        if self._state.steps >= self._stop.steps:
            return "steps"
        return "minutes" if 0 < self._stop.minutes * 60 <= self._state.seconds else None

    def _report(self, iteration: Iteration, reason: StopReason | None, *, checkpointed: bool) -> Report:
        best = self._state.best
        return Report(
            iteration=iteration,
            steps=self._state.steps,
            seconds=self._state.seconds,
            window=self._windows.window,
            best_pass_rate=best.score[0] if best else None,
            stop=reason,
            checkpointed=checkpointed,
            searched=self._state.searched,
            replayed=self._state.replayed,
        )

    def _save(self) -> None:
        """Write policy and checkpoint, where there is anything new."""
        state = self._state
        if self._own.rank != 0 or state is self._saved:
            return
        # Whatever comes of it, it is not tried again at once.
        self._saved, self._saved_at = state, time.perf_counter()
        if state.best is not self._saved_best or self._reason():
            self._write_policy()
            self._saved_best = state.best
        self._write_checkpoint()

    def _write_policy(self) -> None:
        """Write the best policy, or the last one where none is the best yet."""
        best = self._state.best
        weights = best.actor if best else self._state.algorithm["actor_state_dict"]
        write_policy(self._run.folder / POLICY, policy_of(self._run, self._runner.env, weights))

    def _write_checkpoint(self) -> None:
        if self._own.rank == 0:
            write_checkpoint(self._run.folder / CHECKPOINT, self._state)


def _begun(run: Run, resume: bool) -> Checkpoint | None:
    """The checkpoint to go on from; what is trained is written down."""
    if resume:
        begun = read_checkpoint(run.folder / CHECKPOINT, identity(run))
        if read_run(run.folder).settings != run.settings:
            # Its limits are others now, and hold when it is resumed the next time.
            write_run(run)
        return begun
    if (run.folder / RUN).exists():
        title = f"`{run.folder}` holds a training already"
        help_ = f"go on with it by `tltlc train --resume {run.folder}`, or name another place with --out"
        raise TltlError([Diagnostic("TLT0867", title, help=help_)])
    write_run(run)
    return None


def _environments(run: Run) -> WorkerVectorEnv:
    """The environments of this process."""
    settings, rollout = run.settings, run.settings.rollout
    return make_vec(
        run.level,
        run.variant,
        rollout.envs,
        "ray" if rollout.pool == "ray" else rollout.workers or cores(),
        spec=run.fspa,
        sensors=run.sensors,
        reward=settings.reward,
        params=run.params,
        wrapper=Replayed,
        info={**TLTL_INFO, "cell": np.int64},
    )


def _prepared(
    run: Run,
    own: Peers,
    device: str,
    played: WorkerVectorEnv,
    begun: Checkpoint | None,
    searching: Callable[[Searched], None],
) -> tuple[TrainingEnv, Searched | None]:
    """What rsl-rl trains with, at the beginning of episodes that no process played before, and what a search found."""
    exploration, searched, restarts = run.settings.exploration, None, None
    iteration = begun.iteration if begun else 0
    if exploration.ways:
        ways: list[Way] = []
        if begun is None:
            search = Search(played, len(run.fspa.states), exploration, _stream(run, own, _OF_SEARCH, 0))
            for searched in search.run():
                searching(searched)
                if 0 < run.settings.stop.minutes * 60 <= searched.seconds:
                    break
            ways = search.ways
        restarts = Restarts(ways, exploration.parts, np.random.default_rng(_stream(run, own, _OF_STARTS, iteration)))
        if begun is not None:
            # Of more processes than there were, the new ones know the ways of older ones.
            known = begun.processes[own.rank % len(begun.processes)]
            restarts.load({name: each.numpy() for name, each in known.items()})
    seeds = _stream(run, own, _OF_ENVIRONMENTS, iteration).generate_state(played.num_envs) >> 1
    return TrainingEnv(played, [int(each) for each in seeds], device, restarts), searched


def _stream(run: Run, own: Peers, purpose: int, iteration: int) -> np.random.SeedSequence:
    return np.random.SeedSequence(run.seed, spawn_key=(own.rank, purpose, iteration))


def _own(runner: Runner) -> dict[str, Tensor]:
    """What this process has for itself: see :class:`Checkpoint`."""
    own = {"cpu": torch.get_rng_state()}
    if runner.device.startswith("cuda"):
        own["cuda"] = torch.cuda.get_rng_state(runner.device)
    if runner.env.restarts:
        own |= {name: torch.from_numpy(each) for name, each in runner.env.restarts.state().items()}
    return own


def _set_own(own: Mapping[str, Tensor], runner: Runner) -> None:
    torch.set_rng_state(own["cpu"])
    if runner.device.startswith("cuda") and "cuda" in own:
        torch.cuda.set_rng_state(own["cuda"], runner.device)


def _check_losses(iteration: Iteration) -> None:
    wrong = [name for name, loss in iteration.losses.items() if not isfinite(loss)]
    if wrong:
        title = f"the training has diverged: in iteration {iteration.number} the loss `{wrong[0]}` is no number"
        help_ = "train anew with a smaller `learning_rate` or `max_gradient`"
        raise TltlError([Diagnostic("TLT0866", title, help=help_)])
