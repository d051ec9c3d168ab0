"""Rendering through Gymnasium: pictures, a window, and invalid options."""

from __future__ import annotations

import resource
import subprocess
import sys
from pathlib import Path

import gymnasium
import numpy as np
import pytest
from gymnasium.utils.env_checker import check_env
from PIL import Image

import tltl_runtime  # noqa: F401  (registers the environments)
from tests.runtime.stealth.xvfb import MISSING, screen
from tests.waiting import HANG_S
from tltl_runtime.stealth.env import GameEnv, make_env
from tltl_runtime.stealth.levels.file import load_level
from tltl_runtime.stealth.simulation import Simulation
from tltl_runtime.stealth.window.screen import Screen

NAMES = ("tltl/Navigation-v0", "tltl/CoverAndHide-v0", "tltl/Branching-v0")
SMALL = (96, 64)


@pytest.mark.parametrize("name", NAMES)
def test_gymnasium_returns_pictures_of_the_requested_size(name: str) -> None:
    env = gymnasium.make(name, render_mode="rgb_array", render_view="top_down", render_size=SMALL)
    assert env.metadata["render_modes"] == ["human", "rgb_array"] and env.metadata["render_fps"] == 7
    env.reset(seed=1)
    before = env.render()
    assert isinstance(before, np.ndarray) and before.shape == (64, 96, 3) and before.dtype == np.uint8
    for _ in range(8):
        env.step(np.array([1, 2, 0, 0, 0]))
    after = env.render()
    assert isinstance(after, np.ndarray) and (after != before).any()
    env.close()


@pytest.mark.parametrize("size", [(-1, 5), (0, 0), (100_000, 100_000), 64, (10,), (64.0, 48.0), (64, 15), None])
def test_invalid_sizes_are_rejected_at_once(size: object) -> None:
    with pytest.raises(ValueError, match=r"\(width, height\) in pixels, each from 16 to 4096, not "):
        GameEnv("branching", render_mode="rgb_array", render_size=size)  # type: ignore[arg-type]


@pytest.mark.skipif(not sys.platform.startswith("linux"), reason="reads what Linux says of memory")
def test_closing_a_screen_frees_its_memory() -> None:
    def used_mb() -> float:
        """Return the resident memory of this process in MB."""
        return int(Path("/proc/self/statm").read_text(encoding="utf-8").split()[1]) * resource.getpagesize() / 1e6

    def render_once() -> None:
        screen = Screen(level, "rgb_array", "third_person", SMALL)
        screen.render(snapshot)
        screen.close()

    game = Simulation(load_level("branching"))
    level, snapshot = game.level, game.snapshot()
    game.close()
    for _ in range(3):
        render_once()
    before = used_mb()
    for _ in range(12):
        render_once()
    assert used_mb() - before < 4.0  # it is 15 or more if each screen keeps its meshes


def test_a_list_of_pictures_has_one_for_the_reset_and_each_step() -> None:
    env = gymnasium.make("tltl/Branching-v0", render_mode="rgb_array_list", render_size=SMALL)
    env.reset(seed=1)
    for _ in range(3):
        env.step(env.action_space.sample())
    frames = env.render()
    assert isinstance(frames, list) and len(frames) == 4
    env.close()


def test_an_episode_is_the_same_with_pictures() -> None:
    observations = []
    for mode in (None, "rgb_array"):
        env = make_env("cover_and_hide", render_mode=mode, render_size=SMALL)
        env.reset(seed=5)
        for _ in range(10):
            observation, *_ = env.step([1, 1, 0, 0, 1])
            if mode:
                env.render()
        observations.append(observation)
        env.close()
    assert all(np.array_equal(observations[0][key], observations[1][key]) for key in observations[0])


def test_unknown_modes_and_views_are_rejected() -> None:
    with pytest.raises(ValueError, match=r"no render mode 'ansi': there are human, rgb_array"):
        GameEnv("navigation", render_mode="ansi")
    with pytest.raises(ValueError, match=r"no view 'side': there are third_person, top_down, overview"):
        GameEnv("navigation", render_view="side")  # type: ignore[arg-type]


def test_without_a_render_mode_there_is_no_picture() -> None:
    env = GameEnv("navigation")
    env.reset(seed=0)
    with pytest.warns(UserWarning, match="render_mode='rgb_array'"):
        assert env.render() is None
    env.close()


CHECK = """
import gymnasium, tltl_runtime, warnings
from gymnasium.utils.env_checker import check_env
from PIL import Image
env = gymnasium.make("tltl/CoverAndHide-v0", render_mode="human", render_size=(96, 64))
with warnings.catch_warnings(record=True) as caught:
    check_env(env.unwrapped, skip_render_check=False)
assert not [warning for warning in caught if "TLT0830" in str(warning.message)]
env.close()
print("checked")
"""


@pytest.mark.slow
@pytest.mark.skipif(bool(MISSING), reason=f"not installed: {', '.join(MISSING)}")
def test_the_checks_of_gymnasium_pass_with_a_screen(tmp_path: Path) -> None:
    with screen() as environment:
        command = [sys.executable, "-c", CHECK]
        done = subprocess.run(command, env=environment, cwd=tmp_path, capture_output=True, text=True, timeout=HANG_S)
        assert done.stdout.endswith("checked\n"), done.stderr


@pytest.mark.parametrize("name", NAMES)
def test_the_checks_of_gymnasium_pass_without_a_screen(name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    """The checks try all render modes, so the mode with a window must not fail without a screen."""
    monkeypatch.delenv("DISPLAY", raising=False)
    monkeypatch.setenv("SDL_VIDEODRIVER", "x11")
    env = gymnasium.make(name, render_mode="rgb_array", render_size=SMALL)
    with pytest.warns(UserWarning, match="TLT0830: cannot open a window here"):
        check_env(env.unwrapped, skip_render_check=False)
    env.close()


@pytest.mark.slow
def test_the_pictures_of_the_readme_are_up_to_date(tmp_path: Path) -> None:
    images = Path(__file__).parents[4] / "docs" / "images"
    subprocess.run([sys.executable, images / "frames.py", tmp_path], check=True, timeout=HANG_S, capture_output=True)
    new_paths = sorted(tmp_path.iterdir())
    assert [path.name for path in new_paths] == ["branching.png", "cover_and_hide.png", "navigation.png"]
    for path in new_paths:
        committed = images / path.name
        assert committed.stat().st_size < 150_000
        pictures = [np.asarray(Image.open(picture_path).convert("RGB"), float) for picture_path in (path, committed)]
        # Another processor may round differently.
        assert np.abs(pictures[0] - pictures[1]).mean() < 1.0, f"{path.name} is old: make generate"
