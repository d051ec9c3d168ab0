"""Writing the files that a training needs to resume."""

from __future__ import annotations

import os
from pathlib import Path

import pytest
import torch

from tests.runtime.training.runs import run_in
from tltl_runtime.training.exploration.search import SearchProgress
from tltl_runtime.training.files.checkpoint import BestPolicy, Checkpoint, read_checkpoint, write_checkpoint
from tltl_runtime.training.files.run_file import RUN, write_run
from tltlc.core.record import replace


@pytest.fixture(name="checkpoint")
def _checkpoint() -> Checkpoint:
    return Checkpoint(
        run={"level": "0"},
        iteration=3,
        losses={"value": 0.5},
        steps=192,
        seconds=1.5,
        replayed=7,
        searched=SearchProgress(10, 7, 0.5, 4, (8, 9), complete=True),
        algorithm={"rate": 0.001, "actor_state_dict": {}},
        processes=({"cpu": torch.get_rng_state()},),
        window=((True, 1.0, 30, 2, False),),
        unbroken=0,
        best=BestPolicy((0.5, 1.0, -2.0), {}, 64),
        met=False,
        standstill=(0.5, 128),
    )


@pytest.fixture(name="synced")
def _synced(monkeypatch: pytest.MonkeyPatch) -> list[int]:
    """The sizes of the files at each call of ``os.fsync``."""
    sizes, sync = [], os.fsync

    def synced(descriptor: int) -> None:
        sizes.append(os.fstat(descriptor).st_size)
        sync(descriptor)

    monkeypatch.setattr(os, "fsync", synced)
    return sizes


def test_a_checkpoint_is_synced_to_disk(tmp_path: Path, checkpoint: Checkpoint, synced: list[int]) -> None:
    write_checkpoint(path := tmp_path / "checkpoint.pt", checkpoint)
    assert synced[0] == path.stat().st_size
    assert [file.name for file in tmp_path.iterdir()] == [path.name]
    again = read_checkpoint(path, checkpoint.run)
    assert again is not None
    assert torch.equal(again.processes[0]["cpu"], checkpoint.processes[0]["cpu"])
    assert replace(again, processes=()) == replace(checkpoint, processes=())


def test_the_description_of_a_training_is_synced_to_disk(tmp_path: Path, synced: list[int]) -> None:
    write_run(run_in(tmp_path))
    assert synced[0] == (tmp_path / RUN).stat().st_size
