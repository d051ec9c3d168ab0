"""Games that speak the protocol of Godot RL Agents: as environments, in game files, and with faults."""

from __future__ import annotations

import json
import os
import socket
import subprocess
import sys
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from gymnasium import spaces

from tests.interfaces.cli.conftest import Outcome, tltlc  # noqa: F401
from tests.runtime.wire.test_faults import GAMES, no_new_children
from tests.waiting import HANG_S
from tltl_runtime.gymnasium_games.game_file import read_game_file
from tltl_runtime.gymnasium_games.scene_env import make_base_env
from tltl_runtime.gymnasium_games.scene_hash import scene_hash
from tltl_runtime.wire.env import WireEnv
from tltl_runtime.wire.errors import WireError
from tltl_runtime.wire.wire_game import GODOT_RL, WireGame
from tltlc.api import TltlError

Run = Callable[..., Outcome]
PLAYER = GAMES / "godot_rl_player.py"
GAME_FILE = """\
[game]
process = {process}
protocol = "godot-rl"
signals = "row_signals:signals"
clock = "10 Hz"

[[scene]]
name = "row"
spec = "row.tltl:arrive"
variants = {{ long = {{ options = {{ length = 7 }} }} }}
"""
SIGNALS = """\
def signals(observation):
    return {"place": observation["obs"][0], "in_view": bool(observation["camera_2d"][0, 1, 0] == 255)}
"""
SPEC = """\
clock 10 Hz
signal place in [0, 10]
signal in_view: bool
spec arrive { reach place >= 5 limit 40 steps }
"""


def player(*words: str, start_s: float = HANG_S, step_s: float = HANG_S) -> WireGame:
    command = (sys.executable, PLAYER.name, *words)
    return WireGame("row", GAMES, command, start_s=start_s, step_s=step_s, protocol=GODOT_RL)


def action(move: int) -> dict[str, Any]:
    return {"move": move, "push": np.zeros(2, np.float32)}


@pytest.fixture(name="env")
def _env() -> Iterator[WireEnv]:
    env = WireEnv(player("--env_seed=0"))
    yield env
    env.close()


def test_the_spaces_are_those_of_the_only_agent(env: WireEnv) -> None:
    assert env.action_space == spaces.Dict({"move": spaces.Discrete(3), "push": spaces.Box(-1, 1, (2,))})
    picture = spaces.Box(0, 255, (1, 2, 3), np.uint8)
    box = spaces.Box(-np.inf, np.inf, (2,))
    assert env.observation_space == spaces.Dict({"obs": box, "camera_2d": picture, "level": spaces.Discrete(4)})
    old = WireEnv(player("--old"))
    assert (old.action_space, old.observation_space) == (env.action_space, env.observation_space)
    old.close()


def test_an_episode_is_played_to_its_end(env: WireEnv) -> None:
    observation, _ = env.reset(seed=3)
    assert env.observation_space.contains(observation)
    assert observation["obs"].tolist() == [1, 0]
    assert observation["camera_2d"].tolist() == [[[1, 0, 0], [255, 0, 0]]]
    ends = [env.step(action(2))[2] for _ in range(4)]
    assert ends == [False, False, False, True]
    assert env.observation["obs"].tolist() == [5, 4]
    env.reset()
    assert env.observation["obs"].tolist() == [1, 0]


def test_a_step_may_be_several_actions() -> None:
    env = WireEnv(player("--env_seed=0"), repeat=3)
    env.reset()
    observation, _, ended, _, _ = env.step(action(2))
    assert (observation["obs"].tolist(), ended) == ([4, 3], False)
    observation, _, ended, _, _ = env.step(action(2))
    assert (observation["obs"].tolist(), ended) == ([5, 4], True)
    env.close()


def test_games_that_start_at_once_have_different_seeds() -> None:
    places = set()
    for _ in range(30):
        env = WireEnv(player())
        places.add(float(env.reset()[0]["obs"][0]))
        env.close()
        if len(places) == 2:
            break
    assert places == {1.0, 2.0}


def free_place(host: str) -> tuple[int, str]:
    """Return a free port of a host, and ``HOST:PORT``; skip the test if the machine has no IPv6."""
    try:
        server = socket.create_server((host, 0), family=socket.AF_INET6 if ":" in host else socket.AF_INET)
    except OSError:
        pytest.skip("needs IPv6")
    with server:
        port: int = server.getsockname()[1]
    return port, f"[{host}]:{port}" if ":" in host else f"{host}:{port}"


