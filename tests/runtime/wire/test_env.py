"""A game in another process as an environment: capabilities, scenes, seeds, snapshots, and lost games in workers."""

from __future__ import annotations

import os
import signal
import socket
import subprocess
import sys
from collections.abc import Iterator
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from gymnasium.error import ResetNeeded
from gymnasium.utils.env_checker import check_env

from tests.runtime.wire.test_faults import GAMES, faulty, no_new_children
from tests.waiting import HANG_S, children, until_gone
from tltl_runtime.spec.wrapper import TltlEnv
from tltl_runtime.vector import WorkerVectorEnv
from tltl_runtime.wire.env import WireEnv
from tltl_runtime.wire.errors import WireError
from tltl_runtime.wire.requests import StepRequest
from tltl_runtime.wire.wire_game import WireGame, address
from tltlc.api import TltlError

COUNTER = WireGame("counter", GAMES, (sys.executable, "counter.py"), start_s=HANG_S, step_s=HANG_S)
LEFT, STAY, RIGHT = range(3)
SPEC = """
signal position: number in [0, 10]
signal at_goal: bool
param goal: number in [0, 10] = 8
spec arrive {
  reach at_goal
  avoid position > goal
  limit 20 steps
}
"""


@pytest.fixture
def env() -> Iterator[WireEnv]:
    env = WireEnv(COUNTER, render_mode="rgb_array")
    yield env
    env.close()


@pytest.mark.filterwarnings("ignore:.*render modes.*")
def test_gymnasium_accepts_the_environment(env: WireEnv) -> None:
    check_env(env)


def test_an_episode_is_played(env: WireEnv) -> None:
    observation, _ = env.reset(seed=2)
    assert observation.dtype == np.float32 and observation.tolist() == [3]
    assert env.tltl_signals() == {"position": 3, "moves": 0, "at_goal": False}
    assert env.tltl_cause() is None and env.tltl_positions() == {"player": (3, 0)}
    assert env.tltl_clock_s == 0.1 and env.tltl_params() == {"goal": 10}
    assert env.step(RIGHT)[1:4] == (0.0, False, False)
    assert env.step(RIGHT)[1:4] == (0.0, True, False)
    assert env.tltl_cause() == "goal"
    with pytest.raises(ResetNeeded):
        env.step(RIGHT)


def test_options_choose_scene_and_variant(env: WireEnv) -> None:
    env.reset(seed=3, options={"scene": "long"})
    assert not env.step(RIGHT)[2]
    env.reset(seed=0, options={"variant": "trap"})
    assert env.step(LEFT)[2] and env.tltl_cause() == "trap"
    with pytest.raises(ValueError, match="the game `counter` has no scene `crypt`; it has short, long"):
        env.reset(options={"scene": "crypt"})


def test_a_scene_that_does_not_exist_is_refused_at_once() -> None:
    with no_new_children(), pytest.raises(ValueError, match="no scene `crypt`"):
        WireEnv(COUNTER, scene="crypt")


def test_a_variant_that_does_not_exist_is_an_error_of_the_game(env: WireEnv) -> None:
    with pytest.raises(WireError, match="TLT0793: the game `counter` reports: there is no variant `v7`"):
        env.reset(options={"variant": "v7"})
    env.reset()


def test_without_a_seed_the_random_generator_goes_on(env: WireEnv) -> None:
    def starts() -> list[Any]:
        return [env.reset(seed=5)[0].item(), *(env.reset()[0].item() for _ in range(20))]

    first = starts()
    assert first == starts() and len(set(first)) > 1
    with pytest.raises(ValueError, match=r"less than 2\^53"):
        env.reset(seed=2**53)


def test_a_step_may_be_several_ticks() -> None:
    env = WireEnv(COUNTER, scene="long", repeat=3)
    env.reset(seed=0)
    env.step(RIGHT)
    assert env.tltl_signals()["moves"] == 3 and env.tltl_clock_s == pytest.approx(0.3)
    env.close()


