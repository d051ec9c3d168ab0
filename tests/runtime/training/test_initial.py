"""Trainings that start from the weights of a policy."""

from __future__ import annotations

import json
import shutil
from collections.abc import Mapping
from itertools import pairwise
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
import torch
from numpy.typing import NDArray
from torch import nn

from tests.runtime.training.runs import checkpoint_of, run_in
from tests.runtime.training.test_settings import compare
from tltl_runtime.policies.file import read_policy, write_policy
from tltl_runtime.policies.policy import NotFiniteError, Policy
from tltl_runtime.policies.summary import summary, summary_text
from tltl_runtime.policies.torch_actor import arrays
from tltl_runtime.training.exploration.search import SearchProgress
from tltl_runtime.training.files.checkpoint import deep_copy
from tltl_runtime.training.files.record import record_so_far, write_record
from tltl_runtime.training.files.report import TrainingReport
from tltl_runtime.training.files.run_file import CHECKPOINT, POLICY, TrainingRun, identity, read_run
from tltl_runtime.training.run.initial_policy import initial_policy_of, weights_hash
from tltl_runtime.training.run.train import train
from tltl_runtime.training.runner import Runner
from tltlc.core.record import replace
from tltlc.diagnostics.diagnostic import TltlError


def tuned(folder: Path, path: Path, **changes: object) -> TrainingRun:
    """A training that starts from the policy in a file."""
    return replace(run_in(folder, **changes), initial=initial_policy_of(path, read_policy(path)))


@pytest.fixture(name="policy")
def _policy(tmp_path: Path, whole: tuple[TrainingRun, list[TrainingReport]]) -> Path:
    shutil.copy(whole[0].folder / POLICY, tmp_path / "old.safetensors")
    return tmp_path / "old.safetensors"


def weights(run: TrainingRun) -> dict[str, NDArray[Any]]:
    actor = checkpoint_of(run).algorithm["actor_state_dict"]
    return {name: weight.astype(np.float16) for name, weight in arrays(actor).items()}


def differing(one: Mapping[str, Any], other: Mapping[str, Any]) -> list[str]:
    return [name for name in one if not np.array_equal(np.asarray(one[name]), np.asarray(other[name]))]


def test_the_critic_learns_first_and_then_the_actor(tmp_path: Path, policy: Path) -> None:
    run, old = tuned(tmp_path / "run", policy, ppo__warm_up=2), read_policy(policy).weights()
    critics = []
    training = train(run)
    for report in training:
        checkpoint = checkpoint_of(run)
        critics.append(checkpoint.algorithm["critic_state_dict"])
        assert bool(differing(old, weights(run))) == (report.iteration.number == 3)
        assert report.iteration.losses["value"] > 0.0
    assert len(critics) == 3
    assert all(differing(earlier, later) for earlier, later in pairwise(critics))


def test_without_a_warm_up_the_actor_learns_at_once(tmp_path: Path, policy: Path) -> None:
    run = tuned(tmp_path / "run", policy, ppo__warm_up=0, stop__steps=64)
    list(train(run))
    assert differing(read_policy(policy).weights(), weights(run))


def test_the_inverse_temperature_rises_only_after_the_warm_up() -> None:
    last = nn.Linear(2, 2)
    runner = Runner.__new__(Runner)
    actor = SimpleNamespace(mlp=[nn.Linear(2, 2), last], distribution=None)
    runner.cfg, runner.alg = {"warm_up": 2}, SimpleNamespace(actor=actor)
    before = deep_copy(last.state_dict())
    for runner.current_learning_iteration in (1, 2):
        runner.scale_inverse_temperature(1.5)
        assert not differing(before, last.state_dict())
    runner.current_learning_iteration = 3
    runner.scale_inverse_temperature(1.5)
    assert all(torch.equal(weight, 1.5 * before[name]) for name, weight in last.state_dict().items())


def test_a_new_actor_has_no_warm_up(tmp_path: Path) -> None:
    waiting, other = (run_in(tmp_path / str(number), ppo__warm_up=number, stop__steps=64) for number in (5, 0))
    list(train(waiting))
    list(train(other))
    assert not differing(weights(waiting), weights(other))


