"""Fixtures: a finished training, which the tests of a module share."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.runtime.training.runs import run_in
from tltl_runtime.training.files.report import TrainingReport
from tltl_runtime.training.files.run_file import TrainingRun
from tltl_runtime.training.run.train import train


@pytest.fixture(name="folder", scope="module")
def _folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return tmp_path_factory.mktemp("trainings")


@pytest.fixture(name="whole", scope="module")
def _whole(folder: Path) -> tuple[TrainingRun, list[TrainingReport]]:
    """Return a training of three iterations, and its reports.

    Each module has its own training, because resuming changes it.
    """
    run = run_in(folder / "whole")
    return run, list(train(run))
