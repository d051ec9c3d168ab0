"""The trace of a recorded episode's signals, and the command that judges it."""

from __future__ import annotations

import csv
import shlex
from io import StringIO
from math import inf
from typing import Final

from tltl_runtime.game.episode import RecordedEpisode
from tltlc.api import specs

_UNITS: Final[dict[specs.ValueType, str]] = {"length": " m", "time": " s", "speed": " m/s", "angle": " rad"}
_INSTANT: Final = 1e-6
"""Times that differ by no more than this many seconds are equal."""


def trace_csv(episode: RecordedEpisode, start: float = 0.0, stop: float = inf) -> str:
    """Return the spec's signals from ``start`` to ``stop`` seconds as CSV, for ``tltlc monitor``.

    The column ``step`` counts time steps from 1: the moment of the reset is not part of the trace.
    Numbers have enough digits to be read back bit for bit.
    """
    text = StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(["step", *(signal.name for signal in episode.fspa.signals)])
    for row, time in enumerate(episode.times.tolist()):
        if row and start - _INSTANT <= time <= stop + _INSTANT:
            writer.writerow([row, *map(repr, episode.signals[row].tolist())])
    return text.getvalue()


def monitor_command(episode: RecordedEpisode, trace: str) -> str:
    """Return the shell command that judges the trace file ``trace`` with the episode's params."""
    words = ["tltlc", "monitor", f"SPEC.tltl:{episode.fspa.name}", trace]
    for param in episode.fspa.params:
        if param.name in episode.params:
            words += ["--param", f"{param.name}={episode.params[param.name]!r}{_UNITS.get(param.type, '')}"]
    return shlex.join(words)
