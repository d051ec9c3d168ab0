"""A training from its beginning, or from its checkpoint, to its end."""

from __future__ import annotations

from collections.abc import Iterator

from tltl_runtime.training.report import Report
from tltl_runtime.training.run import CHECKPOINT, POLICY, RUN, Run

__all__ = ["CHECKPOINT", "POLICY", "RUN", "Run", "train"]


def train(run: Run, *, resume: bool = False) -> Iterator[Report]:
    """Train in ``run.folder``, with a report after each iteration; the last one says why it ends.

    The folder gets ``run.json``, ``checkpoint.pt``, ``policy.safetensors`` and the measurements of
    :class:`~tltl_runtime.training.metrics.Metrics`, all written here and before the report that tells of them.
    Closing the iterator, Ctrl-C and any other error leave a checkpoint of the last iteration that was reported.
    With ``resume``, the training goes on from there.
    """
    raise NotImplementedError
    yield
