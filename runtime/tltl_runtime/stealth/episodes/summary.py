"""What there is to say of an episode: how it went, and the trace of its signals."""

from __future__ import annotations

import csv
from io import StringIO
from math import inf
from typing import Any, Final

from tltl_runtime.stealth.episodes.episode import Episode

_INSTANT: Final = 1e-6
"""Seconds that count as none."""


def summary(episode: Episode) -> dict[str, Any]:
    """How an episode went, as JSON can say it; ``changes`` has a row for the start and for each change of state."""
    level, fspa, count = episode.level, episode.fspa, len(episode.actions)
    states = episode.states.tolist()
    rows = [row for row in range(count + 1) if row == 0 or states[row] != states[row - 1]]
    return {
        "level": level.name,
        "variant": level.variant,
        "spec": fspa.name,
        "player": episode.player,
        "seed": episode.seed,
        "steps": count,
        "seconds": episode.snapshots[-1].time,
        "limit_steps": fspa.limit_steps,
        "end": episode.end,
        "success": episode.success,
        "verdict": episode.verdict,
        "progress": float(episode.progress[-1]),
        "reward": float(episode.rewards.sum()),
        "health": episode.snapshots[-1].health,
        "seen_steps": sum(any(shot.sees) for shot in episode.snapshots),
        "params": dict(episode.params),
        "versions": dict(episode.versions),
        "changes": [
            {
                "step": row,
                "time": episode.snapshots[row].time,
                "state": states[row],
                "progress": float(episode.progress[row]),
                "label": fspa.states[states[row]].label.unicode,
            }
            for row in rows
        ],
    }


def summary_text(said: dict[str, Any]) -> str:
    """A summary for people."""
    limit = "" if said["limit_steps"] is None else f" of {said['limit_steps']}"
    lines = [
        f"  level    {said['level']} {said['variant']}, spec {said['spec']}",
        f"  player   {said['player']}, seed {said['seed']}",
        f"  end      {said['end']}, {said['verdict']}, after {said['steps']}{limit} steps, {said['seconds']:.2f} s",
        f"  reward   {said['reward']:.3f}, progress {said['progress']:.3f}",
        f"  health   {said['health']:.2f}, in sight of an enemy for {said['seen_steps']} steps",
        "",
        "    time  state  progress  what remains",
    ]
    lines += [
        f"{each['time']:8.2f}  {each['state']:5}  {each['progress']:8.3f}  {each['label']}" for each in said["changes"]
    ]
    return "\n".join(lines) + "\n"


def trace_csv(episode: Episode, start: float = 0.0, stop: float = inf) -> str:
    """The signals of the spec from ``start`` to ``stop`` seconds, as ``tltlc monitor`` reads them.

    The column ``step`` counts decisions from 1: the moment of the reset is no sample of the trace.  Numbers are written
    so that they come back bit for bit.
    """
    written = StringIO()
    writer = csv.writer(written, lineterminator="\n")
    writer.writerow(["step", *(signal.name for signal in episode.fspa.signals)])
    for row, shot in enumerate(episode.snapshots):
        if row and start - _INSTANT <= shot.time <= stop + _INSTANT:
            writer.writerow([row, *map(repr, episode.signals[row].tolist())])
    return written.getvalue()