def test_a_snapshot_is_bytes_that_lead_back(env: WireEnv) -> None:
    env.reset(seed=0)
    kept = env.tltl_snapshot()
    assert isinstance(kept, bytes)
    env.step(RIGHT)
    env.tltl_restore(kept)
    assert env.tltl_signals()["position"] == 1 and env.step(RIGHT)[0].tolist() == [2]
    os.kill(env.process_id or 0, signal.SIGKILL)
    with pytest.raises(WireError):
        while True:
            env.step(STAY)
    env.reset()
    with pytest.raises(ValueError, match="the game that took this snapshot has ended"):
        env.tltl_restore(kept)


def test_a_snapshot_that_was_released_leads_nowhere(env: WireEnv) -> None:
    env.reset(seed=0)
    first, second = env.tltl_snapshot(), env.tltl_snapshot()
    env.tltl_release(first)
    assert env.step(RIGHT)[0].tolist() == [2]
    env.tltl_restore(second)
    assert env.tltl_signals()["position"] == 1
    with pytest.raises(WireError, match="there is no snapshot 1"):
        env.tltl_restore(first)
    env.tltl_release(second)  # The game that took it has ended.
    env.reset()
    env.tltl_release(second)
    assert env.step(RIGHT)[0].tolist()


def test_a_game_that_is_lost_at_a_snapshot_needs_a_reset() -> None:
    env = WireEnv(faulty("none"))
    env.reset()
    with pytest.raises(WireError, match="sent a message `state` instead of `snapshot`"):
        env.tltl_snapshot()
    with pytest.raises(ResetNeeded):
        env.tltl_signals()
    with pytest.raises(ResetNeeded):
        env.step(0)
    env.reset()
    env.step(0)
    env.close()


def test_an_outline_is_that_of_the_scene_and_variant(env: WireEnv) -> None:
    env.reset(seed=2, options={"scene": "long", "variant": "trap"})
    outline = env.tltl_outline()
    assert outline["image"].pop("pixels").tolist() == [[[255, 255, 255]]]
    assert outline == {
        "bounds": [[-1, -2], [11, 3]],
        "boxes": {"edge": [[[-1, -1], [-0.5, 2]], [[10.5, -1], [11, 2]]]},
        "polygons": {"trap": [[-0.5, -1], [0.5, -1], [0, 2]]},
        "regions": {"goal": [[9.5, -1], [10.5, 2]]},
        "image": {"extent": [-0.5, -1, 10.5, 2]},
    }
    assert env.step(RIGHT)[0].tolist() == [4], "the episode goes on"
    env.reset()
    assert env.tltl_outline()["regions"] == {"goal": [[4.5, -1], [10.5, 2]]} and not env.tltl_outline()["polygons"]


def test_a_picture_is_rendered(env: WireEnv) -> None:
    env.reset(seed=1)
    picture = env.render()
    assert picture is not None and picture.shape == (1, 11, 3) and picture[0, :, 0].tolist() == [0, 0, 255] + [0] * 8


def test_the_environment_has_only_what_the_game_declares() -> None:
    env = WireEnv(faulty("none"))
    for name in ("tltl_positions", "tltl_params", "tltl_clock_s"):
        assert not env.has_wrapper_attr(name)
    assert env.has_wrapper_attr("tltl_snapshot") and env.metadata["render_modes"] == []
    env.close()
    with pytest.raises(ValueError, match="cannot render `rgb_array`"):
        WireEnv(faulty("none"), render_mode="rgb_array")


def test_what_ends_an_episode_is_unknown_until_it_has_ended() -> None:
    env = WireEnv(faulty("early cause"))
    env.reset()
    assert env.tltl_cause() is None
    env.close()


def test_an_action_outside_the_space_does_not_reach_the_game(env: WireEnv) -> None:
    env.reset()
    with pytest.raises(ValueError, match="the action is 3"):
        env.step(3)
    env.step(STAY)


def judged(spec: str, game: WireGame) -> TltlEnv:
    return TltlEnv(WireEnv(game, scene="long"), spec)


@pytest.fixture
def spec(tmp_path: Path) -> str:
    path = tmp_path / "arrive.tltl"
    path.write_text(SPEC, encoding="utf-8")
    return str(path)


