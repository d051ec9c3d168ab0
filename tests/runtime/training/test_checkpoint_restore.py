"""Checkpoints of the right types whose tensors do not fit the training that resumes from them."""

from __future__ import annotations

import shutil
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import torch

from tests.runtime.training.runs import STEALTH_ACTIONS, run_in
from tltl_runtime.training.exploration.reverse_curriculum import ReverseCurriculum
from tltl_runtime.training.exploration.search import FailedEpisode, SuccessfulEpisode
from tltl_runtime.training.files.checkpoint import read_checkpoint
from tltl_runtime.training.files.report import TrainingReport
from tltl_runtime.training.files.run_file import CHECKPOINT, TrainingRun
from tltl_runtime.training.run.train import train
from tltlc.core.record import replace
from tltlc.diagnostics.diagnostic import TltlError

Content = dict[str, Any]


def changed(run: TrainingRun, change: Callable[[Content], object]) -> None:
    content = torch.load(run.folder / CHECKPOINT, weights_only=True)
    change(content)
    torch.save(content, run.folder / CHECKPOINT)


def refusal(run: TrainingRun) -> str:
    """The reason why a training cannot resume from a checkpoint; the checkpoint itself is readable."""
    assert read_checkpoint(run.folder / CHECKPOINT)
    before = (run.folder / CHECKPOINT).read_bytes()
    with pytest.raises(TltlError) as caught:
        next(train(run, resume=True))
    (diagnostic,) = caught.value.diagnostics
    assert diagnostic.code == "TLT0864"
    assert (run.folder / CHECKPOINT).read_bytes() == before
    return diagnostic.title.partition("`: ")[2]


@pytest.fixture(name="copy")
def _copy(tmp_path: Path, whole: tuple[TrainingRun, list[TrainingReport]]) -> TrainingRun:
    shutil.copytree(whole[0].folder, tmp_path / "run")
    return replace(whole[0], folder=tmp_path / "run")


def _first(weights: dict[str, Any], change: Callable[[Any], object]) -> None:
    name = next(iter(weights))
    weights[name] = change(weights[name])


def _cut(content: Content) -> dict[str, Any]:
    """The weights of the actor; the first tensor lacks its last row."""
    weights: dict[str, Any] = dict(content["algorithm"]["actor_state_dict"])
    _first(weights, lambda tensor: tensor[:-1])
    return weights


def _state(content: Content) -> dict[Any, Any]:
    state: dict[Any, Any] = content["algorithm"]["optimizer_state_dict"]["state"][0]
    return state


def _group(content: Content) -> dict[str, Any]:
    group: dict[str, Any] = content["algorithm"]["optimizer_state_dict"]["param_groups"][0]
    return group


CHANGES: dict[str, tuple[Callable[[Content], object], str]] = {
    "critic of another shape": (
        lambda it: _first(it["algorithm"]["critic_state_dict"], lambda tensor: tensor[:-1]),
        "and the network needs",
    ),
    "critic of whole numbers": (
        lambda it: _first(it["algorithm"]["critic_state_dict"], lambda tensor: tensor.long()),
        "is not a tensor of float32",
    ),
    "critic without a layer": (
        lambda it: it["algorithm"]["critic_state_dict"].popitem(),
        "`algorithm.critic_state_dict` is of another network",
    ),
    "critic that is a number": (
        lambda it: it["algorithm"].update(critic_state_dict=1),
        "`algorithm.critic_state_dict` is of another network",
    ),
    "no critic": (lambda it: it["algorithm"].pop("critic_state_dict"), "a part is missing: 'critic_state_dict'"),
    "best actor of another shape": (
        lambda it: it.update(best={"score": (0.5, 1.0, -2.0), "steps": 64, "actor": _cut(it)}),
        "and the network needs",
    ),
    "averages of another shape": (
        lambda it: _state(it).update(exp_avg=torch.zeros(2)),
        "`algorithm.exp_avg` has the shape [2]",
    ),
    "averages that are missing": (lambda it: _state(it).pop("exp_avg_sq"), "an optimizer in it has other averages"),
    "averages that are no tensor": (
        lambda it: _state(it).update(exp_avg="text"),
        "contains a value that is not a tensor of finite numbers",
    ),
    "optimizer of fewer weights": (lambda it: _group(it)["params"].pop(), "is of another optimizer"),
    "optimizer whose rate is a text": (
        lambda it: _group(it).update(lr="fast"),
        "an optimizer in it has other options",
    ),
    "optimizer whose rate is no number": (
        lambda it: _group(it).update(lr=float("nan")),
        "an optimizer in it has other options: `lr`",
    ),
    "optimizer with averages of no weight": (
        lambda it: it["algorithm"]["optimizer_state_dict"]["state"].update({99: {}}),
        "`algorithm.optimizer_state_dict.state` is of another optimizer",
    ),
    "optimizer whose betas are one": (
        lambda it: _group(it).update(betas=(0.9,)),
        "an optimizer in it has other options",
    ),
    "generator that is too short": (
        lambda it: it["processes"][0].update(cpu=torch.zeros(3, dtype=torch.uint8)),
        "the state of a random generator in `processes` is invalid",
    ),
    "generator of other numbers": (
        lambda it: it["processes"][0].update(cpu=it["processes"][0]["cpu"].float()),
        "the state of a random generator in `processes` is invalid",
    ),
    "no generator": (
        lambda it: it["processes"][0].pop("cpu"),
        "the state of a random generator in `processes` is invalid",
    ),
}


