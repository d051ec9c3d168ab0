"""The trajectories of many episodes on the plan of a level."""

from __future__ import annotations

from io import BytesIO

import numpy as np
from PIL import Image

from tltl_runtime.game.episode import Trajectory
from tltl_runtime.stealth.env import make_env
from tltl_runtime.stealth.levels.file import load_level
from tltl_runtime.stealth.rendering.trajectories import draw_trajectories

RED, GREEN = (220, 38, 38), (22, 163, 74)


def test_trajectories_are_marked_where_they_end() -> None:
    level = load_level("cover_and_hide")
    env = make_env("cover_and_hide")
    fspa = env.task.fspa
    env.close()
    line = np.array([[5.0, 1.0], [5.0, 3.0], [12.0, 3.0]], dtype=np.float32)
    passed = Trajectory(line, np.array([0, 0, 4], dtype=np.int32), "success")
    failed = Trajectory(line, np.array([0, 1, 2], dtype=np.int32), "violation")

    def count(trajectories: list[Trajectory], colour: tuple[int, int, int]) -> int:
        drawn = draw_trajectories(level, fspa, trajectories, "some episodes")
        assert drawn == draw_trajectories(level, fspa, trajectories, "some episodes")
        with Image.open(BytesIO(drawn)) as picture:
            colours = picture.convert("RGB").getcolors(1 << 20)
            assert colours is not None
            return sum(pixels for pixels, pixel_colour in colours if pixel_colour == colour)

    unmarked = count([passed] * 3, RED)
    assert count([passed, failed, passed], RED) > unmarked + 40, "a mark at the end and one in the legend"
    shorter = Trajectory(line[:2], np.array([0, 4], dtype=np.int32), "success")
    assert count([passed, shorter], GREEN) > count([passed, passed], GREEN), "a mark where each succeeded"