@pytest.mark.parametrize("host", ["127.0.0.1", "::1"])
def test_a_game_that_is_started_by_hand_connects(host: str) -> None:
    port, place = free_place(host)
    game = WireGame("row", GAMES, connect=place, start_s=HANG_S, protocol=GODOT_RL)
    words = [sys.executable, str(PLAYER), f"--port={port}", f"--host={host}"]
    code = f"import socket, subprocess, time\nwhile subprocess.run({words!r}, stderr=-3).returncode: time.sleep(0.05)"
    with subprocess.Popen([sys.executable, "-c", code]) as starter:
        try:
            env = WireEnv(game)
            assert float(env.reset()[0]["level"]) == 2
            env.close()
            assert starter.wait(HANG_S) == 0
        finally:
            starter.kill()


@pytest.mark.parametrize(
    ("words", "code", "message", "help_"),
    [
        (["--fault=early"], "TLT0790", "ended with exit status 1 before it answered `env_info`", "there is no display"),
        (["--agents=4"], "TLT0792", "has 4 agents, but tltlc plays games with one", ""),
        (["--fault=text"], "TLT0792", "sent a line that is not JSON: `<html>`", ""),
    ],
)
def test_a_game_that_cannot_be_played_is_refused(words: list[str], code: str, message: str, help_: str) -> None:
    with no_new_children(), pytest.raises(WireError) as error:
        WireEnv(player(*words))
    (diagnostic,) = error.value.diagnostics
    assert diagnostic.code == code
    assert message in diagnostic.title
    assert help_ in (diagnostic.help or "")


def test_a_game_that_does_not_connect_is_ended() -> None:
    with no_new_children(), pytest.raises(WireError, match=r"did not connect and answer `env_info` within 0\.2 s"):
        WireEnv(player("--fault=silent", start_s=0.2))


def test_a_lost_game_costs_an_episode() -> None:
    with no_new_children():
        env = WireEnv(player("--fault=exit"))
        env.reset()
        with pytest.raises(WireError, match="TLT0791") as error:
            env.step(action(1))
        assert "the hero fell out of the world" in (error.value.diagnostics[0].help or "")
        env.reset()
        env.close()


def test_a_picture_that_is_no_picture_is_refused() -> None:
    env = WireEnv(player("--fault=hex"))
    with pytest.raises(WireError, match=r"sent `reset.obs\[0\].camera_2d` as \"zz\", but it must be a text of hexa"):
        env.reset()


@pytest.fixture(name="game")
def _game(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tmp_path)
    (tmp_path / "row_signals.py").write_text(SIGNALS)
    (tmp_path / "row.tltl").write_text(SPEC)
    path = tmp_path / "row.game.toml"
    path.write_text(GAME_FILE.format(process=json.dumps([sys.executable, str(PLAYER), "--env_seed=0"])))
    return path


@pytest.mark.usefixtures("game")
def test_a_game_file_needs_only_a_function_of_the_observation(tltlc: Run) -> None:  # noqa: F811
    result = tltlc("check", "--game", "row.game.toml")
    assert result.status == 0, result.err
    assert "row:long has the signals that `arrive` uses" in result.err
    assert "signals: place, in_view" in result.err
    assert "equal seeds and actions give equal plays: yes" in result.err


def test_the_options_of_a_scene_are_arguments_of_the_game(game: Path) -> None:
    env = make_base_env(read_game_file(game), "row", "long")
    env.reset()
    ended = [env.step(action(2))[2] for _ in range(6)]
    assert ended == [False] * 5 + [True]
    env.close()


def test_a_game_file_without_signals_is_refused(game: Path) -> None:
    game.write_text(game.read_text().replace('signals = "row_signals:signals"\n', ""))
    with pytest.raises(TltlError, match="TLT0803: a game that speaks `godot-rl` does not say its signals"):
        read_game_file(game)


def test_the_hash_notices_the_protocol(game: Path) -> None:
    before = scene_hash(read_game_file(game), "row")
    game.write_text(game.read_text().replace("godot-rl", "tltl"))
    assert scene_hash(read_game_file(game), "row") != before


@pytest.mark.slow
@pytest.mark.skipif(os.name == "nt", reason="the player is started by a shell")
@pytest.mark.usefixtures("game")
def test_a_training_and_a_suite_run(tltlc: Run) -> None:  # noqa: F811
    Path("few.toml").write_text(
        "[rollout]\nenvs = 2\nsteps = 16\nworkers = 1\n[network]\nhidden = [8]\n[exploration]\nways = 0\n"
    )
    Path("suite.toml").write_text(
        'seed = 1\nepisodes = 25\n[[case]]\ngame = "row.game.toml"\nscene = "row"\npolicy = "run"\n'
    )
    options = ("--steps", "64", "--config", "few.toml", "--out", "run")
    trained = tltlc("train", "--game", "row.game.toml:row", *options)
    assert trained.status in (0, 1), trained.err
    assert "error[" not in trained.err
    assert tltlc("baseline", "suite.toml", "--workers", "1").status in (0, 1)
    result = tltlc("regress", "suite.toml", "--workers", "1")
    assert result.status in (0, 1), result.err
    assert "row:v0" in result.out
