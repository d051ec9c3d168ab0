"""Messages over WebSocket, for games in web pages."""

from __future__ import annotations

import json
import socket
import time
from collections import deque
from typing import Any

from tltl_runtime.wire import json_text
from tltl_runtime.wire.byte_stream import TWO_ANSWERS, ByteStream
from tltl_runtime.wire.channel import Channel, unpacked
from tltl_runtime.wire.errors import GameGoneError, MalformedMessageError
from tltlc.api import fileio


class WebSocketMessages:
    """Turns received bytes into messages, and messages into bytes to send; uses no socket itself.

    ``messages`` are the messages that were received but not read yet. In the WebSocket protocol, tltlc is
    the server, and the game is the client.

    Raises ModuleNotFoundError if the package ``websockets`` is not installed.
    """

    def __init__(self) -> None:
        from websockets.server import ServerProtocol

        self._limit = fileio.limits.WIRE_MESSAGE.size
        self._protocol: Any = ServerProtocol(max_size=self._limit)
        self._pieces = bytearray()
        self.messages: deque[bytes] = deque()

    @property
    def is_open(self) -> bool:
        """Whether the handshake is done, so that messages can be sent."""
        from websockets.protocol import State

        return bool(self._protocol.state is State.OPEN)

    @property
    def has_part(self) -> bool:
        """Whether bytes of a message were received that was not read yet, even if it is not complete."""
        return bool(self.messages or self._pieces or self._protocol.reader.buffer)

    def feed(self, data: bytes) -> None:
        """Process received bytes; complete messages are appended to ``messages``.

        Raises:
            MalformedMessageError: the bytes do not follow the WebSocket protocol, or a message is too large.
            GameGoneError: the game closes the connection.
        """
        from websockets.frames import Frame, Opcode

        protocol = self._protocol
        protocol.receive_data(data)
        for event in protocol.events_received():
            if not isinstance(event, Frame):
                protocol.send_response(protocol.accept(event))
            elif event.opcode in (Opcode.TEXT, Opcode.BINARY, Opcode.CONT):
                self._add(event)
            elif event.opcode is Opcode.CLOSE:
                raise GameGoneError
        if protocol.handshake_exc is not None or protocol.parser_exc is not None:
            self._refuse(protocol.handshake_exc or protocol.parser_exc)

    def outgoing(self) -> bytes:
        """Return the bytes to send now, such as the answer to a ping."""
        return b"".join(self._protocol.data_to_send())

    def text(self, data: bytes) -> bytes:
        """Return the bytes to send for a message of text."""
        self._protocol.send_text(data)
        return self.outgoing()

    def binary(self, data: bytes) -> bytes:
        """Return the bytes to send for a message of binary data."""
        self._protocol.send_binary(data)
        return self.outgoing()

    def _add(self, frame: Any) -> None:
        self._pieces += frame.data
        if len(self._pieces) > self._limit:
            raise MalformedMessageError(f"sent a message of more than {self._limit >> 20} MiB")
        if frame.fin:
            self.messages.append(bytes(self._pieces))
            self._pieces.clear()

    def _refuse(self, error: Exception) -> None:
        from websockets.exceptions import PayloadTooBig

        if isinstance(error, PayloadTooBig):
            raise MalformedMessageError(f"sent a message of more than {self._limit >> 20} MiB")
        raise MalformedMessageError(f"sent what is not WebSocket: {json_text.shortened(str(error))}")


class WebSocketChannel(Channel):
    """Each message is a text of JSON or, after :meth:`with_msgpack`, binary data of MessagePack."""

    def __init__(self, connection: socket.socket, messages: WebSocketMessages) -> None:
        self._stream, self._messages = ByteStream(connection), messages
        self._msgpack: Any = None

    def send(self, message: Any, patience: float) -> None:
        """Send a message."""
        if arrived := self._stream.arrived():
            self._messages.feed(arrived)
        if self._messages.has_part:
            raise MalformedMessageError(TWO_ANSWERS)
        if self._msgpack is None:
            data = self._messages.text(json.dumps(message, allow_nan=False).encode())
        else:
            data = self._messages.binary(self._msgpack.packb(message))
        self._stream.send(data, patience)

    def receive(self, patience: float, limit: int = fileio.limits.WIRE_MESSAGE.size) -> Any:
        """Return the next message."""
        deadline = time.monotonic() + patience
        while not self._messages.messages:
            self._messages.feed(self._stream.some(deadline - time.monotonic()))
            if reply := self._messages.outgoing():
                self._stream.send(reply, deadline - time.monotonic())
        data = self._messages.messages.popleft()
        if len(data) > limit:
            raise MalformedMessageError(f"sent a message of {len(data):,} bytes; at most {limit:,} are allowed")
        return json_text.parse(data) if self._msgpack is None else unpacked(data)

    def close(self) -> None:
        """Close the connection."""
        self._stream.close()

    def with_msgpack(self) -> Channel:
        """Use MessagePack from now on; return this channel."""
        import msgpack

        self._msgpack = msgpack
        return self
