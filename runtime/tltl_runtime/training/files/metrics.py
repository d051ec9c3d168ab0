"""The metrics of a training, per iteration: the lines of ``metrics.jsonl``."""

from __future__ import annotations

import json
from collections.abc import Mapping
from math import isfinite
from pathlib import Path
from typing import Any, Final

from tltl_runtime.support.record_json import to_json
from tltl_runtime.training.files.report import EpisodeWindow, TrainingReport
from tltlc.api import Diagnostic, Fspa, TltlError, fileio, label_text

METRICS: Final = "metrics.jsonl"

WRITE_ADVICE: Final = "check that there is room, and that you may write there"
WINDOW_MEANS: Final = ("pass_rate", "progress", "reward", "episode_steps")
"""The fields of a line of ``metrics.jsonl`` that are means over the last episodes."""
_INTEGERS: Final = ("iteration", "steps", "episodes", "window")
"""The fields of a line of ``metrics.jsonl`` that are read back and must be integers."""
_REQUIRED: Final = {*_INTEGERS, "seconds", "losses", *WINDOW_MEANS}
"""The fields of a line of ``metrics.jsonl`` that are read back."""


def metrics_line(report: TrainingReport, fspa: Fspa) -> dict[str, Any]:
    """Return the fields of a line of ``metrics.jsonl``; ``docs/training.md`` describes them."""
    iteration, window = report.iteration, report.window
    return {
        "iteration": iteration.number,
        "steps": report.steps,
        "seconds": round(report.seconds, 3),
        "steps_per_s": round(iteration.steps / (iteration.collect_s + iteration.learn_s), 1),
        "collect_s": round(iteration.collect_s, 4),
        "learn_s": round(iteration.learn_s, 4),
        "episodes": len(iteration.finished),
        **({"lost": iteration.lost.count} if iteration.lost else {}),
        "window": window.count,
        **(dict.fromkeys(WINDOW_MEANS) if not window.count else means(window)),
        "confirmation": report.confirmation and to_json(report.confirmation),
        "states": [_state_shares(window, fspa, state) for state in sorted(window.states)],
        "losses": {name: round(loss, 6) for name, loss in iteration.losses.items()},
    }


def _state_shares(window: EpisodeWindow, fspa: Fspa, state: int) -> dict[str, Any]:
    shares = {"share": round(window.states[state], 6), "violated": round(window.violated.get(state, 0.0), 6)}
    return {"state": state, "label": str(fspa.states[state].label), "english": label_text(fspa, state), **shares}


def means(window: EpisodeWindow) -> dict[str, float]:
    """Return the means over the episodes of ``window``, by their names in ``metrics.jsonl``."""
    values = (window.pass_rate, window.progress, window.reward, window.steps)
    return {name: round(value, 6) for name, value in zip(WINDOW_MEANS, values, strict=True)}


def read_metrics(path: Path) -> list[dict[str, Any]]:
    """Read the lines of ``metrics.jsonl`` in order; an empty list if there is no file.

    Lines that are incomplete or lack a required field are left out.

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
        raise TltlError([Diagnostic("TLT0004", title, help="move it away: the training then continues without it")])
    text = data.decode(errors="replace")
    return [fields for line in text.splitlines() if (fields := _parse_line(line)) is not None]


def truncate(path: Path, iteration: int) -> None:
    """Remove the lines of ``metrics.jsonl`` that belong to iterations after ``iteration``.

    Raises the errors of :func:`read_metrics`, and TltlError, TLT0005, if the file cannot be
    written.
    """
    remaining = [fields for fields in read_metrics(path) if fields["iteration"] <= iteration]
    fileio.write_file(path, "".join(map(line_text, remaining)), WRITE_ADVICE, over_inputs=True)


def line_text(fields: Mapping[str, Any]) -> str:
    """Return the text of a line of ``metrics.jsonl``."""
    return json.dumps(fields, ensure_ascii=False) + "\n"


def _parse_line(line: str) -> dict[str, Any] | None:
    """Parse a line of ``metrics.jsonl``; return None if it is invalid or lacks a required field."""
    try:
        fields = fileio.parse_json(line, fileio.limits.TRACE_LINE)
    except (ValueError, RecursionError):
        return None
    if not isinstance(fields, dict) or not fields.keys() >= _REQUIRED:
        return None
    are_integers = all(type(fields[name]) is int for name in _INTEGERS)
    # There are no means before the first episode has ended.
    means = [fields[name] for name in WINDOW_MEANS if fields["window"] or fields[name] is not None]
    is_valid = are_integers and all(map(_is_number, [fields["seconds"], *means])) and isinstance(fields["losses"], dict)
    return fields if is_valid else None


def _is_number(value: object) -> bool:
    return isinstance(value, (int, float)) and not isinstance(value, bool) and isfinite(value)