def test_a_spec_judges_the_game(spec: str) -> None:
    env = judged(spec, COUNTER)
    env.reset(seed=0)
    total, done = 0.0, False
    while not done:
        _, reward, done, _, info = env.step(RIGHT)
        total += float(reward)
    assert info["success"] and total > 0
    env.close()


def test_a_worker_whose_game_is_lost_is_replaced(spec: str) -> None:
    env = WorkerVectorEnv([partial(judged, spec, COUNTER)] * 2, 2, on_death="replace", timeout=HANG_S)
    env.reset(seed=0)
    games = [pid for worker in env.worker_pids for pid in children(worker or 0)]
    assert len(games) == 2
    os.kill(games[1], signal.SIGKILL)
    until_gone(games[1:2])
    infos: dict[str, Any] = {}
    while "lost" not in infos:
        *_, infos = env.step(np.array([STAY, STAY]))
    assert infos["lost"].tolist() == [False, True]
    env.step(np.array([RIGHT, RIGHT]))
    pids = [pid for worker in env.worker_pids for pid in children(worker or 0)]
    assert len(pids) == 2
    env.close()
    until_gone([*games, *pids])


# --- games that are running ---------------------------------------------------------------------------


def free_port() -> int:
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        port: int = probe.getsockname()[1]
        return port


@pytest.fixture
def listening(monkeypatch: pytest.MonkeyPatch) -> Iterator[tuple[int, subprocess.Popen[str]]]:
    monkeypatch.setattr("tltl_runtime.wire.session._TO_LISTEN_S", HANG_S)
    port = free_port()
    words = [sys.executable, str(GAMES / "counter.py"), "--listen", str(port)]
    variables = {**os.environ, "TLTL_TOKEN": "open sesame"}
    with subprocess.Popen(words, stderr=subprocess.PIPE, text=True, env=variables) as process:
        yield port, process
        process.kill()


def connected(port: int) -> WireEnv:
    """Connect as soon as the game listens."""
    return WireEnv(WireGame("counter", GAMES, connect=f"127.0.0.1:{port}", start_s=HANG_S, step_s=HANG_S))


def test_a_running_game_is_played_again_and_again(listening: tuple[int, Any], monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("TLTL_TOKEN", "open sesame")
    for _ in range(2):
        env = connected(listening[0])
        env.reset(seed=0)
        assert env.step(RIGHT)[0].tolist() == [2]
        with pytest.raises(WireError, match="TLT0790: no game listens at"):
            WireEnv(WireGame("counter", GAMES, connect=f"127.0.0.1:{listening[0]}", start_s=0.2))
        env.close()


def test_a_running_game_is_played_again_after_a_lost_episode(
    listening: tuple[int, Any], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("TLTL_TOKEN", "open sesame")
    env = connected(listening[0])
    for _ in range(5):
        env.reset(seed=0)
        with pytest.raises(ZeroDivisionError):
            env._session.ask("step", StepRequest(STAY).message(), lambda _: 1 / 0)
    env.close()


def test_a_running_game_refuses_a_wrong_token(listening: tuple[int, Any], monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("TLTL_TOKEN", "open barley")
    with pytest.raises(WireError, match="TLT0793: the game `counter` reports: the token is wrong"):
        connected(listening[0])


def test_two_running_games_cannot_share_a_port(listening: tuple[int, Any], monkeypatch: pytest.MonkeyPatch) -> None:
    with socket.create_server(("127.0.0.1", 0)) as other:
        port = other.getsockname()[1]
        words = [sys.executable, str(GAMES / "counter.py"), "--listen", str(port)]
        second = subprocess.run(words, stderr=subprocess.PIPE, text=True, timeout=HANG_S, check=False)
    assert second.returncode == 1 and f"cannot listen on port {port}" in second.stderr


def test_an_address_has_a_host_and_a_port() -> None:
    assert address("127.0.0.1:5000") == ("127.0.0.1", 5000)
    assert address("[::1]:5000") == ("::1", 5000)
    for text in ("", "5000", ":5000", "host:", "host:0", "host:70000", "host:5e3"):
        with pytest.raises(TltlError, match="TLT0803"):
            address(text)
