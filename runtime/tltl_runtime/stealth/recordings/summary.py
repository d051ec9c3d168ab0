"""Summaries of an episode, as JSON and as text, and the trace of its signals."""

from __future__ import annotations

import csv
import shlex
from io import StringIO
from math import inf
from typing import Any, Final

from tltl_runtime.stealth.recordings.cause import cause
from tltl_runtime.stealth.recordings.episode import Episode
from tltl_runtime.stealth.recordings.episode_summary import seen_steps, summary_of
from tltl_runtime.support.number_text import column, number, share
from tltlc.api import Notation, label_text, specs

_UNITS: Final[dict[specs.ValueType, str]] = {"length": " m", "time": " s", "speed": " m/s", "angle": " rad"}
_INSTANT: Final = 1e-6
"""Times that differ by no more than this many seconds are equal."""


def summary(episode: Episode, notation: Notation = "english") -> dict[str, Any]:
    """Return a summary of an episode as JSON data.

    The key ``changes`` has a row for the start and for each change of the automaton's state. The
    label in a row says, in ``notation``, what remains to be satisfied in that state.
    """
    level, fspa, result, reason = episode.level, episode.fspa, summary_of(episode), cause(episode)
    states = episode.states.tolist()
    rows = [row for row in range(result.steps + 1) if row == 0 or states[row] != states[row - 1]]
    return {
        "level": level.name,
        "variant": level.variant,
        "spec": fspa.name,
        "player": episode.player,
        "seed": episode.seed,
        "steps": result.steps,
        "seconds": result.seconds,
        "limit_steps": fspa.limit_steps,
        "end": result.end,
        "success": result.success,
        "cause": {
            "kind": reason.kind,
            "by": reason.by,
            "time": reason.time,
            "place": reason.place,
            "text": reason.text,
        },
        "verdict": result.verdict,
        "progress": result.progress,
        "reward": result.reward,
        "health": episode.snapshots[-1].health,
        "seen_steps": seen_steps(episode),
        "params": dict(episode.params),
        "versions": dict(episode.versions),
        "changes": [
            {
                "step": row,
                "time": episode.snapshots[row].time,
                "state": states[row],
                "progress": float(episode.progress[row]),
                "label": label_text(fspa, states[row], notation),
            }
            for row in rows
        ],
    }


def summary_text(values: dict[str, Any]) -> str:
    """Return the result of :func:`summary` as text for people."""
    limit = "" if values["limit_steps"] is None else f" of {values['limit_steps']}"
    end = values["end"] if values["verdict"] in ("satisfied", "violated") else f"{values['end']}, {values['verdict']}"
    lines = [
        f"  level    {values['level']} {values['variant']}, spec {values['spec']}",
        column("  player   ", f"{values['player']}, seed {values['seed']}"),
        f"  end      {end}, after {values['steps']}{limit} steps, {values['seconds']:.2f} s",
        *([] if values["success"] else [column("  why      ", values["cause"]["text"])]),
        f"  reward   {number(values['reward'], 3)}, progress {share(values['progress'], 3)}",
        f"  health   {share(values['health'])}, in sight of an enemy for {values['seen_steps']} steps",
        "",
        "    time  state  progress  what remains",
    ]
    lines += [
        column(f"{change['time']:8.2f}  {change['state']:5}  {share(change['progress'], 3):>8}  ", change["label"])
        for change in values["changes"]
    ]
    return "\n".join(lines) + "\n"


def monitor_command(episode: Episode, trace: str) -> str:
    """Return the shell command that judges the trace file ``trace`` with the episode's params."""
    words = ["tltlc", "monitor", f"SPEC.tltl:{episode.fspa.name}", trace]
    for param in episode.fspa.params:
        if param.name in episode.params:
            words += ["--param", f"{param.name}={episode.params[param.name]!r}{_UNITS.get(param.type, '')}"]
    return shlex.join(words)


def trace_csv(episode: Episode, start: float = 0.0, stop: float = inf) -> str:
    """Return the spec's signals from ``start`` to ``stop`` seconds as CSV, for ``tltlc monitor``.

    The column ``step`` counts time steps from 1: the moment of the reset is not part of the trace.
    Numbers have enough digits to be read back bit for bit.
    """
    text = StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(["step", *(signal.name for signal in episode.fspa.signals)])
    for row, shot in enumerate(episode.snapshots):
        if row and start - _INSTANT <= shot.time <= stop + _INSTANT:
            writer.writerow([row, *map(repr, episode.signals[row].tolist())])
    return text.getvalue()
