"""Games in web pages: the same messages over WebSocket, at the same port."""

from __future__ import annotations

import sys

import pytest

from tests.runtime.wire import conversation
from tests.runtime.wire.test_faults import GAMES
from tests.waiting import HANG_S
from tltl_runtime.wire.env import WireEnv
from tltl_runtime.wire.errors import WireError
from tltl_runtime.wire.first_message import FirstMessage
from tltl_runtime.wire.wire_game import WireGame

REQUEST = b"GET / HTTP/1.1\r\nHost: 127.0.0.1\r\n\r\n"


def web(*words: str) -> WireGame:
    return WireGame("web", GAMES, (sys.executable, "web.py", *words), start_s=HANG_S, step_s=HANG_S)


def test_the_conversation_is_held_over_websocket() -> None:
    pytest.importorskip("websockets")
    lines: list[str] = []
    assert conversation.check([sys.executable, str(GAMES / "web.py")], lines.append), "\n".join(lines)


@pytest.mark.parametrize("words", [(), ("pieces",)])
def test_an_episode_is_played_over_websocket(words: tuple[str, ...]) -> None:
    pytest.importorskip("websockets")
    env = WireEnv(web(*words))
    assert env.reset(seed=2)[0].tolist() == [3]
    env.step(2)
    assert env.step(2)[2] and env.tltl_cause() == "goal"
    env.close()


def test_a_wrong_token_is_refused_over_websocket() -> None:
    pytest.importorskip("websockets")
    with pytest.raises(WireError, match="sent a wrong token") as caught:
        WireEnv(web("token"))
    assert "tltlc refuses this game" in (caught.value.diagnostics[0].help or "")


def test_a_long_message_is_refused_over_websocket() -> None:
    pytest.importorskip("websockets")
    env = WireEnv(web("long"))
    with pytest.raises(WireError, match="sent a message of more than 32 MiB"):
        env.reset()


def test_a_request_that_is_no_websocket_is_refused() -> None:
    pytest.importorskip("websockets")
    with pytest.raises(ValueError, match="sent what is not WebSocket"):
        FirstMessage().add(REQUEST)


def test_without_the_package_a_page_is_told_what_is_missing(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "websockets.server", None)
    first = FirstMessage()
    with pytest.raises(ValueError, match="for which tltlc needs the package `websockets`"):
        first.add(REQUEST)
    assert first.refusal("fails").endswith(b"\n")
