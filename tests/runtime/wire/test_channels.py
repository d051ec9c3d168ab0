"""Channels over a pair of sockets: answers that come too often or too late."""

from __future__ import annotations

import json
import socket
from collections.abc import Iterator
from typing import Any

import pytest

from tests.runtime.wire.fast_clock import FastClock
from tests.waiting import HANG_S
from tltl_runtime.wire.byte_stream import ByteStream
from tltl_runtime.wire.channel import Channel, JsonLines, MessagePackFrames
from tltl_runtime.wire.errors import GameSilentError, MalformedMessageError
from tltl_runtime.wire.godot_rl import GodotRlChannel
from tltl_runtime.wire.websocket import WebSocketChannel, WebSocketMessages

Sockets = tuple[socket.socket, socket.socket]
TWO_ANSWERS = "sent more than one message as the answer to one request"


@pytest.fixture(name="sockets")
def _sockets() -> Iterator[Sockets]:
    """The sockets of tltlc and of the game. What is sent to one arrives at once."""
    one, other = socket.socketpair()
    with one, other:
        yield one, other


def check_two_answers(channel: Channel, game: socket.socket, request: Any, answer: bytes) -> None:
    """Answer a request again once the first answer has been read."""
    channel.send(request, HANG_S)
    game.sendall(answer)
    channel.receive(HANG_S)
    game.sendall(answer)
    with pytest.raises(MalformedMessageError, match=TWO_ANSWERS):
        channel.send(request, HANG_S)


def test_a_second_answer_in_json_is_refused(sockets: Sockets) -> None:
    check_two_answers(JsonLines(ByteStream(sockets[0])), sockets[1], {"reset": {}}, b'{"state": {}}\n')


def test_a_second_answer_in_messagepack_is_refused(sockets: Sockets) -> None:
    pytest.importorskip("msgpack")
    check_two_answers(MessagePackFrames(ByteStream(sockets[0])), sockets[1], {"reset": {}}, b"\0\0\0\1\xc0")


GODOT_STEP = {"type": "step", "obs": [{}], "reward": [0], "done": [False]}


def godot_message(message: Any) -> bytes:
    data = json.dumps(message).encode()
    return len(data).to_bytes(4, "little") + data


def test_a_second_answer_of_a_godot_rl_game_is_refused(sockets: Sockets) -> None:
    channel, request = GodotRlChannel(ByteStream(sockets[0])), {"step": {"action": {}}}
    check_two_answers(channel, sockets[1], request, godot_message(GODOT_STEP))


def test_a_second_answer_is_refused_between_the_ticks_of_a_step(sockets: Sockets) -> None:
    channel = GodotRlChannel(ByteStream(sockets[0]))
    channel.send({"step": {"action": {}, "repeat": 2}}, HANG_S)
    sockets[1].sendall(2 * godot_message(GODOT_STEP))
    with pytest.raises(MalformedMessageError, match=TWO_ANSWERS):
        channel.receive(HANG_S)


class Page:
    """The game's side of a connection over WebSocket, after the handshake."""

    def __init__(self, sockets: Sockets) -> None:
        from websockets.client import ClientProtocol
        from websockets.uri import parse_uri

        connection, self._socket = sockets
        self.protocol: Any = ClientProtocol(parse_uri("ws://127.0.0.1/"))
        self.protocol.send_request(self.protocol.connect())
        messages = WebSocketMessages()
        messages.feed(self.bytes())
        self.protocol.receive_data(messages.outgoing())
        self.protocol.events_received()
        self.channel = WebSocketChannel(connection, messages)

    def bytes(self) -> bytes:
        """Return what the page sends now."""
        return b"".join(self.protocol.data_to_send())

    def message(self, text: bytes) -> bytes:
        """Return the bytes of a message."""
        self.protocol.send_text(text)
        return self.bytes()


def test_a_second_answer_of_a_page_is_refused(sockets: Sockets) -> None:
    pytest.importorskip("websockets")
    page = Page(sockets)
    check_two_answers(page.channel, sockets[1], {"reset": {}}, page.message(b'{"state": {}}'))


def test_the_beginning_of_a_second_answer_of_a_page_is_refused(sockets: Sockets) -> None:
    pytest.importorskip("websockets")
    page = Page(sockets)
    sockets[1].sendall(page.message(b'{"state": {}}')[:-1])
    with pytest.raises(MalformedMessageError, match=TWO_ANSWERS):
        page.channel.send({"reset": {}}, HANG_S)


def test_a_ping_of_a_page_between_two_requests_is_answered(sockets: Sockets) -> None:
    pytest.importorskip("websockets")
    page = Page(sockets)
    page.protocol.send_ping(b"hi")
    sockets[1].sendall(page.bytes())
    page.channel.send({"reset": {}}, HANG_S)
    page.protocol.receive_data(sockets[1].recv(1 << 16))
    assert [bytes(frame.data) for frame in page.protocol.events_received()] == [b"hi", b'{"reset": {}}']


def test_a_page_that_sends_no_message_does_not_move_its_deadline(
    sockets: Sockets, monkeypatch: pytest.MonkeyPatch
) -> None:
    pytest.importorskip("websockets")
    page = Page(sockets)
    # More than tltlc receives in one piece.
    for _ in range(800):
        page.protocol.send_pong(b"x" * 100)
    sockets[1].sendall(page.bytes() + page.message(b'{"state": {}}'))
    monkeypatch.setattr("tltl_runtime.wire.websocket.time", FastClock(0.6 * HANG_S))
    with pytest.raises(GameSilentError):
        page.channel.receive(HANG_S)


def test_the_parts_of_a_packed_message_have_one_deadline(sockets: Sockets, monkeypatch: pytest.MonkeyPatch) -> None:
    msgpack = pytest.importorskip("msgpack")
    data = msgpack.packb(bytes(100_000))  # More than tltlc receives in one piece.
    sockets[1].sendall(len(data).to_bytes(4, "big") + data)
    monkeypatch.setattr("tltl_runtime.wire.channel.time", FastClock(2 * HANG_S))
    with pytest.raises(GameSilentError):
        MessagePackFrames(ByteStream(sockets[0])).receive(HANG_S)
