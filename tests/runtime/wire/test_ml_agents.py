"""Games that speak the protocol of ML-Agents: as environments, in game files, and with faults."""

from __future__ import annotations

import json
import subprocess
import sys
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from gymnasium import spaces
from hypothesis import given
from hypothesis import strategies as st

pytest.importorskip("grpc", reason="needs grpcio")
pytest.importorskip("google.protobuf", reason="needs protobuf")

from tests.interfaces.cli.conftest import Outcome, tltlc  # noqa: F401
from tests.runtime.wire.test_faults import GAMES, no_new_children
from tests.runtime.wire.test_godot_rl import free_place
from tests.waiting import HANG_S
from tltl_runtime.gymnasium_games.game_file import read_game_file
from tltl_runtime.gymnasium_games.scene_env import make_base_env
from tltl_runtime.wire import protobuf
from tltl_runtime.wire.env import WireEnv
from tltl_runtime.wire.errors import MalformedMessageError, WireError
from tltl_runtime.wire.wire_game import ML_AGENTS, WireGame
from tltlc.api import TltlError

Run = Callable[..., Outcome]
PLAYER = GAMES / "ml_agents_player.py"
GAME_FILE = """\
[game]
process = {process}
protocol = "ml-agents"
signals = "row_signals:signals"
clock = "10 Hz"

[[scene]]
name = "row"
spec = "row.tltl:arrive"
variants = {{ long = {{ options = {{ length = 7 }} }} }}
"""
SIGNALS = "def signals(observation):\n    return {'place': observation['VectorSensor_size2'][0]}\n"
SPEC = "clock 10 Hz\nsignal place in [0, 10]\nspec arrive { reach place >= 5 limit 40 steps }\n"


def player(*words: str, start_s: float = HANG_S, step_s: float = HANG_S) -> WireGame:
    command = (sys.executable, PLAYER.name, *words)
    return WireGame("row", GAMES, command, start_s=start_s, step_s=step_s, protocol=ML_AGENTS)


def action(move: int) -> dict[str, Any]:
    return {"continuous": np.array([0.5, -1.0], np.float32), "discrete": move}


@pytest.fixture(name="env")
def _env() -> Iterator[WireEnv]:
    env = WireEnv(player("--start=1"))
    yield env
    env.close()


def test_the_spaces_are_those_of_the_only_behavior(env: WireEnv) -> None:
    assert env.action_space == spaces.Dict({"continuous": spaces.Box(-1, 1, (2,)), "discrete": spaces.Discrete(3)})
    vector, picture = spaces.Box(-np.inf, np.inf, (2,)), spaces.Box(-np.inf, np.inf, (1, 2, 3))
    assert env.observation_space == spaces.Dict({"VectorSensor_size2": vector, "CameraSensor": picture})


@pytest.mark.parametrize("words", [(), ("--lazy",)])
def test_episodes_are_played_to_their_ends(words: tuple[str, ...]) -> None:
    env = WireEnv(player("--start=1", *words))
    for _ in range(2):
        observation, _ = env.reset(seed=3)
        assert env.observation_space.contains(observation)
        assert observation["VectorSensor_size2"][0] == 1
        assert observation["CameraSensor"].tolist() == [[[0, 0, 0], [1, 1, 1]]]
        ends = [env.step(action(2))[2] for _ in range(4)]
        assert ends == [False, False, False, True]
        assert env.observation["VectorSensor_size2"][0] == 5
    env.reset()
    assert env.step(action(0))[0]["VectorSensor_size2"][0] == 0
    env.close()


def test_a_step_may_be_several_actions() -> None:
    env = WireEnv(player("--start=1"), repeat=3)
    env.reset()
    observation, _, ended, _, _ = env.step(action(2))
    assert (observation["VectorSensor_size2"].tolist(), ended) == ([4, 3], False)
    observation, _, ended, _, _ = env.step(action(2))
    assert (observation["VectorSensor_size2"].tolist(), ended) == ([5, 4], True)
    env.close()


@pytest.mark.parametrize("host", ["127.0.0.1", "::1"])
def test_a_game_in_the_editor_connects(host: str) -> None:
    port, place = free_place(host)
    words = [sys.executable, str(PLAYER), "--mlagents-port", str(port), f"--host={place.rpartition(':')[0]}"]
    with subprocess.Popen(words) as game:
        try:
            env = WireEnv(WireGame("row", GAMES, connect=place, start_s=HANG_S, protocol=ML_AGENTS))
            assert env.reset()[0]["VectorSensor_size2"][0] in (1, 2)
            env.close()
            assert game.wait(HANG_S) == 0
        finally:
            game.kill()


