"""The trainings of our Table I: which ones it takes, and what became of each."""

from __future__ import annotations

import json
from hashlib import sha256
from pathlib import Path
from typing import Final

from tltl_runtime.policies.card import OBSERVATION, Card
from tltl_runtime.policies.identity import level_hash, spec_hash
from tltl_runtime.regression.table1.paper_table import Model
from tltl_runtime.spec.task import load_task
from tltl_runtime.stealth.capabilities.vocabulary import params
from tltl_runtime.stealth.env import spec_of
from tltl_runtime.stealth.levels.file import load_level
from tltl_runtime.stealth.observation.sensors import chosen
from tltl_runtime.support.record_json import to_json
from tltl_runtime.training.run.record import ended_as
from tltl_runtime.training.run.run import MAY_CHANGE, POLICY, RECORD, RUN, leaves, read_run
from tltl_runtime.training.run.settings import read_settings
from tltlc.core.record import record, replace

_MINUTES: Final = 60.0


@record
class Limits:
    """A training ends after so many ``steps`` of all environments, or after ``minutes`` (0: no such limit)."""

    steps: int
    minutes: float


@record
class TableTraining:
    """A training of a model on a level, in a folder of its own."""

    folder: Path
    level: str
    imitates: bool
    limits: Limits


@record
class Trained:
    """What a training of a ``seed`` came to: its policy, the hours it took, and the share of its steps in which it was
    cloned, None of a model that does not imitate.
    """

    policy: Path
    seed: int
    hours: float
    cloned: float | None


def limits(minutes: float | None) -> Limits:
    """The limits of our trainings, by default of an hour."""
    return Limits(read_settings().stop.steps, _MINUTES if minutes is None else minutes)


def limits_as_of(card: Card, minutes: float | None) -> Limits:
    """The limits that the training of a policy had, but for ``minutes``: what has the same can be compared with it."""
    stop = card.training["settings"]["stop"]
    return Limits(int(stop["steps"]), float(stop["minutes"]) if minutes is None else minutes)


def table_training(folder: Path, level: str, model: Model, limits: Limits) -> TableTraining:
    """The training of a model on a level as it is now.

    Its place below ``folder`` is called after all that the agent learns from, but for the code: level, spec, senses and
    settings; and the limits of an agent that imitates, which is cloned for a share of these.  So another of these is
    another training, and where nothing is cloned, one with greater limits goes on.

    Raises:
        TltlError: the level or its spec cannot be read.
    """
    settings = replace(read_settings(), method="imitation" if model == "imitation" else "automaton")
    there = load_level(level, "v0")
    task = load_task(spec_of(there), offered=params(there))
    parts = [
        level_hash(there),
        spec_hash(task.fspa),
        OBSERVATION,
        to_json(chosen(there, None)),
        {path: value for path, value in leaves(to_json(settings)) if path not in MAY_CHANGE},
        to_json(limits) if settings.imitates else None,
    ]
    digest = sha256(json.dumps(parts, sort_keys=True).encode()).hexdigest()
    return TableTraining(folder / f"{level}-{model}-{digest[:8]}", level, settings.imitates, limits)


def train_arguments(training: TableTraining) -> list[str]:
    """What ``tltlc train`` is to be told, so that the training begins or goes on.

    One that was broken off goes on to the limits that it was begun with, where these are greater: it may have passed
    the others.
    """
    steps, minutes = training.limits.steps, training.limits.minutes
    if (training.folder / RUN).exists():
        begun = read_run(training.folder).settings.stop
        what = ["--resume", str(training.folder)]
        steps, minutes = max(steps, begun.steps), minutes and begun.minutes and max(minutes, begun.minutes)
    else:
        method = ["--method", "imitation"] if training.imitates else []
        what = ["--level", training.level, "--out", str(training.folder), *method]
    return [*what, "--steps", str(steps), "--minutes", f"{minutes:g}"]


def trained(training: TableTraining) -> Trained | None:
    """What a training came to that has ended by its goal or by its limits; None of any other.

    Raises:
        TltlError: TLT0863, its folder cannot be read.
    """
    if not all((training.folder / name).exists() for name in (RUN, RECORD, POLICY)):
        return None
    run = read_run(training.folder)
    stop = replace(run.settings.stop, steps=training.limits.steps, minutes=training.limits.minutes)
    made = ended_as(replace(run, settings=replace(run.settings, stop=stop)))
    if made is None:
        return None
    cloned = made["imitated"]["cloned"] / made["steps"] if training.imitates else None
    return Trained(training.folder / POLICY, run.seed, made["seconds"] / 3600, cloned)
