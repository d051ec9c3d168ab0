"""Very short trainings, for tests of ``tltlc train``."""

from __future__ import annotations

import shutil
from collections.abc import Callable
from pathlib import Path

import pytest

from tests.interfaces.cli.conftest import EXAMPLE, Outcome
from tests.shared import made_once
from tltlc.interfaces.cli.main import main

TltlcFunction = Callable[..., Outcome]

SMALL = """
[rollout]
envs = 4
steps = 16
workers = 1

[exploration]
ways = 0

[ppo]
epochs = 1
minibatches = 1

[network]
hidden = [8]

[stop]
windows = 1
episodes = 2
confirmation = 2
steps = 128
"""

SOON = "import stealth\nspec soon { level cover_and_hide\n limit 8 steps\n keep alive }\n"
"""A spec that any player meets after eight steps."""


@pytest.fixture(name="here")
def _here(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """The current folder, which contains only small settings and a spec."""
    _write_inputs(tmp_path)
    monkeypatch.chdir(tmp_path)
    return tmp_path


def _write_inputs(folder: Path) -> None:
    (folder / "small.toml").write_text(SMALL)
    (folder / "soon.tltl").write_text(SOON)


@pytest.fixture(name="trainings", scope="module")
def _trainings(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder with two finished trainings: ``run``, ended by its limit of steps, and ``second``, whose spec is met."""
    return made_once(tmp_path_factory, "cli-trainings", _train_twice)


def _train_twice(folder: Path) -> None:
    _write_inputs(folder)
    with pytest.MonkeyPatch.context() as patch:
        patch.chdir(folder)
        for spec, name, status in ((str(EXAMPLE), "run", 1), ("soon.tltl", "second", 0)):
            with pytest.raises(SystemExit) as ended:
                main(["train", spec, "--config", "small.toml", "--out", name])
            assert ended.value.code == status


@pytest.fixture(name="run")
def _run(trainings: Path, here: Path) -> Path:
    """A copy of the training that was ended by its limit, as ``run`` in the current folder."""
    return shutil.copytree(trainings / "run", here / "run")


@pytest.fixture(name="second")
def _second(trainings: Path, here: Path) -> Path:
    """A copy of the training whose spec is met, as ``second`` in the current folder."""
    return shutil.copytree(trainings / "second", here / "second")


def train_arguments(*options: str) -> list[str]:
    return ["train", str(EXAMPLE), "--config", "small.toml", "--out", "run", *options]
