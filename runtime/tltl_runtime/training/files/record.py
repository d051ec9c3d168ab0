"""The record of a training that has ended: its inputs and results.

It is stored in ``record.json`` and in the policy file.
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
from tltl_runtime.training.files.checkpoint import read_checkpoint
from tltl_runtime.training.files.curve import draw_curve
from tltl_runtime.training.files.metrics import METRICS, WINDOW_MEANS, means, read_metrics
from tltl_runtime.training.files.report import StopReason, TrainingReport
from tltl_runtime.training.files.run_file import CHECKPOINT, CURVE, POLICY, RECORD, WRITABLE, TrainingRun, read_run
from tltl_runtime.training.files.versions import versions
from tltlc.api import fileio, record, replace, traces

_VERSION: Final = 1
_MOST_POINTS: Final = 200
_POINT: Final = ("iteration", "steps", "seconds", "pass_rate", "progress", "reward")


def write_record(run: TrainingRun, last: TrainingReport) -> dict[str, Any]:
    """Write ``record.json``, ``curve.png`` and the record in the policy file; return the record.

    ``last`` is the last report of the training. No line of ``metrics.jsonl`` is of a later
    iteration.

    Raises:
        TltlError: TLT0005, a file cannot be written; the errors of ``read_policy``.
    """
    policy = read_policy(run.folder / POLICY)
    document = training_record(run, policy.card, last, read_metrics(run.folder / METRICS))
    write_policy(run.folder / POLICY, Policy(replace(policy.card, training=document), policy.weights()), WRITABLE)
    text = json.dumps(document, indent=2, ensure_ascii=False) + "\n"
    title = f"{run.fspa.name} on {document['level']} {run.variant.text}, seed {run.seed}"
    fileio.write_files(
        run.folder,
        {CURVE: draw_curve(title, document["curve"]), RECORD: text},
        WRITABLE,
        durable=True,
        over_inputs=True,
    )
    return document


def training_record(
    run: TrainingRun, card: Card, last: TrainingReport, metrics: Sequence[Mapping[str, Any]]
) -> dict[str, Any]:
    """Return the record of a training as JSON data; ``docs/training.md`` describes it.

    ``card`` is the metadata of the trained policy, ``last`` the last report of the training, and
    ``metrics`` are the lines of ``metrics.jsonl``.
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
        "initial": _initial_policy(run),
        "end": last.stop,
        "best": _best_policy(last.best_pass_rate, last.best_steps, confirmed=last.stop == "met"),
        "iterations": last.iteration.number,
        "steps": last.steps,
        "replayed": last.replayed,
        "search": None if last.searched is None else to_json(last.searched),
        "imitated": None if last.imitated is None else {**to_json(last.imitated), "cloned": _cloning_steps(metrics)},
        "seconds": round(last.seconds, 3),
        "window": {
            "episodes": last.window.count,
            **means(last.window),
            "causes": list(map(traces.group_json, last.window.causes)),
        },
        "versions": versions(),
        "machine": {
            "system": platform.platform(),
            "processor": platform.machine(),
            "cores": os.cpu_count(),
            "device": run.settings.device,
        },
        "settings": to_json(run.settings),
        "curve": [{name: line[name] for name in _POINT} for line in _evenly_spaced(metrics)],
    }


def _initial_policy(run: TrainingRun) -> dict[str, Any] | None:
    """Describe the policy that the training began with; None if it began with random weights.

    The path of the policy's file is left out, because it is valid only on this machine.
    """
    return (
        None if run.initial is None else {name: value for name, value in to_json(run.initial).items() if name != "path"}
    )


def record_so_far(folder: Path) -> dict[str, Any]:
    """Return the record of an unfinished training: only the fields that are already known.

    ``folder`` is the folder of the training.

    Raises:
        TltlError: the files of the training cannot be read.
    """
    run = read_run(folder)
    document: dict[str, Any] = {"seed": run.seed, "initial": _initial_policy(run), "end": None}
    if metrics := read_metrics(folder / METRICS):
        last = metrics[-1]
        document |= {name: last[name] for name in ("steps", "seconds")}
        if last["window"]:
            document["window"] = {"episodes": last["window"], **{name: last[name] for name in WINDOW_MEANS}}
    if checkpoint := read_checkpoint(folder / CHECKPOINT):
        best, searched = checkpoint.best, checkpoint.searched
        document["best"] = _best_policy(best.score[0], best.steps, confirmed=checkpoint.met) if best else None
        document["search"] = None if searched is None else to_json(searched)
    return document


def _best_policy(pass_rate: float | None, steps: int | None, *, confirmed: bool) -> dict[str, Any] | None:
    """Return the entry ``best`` of the record; None if there is no best policy yet.

    ``steps`` is the number of steps after which the policy had its weights. ``confirmed`` says
    whether it met the spec in all episodes of its confirmation.
    """
    return None if pass_rate is None else {"pass_rate": round(pass_rate, 6), "steps": steps, "confirmed": confirmed}


def finished_record(run: TrainingRun) -> dict[str, Any] | None:
    """Return the record of a training that would end at once if it were resumed, else None.

    In the record, ``end`` is ``met`` if the policy met the spec. Otherwise it is the limit in the
    settings of ``run`` that the training has reached, ``steps`` or ``minutes``, even if the
    training ended at another limit.
    """
    document = _read_record(run.folder)
    if document is None or document["end"] == "met":
        return document
    limit = run.settings.stop.reached_limit(document["steps"], document["seconds"])
    return {**document, "end": limit} if limit else None


def recorded_end(folder: Path) -> StopReason | None:
    """Return why the training in a folder ended; None if the folder has no valid record."""
    document = _read_record(folder)
    return None if document is None else document["end"]


def _read_record(folder: Path) -> dict[str, Any] | None:
    """Return the content of ``record.json`` in a folder; None if it is missing or invalid.

    Only the fields that say how the training ended are checked.
    """
    try:
        document = fileio.load_json(folder / RECORD, fileio.limits.REPORT)
        from_json(_EndFields, {name: document[name] for name in ("end", "steps", "seconds")}, RECORD)
    except (OSError, ValueError, KeyError, TypeError, RecursionError):
        return None
    return {**document}


@record
class _EndFields:
    """The fields of ``record.json`` that say how a training ended."""

    end: StopReason
    steps: int
    seconds: float


def _cloning_steps(metrics: Sequence[Mapping[str, Any]]) -> int:
    """Return the number of steps at which behavioural cloning ended; 0 if there was no cloning."""
    return max((line["steps"] for line in metrics if "cloning" in line["losses"]), default=0)


def _evenly_spaced(lines: Sequence[Mapping[str, Any]]) -> list[Mapping[str, Any]]:
    """Return at most ``_MOST_POINTS`` of the lines, evenly spaced and including the last one."""
    stride = -(-len(lines) // _MOST_POINTS) or 1
    return list(lines[::-1][::stride])[::-1]
