"""Trainings with a game that is running already, which plays for one environment at a time."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest

from tests.interfaces.cli.conftest import Outcome, tltlc  # noqa: F401
from tests.runtime.gymnasium_games.test_games_in_processes import SPEC
from tests.runtime.wire.test_env import connected, free_port
from tltlc.api import fileio

Run = Callable[..., Outcome]
FICKLE = Path(__file__).parents[1] / "wire" / "games" / "fickle.py"
SETTINGS = """\
stop = { windows = 2, episodes = 4, confirmation = 3, steps = 64 }
rollout = { steps = 8, workers = 1, envs = %d }
ppo.minibatches = 1
network.hidden = [8]
exploration.ways = 1
"""
BARRED = 11
"""The first episode of the first confirmation, after one to examine the game, and eight and a begun one of training."""


@pytest.fixture(name="folder")
def _folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Path]:
    """A folder with the file of a game that is running."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.delenv("TLTL_TOKEN", raising=False)
    port = free_port()
    (tmp_path / "counter.tltl").write_text(SPEC)
    scene = '[[scene]]\nname = "short"\nspec = "counter.tltl:count"\n'
    (tmp_path / "counter.game.toml").write_text(f'[game]\nconnect = "127.0.0.1:{port}"\n\n{scene}')
    with subprocess.Popen([sys.executable, str(FICKLE), str(port), str(BARRED)], env=dict(os.environ)) as process:
        try:
            connected(port).close()
            yield tmp_path
        finally:
            process.kill()


def train(tltlc: Run, folder: Path, envs: int) -> Outcome:  # noqa: F811
    (folder / "settings.toml").write_text(SETTINGS % envs)
    return tltlc("train", "--game", "counter.game.toml:short", "--config", "settings.toml", "-o", "run")


def test_a_running_game_refuses_to_play_for_several_environments(tltlc: Run, folder: Path) -> None:  # noqa: F811
    result = train(tltlc, folder, envs=2)
    assert result.status == 1
    title = "the game of `counter.game.toml:short` plays for one environment at a time, and the training has 2"
    assert f"error[TLT0862]: {title}" in result.err
    assert "set `envs = 1` under `[rollout]`, or write `process` in place of `connect`" in result.err
    assert not fileio.exists(folder / "run" / "run.json")


@pytest.mark.parametrize("envs", [1, 2])
def test_nothing_connects_to_a_running_game_that_cannot_be_trained_in(
    tltlc: Run,  # noqa: F811
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    envs: int,
) -> None:
    monkeypatch.chdir(tmp_path)
    (tmp_path / "counter.tltl").write_text(SPEC)
    scene = '[[scene]]\nname = "short"\nspec = "counter.tltl:count"\n'
    # No game listens there: a connection would be another error.
    (tmp_path / "counter.game.toml").write_text(f'[game]\nconnect = "127.0.0.1:{free_port()}"\n\n{scene}')
    if envs == 1:
        for name, value in {"RANK": 0, "WORLD_SIZE": 2, "LOCAL_RANK": 0, "LOCAL_WORLD_SIZE": 2}.items():
            monkeypatch.setenv(name, str(value))
    result = train(tltlc, tmp_path, envs)
    assert result.status == 1
    reason = "the training has 2" if envs == 2 else "torchrun has started 2 processes, each with its own"
    title = "the game of `counter.game.toml:short` plays for one environment at a time, and"
    assert f"error[TLT0862]: {title} {reason}\n" in result.err
    assert not fileio.exists(tmp_path / "run" / "run.json")


def test_a_policy_is_confirmed_in_the_running_game_in_which_it_was_trained(
    tltlc: Run,  # noqa: F811
    folder: Path,
) -> None:
    result = train(tltlc, folder, envs=1)
    assert result.status == 0, result.err
    lines = [json.loads(line) for line in (folder / "run" / "metrics.jsonl").read_text().splitlines()]
    # The first confirmation fails, and the training goes on.
    assert [line["steps"] for line in lines] == [8, 16]
