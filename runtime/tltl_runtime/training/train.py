"""A training from its beginning, or from its checkpoint, to its end."""

from __future__ import annotations

import time
from collections.abc import Callable, Generator, Mapping
from contextlib import ExitStack, closing
from itertools import chain, zip_longest
from math import isfinite

import torch
from rsl_rl.algorithms import PPO
from torch import Tensor

from tltl_runtime.policies.file import check_size, write_policy
from tltl_runtime.policies.policy import Policy
from tltl_runtime.policies.threads import threads
from tltl_runtime.training.available import class_of, device_of
from tltl_runtime.training.beginning import (
    begun,
    demonstrated,
    environments,
    initial_weights,
    prepared,
    searched_again,
)
from tltl_runtime.training.checkpoint import Best, Checkpoint, copied, write_checkpoint
from tltl_runtime.training.confirmation import confirm
from tltl_runtime.training.demonstrations import Tried
from tltl_runtime.training.distributed import Peers, joined
from tltl_runtime.training.folder import held
from tltl_runtime.training.gail import Gail
from tltl_runtime.training.metrics import Metrics
from tltl_runtime.training.policy import card_of, policy_of
from tltl_runtime.training.report import Confirmation, Report, StopReason
from tltl_runtime.training.run import CHECKPOINT, CURVE, POLICY, RECORD, WRITABLE, Run, identity
from tltl_runtime.training.runner import Iteration, Runner
from tltl_runtime.training.search import Searched, together
from tltl_runtime.training.settings import algorithm_name, rsl_config
from tltl_runtime.training.streams import Purpose, stream
from tltl_runtime.training.windows import Standstill, Windows
from tltlc.diagnostics.diagnostic import Diagnostic, TltlError
from tltlc.record import replace


def train(
    run: Run,
    *,
    resume: bool = False,
    searching: Callable[[Searched], None] = lambda searched: None,
    recording: Callable[[Tried], None] = lambda tried: None,
) -> Generator[Report]:
    """Train in ``run.folder``, with a report after each iteration; the last one says why it ends.

    The folder gets ``run.json``, ``checkpoint.pt``, ``policy.safetensors`` and the measurements of
    :class:`~tltl_runtime.training.metrics.Metrics`, each before the report that tells of it.  Whatever ends it, Ctrl-C
    and closing the iterator too, leaves a checkpoint of the last whole iteration; a process that is killed loses what
    came after the last one.  With ``resume`` the training goes on from there; one that is over gives its last report.

    A search for ways to meet the spec comes first, which tells ``searching`` how far it is; by imitation, where no
    demonstrations are named, the recording of the expert's, which tells ``recording`` of each.

    Equal runs give equal numbers, and so do equal checkpoints that are resumed.  With torchrun each process trains with
    environments of its own, and all report the same but for losses, times and searches, which are each one's own; the
    first alone writes.

    Raises:
        TltlError: TLT0005, a file cannot be written; TLT0854, the environment gave values that are no numbers; TLT0862,
            there is no such device or class, or the network is too large for the file of a policy; TLT0864, the
            checkpoint cannot be resumed from; TLT0865, another process trains in the folder; TLT0866, a loss is no
            number any more; TLT0867, the folder holds a training and ``resume`` is false; TLT0868, the level has
            changed meanwhile; TLT0920 and TLT0921, there are no demonstrations to imitate;
            TLT0922, they are others now; TLT0940, so is the policy to begin with.
        WorkerError: a process that plays was lost.
    """
    runner = class_of("runner", run.settings.classes.runner, Runner)
    class_of("algorithm", algorithm_name(run.settings), Gail if run.settings.imitates else PPO)
    check_size(run.settings.network, run.fspa, run.sensors)
    with ExitStack() as stack:
        own, device = stack.enter_context(joined(device_of(run.settings.device)))
        checkpoint = None
        if own.rank == 0:
            stack.enter_context(held(run.folder))
            checkpoint = begun(run, resume)
        checkpoint = own.broadcast(checkpoint)
        stack.enter_context(threads(1))
        to_imitate = demonstrated(run, own, recording)
        weights = initial_weights(run, own, checkpoint)
        played = stack.enter_context(closing(environments(run)))
        env, searched = prepared(run, own, device, played, checkpoint, searching, to_imitate)
        if env.lessons:
            stack.callback(env.lessons.close)
        torch.manual_seed(int(stream(run, own, Purpose.TORCH).generate_state(1)[0]))
        config = rsl_config(run.settings, env.shapes, env.branches)
        made = runner(env, config | {"warm_up": run.settings.ppo.warm_up if run.initial else 0}, None, device)
        if weights:
            made.begin_with(weights)
        training = _Training(run, own, made, checkpoint, searched, searching)
        yield from training.reports()


