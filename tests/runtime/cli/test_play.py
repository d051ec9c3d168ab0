"""``tltlc play`` as a process on a real X server, played with real key events."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
from collections.abc import Callable, Iterator
from pathlib import Path

import numpy as np
import pytest

from tests.interfaces.cli.conftest import Outcome, tltlc  # noqa: F401
from tests.runtime.cli.watched import Watched
from tests.runtime.stealth.xvfb import MISSING, keys, screen
from tests.waiting import HANG_S
from tltl_runtime.game.recording_check import check
from tltl_runtime.stealth.recordings.episode import Episode
from tltl_runtime.stealth.recordings.file import read_episode
from tltl_runtime.stealth.recordings.replay_check import resimulate

Run = Callable[..., Outcome]

needs_screen = pytest.mark.skipif(bool(MISSING), reason=f"not installed: {', '.join(MISSING)}")


@pytest.fixture(scope="module")
def display() -> Iterator[dict[str, str]]:
    with screen() as environment:
        yield environment


@pytest.fixture(autouse=True)
def _no_leftovers() -> Iterator[None]:
    yield
    while PLAYERS:
        PLAYERS.pop().kill()


PLAYERS: list[subprocess.Popen[str]] = []


def started(display: dict[str, str], folder: Path, *arguments: str) -> Watched:
    """Start a command; return it once its window is open and receives keys."""
    player = Watched(display, folder, *arguments)
    PLAYERS.append(player.process)
    return player


def ended(player: Watched, status: int = 0) -> str:
    out, err = player.process.communicate(timeout=HANG_S)
    assert player.process.returncode == status, err
    return out


def judged(path: Path) -> Episode:
    """Read a recorded episode and check that its judgement and its simulation can be reproduced."""
    episode = read_episode(path)
    assert episode.player == "keyboard"
    assert check(episode) == ()
    assert resimulate(episode) is None
    return episode


def displacement(episode: Episode) -> np.ndarray:
    return np.subtract(episode.snapshots[-1].player.position, episode.snapshots[0].player.position)


@needs_screen
def test_the_screen_does_not_start_anew_when_its_last_client_leaves(display: dict[str, str]) -> None:
    keys(display, "mousemove", "11", "12")
    command = ["xdotool", "getmouselocation"]
    place = subprocess.run(command, env=display, check=True, timeout=HANG_S, capture_output=True, text=True).stdout
    assert place.startswith("x:11 y:12 ")


@needs_screen
def test_keys_move_the_player_and_escape_records(display: dict[str, str], tmp_path: Path) -> None:
    player = started(display, tmp_path, "play", "branching", "--seed", "3", "-o", "mine.episode.npz")
    keys(display, "keydown", "d")
    player.until(lambda: any(step["x"] > 0.4 for step in player.steps()), "goes east")
    keys(display, "keyup", "d", "keydown", "Up", "keydown", "shift")
    player.until(lambda: any(step["y"] > 0.4 and step["stepped"][4] for step in player.steps()), "runs north")
    keys(display, "keyup", "Up", "keyup", "shift", "keydown", "c")
    player.until(lambda: sum(step["stepped"][3] for step in player.steps()) > 2, "crouches")
    keys(display, "keyup", "c", "key", "space")
    player.until(lambda: any(step["stepped"][2] for step in player.steps()), "jumps")
    keys(display, "key", "v")
    player.until(lambda: any(line.get("view") for line in player.log_lines()), "changes its view")
    keys(display, "key", "Escape")
    out = ended(player)
    assert "mine.episode.npz: stopped after" in out
    episode = judged(tmp_path / "mine.episode.npz")
    assert episode.end == "stopped" and not episode.success
    x, y, _ = displacement(episode)
    assert x > 0.3 and y > 0.3
    assert all(episode.actions[:, branch].any() for branch in range(5))
    assert any(snapshot.player.crouching for snapshot in episode.snapshots)
    # The pressed keys only moved the player towards greater x and y.
    assert episode.actions[:, :2].max() == 1


@needs_screen
def test_one_key_press_toggles_crouching(display: dict[str, str], tmp_path: Path) -> None:
    player = started(display, tmp_path, "play", "branching", "--crouch", "toggle", "-o", "runs")
    keys(display, "key", "c")
    player.until(lambda: sum(step["stepped"][3] for step in player.steps()) > 2, "crouches")
    keys(display, "key", "c")
    player.until(lambda: not player.steps()[-1]["stepped"][3], "stands up")
    player.process.send_signal(signal.SIGHUP)
    ended(player, 129)
    crouching = judged(tmp_path / "runs" / "branching-v0.episode.npz").actions[:, 3].tolist()
    assert crouching == sorted(crouching, reverse=True) and 0 < sum(crouching) < len(crouching)


@needs_screen
def test_restarting_and_ctrl_c_lose_no_episode(display: dict[str, str], tmp_path: Path) -> None:
    player = started(display, tmp_path, "play", "cover_and_hide", "--view", "top_down")
    keys(display, "keydown", "a")
    player.until(lambda: any(step["x"] < -0.3 for step in player.steps()), "goes west")
    keys(display, "keyup", "a")
    player.begin_again()
    keys(display, "keydown", "Right")
    player.until(lambda: any(step["x"] > 0.3 for step in player.steps()), "goes east")
    player.process.send_signal(signal.SIGINT)
    ended(player, 130)
    first, second = (judged(tmp_path / f"cover_and_hide-v0{number}.episode.npz") for number in ("", "-2"))
    assert displacement(first)[0] < -0.2 and displacement(second)[0] > 0.2
    assert first.seed != second.seed
    keys(display, "keyup", "Right")


@needs_screen
def test_a_finished_episode_is_recorded_once_and_sigterm_ends_the_game(display: dict[str, str], tmp_path: Path) -> None:
    spec = tmp_path / "soon.tltl"
    spec.write_text(
        "signal health: number in [0, 1]\npredicate alive in [-1, 1] = health\n"
        "spec soon { limit 4 steps require next next alive }\n",
        encoding="utf-8",
    )
    player = started(display, tmp_path, "play", "navigation", "--spec", "soon.tltl:soon")
    keys(display, "keydown", "w")
    path = tmp_path / "navigation-v0.episode.npz"
    player.until(path.exists, "records its episode")
    # The key is still held at the end screen, which does not step the game.
    player.until_it_looked(5)
    keys(display, "keyup", "w")
    assert list(tmp_path.glob("*.npz")) == [path]
    assert judged(path).end == "success"
    player.process.send_signal(signal.SIGTERM)
    out = ended(player, 143)
    assert out.count("success after") == 1


@pytest.mark.parametrize("driver", ["x11", None])
def test_without_a_screen_an_error_is_reported(tmp_path: Path, driver: str | None) -> None:
    without = ("DISPLAY", "WAYLAND_DISPLAY", "XDG_RUNTIME_DIR", "SDL_VIDEODRIVER")
    environment = {name: value for name, value in os.environ.items() if name not in without}
    if driver:
        environment["SDL_VIDEODRIVER"] = driver
    command = [sys.executable, "-m", "tltlc", "play", "navigation"]
    done = subprocess.run(command, env=environment, cwd=tmp_path, capture_output=True, text=True, timeout=HANG_S)
    assert done.returncode == 1
    assert done.stderr.startswith("error[TLT0830]: cannot open a window here")
    assert not list(tmp_path.iterdir())


def test_a_spec_that_the_level_cannot_supply_is_rejected(
    tltlc: Run,  # noqa: F811
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.chdir(tmp_path)
    Path("alien.tltl").write_text(
        "signal fuel: number in [0, 1]\npredicate full in [-1, 1] = fuel\nspec alien { keep full }\n", encoding="utf-8"
    )
    result = tltlc("play", "navigation", "--spec", "alien.tltl")
    assert result.status == 1
    assert "TLT0811" in result.err and "`fuel`" in result.err
