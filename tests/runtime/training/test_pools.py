"""A training gives the same policy for any number and kind of workers."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from tests.runtime.own_cluster import needs_ray, own_cluster
from tests.runtime.training.runs import run_in
from tltl_runtime.policies.file import read_policy
from tltl_runtime.spec.task import load_task
from tltl_runtime.training.files.run_file import POLICY
from tltl_runtime.training.run.initial_policy import initial_policy_of
from tltl_runtime.training.run.train import train
from tltlc.core.record import replace

SPEC = "import stealth\nspec soon { level cover_and_hide\n limit 8 steps\n keep alive }\n"
"""A spec that every policy meets after eight steps, so that the search finds ways."""


def _trained(folder: Path, initial: Path | None = None, **settings: Any) -> bytes:
    """Train two iterations after a search that finds ways, optionally from a policy; return the policy's file."""
    spec = folder.with_suffix(".tltl")
    spec.write_text(SPEC, encoding="utf-8")
    task = load_task(spec)
    limits = {"exploration__ways": 2, "exploration__steps": 400, "stop__steps": 128}
    run = replace(run_in(folder, **limits, **settings), fspa=task.fspa, params=task.params)
    if initial:
        run = replace(run, initial=initial_policy_of(initial, read_policy(initial)))
    reports = list(train(run))
    assert reports[-1].searched is not None
    assert reports[-1].searched.lengths
    assert reports[-1].replayed > 0
    return (folder / POLICY).read_bytes()


@pytest.fixture(name="alone", scope="module")
def _alone(tmp_path_factory: pytest.TempPathFactory) -> bytes:
    """The policy that was trained with one process."""
    return _trained(tmp_path_factory.mktemp("trainings") / "alone")


def test_two_processes_give_the_same_policy(alone: bytes, tmp_path: Path) -> None:
    assert _trained(tmp_path / "two", rollout__workers=2) == alone


def test_two_processes_give_the_same_policy_from_an_initial_policy(alone: bytes, tmp_path: Path) -> None:
    (tmp_path / "old.safetensors").write_bytes(alone)
    one, two = (
        _trained(tmp_path / str(workers), tmp_path / "old.safetensors", rollout__workers=workers, ppo__warm_up=0)
        for workers in (1, 2)
    )
    assert one == two != alone


@pytest.mark.slow
@needs_ray
def test_a_ray_cluster_gives_the_same_policy(alone: bytes, tmp_path: Path) -> None:
    with own_cluster():
        assert _trained(tmp_path / "ray", rollout__pool="ray") == alone
