"""Run a training from its start or a checkpoint to its end."""

from __future__ import annotations

import time
from collections.abc import Callable, Generator
from contextlib import ExitStack, closing

import torch
from rsl_rl.algorithms import PPO

from tltl_runtime.game.registry import game_of
from tltl_runtime.policies.compatibility import check_spaces
from tltl_runtime.policies.file import check_size
from tltl_runtime.support.record_json import RecordJsonError
from tltl_runtime.training.exploration.search import SearchProgress, combined_progress
from tltl_runtime.training.exploration.search_plan import SearchPlan
from tltl_runtime.training.files.checkpoint import BestPolicy, Checkpoint, checkpoint_error, deep_copy
from tltl_runtime.training.files.found_ways import remove_ways
from tltl_runtime.training.files.report import Confirmation, TrainingReport
from tltl_runtime.training.files.run_file import CHECKPOINT, TrainingRun
from tltl_runtime.training.files.settings import algorithm_name, rsl_config
from tltl_runtime.training.files.training_lock import lock_training
from tltl_runtime.training.imitation.demonstrations import Attempt
from tltl_runtime.training.imitation.gail import Gail
from tltl_runtime.training.ppo.distributed import ProcessGroup, join_process_group, process_group
from tltl_runtime.training.ppo.policy import card_of, policy_of
from tltl_runtime.training.ppo.random_streams import Purpose, stream
from tltl_runtime.training.ppo.recent_episodes import RecentEpisodes, Standstill
from tltl_runtime.training.ppo.scheduled_weights import scheduled_weights
from tltl_runtime.training.ppo.torch_threads import threads
from tltl_runtime.training.run.checkpoint_restore import first_checkpoint, restore_checkpoint
from tltl_runtime.training.run.confirmation import confirm
from tltl_runtime.training.run.named_classes import class_of, device_of
from tltl_runtime.training.run.preparation import (
    check_is_new,
    initial_policy,
    load_imitation_data,
    make_environments,
    prepare_environment,
    start_or_resume,
)
from tltl_runtime.training.run.process_exchange import gather_iteration, process_state, set_generators
from tltl_runtime.training.run.search_schedule import SearchCallback, search_after_standstill
from tltl_runtime.training.run.spaces import (
    TrainingSpaces,
    check_one_at_a_time,
    check_search,
    spaces_of,
    training_spaces,
)
from tltl_runtime.training.run.training_clock import TrainingClock
from tltl_runtime.training.run.training_files import TrainingFiles
from tltl_runtime.training.runner import Iteration, Runner
from tltl_runtime.wire.lost_episodes import LostEpisodes, together
from tltlc.api import replace