@pytest.mark.parametrize("name", CHANGES)
def test_a_checkpoint_that_does_not_fit_is_rejected(copy: TrainingRun, name: str) -> None:
    change, why = CHANGES[name]
    changed(copy, change)
    assert why in refusal(copy)


def test_an_unchanged_checkpoint_fits(copy: TrainingRun) -> None:
    assert next(train(copy, resume=True)).stop == "steps"


def test_a_checkpoint_without_processes_is_rejected(copy: TrainingRun) -> None:
    changed(copy, lambda it: it.update(processes=()))
    with pytest.raises(TltlError, match="TLT0864"):
        read_checkpoint(copy.folder / CHECKPOINT)


def test_a_curriculum_of_another_shape_is_rejected(tmp_path: Path) -> None:
    run = run_in(tmp_path / "run", exploration__ways=1, exploration__steps=64, stop__steps=64)
    list(train(run))
    changed(run, lambda it: it["processes"][0].update(rates=torch.zeros(2, 3)))
    assert refusal(run).startswith("`processes` 1: `rates` must be float64 of the shape [")


def curriculum_state() -> dict[str, Any]:
    """The state of a curriculum with one demonstration and one failed episode."""
    curriculum = ReverseCurriculum(4, np.random.default_rng(0), STEALTH_ACTIONS)
    curriculum.add(SuccessfulEpisode(1, [[0] * 5, [1] * 5], 2))
    curriculum.failures.append(FailedEpisode(3, [[0] * 5], 1))
    return curriculum.state()


STARTS: dict[str, Callable[[dict[str, Any]], object]] = {
    "no seeds": lambda it: it.pop("way_seeds"),
    "no rates": lambda it: it.pop("rates"),
    "more lengths than seeds": lambda it: it.update(way_lengths=np.array([1, 1])),
    "fewer actions than lengths": lambda it: it.update(way_actions=it["way_actions"][:1]),
    "actions of one branch": lambda it: it.update(failure_actions=np.zeros(1, np.int8)),
    "actions that nobody can choose": lambda it: it.update(way_actions=it["way_actions"] + np.int8(100)),
    "a length below 0": lambda it: it.update(way_lengths=np.array([-2])),
    "lengths that are fractions": lambda it: it.update(way_lengths=np.array([2.0])),
    "a seed below 0": lambda it: it.update(way_seeds=np.array([-1])),
    "an end below 0": lambda it: it.update(way_ends=np.array([-1])),
    "a failed state below 0": lambda it: it.update(failure_ends=np.array([-1])),
    "rates of two ends": lambda it: it.update(rates=np.zeros((2, 4))),
    "rates of other parts": lambda it: it.update(rates=np.zeros((1, 3))),
    "a rate above 1": lambda it: it.update(rates=np.full((1, 4), 2.0)),
    "a rate that is no number": lambda it: it.update(passed=np.array([np.nan])),
    "two rates from the start": lambda it: it.update(passed=np.zeros(2)),
    "a mean length of 0": lambda it: it.update(lengths=np.zeros(2)),
}


@pytest.mark.parametrize("name", STARTS)
def test_a_damaged_curriculum_is_rejected(name: str) -> None:
    whole = curriculum_state()
    ReverseCurriculum(4, np.random.default_rng(0), STEALTH_ACTIONS).load(whole)
    STARTS[name](whole)
    with pytest.raises(ValueError, match="`"):
        ReverseCurriculum(4, np.random.default_rng(0), STEALTH_ACTIONS).load(whole)
