"""The files that a training writes while it runs: checkpoint, policy and metrics."""

from __future__ import annotations

import time

from tltl_runtime.policies.card import Card
from tltl_runtime.policies.file import write_policy
from tltl_runtime.policies.policy import Policy
from tltl_runtime.training.files.checkpoint import BestPolicy, Checkpoint, write_checkpoint
from tltl_runtime.training.files.metrics_writer import Metrics
from tltl_runtime.training.files.report import TrainingReport
from tltl_runtime.training.files.run_file import CHECKPOINT, CURVE, POLICY, RECORD, WRITABLE, TrainingRun
from tltl_runtime.training.ppo.policy import policy_of


class TrainingFiles:
    """Writes the files of a training into its folder; only the first process does so.

    ``card`` describes the policies of the training. ``saved`` is the checkpoint in the folder; None
    if there is none yet.

    Raises:
        TltlError: from any method: TLT0005, a file cannot be written; TLT0001, the metrics cannot
            be read; TLT0866, a weight is too large for a policy.
    """

    def __init__(self, run: TrainingRun, card: Card, saved: Checkpoint | None) -> None:
        self._run, self._card = run, card
        self._saved_state, self._saved_at = saved, time.perf_counter()
        self._written_best: BestPolicy | None = None
        """The best policy in the policy file."""
        self._metrics: Metrics | None = None

    def restore(self, state: Checkpoint) -> None:
        """Update the files in the folder to ``state``, with which the training begins or resumes.

        Remove ``record.json`` and ``curve.png``, which are written at the end, and the metrics of
        later iterations. Write the policy file of a resumed training again. Write a new checkpoint
        at once, so that the search need not be repeated if the process is killed soon.
        """
        for name in (RECORD, CURVE):
            (self._run.folder / name).unlink(missing_ok=True)
        if state.iteration and (state.best or self._is_over(state)):
            self._write(self._policy(state), state)
        self.save(state)
        self._metrics = Metrics(self._run.folder, self._run.fspa, after=state.iteration, steps=state.steps)

    def add_metrics(self, report: TrainingReport) -> None:
        """Write the metrics of an iteration."""
        assert self._metrics is not None
        self._metrics.add(report)

    @property
    def is_due(self) -> bool:
        """Whether a checkpoint is due: the last one is at least ``checkpoint_s`` seconds old."""
        return time.perf_counter() - self._saved_at >= self._run.settings.checkpoint_s

    def save(self, state: Checkpoint) -> None:
        """Write ``state`` as the checkpoint; do nothing if it is saved already.

        Also write the policy file if there is a new best policy, or the training is over.
        """
        if state is self._saved_state:
            return
        try:
            # Make the policy first: a checkpoint must not contain weights that are invalid for a policy.
            policy = self._policy(state) if state.best is not self._written_best or self._is_over(state) else None
            write_checkpoint(self._run.folder / CHECKPOINT, state)
            if policy:
                self._write(policy, state)
        except Exception:
            # Do not save this state again at the end. After Ctrl-C, which is no Exception, it is saved again.
            self._saved_state = state
            raise
        self._saved_state, self._saved_at = state, time.perf_counter()

    def close(self, state: Checkpoint) -> None:
        """Save the final state, and close the files of the metrics."""
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
        self._written_best = state.best