def train(
    run: TrainingRun,
    *,
    resume: bool = False,
    on_search: SearchCallback = lambda searched: None,
    on_attempt: Callable[[Attempt], None] = lambda attempt: None,
    on_measuring: Callable[..., None] = lambda *, searches: None,
    on_plan: Callable[[SearchPlan], None] = lambda plan: None,
    on_start: Callable[[], None] = lambda: None,
    on_made: Callable[[int], None] = lambda count: None,
    began: float | None = None,
) -> Generator[TrainingReport]:
    """Train in ``run.folder``; yield a report after each iteration.

    The last report says why the training ends. The folder gets ``run.json``, ``checkpoint.pt``,
    ``policy.safetensors`` and the files of
    :class:`~tltl_runtime.training.files.metrics_writer.Metrics`. All files of an iteration are
    written before its report is yielded. Any end of the training, even by Ctrl-C or by closing the
    iterator, leaves a checkpoint of the last complete iteration. If the process is killed, however,
    the iterations after the last checkpoint are lost. With ``resume``, the training continues from
    the checkpoint; a training that is over yields its last report again.

    First, a search finds demonstrations that meet the spec; ``on_search`` is called with its
    progress. ``on_plan`` is called before, with how the game is searched, or why it is not. ``on_measuring``
    is called before the game is played to find that out; it says with ``searches`` whether the training
    wants a search. ``on_start`` is called before the environments are started, and ``on_made`` from
    time to time with the number of those that have started. If the
    training begins with a policy, that policy plays first in the search. With imitation, there is
    no search. If no demonstrations are given, demonstrations of the expert are recorded first;
    ``on_attempt`` is called with each attempt.

    The limit of minutes counts from ``began``, a time of ``time.perf_counter``; by default, from now. So
    the starts of the games and the search count, too. If the limit passes while an iteration plays, the
    steps of this iteration are dropped, and the training ends after the iteration before. The first
    iteration is always finished, so that there is a policy.

    Equal runs give equal results, and so do trainings that resume from equal checkpoints. With
    torchrun, each process trains with its own environments. The reports of all processes are equal,
    with two exceptions: each process reports its own losses, times and searches, and only the first
    process writes checkpoints.

    Raises:
        TltlError: TLT0005, a file cannot be written; TLT0854, the environment gave values that are
            not numbers; TLT0843, the policy to begin with is of another game; TLT0844, policies do
            not support the observations or actions of the game; TLT0862, the device or a class does
            not exist, or the network is too large for a policy file; TLT0864, the checkpoint cannot
            be resumed from; TLT0865, another process trains in the folder; TLT0866, a loss, an
            action or a weight is not finite; TLT0867, the folder holds a training and ``resume`` is
            false; TLT0868, the level has changed; TLT0920 and TLT0921, there are no demonstrations
            to imitate; TLT0922, the demonstrations have changed; TLT0940, the policy to begin with
            has changed.
        WorkerError: a worker process of the environments was lost. A game in another process that is
            lost costs one episode, as :class:`~tltl_runtime.wire.surviving_env.SurvivingEnv` says;
            only if too many are lost is this a lost worker, too.
    """
    began = time.perf_counter() if began is None else began
    runner = class_of("runner", run.settings.classes.runner, Runner)
    class_of("algorithm", algorithm_name(run.settings), Gail if run.settings.imitates else PPO)
    # A new training writes nothing if it cannot begin. A resumed one first checks that nothing has changed.
    check_one_at_a_time(run)
    if not resume and process_group().rank == 0:
        check_is_new(run)
    if not game_of(run.level).promises_replays:
        on_measuring(searches=run.settings.searches)
    spaces = None if resume else _checked_spaces(run)
    with ExitStack() as stack:
        group, device = stack.enter_context(join_process_group(device_of(run.settings.device)))
        checkpoint = None
        if group.rank == 0:
            stack.enter_context(lock_training(run.folder))
            checkpoint = start_or_resume(run, resume)
        checkpoint = group.broadcast(checkpoint)
        clock = TrainingClock(began, checkpoint.seconds if checkpoint else 0.0)
        stack.enter_context(threads(1))
        # All processes search, or none does.
        spaces = group.broadcast(spaces_of(spaces or _checked_spaces(run), checkpoint))
        check_search(run, spaces, checkpoint)
        if spaces.plan:
            on_plan(spaces.plan)
        imitation_data = load_imitation_data(run, group, spaces, on_attempt)
        initial = initial_policy(run, group, checkpoint)
        on_start()
        vector_env = stack.enter_context(closing(make_environments(run, spaces, on_made)))
        if initial:
            check_spaces(initial.card, vector_env.single_observation_space, vector_env.single_action_space)
        env, searched = prepare_environment(
            run, group, device, spaces, vector_env, checkpoint, on_search, imitation_data, initial, clock
        )
        if env.self_imitation:
            stack.callback(env.self_imitation.close)
        torch.manual_seed(int(stream(run, group, Purpose.TORCH).generate_state(1)[0]))
        config = rsl_config(run.settings, env.shapes, env.branches, env.layouts)
        new_runner = runner(env, config | {"warm_up": run.settings.ppo.warm_up if run.initial else 0}, None, device)
        if initial:
            new_runner.load_actor(initial.weights())
        training = _Training(run, group, new_runner, checkpoint, searched, on_search, spaces, clock)
        yield from training.reports()


def _checked_spaces(run: TrainingRun) -> TrainingSpaces:
    """Examine the environment of a training, and check that its policy is not too large for a file."""
    spaces = training_spaces(run)
    check_size(run.settings.network, run.fspa, run.sensors, spaces.layouts)
    return spaces


