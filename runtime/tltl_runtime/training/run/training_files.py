"""What a training keeps in its folder while it goes on: checkpoint, policy and measurements."""

from __future__ import annotations

import time

from tltl_runtime.policies.card import Card
from tltl_runtime.policies.file import write_policy
from tltl_runtime.policies.policy import Policy
from tltl_runtime.training.ppo.policy import policy_of
from tltl_runtime.training.run.checkpoint import Best, Checkpoint, write_checkpoint
from tltl_runtime.training.run.metrics import Metrics
from tltl_runtime.training.run.report import Report
from tltl_runtime.training.run.run import CHECKPOINT, CURVE, POLICY, RECORD, WRITABLE, Run


class Keeping:
    """The folder of a training as its first process keeps it, which alone writes.

    ``card`` is that of its policies, ``saved`` the checkpoint that is there, None where there is none.

    Raises:
        TltlError: TLT0005, a file cannot be written; TLT0001, the measurements cannot be read; TLT0866, a weight is too
            large for a policy.
    """

    def __init__(self, run: Run, card: Card, saved: Checkpoint | None) -> None:
        self._run, self._card = run, card
        self._saved, self._saved_at = saved, time.perf_counter()
        self._written: Best | None = None
        """The best policy of which there is a file."""
        self._metrics: Metrics | None = None

    def take_up(self, state: Checkpoint) -> None:
        """Bring the folder to where the training is: whoever is killed soon need not search again."""
        for name in (RECORD, CURVE):
            (self._run.folder / name).unlink(missing_ok=True)
        if state.iteration and (state.best or self._is_over(state)):
            self._write(self._policy(state), state)
        self.save(state)
        self._metrics = Metrics(self._run.folder, self._run.fspa, after=state.iteration, steps=state.steps)

    def measure(self, report: Report) -> None:
        """Write what an iteration measured."""
        assert self._metrics is not None
        self._metrics.add(report)

    @property
    def is_due(self) -> bool:
        """Whether the last checkpoint is so old that there should be another."""
        return time.perf_counter() - self._saved_at >= self._run.settings.checkpoint_s

    def save(self, state: Checkpoint) -> None:
        """Write checkpoint and policy, where there is anything new."""
        if state is self._saved:
            return
        try:
            # A policy that cannot be written must not be in a checkpoint.
            policy = self._policy(state) if state.best is not self._written or self._is_over(state) else None
            write_checkpoint(self._run.folder / CHECKPOINT, state)
            if policy:
                self._write(policy, state)
        except Exception:
            # It is not tried again at the end; what is broken off by Ctrl-C is.
            self._saved = state
            raise
        self._saved, self._saved_at = state, time.perf_counter()

    def close(self, state: Checkpoint) -> None:
        """Save the training as it ends here, and close the measurements."""
        try:
            self.save(state)
        finally:
            if self._metrics:
                self._metrics.close()

    def _is_over(self, state: Checkpoint) -> bool:
        return state.reason(self._run.settings.stop) is not None

    def _policy(self, state: Checkpoint) -> Policy:
        return policy_of(self._card, state.weights)

    def _write(self, policy: Policy, state: Checkpoint) -> None:
        write_policy(self._run.folder / POLICY, policy, WRITABLE)
        self._written = state.best
