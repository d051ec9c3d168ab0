"""The record of a training that ended: its inputs and results.

It is in ``record.json`` and in the policy file.
"""

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
from tltl_runtime.training.run.report import StopReason, TrainingReport
from tltl_runtime.training.run.run_file import CHECKPOINT, CURVE, POLICY, RECORD, WRITABLE, Run, read_run
from tltl_runtime.training.run.versions import versions
from tltlc.api import fileio, record, replace

_VERSION: Final = 1
_MOST_POINTS: Final = 200
_POINT: Final = ("iteration", "steps", "seconds", "pass_rate", "progress", "reward")


def write_record(run: Run, last: TrainingReport) -> dict[str, Any]:
    """Write ``record.json``, ``curve.png`` and the record in the policy file; return the record.

    ``last`` is the last report of the training.  The metrics have no lines after it, because the
    training has removed those that a killed process left.

    Raises:
        TltlError: TLT0005, a file cannot be written; the errors of ``read_policy``.
    """
    policy = read_policy(run.folder / POLICY)
    document = training_record(run, policy.card, last, read_metrics(run.folder / METRICS))
    write_policy(run.folder / POLICY, Policy(replace(policy.card, training=document), policy.weights()), WRITABLE)
    text = json.dumps(document, indent=2, ensure_ascii=False) + "\n"
    title = f"{run.fspa.name} on {document['level']} {run.variant}, seed {run.seed}"
    fileio.write_files(
        run.folder,
        {CURVE: draw_curve(title, document["curve"]), RECORD: text},
        WRITABLE,
        durable=True,
        over_inputs=True,
    )
    return document


def training_record(
    run: Run, card: Card, last: TrainingReport, measured: Sequence[Mapping[str, Any]]
) -> dict[str, Any]:
    """Return the record of a training as JSON data; ``docs/training.md`` describes it.

    ``card`` is the card of its policy.  ``measured`` are the lines of ``metrics.jsonl``.
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
    """Return the entry for the initial policy.

    It lacks the path, which is only valid on this machine.
    """
    return None if run.initial is None else {k: v for k, v in to_json(run.initial).items() if k != "path"}


def record_so_far(folder: Path) -> dict[str, Any]:
    """Return the part of the record that exists for an unfinished training in a folder.

    Raises:
        TltlError: its files cannot be read.
    """
    run = read_run(folder)
    document: dict[str, Any] = {"seed": run.seed, "initial": _initial(run), "end": None}
    if measured := read_metrics(folder / METRICS):
        last = measured[-1]
        document |= {name: last[name] for name in ("steps", "seconds")}
        if last["window"]:
            document["window"] = {"episodes": last["window"], **{name: last[name] for name in OF_THE_WINDOW}}
    if checkpoint := read_checkpoint(folder / CHECKPOINT):
        best, searched = checkpoint.best, checkpoint.searched
        document["best"] = _best(best.score[0], best.steps, confirmed=checkpoint.met) if best else None
        document["search"] = None if searched is None else to_json(searched)
    return document


def _best(pass_rate: float | None, steps: int | None, *, confirmed: bool) -> dict[str, Any] | None:
    """Return the entry for the best policy; None if there is none."""
    return None if pass_rate is None else {"pass_rate": round(pass_rate, 6), "steps": steps, "confirmed": confirmed}


def ended_as(run: Run) -> dict[str, Any] | None:
    """Return the record of a training that has ended and would end at once if resumed, or None.

    Unless the spec was met, ``end`` is the limit of ``run`` that the training has reached,
    whichever limit it ended by.
    """
    document = _recorded(run.folder)
    if document is None or document["end"] == "met":
        return document
    limit = run.settings.stop.reached(document["steps"], document["seconds"])
    return {**document, "end": limit} if limit else None


def recorded_end(folder: Path) -> StopReason | None:
    """Return why the training in a folder ended; None if it has no valid record."""
    document = _recorded(folder)
    return None if document is None else document["end"]


def _recorded(folder: Path) -> dict[str, Any] | None:
    """Return the record in a folder; None if it is missing or damaged and must be written again."""
    try:
        document = fileio.load_json(folder / RECORD, fileio.limits.REPORT)
        from_json(_Ended, {name: document[name] for name in ("end", "steps", "seconds")}, RECORD)
    except (OSError, ValueError, KeyError, TypeError, RecursionError):
        return None
    return {**document}


@record
class _Ended:
    """The fields that are read back from the record of a training that has ended."""

    end: StopReason
    steps: int
    seconds: float


def _cloned(measured: Sequence[Mapping[str, Any]]) -> int:
    """Return the number of steps, from the first one, in which the actor was cloned."""
    return max((line["steps"] for line in measured if "cloning" in line["losses"]), default=0)


def _thinned(lines: Sequence[Mapping[str, Any]]) -> list[Mapping[str, Any]]:
    """Return at most ``_MOST_POINTS`` lines at equal distances, including the last one."""
    stride = -(-len(lines) // _MOST_POINTS) or 1
    return list(lines[::-1][::stride])[::-1]