@pytest.mark.parametrize(
    ("word", "code", "message", "help_"),
    [
        ("--fault=early", "TLT0790", "ended with exit status 1 before it described its agent", "there is no display"),
        ("--fault=version", "TLT0792", "speaks version `2.0.0` of ML-Agents' protocol; tltlc speaks version 1", ""),
        ("--fault=bytes", "TLT0792", "sent a message that is not that of ML-Agents", ""),
        ("--agents=2", "TLT0792", "has 2 agents that wait, but tltlc plays games with one agent", ""),
        ("--behaviors=2", "TLT0792", "has 2 behaviors, Walker?team=0, Guard_1?team=0, but tltlc plays one", ""),
    ],
)
def test_a_game_that_cannot_be_played_is_refused(word: str, code: str, message: str, help_: str) -> None:
    with no_new_children(), pytest.raises(WireError) as error:
        WireEnv(player(word))
    (diagnostic,) = error.value.diagnostics
    assert diagnostic.code == code
    assert message in diagnostic.title
    assert help_ in (diagnostic.help or "")


def test_a_game_that_does_not_connect_is_ended() -> None:
    with no_new_children(), pytest.raises(WireError, match=r"did not connect and describe its agent within 0\.2 s"):
        WireEnv(player("--fault=silent", start_s=0.2))


def test_a_lost_game_costs_an_episode() -> None:
    with no_new_children():
        env = WireEnv(player("--fault=exit"))
        env.reset()
        with pytest.raises(WireError, match=r"TLT0791: .* ended with exit status 3") as error:
            env.step(action(1))
        assert "NullReferenceException" in (error.value.diagnostics[0].help or "")
        env.reset()
        env.close()


def test_a_picture_as_png_is_refused() -> None:
    env = WireEnv(player("--fault=png"))
    with pytest.raises(WireError, match="sent `CameraSensor` as a PNG: set the compression of this sensor to None"):
        env.reset()


def test_a_missing_package_is_reported(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "grpc", None)
    with pytest.raises(TltlError, match="TLT0730: games that speak `ml-agents` need the package `grpcio`"):
        WireEnv(player())


@pytest.fixture(name="game")
def _game(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tmp_path)
    (tmp_path / "row_signals.py").write_text(SIGNALS)
    (tmp_path / "row.tltl").write_text(SPEC)
    path = tmp_path / "row.game.toml"
    path.write_text(GAME_FILE.format(process=json.dumps([sys.executable, str(PLAYER), "--start=1"])))
    return path


@pytest.mark.usefixtures("game")
def test_a_game_file_needs_only_a_function_of_the_observation(tltlc: Run) -> None:  # noqa: F811
    result = tltlc("check", "--game", "row.game.toml:row:long")
    assert result.status == 0, result.err
    assert "row:long has the signals that `arrive` uses" in result.err
    assert "signals: place" in result.err
    assert "equal seeds and actions give equal plays: yes" in result.err


def test_the_options_of_a_scene_are_environment_parameters(game: Path) -> None:
    env = make_base_env(read_game_file(game), "row", "long")
    env.reset()
    assert [env.step(action(2))[2] for _ in range(6)] == [False] * 5 + [True]
    env.close()
    game.write_text(game.read_text().replace("length = 7", 'length = "long"'))
    with pytest.raises(TltlError, match="TLT0803: the environment parameter `length` must be a number"):
        make_base_env(read_game_file(game), "row", "long")


@given(st.binary(max_size=60))
def test_bytes_that_are_no_message_are_refused(data: bytes) -> None:
    try:
        parts = protobuf.fields(data)
    except MalformedMessageError:
        return
    for number in parts:
        for read in (
            protobuf.message,
            protobuf.messages,
            protobuf.text,
            protobuf.whole,
            protobuf.wholes,
            protobuf.floats,
        ):
            try:
                read(parts, number)
            except MalformedMessageError:
                continue


@given(st.lists(st.integers(-(2**31), 2**31 - 1)), st.text())
def test_what_is_written_is_read(numbers: list[int], text: str) -> None:
    data = protobuf.packed_wholes(7, np.array(numbers, np.int64)) + protobuf.field(3, text)
    data += b"".join(protobuf.field(2, number) for number in numbers)
    parts = protobuf.fields(data)
    assert (protobuf.wholes(parts, 7), protobuf.text(parts, 3), protobuf.wholes(parts, 2)) == (numbers, text, numbers)
