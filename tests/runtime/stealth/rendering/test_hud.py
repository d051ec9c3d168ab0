"""The head-up display, and the interpolation between two decisions."""

from __future__ import annotations

from math import pi
from typing import Any

import pytest

from tltl_runtime.game.episode import Cause
from tltl_runtime.stealth.env import make_env
from tltl_runtime.stealth.game import Game
from tltl_runtime.stealth.levels.file import load_level
from tltl_runtime.stealth.rendering.hud import beginning, ending, hud
from tltl_runtime.stealth.rendering.interpolation import between
from tltlc import compile_text
from tltlc.automaton.text import label_text
from tltlc.core.record import replace


@pytest.fixture(scope="module")
def played() -> Any:
    env = make_env("cover_and_hide")
    _, info = env.reset(seed=1)
    yield env, env.unwrapped.game.snapshot(), info  # type: ignore[attr-defined]
    env.close()


def test_the_display_shows_the_state_of_the_game(played: Any) -> None:
    env, snapshot, info = played
    shown = hud(snapshot, info, env.task.fspa)
    assert [(bar.name, bar.value) for bar in shown.bars] == [("health", 1.0), ("stamina", 1.0), ("progress", 0.0)]
    texts = [line.text for line in shown.lines]
    assert texts[:2] == ["0.0 s, 60 s left   pending", "nobody sees you"]
    endless = replace(env.task.fspa, limit_steps=None)
    assert hud(snapshot, info, endless).lines[0].text == "0.0 s   pending"
    assert " ".join(texts[2:]) == label_text(env.task.fspa, 0)
    assert max(map(len, texts)) <= 36


@pytest.mark.parametrize(
    "modes, sees, said",
    [
        (("patrol",), (True,), "you are in sight"),
        (("chase",), (False,), "you are chased"),
        (("search",), (False,), "they search for you"),
        (("return",), (False,), "nobody sees you"),
    ],
)
def test_the_display_shows_who_sees_the_player(
    played: Any, modes: tuple[str, ...], sees: tuple[bool, ...], said: str
) -> None:
    env, snapshot, info = played
    shown = hud(replace(snapshot, modes=modes, sees=sees), info, env.task.fspa)
    assert shown.lines[1].text == said


def test_a_long_formula_is_cut(played: Any) -> None:
    _, snapshot, info = played
    names = [f"seen_by_{number}" for number in range(40)]
    text = "".join(f"signal {name}: bool\n" for name in names)
    (fspa,) = compile_text(f"{text}spec long {{ keep {' & '.join(names)} }}")
    shown = hud(snapshot, info, fspa)
    assert len(shown.lines) == 12 and shown.lines[-1].text.endswith(" …")


def test_the_first_and_the_last_screen(played: Any) -> None:
    env, snapshot, info = played
    shown = hud(snapshot, info, env.task.fspa)
    first = beginning(shown, env.unwrapped.level, env.task.fspa)
    assert first.title == "cover_and_hide v0" and any("Press the button" in line for line in first.below)
    text = "killed by `guard` at 3.00 s at (1.0, 2.0)"
    last = ending(shown, Cause("killed", ("guard",), 3.0, (1.0, 2.0, 0.0), text), "a.episode.npz")
    assert (last.title, last.tone) == ("you died", "bad")
    assert last.below[:2] == (text, "recorded: a.episode.npz")


def test_snapshots_are_interpolated_between_decisions() -> None:
    game = Game(load_level("branching"))
    before = game.snapshot()
    for _ in range(4):
        game.step([1, 0, 0, 0, 0])
    after = game.snapshot()
    assert between(before, after, 1.0) == after
    start = between(before, after, 0.0)
    assert start.player.position == before.player.position and start.movers == before.movers
    middle = between(before, after, 0.5)
    assert middle.player.position[0] == pytest.approx((before.player.position[0] + after.player.position[0]) / 2)
    assert middle.time == pytest.approx(0.3) and middle.health == after.health
    game.close()


def test_yaw_is_interpolated_along_the_shorter_turn() -> None:
    game = Game(load_level("branching"))
    snapshot = game.snapshot()
    game.close()
    turned = [replace(snapshot, player=replace(snapshot.player, yaw=yaw)) for yaw in (3.0, -3.0)]
    assert abs(between(*turned, 0.5).player.yaw) == pytest.approx(pi)
