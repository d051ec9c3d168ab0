"""Fixtures: the small game with its baseline and the results of a first run of its suite."""

from __future__ import annotations

import shutil
from pathlib import Path

import pytest

from tests.runtime.regression.game import Played, with_baseline, write_game
from tests.shared import made_once
from tltl_runtime.regression.suite_run import regress
from tltl_runtime.regression.verdict.baseline import baseline_of


@pytest.fixture(name="recorded", scope="module")
def _recorded(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return recorded_game(tmp_path_factory)


def recorded_game(temporary: pytest.TempPathFactory) -> Path:
    """Return the folder of a game with its baseline.

    Its folder ``run`` contains the results of a first run of the suite.
    """
    return made_once(temporary, "recorded-game", _record)


def _record(folder: Path) -> None:
    suite = with_baseline(write_game(folder))
    list(regress(suite, suite.cases, baseline_of(suite), folder / "run", 1, Played()))


@pytest.fixture(name="game")
def _game(recorded: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    shutil.copytree(recorded, tmp_path / "game")
    monkeypatch.chdir(tmp_path / "game")
    return tmp_path / "game"