def test_the_initial_policy_plays_first_in_the_search(tmp_path: Path) -> None:
    spec = "import stealth\nspec soon { level cover_and_hide\n limit 8 steps\n keep alive }\n"
    old = run_in(tmp_path / "old", spec, stop__steps=64)
    list(train(old))
    run = run_in(tmp_path / "run", spec, exploration__ways=4, exploration__steps=400, stop__steps=64)
    path = old.folder / POLICY
    searches: list[SearchProgress] = []
    list(train(replace(run, initial=initial_policy_of(path, read_policy(path))), on_search=searches.append))
    # Each of the four environments plays one episode of eight steps, and none from a discovered place.
    assert (searches[-1].lengths, searches[-1].steps, searches[-1].replayed) == ((8, 8, 8, 8), 32, 0)


def test_an_initial_policy_that_gives_no_numbers_is_rejected(
    tmp_path: Path, policy: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def refuse(*_: object) -> None:
        raise NotFiniteError("it gives no numbers")

    run = tuned(tmp_path / "run", policy, exploration__ways=4, exploration__steps=400)
    monkeypatch.setattr(Policy, "choose_row", refuse)
    with pytest.raises(TltlError, match=r"TLT0854: the policy that the training in `.*run` begins with: it gives no n"):
        list(train(run))


def test_a_training_resumes_from_its_checkpoint_without_the_policy(tmp_path: Path, policy: Path) -> None:
    run, old = tuned(tmp_path / "run", policy, ppo__warm_up=2), read_policy(policy).weights()
    part = replace(run, settings=replace(run.settings, stop=replace(run.settings.stop, steps=64)))
    list(train(part))
    policy.unlink()
    assert read_run(run.folder) == part
    changed = [bool(differing(old, weights(run))) for _ in train(run, resume=True)]
    assert (changed, checkpoint_of(run).iteration) == ([False, True], 3)


def test_the_initial_policy_is_part_of_the_identity(tmp_path: Path, policy: Path) -> None:
    run = tuned(tmp_path / "run", policy)
    without = identity(replace(run, initial=None))
    assert identity(run) == {**without, "policy": weights_hash(read_policy(policy))}


def test_the_training_record_does_not_change_the_hash_of_the_weights(tmp_path: Path, policy: Path) -> None:
    old = read_policy(policy)
    again = tmp_path / "again.safetensors"
    write_policy(again, Policy(replace(old.card, training={"seed": 1}), old.weights()))
    assert again.read_bytes() != policy.read_bytes()
    assert weights_hash(read_policy(again)) == weights_hash(old)


@pytest.mark.parametrize("name", ["TLT0940", "TLT0940_gone"])
def test_without_a_checkpoint_the_initial_policy_is_needed(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, policy: Path, name: str
) -> None:
    monkeypatch.chdir(tmp_path)
    run = tuned(Path("run"), Path("old.safetensors"), stop__steps=64, ppo__warm_up=0)
    list(train(run))
    (run.folder / CHECKPOINT).unlink()
    if name == "TLT0940":
        shutil.copy(run.folder / POLICY, policy)
    else:
        policy.unlink()
    with pytest.raises(TltlError) as caught:
        next(train(run, resume=True))
    compare(name, caught.value)


def test_the_record_names_the_initial_policy(tmp_path: Path, policy: Path) -> None:
    run, old = tuned(tmp_path / "run", policy, stop__steps=64), read_policy(policy)
    (last,) = train(run)
    so_far = record_so_far(run.folder)["initial"]
    record = write_record(run, last)["initial"]
    assert record == so_far == {
        "weights": weights_hash(old), "level": "cover_and_hide", "variant": "v0", "level_hash": old.card.level_hash
    }  # fmt: skip
    assert str(tmp_path) not in json.dumps(record)
    text = summary_text(summary(read_policy(run.folder / POLICY)))
    assert f"cover_and_hide v0 (hash {record['weights'][:12]})" in " ".join(text.split())
