"""The head-up display, and the interpolation between two decisions."""

from __future__ import annotations

from math import pi
from typing import Any

import pytest

from tltl_runtime.game.episode import Cause
from tltl_runtime.game.hud import end_screen
from tltl_runtime.stealth.env import make_env
from tltl_runtime.stealth.levels.file import load_level
from tltl_runtime.stealth.rendering.hud import hud, start_screen
from tltl_runtime.stealth.rendering.interpolation import interpolate
from tltl_runtime.stealth.simulation import Simulation
from tltlc import compile_text
from tltlc.automaton.text import label_text
from tltlc.core.record import replace


@pytest.fixture(scope="module")
def game_display() -> Any:
    env = make_env("cover_and_hide")
    _, info = env.reset(seed=1)
    yield env, env.unwrapped.game.snapshot(), info  # type: ignore[attr-defined]
    env.close()


def test_the_display_shows_the_state_of_the_game(game_display: Any) -> None:
    env, snapshot, info = game_display
    display = hud(snapshot, info, env.task.fspa)
    assert [(bar.name, bar.value) for bar in display.bars] == [("health", 1.0), ("stamina", 1.0), ("progress", 0.0)]
    texts = [line.text for line in display.lines]
    assert texts[:2] == ["0.0 s, 60 s left   pending", "nobody sees you"]
    endless = replace(env.task.fspa, limit_steps=None)
    assert hud(snapshot, info, endless).lines[0].text == "0.0 s   pending"
    assert " ".join(texts[2:]) == label_text(env.task.fspa, 0)
    assert max(map(len, texts)) <= 36


@pytest.mark.parametrize(
    "modes, sees, text",
    [
        (("patrol",), (True,), "you are in sight"),
        (("chase",), (False,), "you are chased"),
        (("search",), (False,), "they search for you"),
        (("return",), (False,), "nobody sees you"),
    ],
)
def test_the_display_shows_who_sees_the_player(
    game_display: Any, modes: tuple[str, ...], sees: tuple[bool, ...], text: str
) -> None:
    env, snapshot, info = game_display
    display = hud(replace(snapshot, modes=modes, sees=sees), info, env.task.fspa)
    assert display.lines[1].text == text


def test_a_long_formula_is_cut(game_display: Any) -> None:
    _, snapshot, info = game_display
    names = [f"seen_by_{number}" for number in range(40)]
    text = "".join(f"signal {name}: bool\n" for name in names)
    (fspa,) = compile_text(f"{text}spec long {{ keep {' & '.join(names)} }}")
    display = hud(snapshot, info, fspa)
    assert len(display.lines) == 12 and display.lines[-1].text.endswith(" …")


def test_the_first_screen_shows_the_goal_and_the_last_one_the_cause(game_display: Any) -> None:
    env, snapshot, info = game_display
    display = hud(snapshot, info, env.task.fspa)
    first = start_screen(display, env.unwrapped.level, env.task.fspa)
    assert first.title == "cover_and_hide v0" and any("Press the button" in line for line in first.below)
    text = "killed by `guard` at 3.00 s at (1.0, 2.0)"
    last = end_screen(display, Cause("killed", ("guard",), 3.0, (1.0, 2.0, 0.0), text), "a.episode.npz")
    assert (last.title, last.tone) == ("you died", "bad")
    assert last.below[:2] == (text, "recorded: a.episode.npz")


def test_snapshots_are_interpolated_between_decisions() -> None:
    game = Simulation(load_level("branching"))
    before = game.snapshot()
    for _ in range(4):
        game.step([1, 0, 0, 0, 0])
    after = game.snapshot()
    assert interpolate(before, after, 1.0) == after
    start = interpolate(before, after, 0.0)
    assert start.player.position == before.player.position and start.movers == before.movers
    middle = interpolate(before, after, 0.5)
    assert middle.player.position[0] == pytest.approx((before.player.position[0] + after.player.position[0]) / 2)
    assert middle.time == pytest.approx(0.3) and middle.health == after.health
    game.close()


def test_yaw_is_interpolated_along_the_shorter_turn() -> None:
    game = Simulation(load_level("branching"))
    snapshot = game.snapshot()
    game.close()
    turned = [replace(snapshot, player=replace(snapshot.player, yaw=yaw)) for yaw in (3.0, -3.0)]
    assert abs(interpolate(*turned, 0.5).player.yaw) == pytest.approx(pi)