class _Training:
    """A training of this process as one of ``own``; ``state`` is that after the last whole iteration."""

    def __init__(
        self,
        run: Run,
        own: Peers,
        runner: Runner,
        begun: Checkpoint | None,
        searched: Searched | None,
        searching: Callable[[Searched], None],
    ) -> None:
        self._run, self._own, self._runner, self._searching = run, own, runner, searching
        self._stop = run.settings.stop
        demonstrated = runner.env.demonstrated
        self._imitated = demonstrated.about if demonstrated else None
        # As the level is now: what its file holds later was not trained on.
        self._card = card_of(run, runner.env)
        self._windows = Windows(self._stop.windows, self._stop.episodes, run.fspa.limit_steps)
        if begun is not None:
            runner.take_up(begun.algorithm)
            runner.current_learning_iteration = begun.iteration
            self._windows.load(begun.window, begun.unbroken)
            if own.rank < len(begun.processes):
                _set_own(begun.processes[own.rank], runner)
        self._sharpness = 1.0
        self._weigh()
        self._state = begun or Checkpoint(
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
        if searched:
            seconds = own.broadcast(self._state.seconds + searched.seconds)
            if before := self._state.searched:
                searched = together(before, searched)
            self._state = replace(self._state, searched=searched, seconds=seconds)
        if searched or begun is None:
            self._state = replace(self._state, processes=tuple(own.gather(_own(runner))))
        self._seconds_before, self._began = self._state.seconds, time.perf_counter()
        self._replayed_before = self._state.replayed
        self._saved: Checkpoint | None = begun
        self._saved_at = self._began
        self._standstill, self._stands_still = Standstill(*self._state.standstill), False
        self._written: Best | None = None
        """The best policy of which there is a file."""
        self._tell_time()

    def reports(self) -> Generator[Report]:
        """Train to the end."""
        metrics = None
        try:
            if self._own.rank == 0:
                metrics = self._take_up()
            if self._state.iteration and (reason := self._reason()):
                iteration = Iteration(self._state.iteration, 0, (), dict(self._state.losses), 0.0, 0.0)
                yield self._report(iteration, reason, None, checkpointed=False)
                return
            for iteration in self._runner.iterations():
                yield (report := self._after(iteration, metrics))
                if report.stop:
                    return
                if self._stands_still:
                    self._search_again()
        finally:
            try:
                self._save()
            finally:
                if metrics:
                    metrics.close()

    def _take_up(self) -> Metrics:
        """Bring the folder to where the training is: whoever is killed soon need not search again."""
        for name in (RECORD, CURVE):
            (self._run.folder / name).unlink(missing_ok=True)
        if self._state.iteration and (self._state.best or self._reason()):
            self._write_policy(self._policy())
        self._save()
        return Metrics(self._run.folder, self._run.fspa, after=self._state.iteration, steps=self._state.steps)

    def _after(self, iteration: Iteration, metrics: Metrics | None) -> Report:
        """Take up what an iteration gave, and write what is due."""
        told = self._own.gather((iteration, _own(self._runner), self._runner.env.replayed))
        for theirs, *_ in told:
            _check_losses(theirs)
        # In which order the episodes of different processes ended nobody knows.
        by_turns = chain.from_iterable(zip_longest(*(theirs.finished for theirs, *_ in told)))
        finished = tuple(each for each in by_turns if each)
        iteration = replace(iteration, finished=finished, steps=iteration.steps * self._own.count)
        self._windows.add(finished)
        sharpness = self._sharpness
        self._weigh()
        self._runner.sharpen(self._sharpness / sharpness)
        steps = self._state.steps + iteration.steps
        standstill = self._standstill.state()
        self._stands_still = self._standstill.add(self._windows.window, steps)
        best = self._best() if finished else self._state.best
        confirmation = self._confirmation(best, iteration.number) if best and self._windows.met else None
        if confirmation and not confirmation.passed:
            self._windows.refuse()
        before, self._state = (
            self._state,
            replace(
                self._state,
                iteration=iteration.number,
                losses=iteration.losses,
                steps=steps,
                seconds=self._seconds(),
                replayed=self._replayed_before + sum(replayed for *_, replayed in told),
                processes=tuple(theirs for _, theirs, _ in told),
                algorithm=copied(self._runner.alg.save()),
                window=tuple(self._windows.state()),
                unbroken=self._windows.unbroken,
                best=best,
                met=confirmation is not None and confirmation.passed,
                # Where it stands still the search is yet to come, of whoever resumes it, too.
                standstill=standstill if self._stands_still else self._standstill.state(),
            ),
        )
        self._tell_time()
        reason = self._reason()
        due = bool(reason) or time.perf_counter() - self._saved_at >= self._run.settings.checkpoint_s
        report = self._report(iteration, reason, confirmation, checkpointed=due)
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

    def _search_again(self) -> None:
        """Search ways for what the agent fails in; each process does so for its own failures."""
        state = self._state
        searched = searched_again(
            self._run, self._own, self._runner.env, state.iteration, state.seconds, self._searching
        )
        processes = tuple(self._own.gather(_own(self._runner)))
        seconds = self._seconds()
        if state.searched and searched:
            # Whether it was broken off is asked of the search before the training alone.
            searched = replace(together(state.searched, searched), complete=state.searched.complete)
            self._state = replace(
                state,
                searched=searched,
                processes=processes,
                seconds=seconds,
                standstill=self._standstill.state(),
            )
            # Whoever is killed soon need not search again.
            self._save()

    def _seconds(self) -> float:
        """How long the training has gone on: what all decide upon must be the same for all, so one has the clock."""
        return self._own.broadcast(self._seconds_before + time.perf_counter() - self._began)

    def _weigh(self) -> None:
        """Weigh the entropy bonus the less, the more often the spec is met, and failures the more: then there is less
        to try, and the discounted penalty is less than what a longer way costs that is safe.  What is chosen by chance
        against what was learned then makes most of the failures, so the likelier choices become likelier.
        """
        ppo, stop = self._run.settings.ppo, self._stop
        met = self._windows.window.successes / (stop.windows * stop.episodes)
        if ppo.entropy_schedule == "fading":
            self._runner.alg.entropy_coef = ppo.entropy * (1 - met)
        rise = max(0.0, 2 * met - 1)
        self._runner.env.severity = rise
        self._sharpness = 1 + (ppo.sharpening - 1) * rise

    def _tell_time(self) -> None:
        """Tell who imitates how long it has trained: it clones for a share of the minutes, where these are limited."""
        if isinstance(self._runner.alg, Gail):
            self._runner.alg.seconds = self._state.seconds

    def _best(self) -> Best | None:
        """The best policy so far: that which played the end of the last window, where none before did better."""
        best, score = self._state.best, self._windows.score
        if score is None or (best is not None and score < best.score and not self._windows.met):
            return best
        # The rollout was played with the weights from before the update that followed it.
        return Best(score, self._state.algorithm["actor_state_dict"], self._state.steps)

    def _confirmation(self, best: Best, iteration: int) -> Confirmation:
        """What the first process finds when it confirms the policy that met the spec throughout the windows."""
        found = None
        if self._own.rank == 0:
            policy = policy_of(self._card, best.actor)
            found = confirm(self._run, policy, stream(self._run, self._own, Purpose.CONFIRMATION, iteration))
        found = self._own.broadcast(found)
        assert found is not None
        return found

    def _reason(self) -> StopReason | None:
        """Why the training is over, if it is."""
        if self._state.met:
            return "met"
        if self._state.steps >= self._stop.steps:
            return "steps"
        return "minutes" if 0 < self._stop.minutes * 60 <= self._state.seconds else None

    def _report(
        self, iteration: Iteration, reason: StopReason | None, confirmation: Confirmation | None, *, checkpointed: bool
    ) -> Report:
        best = self._state.best
        return Report(
            iteration=iteration,
            steps=self._state.steps,
            seconds=self._state.seconds,
            window=self._windows.window,
            unbroken=self._windows.unbroken,
            confirmation=confirmation,
            best_pass_rate=best.score[0] if best else None,
            best_steps=best.steps if best else None,
            stop=reason,
            checkpointed=checkpointed,
            searched=self._state.searched,
            replayed=self._state.replayed,
            imitated=self._imitated,
        )

    def _save(self) -> None:
        """Write checkpoint and policy, where there is anything new."""
        state = self._state
        if self._own.rank != 0 or state is self._saved:
            return
        try:
            # A policy that cannot be written must not be in a checkpoint.
            policy = self._policy() if state.best is not self._written or self._reason() else None
            write_checkpoint(self._run.folder / CHECKPOINT, state)
            if policy:
                self._write_policy(policy)
        except Exception:
            # It is not tried again at the end; what is broken off by Ctrl-C is.
            self._saved = state
            raise
        self._saved, self._saved_at = state, time.perf_counter()

    def _policy(self) -> Policy:
        """The best policy, or the last one where none is the best yet."""
        best = self._state.best
        return policy_of(self._card, best.actor if best else self._state.algorithm["actor_state_dict"])

    def _write_policy(self, policy: Policy) -> None:
        write_policy(self._run.folder / POLICY, policy, WRITABLE)
        self._written = self._state.best


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
