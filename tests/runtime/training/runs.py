"""Trainings that take seconds; :func:`main` is one as a program."""

from __future__ import annotations

import hashlib
import json
import math
import os
import signal
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import torch

from tltl_runtime.spec.task import load_task
from tltl_runtime.stealth.capabilities.vocabulary import params
from tltl_runtime.stealth.env import spec_of
from tltl_runtime.stealth.levels.file import load_level
from tltl_runtime.training.exploration.search import Searched
from tltl_runtime.training.run.checkpoint import Checkpoint, read_checkpoint
from tltl_runtime.training.run.run import CHECKPOINT, Run, identity
from tltl_runtime.training.run.settings import read_settings
from tltl_runtime.training.run.train import train
from tltl_runtime.training.runner import Iteration, Runner
from tltlc.core.record import replace

SMALL: dict[str, Any] = {
    "rollout.envs": 4,
    "rollout.steps": 16,
    "rollout.workers": 1,
    "network.hidden": (16,),
    "network.channels": (4,),
    "exploration.ways": 0,
    "stop.steps": 192,
    "stop.confirmation": 4,
    "checkpoint_s": 0.0,
}


def run_in(folder: Path, spec: str | None = None, **changes: Any) -> Run:
    """A training on cover_and_hide of three iterations of 64 steps, with ``changes`` of :data:`SMALL`; dots in the
    names of settings are written as two underscores.  ``spec`` is the text of another one than the level's own.
    """
    level = load_level("cover_and_hide")
    task = load_task(spec or spec_of(level), offered=params(level))
    settings = read_settings()
    for name, value in {**SMALL, **{name.replace("__", "."): value for name, value in changes.items()}}.items():
        table, _, key = name.rpartition(".")
        if table:
            settings = replace(settings, **{table: replace(getattr(settings, table), **{key: value})})
        else:
            settings = replace(settings, **{key: value})
    return Run(folder, task.fspa, task.params, "cover_and_hide", "v0", level.sensors, settings, 3)


def checkpoint_of(run: Run) -> Checkpoint:
    """The checkpoint that a training has left."""
    checkpoint = read_checkpoint(run.folder / CHECKPOINT, identity(run))
    assert checkpoint is not None
    return checkpoint


class Telling(Runner):
    """A runner that tells the weights after each iteration, as their hash."""

    def iterations(self) -> Iterator[Iteration]:
        for iteration in super().iterations():
            weights = b"".join(each.numpy().tobytes() for each in self.alg.actor.state_dict().values())
            _say(weights=hashlib.sha256(weights).hexdigest(), iteration=iteration.number)
            yield iteration


class Diverging(Runner):
    """A runner whose second iteration gives a loss that is no number."""

    def iterations(self) -> Iterator[Iteration]:
        for iteration in super().iterations():
            yield iteration if iteration.number < 2 else replace(iteration, losses={"value": math.nan})


class Growing(Runner):
    """A runner one of whose weights grows larger than a policy's file can hold."""

    def iterations(self) -> Iterator[Iteration]:
        for iteration in super().iterations():
            next(self.alg.actor.parameters()).data.view(-1)[0] = 1e5
            yield iteration


class Failing(Runner):
    """A runner whose environment gives, from its second iteration on, an observation that has no number."""

    def _step(self, observation: Any) -> Any:
        if self.current_learning_iteration == 1:
            self.env.get_observations()["entities"][0, 0] = math.nan
            self.env.step = lambda actions: (self.env.get_observations(), torch.zeros(4), torch.zeros(4), {})
        return super()._step(observation)


class Weighing(Runner):
    """A runner that tells the weights of the entropy bonus and of the terminal penalty's rise, and this rise at the
    first step, among the losses.
    """

    def iterations(self) -> Iterator[Iteration]:
        for iteration in super().iterations():
            dearer = self.env._dearer
            losses = {"weight": self.alg.entropy_coef, "severity": self.env.severity}
            yield replace(iteration, losses=losses | {"dearer": dearer(0) if dearer else 0.0})


def _say(**values: Any) -> None:
    # In one piece: several processes may write at once.
    os.write(1, (json.dumps({"rank": os.environ.get("RANK", "0"), **values}) + "\n").encode())


def main(folder: str, *given: str) -> None:
    """Train in a folder with ``NAME=VALUE`` of :func:`run_in`, the values in JSON, or go on there with ``--resume``.

    It prints a line of JSON for each report; in several processes of torchrun each does. With ``--wait-in-search`` it
    prints how many steps a search has taken when it first tells, and waits there until somebody kills it.
    """

    def searching(searched: Searched) -> None:
        if "--wait-in-search" in given:
            _say(searched=searched.steps)
            signal.pause()

    changes = dict(each.split("=", 1) for each in given if "=" in each)
    run = run_in(Path(folder), **{name: json.loads(value) for name, value in changes.items()})
    for report in train(run, resume="--resume" in given, searching=searching):
        _say(number=report.iteration.number, steps=report.steps, stop=report.stop, finished=report.window.count)
