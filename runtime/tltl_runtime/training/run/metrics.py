"""The metrics of a training, per iteration, in ``metrics.jsonl`` and for TensorBoard."""

from __future__ import annotations

import errno
import json
import os
from collections.abc import Iterator, Mapping
from math import isfinite
from pathlib import Path
from typing import Any, Final

from torch.utils.tensorboard import SummaryWriter

from tltl_runtime.support.record_json import to_json
from tltl_runtime.training.run.report import EpisodeWindow, TrainingReport
from tltlc.api import Diagnostic, Fspa, TltlError, fileio, label_text

METRICS: Final = "metrics.jsonl"

_ADVICE: Final = "see that there is room, and that you may write there"
OF_THE_WINDOW: Final = ("pass_rate", "progress", "reward", "episode_steps")
"""The means over the last episodes."""
_WHOLE: Final = ("iteration", "steps", "episodes", "window")
"""The integers among the fields of a line that are read back."""
_READ: Final = {*_WHOLE, "seconds", "losses", *OF_THE_WINDOW}
_OF_THE_ITERATION: Final = ("steps_per_s", "collect_s", "learn_s", "episodes")


class Metrics:
    """Writes the metrics files in the folder of a training.

    When a training is resumed, metrics after iteration ``after``, which ended at ``steps``, are
    removed, because those iterations run again.

    Raises:
        TltlError: TLT0005, the folder cannot be written to, here or in ``add``; TLT0001, a file in
            it cannot be read.
    """

    def __init__(self, folder: Path, fspa: Fspa, *, after: int = 0, steps: int = 0) -> None:
        self._path, self._fspa = folder / METRICS, fspa
        truncate(self._path, after)
        try:
            # TensorBoard then hides the events at this step and later in other files of this folder.
            self._events = SummaryWriter(str(folder), purge_step=steps + 1)
        except OSError as error:
            raise _unwritable(folder, error) from None

    def add(self, report: TrainingReport) -> None:
        """Write the metrics of an iteration."""
        measured = measurements(report, self._fspa)
        try:
            _append(self._path, _line(measured).encode())
            for tag, value in _scalars(measured):
                self._events.add_scalar(tag, value, report.steps)
            self._events.flush()
        except OSError as error:
            raise _unwritable(self._path, error) from None

    def close(self) -> None:
        """Close the files."""
        self._events.close()


def measurements(report: TrainingReport, fspa: Fspa) -> dict[str, Any]:
    """Return a line of ``metrics.jsonl``; ``docs/training.md`` describes it."""
    iteration, window = report.iteration, report.window
    return {
        "iteration": iteration.number,
        "steps": report.steps,
        "seconds": round(report.seconds, 3),
        "steps_per_s": round(iteration.steps / (iteration.collect_s + iteration.learn_s), 1),
        "collect_s": round(iteration.collect_s, 4),
        "learn_s": round(iteration.learn_s, 4),
        "episodes": len(iteration.finished),
        "window": window.count,
        **(dict.fromkeys(OF_THE_WINDOW) if not window.count else means(window)),
        "confirmation": report.confirmation and to_json(report.confirmation),
        "states": [_ended(window, fspa, state) for state in sorted(window.states)],
        "losses": {name: round(loss, 6) for name, loss in iteration.losses.items()},
    }


def _ended(window: EpisodeWindow, fspa: Fspa, state: int) -> dict[str, Any]:
    shares = {"share": round(window.states[state], 6), "violated": round(window.violated.get(state, 0.0), 6)}
    return {"state": state, "label": str(fspa.states[state].label), "english": label_text(fspa, state), **shares}


def means(window: EpisodeWindow) -> dict[str, float]:
    """Return the means over a window, by name."""
    values = (window.pass_rate, window.progress, window.reward, window.steps)
    return {name: round(value, 6) for name, value in zip(OF_THE_WINDOW, values, strict=True)}


def read_metrics(path: Path) -> list[dict[str, Any]]:
    """Read the lines of ``metrics.jsonl`` in order; none if there is no file.

    Lines that were cut short, or lack a field that is read, are left out.

    Raises:
        TltlError: TLT0001, the system refuses to read the file; TLT0004, it is larger than
            :data:`tltlc.io.limits.MEASUREMENTS` allows.
    """
    try:
        with path.open("rb") as file:
            data = file.read(fileio.limits.MEASUREMENTS.size + 1)
    except FileNotFoundError:
        return []
    except OSError as error:
        raise fileio.reading_error(str(path), error) from None
    if len(data) > fileio.limits.MEASUREMENTS.size:
        title = f"`{path}` is larger than {fileio.limits.MEASUREMENTS.size >> 20} MiB"
        raise TltlError([Diagnostic("TLT0004", title, help="move it away: the training then goes on without it")])
    text = data.decode(errors="replace")
    return [measured for line in text.splitlines() if (measured := _measured(line)) is not None]


def truncate(path: Path, iteration: int) -> None:
    """Keep the lines of ``metrics.jsonl`` up to an iteration.

    Raises TltlError, TLT0001, TLT0004 or TLT0005.
    """
    kept = [measured for measured in read_metrics(path) if measured["iteration"] <= iteration]
    fileio.write_file(path, "".join(map(_line, kept)), _ADVICE, over_inputs=True)


def _line(measured: Mapping[str, Any]) -> str:
    return json.dumps(measured, ensure_ascii=False) + "\n"


def _measured(line: str) -> dict[str, Any] | None:
    """Parse a line; return None if it is invalid or lacks a field that is read."""
    try:
        measured = fileio.parse_json(line, fileio.limits.TRACE_LINE)
    except (ValueError, RecursionError):
        return None
    if not isinstance(measured, dict) or not measured.keys() >= _READ:
        return None
    whole = all(type(measured[name]) is int for name in _WHOLE)
    # There are no means before the first episode has ended.
    means = [measured[name] for name in OF_THE_WINDOW if measured["window"] or measured[name] is not None]
    fits = whole and all(map(_is_number, [measured["seconds"], *means])) and isinstance(measured["losses"], dict)
    return measured if fits else None


def _is_number(value: object) -> bool:
    return isinstance(value, (int, float)) and not isinstance(value, bool) and isfinite(value)


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


def _scalars(measured: Mapping[str, Any]) -> Iterator[tuple[str, float]]:
    """Yield the metrics as tags and values for TensorBoard."""
    yield from ((f"train/{name}", measured[name]) for name in OF_THE_WINDOW if measured["window"])
    yield from ((f"time/{name}", measured[name]) for name in _OF_THE_ITERATION)
    yield from ((f"state/{state['state']}", state["share"]) for state in measured["states"])
    yield from ((f"violated/{state['state']}", state["violated"]) for state in measured["states"])
    yield from ((f"loss/{name}", value) for name, value in measured["losses"].items())


def _unwritable(path: Path, error: OSError) -> TltlError:
    title = f"cannot write `{path}`: {fileio.reason(error)}"
    return TltlError([Diagnostic("TLT0005", title, help=_ADVICE)])
