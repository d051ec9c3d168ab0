"""Write the metrics of a training to ``metrics.jsonl`` and for TensorBoard."""

from __future__ import annotations

import errno
import os
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any, Final

from torch.utils.tensorboard import SummaryWriter

from tltl_runtime.training.files.metrics import METRICS, WINDOW_MEANS, WRITE_ADVICE, line_text, metrics_line, truncate
from tltl_runtime.training.files.report import TrainingReport
from tltlc.api import Diagnostic, Fspa, TltlError, fileio

_ITERATION_VALUES: Final = ("steps_per_s", "collect_s", "learn_s", "episodes")
"""The fields of a line of ``metrics.jsonl`` that TensorBoard shows under ``time``."""


class Metrics:
    """Writes the metrics files in the folder of a training.

    A resumed training continues after iteration ``after``, at which it had taken ``steps`` steps.
    The metrics of later iterations are removed, because these iterations run again.

    Raises:
        TltlError: TLT0005, the folder cannot be written to, here or in ``add``; the errors of
            :func:`~tltl_runtime.training.files.metrics.read_metrics`.
    """

    def __init__(self, folder: Path, fspa: Fspa, *, after: int = 0, steps: int = 0) -> None:
        self._path, self._fspa = folder / METRICS, fspa
        truncate(self._path, after)
        try:
            # TensorBoard then hides the events at this step and later in other files of this folder.
            self._events = SummaryWriter(str(folder), purge_step=steps + 1)
        except OSError as error:
            raise _write_error(folder, error) from None

    def add(self, report: TrainingReport) -> None:
        """Append the metrics of an iteration to ``metrics.jsonl``, and write them for TensorBoard."""
        fields = metrics_line(report, self._fspa)
        try:
            _append(self._path, line_text(fields).encode())
            for tag, value in _scalars(fields):
                self._events.add_scalar(tag, value, report.steps)
            self._events.flush()
        except OSError as error:
            raise _write_error(self._path, error) from None

    def close(self) -> None:
        """Close the files for TensorBoard; ``metrics.jsonl`` is closed after each line."""
        self._events.close()


def _append(path: Path, line: bytes) -> None:
    """Append a line in a single write, so that a killed process leaves all of it or nothing."""
    descriptor = os.open(path, os.O_WRONLY | os.O_APPEND | os.O_CREAT, 0o666)
    try:
        if os.write(descriptor, line) < len(line):
            raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))
        # A checkpoint must not survive a crash that loses the metrics written before it.
        os.fsync(descriptor)
    finally:
        os.close(descriptor)


def _scalars(fields: Mapping[str, Any]) -> Iterator[tuple[str, float]]:
    """Yield the fields of a line of ``metrics.jsonl`` as tags and values for TensorBoard."""
    yield from ((f"train/{name}", fields[name]) for name in WINDOW_MEANS if fields["window"])
    yield from ((f"time/{name}", fields[name]) for name in _ITERATION_VALUES)
    yield from ((f"state/{state['state']}", state["share"]) for state in fields["states"])
    yield from ((f"violated/{state['state']}", state["violated"]) for state in fields["states"])
    yield from ((f"loss/{name}", value) for name, value in fields["losses"].items())


def _write_error(path: Path, error: OSError) -> TltlError:
    title = f"cannot write `{path}`: {fileio.reason(error)}"
    return TltlError([Diagnostic("TLT0005", title, help=WRITE_ADVICE)])
