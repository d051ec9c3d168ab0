"""The trainings of our Table I: which ones it takes, and what became of each."""

from __future__ import annotations

import json
from hashlib import sha256
from math import inf
from pathlib import Path

from tltl_runtime.policies.card import OBSERVATION
from tltl_runtime.policies.identity import level_hash, spec_hash
from tltl_runtime.record_json import to_json
from tltl_runtime.regression.paper_table import Model
from tltl_runtime.stealth.env import spec_of
from tltl_runtime.stealth.levels.file import load_level
from tltl_runtime.stealth.senses.sensors import chosen
from tltl_runtime.stealth.supply.offer import params
from tltl_runtime.task import load_task
from tltl_runtime.training.record import ended_as
from tltl_runtime.training.run import MAY_CHANGE, POLICY, RECORD, RUN, leaves, read_run
from tltl_runtime.training.settings import Settings, read_settings
from tltlc.record import record, replace


@record
class TableTraining:
    """A training of a model on a level for ``minutes`` at the most (0: no such limit), in a folder of its own."""

    folder: Path
    level: str
    imitates: bool
    minutes: float


@record
class Trained:
    """What a training came to: its policy, the hours it took, and the share of its steps in which it was cloned, None
    of a model that does not imitate.
    """

    policy: Path
    hours: float
    cloned: float | None


def table_training(folder: Path, level: str, model: Model, minutes: float) -> TableTraining:
    """The training of a model on a level as it is now.

    Its place below ``folder`` is called after all that the agent learns from, but for the code: level, spec, senses and
    settings; and the limits of an agent that imitates, which is cloned for a share of these.  So another of these is
    another training, and a greater limit of minutes goes on with the same one where nothing is cloned.

    Raises:
        TltlError: the level or its spec cannot be read.
    """
    settings = _settings(model, minutes)
    there = load_level(level, "v0")
    task = load_task(spec_of(there), offered=params(there))
    parts = [
        level_hash(there),
        spec_hash(task.fspa),
        OBSERVATION,
        to_json(chosen(there, None)),
        {path: value for path, value in leaves(to_json(settings)) if path not in MAY_CHANGE},
        [settings.stop.steps, minutes] if settings.imitates else None,
    ]
    digest = sha256(json.dumps(parts, sort_keys=True).encode()).hexdigest()
    return TableTraining(folder / f"{level}-{model}-{digest[:8]}", level, settings.imitates, minutes)


def train_arguments(training: TableTraining) -> list[str]:
    """What ``tltlc train`` is to be told, so that the training begins or goes on.

    One that was broken off goes on to the limit that it was begun with, where that is the greater one: it may have
    passed the other.
    """
    if not (training.folder / RUN).exists():
        method = ["--method", "imitation"] if training.imitates else []
        limit = ["--minutes", f"{training.minutes:g}"]
        return ["--level", training.level, "--out", str(training.folder), *method, *limit]
    begun = read_run(training.folder).settings.stop.minutes
    longest = max(begun or inf, training.minutes or inf)
    return ["--resume", str(training.folder), "--minutes", f"{0 if longest == inf else longest:g}"]


def trained(training: TableTraining) -> Trained | None:
    """What a training came to that has ended by its goal or by its limits; None of any other.

    Raises:
        TltlError: TLT0863, its folder cannot be read.
    """
    if not all((training.folder / name).exists() for name in (RUN, RECORD, POLICY)):
        return None
    run = read_run(training.folder)
    stop = replace(run.settings.stop, minutes=training.minutes)
    made = ended_as(replace(run, settings=replace(run.settings, stop=stop)))
    if made is None:
        return None
    cloned = made["imitated"]["cloned"] / made["steps"] if training.imitates else None
    return Trained(training.folder / POLICY, made["seconds"] / 3600, cloned)


def _settings(model: Model, minutes: float) -> Settings:
    """Those of both methods are alike but for what is the method's."""
    settings = read_settings()
    stop = replace(settings.stop, minutes=minutes)
    return replace(settings, method="imitation" if model == "imitation" else "automaton", stop=stop)
