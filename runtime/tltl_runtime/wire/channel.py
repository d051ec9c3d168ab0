"""Send and receive messages over a stream of bytes, as JSON or as MessagePack."""

from __future__ import annotations

import time
from abc import ABC, abstractmethod
from typing import Any, Final

from tltl_runtime.wire import json_text
from tltl_runtime.wire.byte_stream import ByteStream
from tltl_runtime.wire.errors import MalformedMessageError
from tltlc.api import fileio

_LENGTH_BYTES: Final = 4


class Channel(ABC):
    """Sends and receives messages.

    ``send`` and ``receive`` raise :class:`~tltl_runtime.wire.errors.GameSilentError` after ``patience``
    seconds, and :class:`~tltl_runtime.wire.errors.GameGoneError` if the game has closed the connection.
    """

    @abstractmethod
    def send(self, message: Any, patience: float) -> None:
        """Send a message.

        Raises MalformedMessageError if another answer to the last request has arrived. One that arrives
        later is taken for the answer to this message.
        """

    @abstractmethod
    def receive(self, patience: float, limit: int = fileio.limits.WIRE_MESSAGE.size) -> Any:
        """Return the next message.

        Raises MalformedMessageError if the bytes are no message, or if it has more than ``limit`` bytes.
        """

    @abstractmethod
    def close(self) -> None:
        """Close the connection."""

    @abstractmethod
    def with_msgpack(self) -> Channel:
        """Return a channel over the same connection that uses MessagePack."""


class JsonLines(Channel):
    """Each message is a line of JSON."""

    def __init__(self, stream: ByteStream) -> None:
        self._stream = stream

    def send(self, message: Any, patience: float) -> None:
        """Send a message."""
        self._stream.check_in_step()
        self._stream.send(json_text.line(message), patience)

    def receive(self, patience: float, limit: int = fileio.limits.WIRE_MESSAGE.size) -> Any:
        """Return the next message."""
        return json_text.parse(self._stream.line(patience, limit))

    def close(self) -> None:
        """Close the connection."""
        self._stream.close()

    def with_msgpack(self) -> Channel:
        """Return a channel that uses MessagePack."""
        return MessagePackFrames(self._stream)


class MessagePackFrames(Channel):
    """Each message is a length of four bytes, the highest first, and that many bytes of MessagePack."""

    def __init__(self, stream: ByteStream) -> None:
        import msgpack

        self._stream, self._msgpack = stream, msgpack

    def send(self, message: Any, patience: float) -> None:
        """Send a message."""
        self._stream.check_in_step()
        data = self._msgpack.packb(message)
        self._stream.send(len(data).to_bytes(_LENGTH_BYTES, "big") + data, patience)

    def receive(self, patience: float, limit: int = fileio.limits.WIRE_MESSAGE.size) -> Any:
        """Return the next message."""
        deadline = time.monotonic() + patience
        length = int.from_bytes(self._stream.exactly(_LENGTH_BYTES, patience), "big")
        if length > limit:
            raise MalformedMessageError(f"sent a message of {length:,} bytes; at most {limit:,} are allowed")
        return unpacked(self._stream.exactly(length, deadline - time.monotonic()))

    def close(self) -> None:
        """Close the connection."""
        self._stream.close()

    def with_msgpack(self) -> Channel:
        """Return this channel, which uses MessagePack already."""
        return self


def unpacked(data: bytes) -> Any:
    """Return the value of a message in MessagePack; raises MalformedMessageError if it is not MessagePack."""
    import msgpack

    try:
        return msgpack.unpackb(data)
    except (ValueError, msgpack.UnpackException):
        raise MalformedMessageError(f"sent a message that is not MessagePack: {json_text.quoted(data)}") from None


def has_msgpack() -> bool:
    """Whether the package for MessagePack is installed."""
    try:
        import msgpack  # noqa: F401
    except ModuleNotFoundError:
        return False
    return True
