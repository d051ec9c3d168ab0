"""Each request has one deadline, which its parts share."""

from __future__ import annotations

import json
import socket
import threading

import pytest

from tests.runtime.wire import test_godot_rl
from tests.runtime.wire.conversation import HELLO
from tests.runtime.wire.fast_clock import FastClock
from tests.runtime.wire.test_faults import GAMES, faulty, no_new_children
from tests.waiting import HANG_S
from tltl_runtime.wire.env import WireEnv
from tltl_runtime.wire.errors import WireError
from tltl_runtime.wire.wire_game import WireGame


def test_a_request_and_its_answer_share_a_deadline(monkeypatch: pytest.MonkeyPatch) -> None:
    env = WireEnv(faulty("none"))
    monkeypatch.setattr("tltl_runtime.wire.session.time", FastClock(2 * HANG_S))
    with pytest.raises(WireError, match="did not answer `reset` within 900 s, and was ended"):
        env.reset()


def test_the_connection_and_the_hello_of_a_running_game_share_a_deadline(monkeypatch: pytest.MonkeyPatch) -> None:
    with socket.create_server(("127.0.0.1", 0)) as server:

        def answer() -> None:
            connection, _ = server.accept()
            with connection:
                connection.sendall(json.dumps({"hello": HELLO}).encode() + b"\n")
                connection.recv(1 << 16)

        game = threading.Thread(target=answer, daemon=True)
        game.start()
        monkeypatch.setattr("tltl_runtime.wire.session.time", FastClock(0.3 * HANG_S))
        place = f"127.0.0.1:{server.getsockname()[1]}"
        with pytest.raises(WireError, match="did not say hello within 900 s"):
            WireEnv(WireGame("counter", GAMES, connect=place, start_s=HANG_S))
        game.join(HANG_S)


def test_the_connection_and_the_hello_of_a_godot_rl_game_share_a_deadline(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("tltl_runtime.wire.session.time", FastClock(2 * HANG_S))
    # The game may end because of the closed connection before its deadline is looked at.
    late = "did not connect and answer `env_info` within 900 s|ended with exit status 0 before it answered `env_info`"
    with no_new_children(), pytest.raises(WireError, match=late):
        WireEnv(test_godot_rl.player())


def test_the_ticks_of_a_step_share_a_deadline(monkeypatch: pytest.MonkeyPatch) -> None:
    env = WireEnv(test_godot_rl.player("--env_seed=0"), repeat=3)
    env.reset()
    monkeypatch.setattr("tltl_runtime.wire.godot_rl.time", FastClock(0.3 * HANG_S))
    with pytest.raises(WireError, match="did not answer `step` within 900 s"):
        env.step(test_godot_rl.action(1))
