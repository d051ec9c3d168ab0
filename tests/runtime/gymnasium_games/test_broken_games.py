"""`tltlc check --game` on games that are lost, stand still, or are slow: it goes on, and says what it found."""

from __future__ import annotations

import json
import shutil
import sys
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest

from tests.interfaces.cli.conftest import Outcome, tltlc  # noqa: F401
from tests.runtime.gymnasium_games.test_games_in_processes import write
from tests.runtime.gymnasium_games.test_lost_episodes import GAMES, mortal
from tests.runtime.wire.processes import no_game_is_left
from tltl_runtime.gymnasium_games.speed_advice import speed_advice
from tltl_runtime.wire.clients import tltl_client
from tltl_runtime.wire.wire_game import WireGame

Run = Callable[..., Outcome]
GODOT_CLIENT = Path(tltl_client.__file__).with_name("tltl_client_godot3.gd")


@pytest.fixture(autouse=True)
def _no_process_is_left() -> Iterator[None]:
    with no_game_is_left():
        yield


@pytest.fixture(name="folder")
def _folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    folder = tmp_path / "game"
    folder.mkdir()
    monkeypatch.chdir(folder)
    return folder


# --- lost games


def test_the_check_goes_on_after_a_lost_game(tltlc: Run, folder: Path) -> None:  # noqa: F811
    # Of the first play, the first step is lost. The other plays are whole.
    mortal(folder, "exit", 1)
    result = tltlc("check", "--game", "counter.game.toml:short:v0")
    assert result.status == 1
    title = "ended with exit status 3 instead of answering `step`, in step 1 of a play of `short:v0`"
    assert f"error[TLT0791]: the game `counter.game.toml` {title}" in result.err
    assert result.err.count("error[") == 1 and "now: exit" in result.err
    assert "short:v0 has the signals that `count` uses\n  signals: position, moves, at_goal\n" in result.err
    assert "equal seeds and actions give equal plays: unknown, because the game was lost" in result.err
    assert "a restored snapshot is what was saved: yes" in result.err


def test_a_loss_at_the_same_step_of_both_plays_is_said_once(tltlc: Run, folder: Path) -> None:  # noqa: F811
    mortal(folder, "exit", 1, 2)
    result = tltlc("check", "--game", "counter.game.toml:short:v0")
    assert result.status == 1 and result.err.count("error[") == 1


def test_a_game_that_is_lost_while_it_restores_is_reported_beside_the_rest(tltlc: Run, folder: Path) -> None:  # noqa: F811
    mortal(folder, "restore")
    result = tltlc("check", "--game", "counter.game.toml:short:v0", "--format", "json")
    document = json.loads(result.out)
    (diagnostic,) = document["diagnostics"]
    assert diagnostic["code"] == "TLT0791" and "instead of answering `restore`" in diagnostic["title"]
    (scene,) = document["scenes"]
    assert (scene["reproducible"], scene["restores"]) == (True, None)


def test_a_game_that_ends_by_an_error_in_a_script_has_not_gone_on(tltlc: Run, folder: Path) -> None:  # noqa: F811
    (folder / "dies.py").write_text(
        f"import os, sys\nsys.path.insert(0, {str(GAMES)!r})\n"
        "from counter import Counter, tltl_client\n\n\n"
        "class Dying(Counter):\n"
        "    def snapshot(self):\n"
        "        print('SCRIPT ERROR: snapshot: Invalid call.', file=sys.stderr, flush=True)\n"
        "        os._exit(3)\n\n\n"
        "tltl_client.play(Dying())\n"
    )
    write(folder, sys.executable, "dies.py")
    result = tltlc("check", "--game", "counter.game.toml:short:v0")
    assert result.status == 1
    assert "error[TLT0791]: " in result.err and "instead of answering `snapshot`" in result.err
    assert "SCRIPT ERROR: snapshot: Invalid call." in result.err
    assert "TLT0787" not in result.err


