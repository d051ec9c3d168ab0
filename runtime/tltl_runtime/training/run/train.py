"""Run a training from its start or a checkpoint to its end."""

from __future__ import annotations

import time
from collections.abc import Callable, Generator
from contextlib import ExitStack, closing

import torch
from rsl_rl.algorithms import PPO

from tltl_runtime.policies.file import check_size
from tltl_runtime.policies.threads import threads
from tltl_runtime.support.record_json import RecordJsonError
from tltl_runtime.training.exploration.search import Searched, joined_searches
from tltl_runtime.training.exploration.search_schedule import Searching, searched_again
from tltl_runtime.training.imitation.demonstrations import Tried
from tltl_runtime.training.imitation.gail import Gail
from tltl_runtime.training.ppo.checkpoint_restore import restore_checkpoint
from tltl_runtime.training.ppo.distributed import Peers, joined
from tltl_runtime.training.ppo.penalty_weight import weighing
from tltl_runtime.training.ppo.policy import card_of, policy_of
from tltl_runtime.training.ppo.process_exchange import gathered, own_state, set_generators
from tltl_runtime.training.ppo.random_streams import Purpose, stream
from tltl_runtime.training.ppo.recent_episodes import RecentEpisodes, Standstill
from tltl_runtime.training.run.checkpoint import BestPolicy, Checkpoint, copied, damaged
from tltl_runtime.training.run.confirmation import confirm
from tltl_runtime.training.run.folder import lock_training
from tltl_runtime.training.run.report import Confirmation, TrainingReport
from tltl_runtime.training.run.requirements import class_of, device_of
from tltl_runtime.training.run.run_file import CHECKPOINT, Run, identity
from tltl_runtime.training.run.settings import algorithm_name, rsl_config
from tltl_runtime.training.run.setup import begun, demonstrated, environments, initial_policy, prepared
from tltl_runtime.training.run.training_files import TrainingFiles
from tltl_runtime.training.runner import Iteration, Runner
from tltlc.api import replace


def train(
    run: Run,
    *,
    resume: bool = False,
    searching: Searching = lambda searched: None,
    recording: Callable[[Tried], None] = lambda tried: None,
) -> Generator[TrainingReport]:
    """Train in ``run.folder``; yield a report after each iteration.  The last one says why it ends.

    The folder gets ``run.json``, ``checkpoint.pt``, ``policy.safetensors`` and the files of
    :class:`~tltl_runtime.training.run.metrics.Metrics`, each before the report of its iteration.
    Any end of the training, even by Ctrl-C or by closing the iterator, leaves a checkpoint of the
    last complete iteration.  Only a killed process loses the iterations after the last checkpoint.
    With ``resume``, the training continues from the checkpoint; a training that is over yields its
    last report again.

    First, a search finds ways to meet the spec; ``searching`` is called with its progress.  In the
    search, the policy that the training begins with plays first, if there is one.  With imitation,
    the expert's demonstrations are recorded first if none are given; ``recording`` is called with
    each attempt.

    Equal runs give equal numbers, and so do equal checkpoints that are resumed.  With torchrun,
    each process trains with its own environments.  The reports of all processes are equal, except
    for losses, times and searches, which are of the process itself, and for checkpoints, which only
    the first process writes.

    Raises:
        TltlError: TLT0005, a file cannot be written; TLT0854, the environment gave values that are
            not numbers; TLT0862, the device or a class does not exist, or the network is too large
            for a policy file; TLT0864, the checkpoint cannot be resumed from; TLT0865, another
            process trains in the folder; TLT0866, a loss is not a number; TLT0867, the folder holds
            a training and ``resume`` is false; TLT0868, the level has changed; TLT0920 and TLT0921,
            there are no demonstrations to imitate; TLT0922, the demonstrations have changed;
            TLT0940, the policy to begin with has changed.
        WorkerError: a worker process of the environments was lost.
    """
    runner = class_of("runner", run.settings.classes.runner, Runner)
    class_of("algorithm", algorithm_name(run.settings), Gail if run.settings.imitates else PPO)
    check_size(run.settings.network, run.fspa, run.sensors)
    with ExitStack() as stack:
        own, device = stack.enter_context(joined(device_of(run.settings.device)))
        checkpoint = None
        if own.rank == 0:
            stack.enter_context(lock_training(run.folder))
            checkpoint = begun(run, resume)
        checkpoint = own.broadcast(checkpoint)
        stack.enter_context(threads(1))
        to_imitate = demonstrated(run, own, recording)
        initial = initial_policy(run, own, checkpoint)
        played = stack.enter_context(closing(environments(run)))
        env, searched = prepared(run, own, device, played, checkpoint, searching, to_imitate, initial)
        if env.lessons:
            stack.callback(env.lessons.close)
        torch.manual_seed(int(stream(run, own, Purpose.TORCH).generate_state(1)[0]))
        config = rsl_config(run.settings, env.shapes, env.branches)
        new_runner = runner(env, config | {"warm_up": run.settings.ppo.warm_up if run.initial else 0}, None, device)
        if initial:
            new_runner.begin_with(initial.weights())
        training = _Training(run, own, new_runner, checkpoint, searched, searching)
        yield from training.reports()


