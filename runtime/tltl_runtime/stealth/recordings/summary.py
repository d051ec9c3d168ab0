"""What there is to say of an episode: how it went, and the trace of its signals."""

from __future__ import annotations

import csv
import shlex
from io import StringIO
from math import inf
from typing import Any, Final, Literal

from tltl_runtime.stealth.recordings.cause import cause
from tltl_runtime.stealth.recordings.episode import Episode
from tltl_runtime.stealth.recordings.outcome import outcome
from tltl_runtime.support.number_text import column, number, share
from tltlc.resolve.spec import ValueType

Notation = Literal["english", "unicode", "ascii"]
"""Of formulas, where people read them."""

_UNITS: Final[dict[ValueType, str]] = {"length": " m", "time": " s", "speed": " m/s", "angle": " rad"}
_INSTANT: Final = 1e-6
"""Seconds that count as none."""


def summary(episode: Episode, notation: Notation = "english") -> dict[str, Any]:
    """How an episode went, as JSON can say it; ``changes`` has a row for the start and for each change of state.

    ``notation`` is that of what remains to be satisfied in each state.
    """
    level, fspa, went, why = episode.level, episode.fspa, outcome(episode), cause(episode)
    states = episode.states.tolist()
    rows = [row for row in range(went.steps + 1) if row == 0 or states[row] != states[row - 1]]
    return {
        "level": level.name,
        "variant": level.variant,
        "spec": fspa.name,
        "player": episode.player,
        "seed": episode.seed,
        "steps": went.steps,
        "seconds": went.seconds,
        "limit_steps": fspa.limit_steps,
        "end": went.end,
        "success": went.success,
        "cause": {"kind": why.kind, "by": why.by, "time": why.time, "place": why.place, "text": why.text},
        "verdict": went.verdict,
        "progress": went.progress,
        "reward": went.reward,
        "health": went.health,
        "seen_steps": went.seen_steps,
        "params": dict(episode.params),
        "versions": dict(episode.versions),
        "changes": [
            {
                "step": row,
                "time": episode.snapshots[row].time,
                "state": states[row],
                "progress": float(episode.progress[row]),
                "label": getattr(fspa.states[states[row]].label, notation),
            }
            for row in rows
        ],
    }


def summary_text(said: dict[str, Any]) -> str:
    """A summary for people."""
    limit = "" if said["limit_steps"] is None else f" of {said['limit_steps']}"
    end = said["end"] if said["verdict"] in ("satisfied", "violated") else f"{said['end']}, {said['verdict']}"
    lines = [
        f"  level    {said['level']} {said['variant']}, spec {said['spec']}",
        column("  player   ", f"{said['player']}, seed {said['seed']}"),
        f"  end      {end}, after {said['steps']}{limit} steps, {said['seconds']:.2f} s",
        *([] if said["success"] else [column("  why      ", said["cause"]["text"])]),
        f"  reward   {number(said['reward'], 3)}, progress {share(said['progress'], 3)}",
        f"  health   {share(said['health'])}, in sight of an enemy for {said['seen_steps']} steps",
        "",
        "    time  state  progress  what remains",
    ]
    lines += [
        column(f"{each['time']:8.2f}  {each['state']:5}  {share(each['progress'], 3):>8}  ", each["label"])
        for each in said["changes"]
    ]
    return "\n".join(lines) + "\n"


def judged_with(episode: Episode, trace: str) -> str:
    """The command that judges the signals of an episode, in the file ``trace``, with the params that it had."""
    words = ["tltlc", "monitor", f"SPEC.tltl:{episode.fspa.name}", trace]
    for param in episode.fspa.params:
        if param.name in episode.params:
            words += ["--param", f"{param.name}={episode.params[param.name]!r}{_UNITS.get(param.type, '')}"]
    return shlex.join(words)


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
