"""The record of a training that ended: what it depended on and how it went, beside the policy and inside of it."""

from __future__ import annotations

import json
import os
import platform
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any, Final

from tltl_runtime.policies.card import Card
from tltl_runtime.policies.file import read_policy, write_policy
from tltl_runtime.policies.identity import spec_hash
from tltl_runtime.policies.policy import Policy
from tltl_runtime.support.record_json import from_json, to_json
from tltl_runtime.training.run.checkpoint import read_checkpoint
from tltl_runtime.training.run.curve import draw_curve
from tltl_runtime.training.run.metrics import METRICS, OF_THE_WINDOW, means, read_metrics
from tltl_runtime.training.run.report import Report, StopReason
from tltl_runtime.training.run.run import CHECKPOINT, CURVE, POLICY, RECORD, WRITABLE, Run, read_run
from tltl_runtime.training.run.versions import versions
from tltlc.core.record import record, replace
from tltlc.io.json_text import load
from tltlc.io.limits import REPORT
from tltlc.io.writing import write_files

_VERSION: Final = 1
_MOST_POINTS: Final = 200
_POINT: Final = ("iteration", "steps", "seconds", "pass_rate", "progress", "reward")


def write_record(run: Run, last: Report) -> dict[str, Any]:
    """Write ``record.json`` and ``curve.png`` for a training whose ``last`` report this is, and the record into its
    policy; the record.

    What was measured after the last report, by a process that was killed then, is gone from the measurements.

    Raises:
        TltlError: TLT0005, a file cannot be written; and what is wrong with the policy's.
    """
    policy = read_policy(run.folder / POLICY)
    made = training_record(run, policy.card, last, read_metrics(run.folder / METRICS))
    write_policy(run.folder / POLICY, Policy(replace(policy.card, training=made), policy.weights()), WRITABLE)
    text = json.dumps(made, indent=2, ensure_ascii=False) + "\n"
    title = f"{run.fspa.name} on {made['level']} {run.variant}, seed {run.seed}"
    write_files(
        run.folder, {CURVE: draw_curve(title, made["curve"]), RECORD: text}, WRITABLE, durable=True, over_inputs=True
    )
    return made


def training_record(run: Run, card: Card, last: Report, measured: Sequence[Mapping[str, Any]]) -> dict[str, Any]:
    """The record, JSON data as ``docs/training.md`` describes it, of a training that made a policy with this ``card``.

    ``measured`` are the lines of ``metrics.jsonl``.
    """
    return {
        "format": "tltl-training",
        "version": _VERSION,
        "spec": run.fspa.name,
        "spec_hash": spec_hash(run.fspa),
        "level": card.level,
        "variant": card.variant,
        "level_hash": card.level_hash,
        "seed": run.seed,
        "initial": _initial(run),
        "end": last.stop,
        "best": _best(last.best_pass_rate, last.best_steps, confirmed=last.stop == "met"),
        "iterations": last.iteration.number,
        "steps": last.steps,
        "replayed": last.replayed,
        "search": None if last.searched is None else to_json(last.searched),
        "imitated": None if last.imitated is None else {**to_json(last.imitated), "cloned": _cloned(measured)},
        "seconds": round(last.seconds, 3),
        "window": {"episodes": last.window.count, **means(last.window)},
        "versions": versions(),
        "machine": {
            "system": platform.platform(),
            "processor": platform.machine(),
            "cores": os.cpu_count(),
            "device": run.settings.device,
        },
        "settings": to_json(run.settings),
        "curve": [{name: line[name] for name in _POINT} for line in _thinned(measured)],
    }


def _initial(run: Run) -> dict[str, Any] | None:
    """What is told of the policy that the training began with: where it lay is of this machine alone."""
    return None if run.initial is None else {k: v for k, v in to_json(run.initial).items() if k != "path"}


def record_so_far(folder: Path) -> dict[str, Any]:
    """What there is yet of the record of a training that goes on, or was broken off, in a folder.

    Raises:
        TltlError: its files cannot be read.
    """
    run = read_run(folder)
    made: dict[str, Any] = {"seed": run.seed, "initial": _initial(run), "end": None}
    if measured := read_metrics(folder / METRICS):
        last = measured[-1]
        made |= {name: last[name] for name in ("steps", "seconds")}
        if last["window"]:
            made["window"] = {"episodes": last["window"], **{name: last[name] for name in OF_THE_WINDOW}}
    if checkpoint := read_checkpoint(folder / CHECKPOINT):
        best, searched = checkpoint.best, checkpoint.searched
        made["best"] = _best(best.score[0], best.steps, confirmed=checkpoint.met) if best else None
        made["search"] = None if searched is None else to_json(searched)
    return made


def _best(pass_rate: float | None, steps: int | None, *, confirmed: bool) -> dict[str, Any] | None:
    """What is told of the policy that is kept; None where there is none."""
    return None if pass_rate is None else {"pass_rate": round(pass_rate, 6), "steps": steps, "confirmed": confirmed}


def ended_as(run: Run) -> dict[str, Any] | None:
    """The record of a training that has ended and would end at once if it went on, None of any other.

    Its ``end`` is the limit of ``run`` that it has reached, whichever it ended by.
    """
    made = _recorded(run.folder)
    if made is None or made["end"] == "met":
        return made
    limit = run.settings.stop.reached(made["steps"], made["seconds"])
    return {**made, "end": limit} if limit else None


def recorded_end(folder: Path) -> StopReason | None:
    """What ended the training in a folder, by its record; None where this does not say so."""
    made = _recorded(folder)
    return None if made is None else made["end"]


def _recorded(folder: Path) -> dict[str, Any] | None:
    """The record in a folder; None where there is none, or it is damaged: it is then written anew."""
    try:
        made = load(folder / RECORD, REPORT)
        from_json(_Ended, {name: made[name] for name in ("end", "steps", "seconds")}, RECORD)
    except (OSError, ValueError, KeyError, TypeError, RecursionError):
        return None
    return {**made}


@record
class _Ended:
    """What is read again of the record of a training that has ended."""

    end: StopReason
    steps: int
    seconds: float


def _cloned(measured: Sequence[Mapping[str, Any]]) -> int:
    """In how many of the first steps an agent that imitates was cloned."""
    return max((line["steps"] for line in measured if "cloning" in line["losses"]), default=0)


def _thinned(lines: Sequence[Mapping[str, Any]]) -> list[Mapping[str, Any]]:
    """At most ``_MOST_POINTS`` of the lines at equal distances, the last among them."""
    stride = -(-len(lines) // _MOST_POINTS) or 1
    return list(lines[::-1][::stride])[::-1]