class _Training:
    """The training in process ``own``; ``_state`` is that after the last complete iteration."""

    def __init__(
        self,
        run: Run,
        own: Peers,
        runner: Runner,
        begun: Checkpoint | None,
        searched: Searched | None,
        searching: Searching,
    ) -> None:
        self._run, self._own, self._runner, self._searching = run, own, runner, searching
        self._stop = run.settings.stop
        # The card is made now: later changes of the level's file are not part of this training.
        self._card = card_of(run, runner.env)
        self._windows = RecentEpisodes(self._stop.windows, self._stop.episodes, run.fspa.limit_steps)
        if begun is not None:
            try:
                restore_checkpoint(begun, runner, len(run.fspa.states))
            except RecordJsonError as error:
                raise damaged(run.folder / CHECKPOINT, str(error)) from None
            runner.current_learning_iteration = begun.iteration
            self._windows.load(begun.window, begun.unbroken)
            if own.rank < len(begun.processes):
                set_generators(begun.processes[own.rank], runner)
        self._sharpness = self._weigh()
        self._state = begun or _unbegun(run, runner)
        if searched:
            seconds = own.broadcast(self._state.seconds + searched.seconds)
            if before := self._state.searched:
                searched = joined_searches(before, searched)
            self._state = replace(self._state, searched=searched, seconds=seconds)
        if searched or begun is None:
            self._state = replace(self._state, processes=tuple(own.gather(own_state(runner))))
        self._seconds_before, self._began = self._state.seconds, time.perf_counter()
        self._replayed_before = self._state.replayed
        self._standstill, self._stands_still = Standstill(*self._state.standstill), False
        self._keeping = TrainingFiles(run, self._card, begun) if own.rank == 0 else None
        self._tell_time()

    def reports(self) -> Generator[TrainingReport]:
        """Train to the end."""
        try:
            if self._keeping:
                self._keeping.take_up(self._state)
            if self._state.iteration and self._state.reason(self._stop):
                iteration = Iteration(self._state.iteration, 0, (), dict(self._state.losses), 0.0, 0.0)
                yield self._report(self._state, iteration, None, checkpointed=False)
                return
            for iteration in self._runner.iterations():
                yield (report := self._after(iteration))
                if report.stop:
                    return
                if self._stands_still:
                    self._search_again()
        finally:
            if self._keeping:
                self._keeping.close(self._state)

    def _after(self, iteration: Iteration) -> TrainingReport:
        """Update the state with an iteration, and write the metrics and, if due, a checkpoint."""
        exchange = gathered(self._own, iteration, self._runner)
        iteration = exchange.iteration
        self._windows.add(iteration.finished)
        before, self._sharpness = self._sharpness, self._weigh()
        self._runner.sharpen(self._sharpness / before)
        steps = self._state.steps + iteration.steps
        standstill = self._standstill.state()
        self._stands_still = self._standstill.add(self._windows.window, steps)
        best = self._best() if iteration.finished else self._state.best
        confirmation = self._confirmation(best, iteration.number) if best and self._windows.met else None
        if confirmation and not confirmation.passed:
            self._windows.refuse()
        state = replace(
            self._state,
            iteration=iteration.number,
            losses=iteration.losses,
            steps=steps,
            seconds=self._seconds(),
            replayed=self._replayed_before + exchange.replayed,
            processes=exchange.processes,
            algorithm=copied(self._runner.alg.save()),
            window=tuple(self._windows.state()),
            unbroken=self._windows.unbroken,
            best=best,
            met=confirmation is not None and confirmation.passed,
            # At a standstill, keep the old value, so that a resumed training searches again, too.
            standstill=standstill if self._stands_still else self._standstill.state(),
        )
        due = self._keeping is not None and (state.reason(self._stop) is not None or self._keeping.is_due)
        report = self._report(state, iteration, confirmation, checkpointed=due)
        if self._keeping:
            self._keeping.measure(report)
        # An iteration counts once its metrics are written: no checkpoint may be of an iteration without metrics.
        self._state = state
        self._tell_time()
        if self._keeping and due:
            self._keeping.save(state)
        return report

    def _search_again(self) -> None:
        """Search for ways from the agent's failures; each process searches from its own."""
        state = self._state
        searched = searched_again(self._run, self._own, self._runner.env, state, self._searching)
        processes = tuple(self._own.gather(own_state(self._runner)))
        seconds = self._seconds()
        if state.searched and searched:
            # `complete` is only about the search before the training.
            searched = replace(joined_searches(state.searched, searched), complete=state.searched.complete)
            standstill = self._standstill.state()
            self._state = replace(state, searched=searched, processes=processes, seconds=seconds, standstill=standstill)
            if self._keeping:
                # Save now, so that a process that is killed soon need not repeat the search.
                self._keeping.save(self._state)

    def _seconds(self) -> float:
        """Return the training time so far.

        It is from the clock of the first process, so that all processes decide alike.
        """
        return self._own.broadcast(self._seconds_before + time.perf_counter() - self._began)

    def _weigh(self) -> float:
        """Set entropy bonus and penalty weight by the last episodes; return the sharpness."""
        # A few successes say little, so episodes that have not been played yet count as failures.
        met = self._windows.window.successes / (self._stop.windows * self._stop.episodes)
        weights = weighing(self._run.settings.ppo, met)
        if weights.entropy is not None:
            self._runner.alg.entropy_coef = weights.entropy
        self._runner.env.severity = weights.severity
        return weights.sharpness

    def _tell_time(self) -> None:
        """Give GAIL the training time, because it clones for a share of the limit of minutes."""
        if isinstance(self._runner.alg, Gail):
            self._runner.alg.seconds = self._state.seconds

    def _best(self) -> BestPolicy | None:
        """Return the best policy so far.

        It is the one that played the end of the last window, unless an older one has a better
        score.  If all episodes of all windows met the spec, it is always the one of the last
        window.
        """
        best, score = self._state.best, self._windows.score
        if score is None or (best is not None and score < best.score and not self._windows.met):
            return best
        # The state still has the weights that played the rollout, from before the update.
        return BestPolicy(score, self._state.algorithm["actor_state_dict"], self._state.steps)

    def _confirmation(self, best: BestPolicy, iteration: int) -> Confirmation:
        """Confirm the policy that met the spec in all windows; the first process plays."""
        confirmation = None
        if self._own.rank == 0:
            policy = policy_of(self._card, best.actor)
            confirmation = confirm(self._run, policy, stream(self._run, self._own, Purpose.CONFIRMATION, iteration))
        confirmation = self._own.broadcast(confirmation)
        assert confirmation is not None
        return confirmation

    def _report(
        self, state: Checkpoint, iteration: Iteration, confirmation: Confirmation | None, *, checkpointed: bool
    ) -> TrainingReport:
        """Return the report of the iteration that led to ``state``."""
        demonstrated = self._runner.env.demonstrated
        return TrainingReport(
            iteration=iteration,
            steps=state.steps,
            seconds=state.seconds,
            window=self._windows.window,
            unbroken=state.unbroken,
            confirmation=confirmation,
            best_pass_rate=state.best.score[0] if state.best else None,
            best_steps=state.best.steps if state.best else None,
            stop=state.reason(self._stop),
            checkpointed=checkpointed,
            searched=state.searched,
            replayed=state.replayed,
            imitated=demonstrated.about if demonstrated else None,
        )


def _unbegun(run: Run, runner: Runner) -> Checkpoint:
    """Return the state before the first iteration, without the own states of the processes."""
    return Checkpoint(
        run=identity(run),
        iteration=0,
        losses={},
        steps=0,
        seconds=0.0,
        replayed=0,
        searched=None,
        algorithm=copied(runner.alg.save()),
        processes=(),
        window=(),
        unbroken=0,
        best=None,
        met=False,
        standstill=Standstill().state(),
    )