def test_a_game_that_is_lost_in_each_reset_is_an_error_alone(tltlc: Run, folder: Path) -> None:  # noqa: F811
    mortal(folder, "reset", "all")
    result = tltlc("check", "--game", "counter.game.toml:short:v0")
    assert result.status == 1
    assert "reports: no such map, in the reset of a play of `short:v0`" in result.err
    assert result.err.count("error[") == 1 and "signals:" not in result.err


# --- games that stand still


@pytest.mark.skipif(shutil.which("godot3-server") is None, reason="needs the program godot3-server")
def test_a_script_of_godot_that_fails_in_each_tick_is_noticed(tltlc: Run, folder: Path) -> None:  # noqa: F811
    project = shutil.copytree(GAMES / "godot3", folder / "project")
    shutil.copy(GODOT_CLIENT, project)
    script = project / "counter.gd"
    body = "func move(action: int) -> void:\n"
    text = script.read_text(encoding="utf-8").replace(body, f"{body}\tvar door = null\n\tdoor.open()\n")
    script.write_text(text, encoding="utf-8")
    write(folder, "godot3-server", "--path", "project", "--fixed-fps", "10", "--disable-render-loop")
    result = tltlc("check", "--game", "counter.game.toml:short:v0")
    assert result.status == 0
    error = "SCRIPT ERROR: move: Invalid call. Nonexistent function 'open' in base 'Nil'."
    assert f"warning[TLT0787]: `short:v0` went on after an error in a script of the game: {error}" in result.err
    assert "At: res://counter.gd:" in result.err
    assert "warning[TLT0786]: none of the 3 signals changed in 200 random steps in `short:v0`" in result.err
    assert f"  the game's standard error ends:\n    {error}\n       At: res://counter.gd:" in result.err


def test_what_a_sound_game_writes_is_shown(tltlc: Run, folder: Path) -> None:  # noqa: F811
    (folder / "talks.py").write_text(
        f"import sys\nsys.path.insert(0, {str(GAMES)!r})\n"
        "from counter import Counter, tltl_client\n"
        "print('loading the map', file=sys.stderr, flush=True)\n"
        "tltl_client.play(Counter())\n"
    )
    write(folder, sys.executable, "talks.py")
    result = tltlc("check", "--game", "counter.game.toml:short:v0")
    assert result.status == 0 and "warning[" not in result.err
    assert "  the game's standard error ends:\n    loading the map\n" in result.err


# --- slow games


def wire(*words: str, connect: str = "") -> WireGame:
    return WireGame("hall", Path(), words, connect)


GODOT = ("godot3-server", "--path", "project")
ENGINE = ("./hall.x86_64", "-batchmode")


@pytest.mark.parametrize(
    ("game", "steps_per_s", "clock_s", "advice"),
    [
        (wire(*GODOT), 200.0, 1 / 60, ""),
        (
            wire(*GODOT),
            60.0,
            1 / 60,
            "4.6 hours in one game; Godot waits for the wall's clock: add `--fixed-fps N --disable-render-loop` to "
            "`process`, where N is the project's physics frames a second",
        ),
        (
            wire(*GODOT, "--fixed-fps", "60"),
            60.0,
            None,
            "Godot waits for the wall's clock: add `--disable-render-loop` to `process`",
        ),
        (
            wire(*ENGINE),
            59.0,
            1 / 60,
            "it seems to wait for the wall's: let each step be played at once",
        ),
        (
            wire(*ENGINE),
            20.0,
            1 / 60,
            "13.9 hours in one game; play without a window, sound and vsync, let an action last several ticks, and let "
            "`train` play more games at once (`envs` and `workers` under `[rollout]`)",
        ),
        (wire(connect="127.0.0.1:5000"), 20.0, None, "let an action last several ticks"),
        (None, 2.0, 0.1, "6 days in one game; let a step of the environment be several ticks of the game"),
    ],
)
def test_a_slow_game_gets_advice(game: WireGame | None, steps_per_s: float, clock_s: float | None, advice: str) -> None:
    text = speed_advice(game, steps_per_s, clock_s)
    assert text.startswith("1,000,000 steps of a training take ") == bool(advice) and advice in text
    assert bool(text) == bool(advice)
