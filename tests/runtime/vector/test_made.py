"""While the environments of a vector environment are made, it says how many there are."""

from __future__ import annotations

from contextlib import closing
from functools import partial
from pathlib import Path
from typing import Any

import gymnasium
import pytest
from gymnasium import spaces
from rich.console import Console

from tests.runtime.training.runs import run_in
from tests.waiting import HANG_S, until
from tltl_runtime.cli.support.training_display import _LineDisplay
from tltl_runtime.cli.support.training_picture import TrainingDisplay
from tltl_runtime.vector import WorkerVectorEnv


class Still(gymnasium.Env[int, int]):
    """An environment in which nothing happens; it can be made only after ``awaited`` exists."""

    def __init__(self, awaited: Path | None = None) -> None:
        self.observation_space, self.action_space = spaces.Discrete(2), spaces.Discrete(2)
        if awaited:
            until(awaited.exists, f"`{awaited}`")

    def reset(self, **_: Any) -> tuple[int, dict[str, Any]]:
        return 0, {}


def test_the_number_of_environments_that_are_made_is_told(tmp_path: Path) -> None:
    counts: list[int] = []

    def count(made: int) -> None:
        counts.append(made)
        # The last environments wait until somebody has heard of the first ones.
        (tmp_path / "told").touch()

    functions = [Still, Still, partial(Still, tmp_path / "told"), partial(Still, tmp_path / "told")]
    with closing(WorkerVectorEnv(functions, 1, timeout=HANG_S, on_made=count)) as env:
        assert env.num_envs == 4
    assert counts[0] in (1, 2) and counts == sorted(set(counts))


def test_a_display_says_how_many_environments_have_started(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    run = run_in(tmp_path / "run")
    lines = _LineDisplay(run, "AGAIN")
    lines.show_made(3)
    assert capsys.readouterr().err == "3 of 4 environments started\n"
    console = Console(record=True, width=90, height=24)
    picture = TrainingDisplay(run, console)
    picture.show_made(3)
    console.print(picture.picture())
    assert "3 of 4 environments started" in console.export_text()
