"""The trainings of our Table I: their configuration, commands and results."""

from __future__ import annotations

import json
from hashlib import sha256
from pathlib import Path
from typing import Final

from tltl_runtime.game.level import default_spec
from tltl_runtime.game.registry import game_of
from tltl_runtime.policies.card import OBSERVATION, Card
from tltl_runtime.policies.identity import spec_hash
from tltl_runtime.regression.table1.paper_table import Model
from tltl_runtime.spec.task import load_task
from tltl_runtime.support.record_json import to_json
from tltl_runtime.training.files.record import finished_record
from tltl_runtime.training.files.run_file import MAY_CHANGE, POLICY, RECORD, RUN, leaves, read_run
from tltl_runtime.training.files.settings import read_settings
from tltlc.api import record, replace

_MINUTES: Final = 60.0


@record
class Limits:
    """The limits of a training.

    ``steps`` is the number of decisions in all environments together, and ``minutes`` is the time;
    0 minutes mean that the time is not limited.
    """

    steps: int
    minutes: float


@record
class TableTraining:
    """A training of a model on a level, in a folder of its own.

    ``imitates`` says whether the model learns by imitation.
    """

    folder: Path
    level: str
    imitates: bool
    limits: Limits


@record
class TrainedModel:
    """The result of a training with a ``seed``: its policy and the hours that it took.

    ``cloning_share`` is the share of its steps with behavioural cloning, or None if the model does
    not imitate.
    """

    policy: Path
    seed: int
    hours: float
    cloning_share: float | None


def limits(minutes: float | None) -> Limits:
    """Return the limits of our trainings: the default number of steps, and ``minutes``.

    If ``minutes`` is None, the limit is one hour.
    """
    return Limits(read_settings().stop.steps, _MINUTES if minutes is None else minutes)


def limits_of_policy(card: Card, minutes: float | None) -> Limits:
    """Return the limits of the training that made a policy, so that another training can have them.

    ``card`` is the policy's card, which stores the settings of its training. ``minutes`` replaces the
    limit of minutes unless it is None.
    """
    stop = card.training["settings"]["stop"]
    return Limits(int(stop["steps"]), float(stop["minutes"]) if minutes is None else minutes)


def table_training(folder: Path, level: str, model: Model, limits: Limits) -> TableTraining:
    """Configure the training of a model on variant ``v0`` of a level, in its own folder in ``folder``.

    The name of the training's folder contains a hash of the level, the spec, the sensors and the
    settings. So a change of one of these gives a new training, but a change of the code does not. If
    the model imitates, the hash includes the limits, since cloning takes a share of them. If not, the
    training can continue in the same folder with greater limits.

    Raises:
        TltlError: the level or its spec cannot be read.
    """
    settings = replace(read_settings(), method="imitation" if model == "imitation" else "automaton")
    game = game_of(level)
    loaded_level = game.load_level(level, "v0")
    task = load_task(default_spec(loaded_level), offered=game.params(loaded_level))
    parts = [
        game.level_hash(loaded_level),
        spec_hash(task.fspa),
        OBSERVATION,
        to_json(loaded_level.sensors),
        {path: value for path, value in leaves(to_json(settings)) if path not in MAY_CHANGE},
        to_json(limits) if settings.imitates else None,
    ]
    digest = sha256(json.dumps(parts, sort_keys=True).encode()).hexdigest()
    return TableTraining(folder / f"{level}-{model}-{digest[:8]}", level, settings.imitates, limits)


def train_arguments(training: TableTraining) -> list[str]:
    """Return the arguments with which ``tltlc train`` starts or continues a training of the table.

    If the training continues, each limit is the greater of its new and its last value, because the
    training may already have passed the new value. 0 minutes means no limit, and counts as greater
    than all other values.
    """
    steps, minutes = training.limits.steps, training.limits.minutes
    if (training.folder / RUN).exists():
        last_stop = read_run(training.folder).settings.stop
        arguments = ["--resume", str(training.folder)]
        steps, minutes = (
            max(steps, last_stop.steps),
            minutes and last_stop.minutes and max(minutes, last_stop.minutes),
        )
    else:
        method = ["--method", "imitation"] if training.imitates else []
        arguments = ["--level", training.level, "--out", str(training.folder), *method]
    return [*arguments, "--steps", str(steps), "--minutes", f"{minutes:g}"]


def finished_training(training: TableTraining) -> TrainedModel | None:
    """Return the result of a training; None if it has reached neither its goal nor one of its limits.

    Raises:
        TltlError: TLT0863, the folder cannot be read.
    """
    if not all((training.folder / name).exists() for name in (RUN, RECORD, POLICY)):
        return None
    run = read_run(training.folder)
    stop = replace(run.settings.stop, steps=training.limits.steps, minutes=training.limits.minutes)
    document = finished_record(replace(run, settings=replace(run.settings, stop=stop)))
    if document is None:
        return None
    cloning_share = document["imitated"]["cloned"] / document["steps"] if training.imitates else None
    return TrainedModel(training.folder / POLICY, run.seed, document["seconds"] / 3600, cloning_share)
