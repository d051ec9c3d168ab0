"""Trainings that take seconds. As a program, this module runs one of them with :func:`main`."""

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
from gymnasium import spaces

from tltl_runtime.game.level import default_spec
from tltl_runtime.game.level_name import Variant
from tltl_runtime.spec.task import load_task
from tltl_runtime.stealth.capabilities.vocabulary import params
from tltl_runtime.stealth.levels.file import load_level
from tltl_runtime.training.exploration.action_encoding import ActionEncoding
from tltl_runtime.training.exploration.search import SearchProgress
from tltl_runtime.training.files.checkpoint import Checkpoint, read_checkpoint
from tltl_runtime.training.files.run_file import CHECKPOINT, TrainingRun, identity
from tltl_runtime.training.files.settings import read_settings
from tltl_runtime.training.run.train import train
from tltl_runtime.training.runner import Iteration, Runner
from tltlc.core.record import replace

STEALTH_ACTIONS = ActionEncoding(spaces.MultiDiscrete([3, 3, 2, 2, 2]))
"""The encoding of the actions of the stealth game."""
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


def run_in(folder: Path, spec: str | None = None, **changes: Any) -> TrainingRun:
    """Return a training on cover_and_hide: three iterations of 64 steps, with the settings SMALL.

    ``changes`` override settings: ``rollout__envs`` is the setting ``rollout.envs``. ``spec`` is
    the text of a spec that replaces the spec of the level.
    """
    level = load_level("cover_and_hide")
    task = load_task(spec or default_spec(level), offered=params(level))
    settings = read_settings()
    for name, value in {**SMALL, **{name.replace("__", "."): value for name, value in changes.items()}}.items():
        table, _, key = name.rpartition(".")
        if table:
            settings = replace(settings, **{table: replace(getattr(settings, table), **{key: value})})
        else:
            settings = replace(settings, **{key: value})
    return TrainingRun(folder, task.fspa, task.params, "cover_and_hide", Variant("v0"), level.sensors, settings, 3)


def checkpoint_of(run: TrainingRun) -> Checkpoint:
    """Return the checkpoint that a training has written."""
    checkpoint = read_checkpoint(run.folder / CHECKPOINT, identity(run))
    assert checkpoint is not None
    return checkpoint


class WeightPrinting(Runner):
    """A runner that prints the hash of the weights after each iteration."""

    def iterations(self) -> Iterator[Iteration]:
        for iteration in super().iterations():
            weights = b"".join(parameter.numpy().tobytes() for parameter in self.alg.actor.state_dict().values())
            _print_json(weights=hashlib.sha256(weights).hexdigest(), iteration=iteration.number)
            yield iteration


class Diverging(Runner):
    """A runner whose second iteration has a loss of NaN."""

    def iterations(self) -> Iterator[Iteration]:
        for iteration in super().iterations():
            yield iteration if iteration.number < 2 else replace(iteration, losses={"value": math.nan})


class Growing(Runner):
    """A runner with a weight that is too large for the file of a policy."""

    def iterations(self) -> Iterator[Iteration]:
        for iteration in super().iterations():
            next(self.alg.actor.parameters()).data.view(-1)[0] = 1e5
            yield iteration


class Failing(Runner):
    """A runner whose environment returns NaN in observations from the second iteration on."""

    def _step(self, observation: Any) -> Any:
        if self.current_learning_iteration == 1:
            self.env.get_observations()["entities"][0, 0] = math.nan
            self.env.step = lambda actions: (self.env.get_observations(), torch.zeros(4), torch.zeros(4), {})
        return super()._step(observation)


class WeightReporting(Runner):
    """A runner that reports weights as if they were losses.

    They are the entropy weight, the penalty weight, and the extra penalty at step 0.
    """

    def iterations(self) -> Iterator[Iteration]:
        for iteration in super().iterations():
            extra_penalty = self.env._extra_penalty
            losses = {"weight": self.alg.entropy_coef, "penalty_weight": self.env.penalty_weight}
            yield replace(iteration, losses=losses | {"extra_penalty": extra_penalty(0) if extra_penalty else 0.0})


def _print_json(**values: Any) -> None:
    # Write with a single call, since several processes may write at once.
    os.write(1, (json.dumps({"rank": os.environ.get("RANK", "0"), **values}) + "\n").encode())


def main(folder: str, *options: str) -> None:
    """Train in a folder, and print a line of JSON for each report.

    An option ``NAME=VALUE`` changes a setting, as in :func:`run_in`; VALUE is JSON. ``--resume``
    resumes the training. With ``--wait-in-search``, print the number of steps of the search at its
    first progress report, and wait there to be killed. With torchrun, each process prints its own
    lines.
    """

    def searching(searched: SearchProgress) -> None:
        if "--wait-in-search" in options:
            _print_json(searched=searched.steps)
            signal.pause()

    changes = dict(option.split("=", 1) for option in options if "=" in option)
    run = run_in(Path(folder), **{name: json.loads(value) for name, value in changes.items()})
    for report in train(run, resume="--resume" in options, on_search=searching):
        _print_json(number=report.iteration.number, steps=report.steps, stop=report.stop, finished=report.window.count)