class _Training:
    """The part of a training that runs in this process.

    ``_state`` is the state of the training after the last complete iteration.
    """

    def __init__(
        self,
        run: TrainingRun,
        group: ProcessGroup,
        runner: Runner,
        checkpoint: Checkpoint | None,
        searched: SearchProgress | None,
        on_search: SearchCallback,
        spaces: TrainingSpaces,
        clock: TrainingClock,
    ) -> None:
        self._plan, self._plays_at_once = spaces.plan, spaces.plays_at_once
        self._run, self._group, self._runner, self._on_search = run, group, runner, on_search
        self._stop = run.settings.stop
        # The card is made now: later changes of the level's file are not part of this training.
        self._card = card_of(run, runner.env)
        self._episodes = RecentEpisodes(self._stop.windows, self._stop.episodes, run.fspa.limit_steps)
        if checkpoint is not None:
            try:
                restore_checkpoint(checkpoint, runner, len(run.fspa.states))
            except RecordJsonError as error:
                raise checkpoint_error(run.folder / CHECKPOINT, str(error)) from None
            runner.current_learning_iteration = checkpoint.iteration
            self._episodes.load(checkpoint.window, checkpoint.unbroken)
            if group.rank < len(checkpoint.processes):
                set_generators(checkpoint.processes[group.rank], runner)
        self._lost: LostEpisodes | None = None
        self._inverse_temperature = self._apply_weights()
        self._state = checkpoint or first_checkpoint(run, runner)
        self._clock = clock
        before_s, search_s = self._state.seconds, searched.seconds if searched else 0.0
        self._setup_s = group.broadcast(max(0.0, clock.seconds - before_s - search_s))
        if searched:
            if before := self._state.searched:
                searched = combined_progress(before, searched)
            self._state = replace(self._state, searched=searched)
        if searched or checkpoint is None:
            processes = tuple(group.gather(process_state(runner)))
            self._state = replace(self._state, processes=processes, seconds=self._seconds())
        if group.count == 1:
            runner.is_out_of_time = lambda: self._stop.is_out_of_time(clock.seconds)
        self._replayed_before = self._state.replayed
        self._standstill, self._is_standstill = Standstill(*self._state.standstill), False
        # A search at a standstill that was stopped is made again after an iteration, and needs its ways until then.
        self._may_have_ways = searched is not None or not self._state.iteration
        self._files = TrainingFiles(run, self._card, checkpoint) if group.rank == 0 else None
        # The start and the search take nothing from the share of the time in which an agent is cloned.
        self._untrained_s = self._setup_s if self._state.iteration else self._state.seconds
        self._update_gail_time()

    def reports(self) -> Generator[TrainingReport]:
        """Train to the end; yield the report of each iteration."""
        try:
            if self._files:
                self._files.restore(self._state)
            if self._state.iteration and self._state.reason(self._stop):
                yield self._last_report()
                return
            for iteration in self._runner.iterations():
                yield (report := self._finish_iteration(iteration))
                if report.stop:
                    return
                if self._is_standstill:
                    self._search_again()
            # The runner has dropped an iteration, because the limit of minutes has passed.
            self._state = replace(self._state, seconds=self._seconds())
            yield self._last_report()
        finally:
            if self._files:
                self._files.close(self._state)

    def _last_report(self) -> TrainingReport:
        """Return the report of a training that ends after an iteration that was reported before."""
        iteration = Iteration(self._state.iteration, 0, (), dict(self._state.losses), 0.0, 0.0)
        return self._report(self._state, iteration, None, checkpointed=False)

    def _finish_iteration(self, iteration: Iteration) -> TrainingReport:
        """Update the state after an iteration; write its metrics and, if due, a checkpoint."""
        exchange = gather_iteration(self._group, iteration, self._runner)
        if self._may_have_ways:
            # All processes have begun to learn, so the ways of the last search are in a checkpoint.
            remove_ways(self._run.folder, self._group.rank)
            self._may_have_ways = False
        iteration = exchange.iteration
        self._episodes.add(iteration.finished)
        self._lost = together((self._lost, iteration.lost))
        before, self._inverse_temperature = self._inverse_temperature, self._apply_weights()
        self._runner.scale_inverse_temperature(self._inverse_temperature / before)
        steps = self._state.steps + iteration.steps
        standstill = self._standstill.state()
        self._is_standstill = self._standstill.add(self._episodes.window, steps)
        best = self._best_policy() if iteration.finished else self._state.best
        confirmation = self._confirmation(best, iteration.number) if best and self._episodes.all_met else None
        if confirmation and not confirmation.passed:
            self._episodes.reset_unbroken()
        state = replace(
            self._state,
            iteration=iteration.number,
            losses=iteration.losses,
            steps=steps,
            seconds=self._seconds(),
            replayed=self._replayed_before + exchange.replayed,
            processes=exchange.processes,
            algorithm=deep_copy(self._runner.alg.save()),
            window=tuple(self._episodes.state()),
            unbroken=self._episodes.unbroken,
            best=best,
            met=confirmation is not None and confirmation.passed,
            # At a standstill, keep the old value, so that a resumed training searches again, too.
            standstill=standstill if self._is_standstill else self._standstill.state(),
        )
        due = self._files is not None and (state.reason(self._stop) is not None or self._files.is_due)
        report = self._report(state, iteration, confirmation, checkpointed=due)
        if self._files:
            self._files.add_metrics(report)
        # An iteration counts once its metrics are written: no checkpoint may be of an iteration without metrics.
        self._state = state
        self._update_gail_time()
        if self._files and due:
            self._files.save(state)
        return report

    def _search_again(self) -> None:
        """Search for demonstrations from failed episodes of the agent.

        Each process searches from its own failed episodes.
        """
        state = self._state
        searched = search_after_standstill(
            self._run, self._group, self._runner.env, state, self._on_search, self._clock
        )
        processes = tuple(self._group.gather(process_state(self._runner)))
        seconds = self._seconds()
        if state.searched and searched:
            # `complete` is only about the search before the training.
            searched = replace(combined_progress(state.searched, searched), complete=state.searched.complete)
            standstill = self._standstill.state()
            self._state = replace(state, searched=searched, processes=processes, seconds=seconds, standstill=standstill)
            if self._files:
                # Save now, so that a process that is killed soon need not repeat the search.
                self._files.save(self._state)
            self._may_have_ways = True

    def _seconds(self) -> float:
        """Return the training time so far, in seconds.

        The clock of the first process measures this time, so that all processes decide alike.
        """
        return self._group.broadcast(self._clock.seconds)

    def _apply_weights(self) -> float:
        """Set the entropy bonus and the penalty weight for the current pass rate.

        Return the inverse temperature for this pass rate; the caller must apply it.
        """
        # A few successes say little, so episodes that have not been played yet count as failures.
        pass_rate = self._episodes.window.successes / (self._stop.windows * self._stop.episodes)
        weights = scheduled_weights(self._run.settings.ppo, pass_rate)
        if weights.entropy is not None:
            self._runner.alg.entropy_coef = weights.entropy
        self._runner.env.penalty_weight = weights.penalty_weight
        return weights.inverse_temperature

    def _update_gail_time(self) -> None:
        """Tell GAIL the training time, because it clones for a share of the limit of minutes."""
        if isinstance(self._runner.alg, Gail):
            self._runner.alg.seconds = max(0.0, self._state.seconds - self._untrained_s)

    def _best_policy(self) -> BestPolicy | None:
        """Return the best policy so far; None until ``episodes`` episodes (a window) have ended.

        The policy that played the latest episodes is the best one if its score is at least that of
        the best policy before, or if the last ``windows * episodes`` episodes all met the spec.
        """
        best, score = self._state.best, self._episodes.score
        if score is None or (best is not None and score < best.score and not self._episodes.all_met):
            return best
        # The state still has the weights that played the rollout, from before the update.
        return BestPolicy(score, self._state.algorithm["actor_state_dict"], self._state.steps)

    def _confirmation(self, best: BestPolicy, iteration: int) -> Confirmation:
        """Let the first process test a policy in new episodes; return the result in all processes.

        Call this method only after the last ``windows * episodes`` episodes of the training met the
        spec.
        """
        confirmation, env = None, self._runner.env
        if not self._plays_at_once:
            # The game can play the new episodes only after the environments have left it.
            env.env.call("close")
        if self._group.rank == 0:
            policy = policy_of(self._card, best.actor)
            confirmation = confirm(self._run, policy, stream(self._run, self._group, Purpose.CONFIRMATION, iteration))
        confirmation = self._group.broadcast(confirmation)
        assert confirmation is not None
        if not self._plays_at_once and not confirmation.passed:
            env.restart_episodes()
        return confirmation

    def _report(
        self, state: Checkpoint, iteration: Iteration, confirmation: Confirmation | None, *, checkpointed: bool
    ) -> TrainingReport:
        """Return the report of the iteration that led to ``state``."""
        imitation_data = self._runner.env.imitation_data
        return TrainingReport(
            iteration=iteration,
            steps=state.steps,
            seconds=state.seconds,
            window=self._episodes.window,
            unbroken=state.unbroken,
            confirmation=confirmation,
            best_pass_rate=state.best.score[0] if state.best else None,
            best_steps=state.best.steps if state.best else None,
            stop=state.reason(self._stop),
            checkpointed=checkpointed,
            searched=state.searched,
            replayed=state.replayed,
            imitated=imitation_data.summary if imitation_data else None,
            plan=self._plan,
            lost=self._lost,
            setup_s=self._setup_s,
        )
