"""The lines about an episode of a game without a clock count steps, and no seconds."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.runtime.gymnasium_games import games
from tltl_runtime.cli.support.episode_text import episode_line
from tltl_runtime.game.recording_summary import summary, summary_text
from tltl_runtime.gymnasium_games.gymnasium_game import GAME


def test_lines_count_steps_and_no_seconds(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    spec = games.SPEC.replace("clock 10 Hz\n", "").replace("20 s", "200 steps")
    games.write(tmp_path, corridor__tltl=spec, corridor__game__toml=games.GAME.replace('clock = "10 Hz"\n', ""))
    env = GAME.recorder(GAME.make_env("corridor.game.toml:short"), player="person")
    env.reset(seed=7)
    for _ in range(3):
        env.step(2)
    episode = env.episode
    env.close()
    line, cause = episode_line(episode, "not kept").splitlines()
    assert line.startswith("seed 7: stopped after 3 steps, progress ")
    assert cause.startswith("  stopped after 3 steps, remaining: ")
    lines = summary_text(summary(episode), GAME.figures(episode)).splitlines()
    assert "  end      stopped, pending, after 3 of 200 steps" in lines
    assert "    step  state  progress  what remains" in lines
    assert any(line.startswith("       0      0") for line in lines)
