"""Read the first message on a new connection. Its first bytes tell whether the game uses plain TCP or WebSocket."""

from __future__ import annotations

import json
import socket

from tltl_runtime.wire.byte_stream import ByteStream
from tltl_runtime.wire.channel import Channel, JsonLines
from tltl_runtime.wire.errors import GameGoneError, MalformedMessageError
from tltl_runtime.wire.requests import Refusal
from tltl_runtime.wire.websocket import WebSocketChannel, WebSocketMessages
from tltlc.api import fileio

_REQUEST = b"GET "
"""The first bytes of each connection over WebSocket, and of no message in JSON."""


class FirstMessage:
    """Collects the bytes of a new connection until its first message is complete."""

    def __init__(self) -> None:
        self._data = bytearray()
        self._web: WebSocketMessages | None = None

    def add(self, received: bytes) -> bytes | None:
        """Add received bytes; return the first message if it is complete now, else None.

        Empty ``received`` means that the connection was closed. Raises MalformedMessageError if it was
        closed too early, or if the bytes cannot become a message.
        """
        limit = fileio.limits.WIRE_HELLO.size
        if not received:
            raise MalformedMessageError("closed its connection before it said hello")
        self._data += received
        if self._web is None and self._data.startswith(_REQUEST):
            try:
                self._web = WebSocketMessages()
            except ModuleNotFoundError:
                raise MalformedMessageError("uses WebSocket, for which tltlc needs the package `websockets`") from None
            received = bytes(self._data)
        if self._web is not None:
            return self._web_message(received, self._web)
        if (end := self._data.find(b"\n")) >= 0:
            line = bytes(self._data[: end + 1])
            del self._data[: end + 1]
            return line
        if len(self._data) > limit:
            raise MalformedMessageError(f"sent a first line of more than {limit >> 20} MiB")
        return None

    def reply(self) -> bytes:
        """Return the bytes to send now: the answer to the handshake of WebSocket, or none."""
        return self._web.outgoing() if self._web is not None else b""

    def refusal(self, reason: str) -> bytes:
        """Return the bytes of a message that tells the game why it is refused; ``reason`` follows "because it"."""
        text = json.dumps(Refusal(reason).message()).encode()
        return self._web.text(text) if self._web is not None and self._web.is_open else text + b"\n"

    def channel(self, connection: socket.socket) -> Channel:
        """Return the channel for all further messages."""
        if self._web is not None:
            return WebSocketChannel(connection, self._web)
        return JsonLines(ByteStream(connection, bytes(self._data)))

    def _web_message(self, received: bytes, web: WebSocketMessages) -> bytes | None:
        try:
            web.feed(received)
        except GameGoneError:
            raise MalformedMessageError("closed its connection before it said hello") from None
        return web.messages.popleft() if web.messages else None
