"""Read lines, or a given number of bytes, from a socket, with limits on time and size."""

from __future__ import annotations

import os
import select
import socket
import struct
import time
from collections.abc import Callable
from math import ceil
from typing import Final

from tltl_runtime.wire.errors import GameGoneError, GameSilentError, MalformedMessageError

TWO_ANSWERS: Final = "sent more than one message as the answer to one request"

_CHUNK: Final = 1 << 16


class ByteStream:
    """A connected socket; ``rest`` are bytes that were already received from it but not read yet.

    The methods that send or receive raise :class:`GameSilentError` after ``patience`` seconds, and
    :class:`GameGoneError` if the other side has closed the connection.
    """

    def __init__(self, connection: socket.socket, rest: bytes = b"") -> None:
        self._socket = connection
        self._rest = rest
        self._timeout: float | None = None
        self._has_arrived = _arrival(connection)
        if connection.family in (socket.AF_INET, socket.AF_INET6):
            connection.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)

    def arrived(self) -> bytes:
        """Return the bytes that have arrived and were not read yet, without waiting; empty if there are none."""
        data, self._rest = self._rest, b""
        try:
            return data or (self._socket.recv(_CHUNK) if self._has_arrived() else b"")
        except OSError:
            raise GameGoneError from None

    def check_in_step(self) -> None:
        """Raise MalformedMessageError if bytes have arrived before the request that they could answer."""
        if self.arrived():
            raise MalformedMessageError(TWO_ANSWERS)

    def send(self, data: bytes, patience: float) -> None:
        """Send all bytes."""
        if patience <= 0:
            raise GameSilentError
        self._set_timeout(patience)
        try:
            self._socket.sendall(data)
        except (BlockingIOError, TimeoutError):
            raise GameSilentError from None
        except OSError:
            raise GameGoneError from None

    def line(self, patience: float, limit: int) -> bytes | bytearray:
        """Return the next line, with its line end.

        Raises MalformedMessageError if the line has more than ``limit`` bytes.
        """
        deadline = time.monotonic() + patience
        if not self._rest:
            data = self._received(patience)
            if data.find(b"\n") == len(data) - 1:
                return data  # Usually, a message comes in one piece.
            self._rest = data
        return self._long_line(deadline, limit)

    def exactly(self, count: int, patience: float) -> bytes:
        """Return the next ``count`` bytes."""
        data, deadline = bytearray(self._rest), time.monotonic() + patience
        while len(data) < count:
            data += self._received(deadline - time.monotonic())
        self._rest = bytes(data[count:])
        return bytes(data[:count])

    def some(self, patience: float) -> bytes:
        """Return the next bytes that are available, at least one."""
        data, self._rest = self._rest or self._received(patience), b""
        return data

    def close(self) -> None:
        """Close the connection."""
        self._socket.close()

    def _long_line(self, deadline: float, limit: int) -> bytearray:
        data, self._rest = bytearray(self._rest), b""
        searched = 0
        while (end := data.find(b"\n", searched)) < 0:
            if len(data) > limit:
                raise MalformedMessageError(f"sent a line of more than {limit >> 20} MiB")
            searched = len(data)
            data += self._received(deadline - time.monotonic())
        self._rest = bytes(data[end + 1 :])
        del data[end + 1 :]
        if len(data) > limit:
            raise MalformedMessageError(f"sent a line of more than {limit >> 20} MiB")
        return data

    def _received(self, patience: float) -> bytes:
        """Receive some bytes, at least one."""
        if patience <= 0:
            raise GameSilentError
        self._set_timeout(patience)
        try:
            data = self._socket.recv(_CHUNK)
        except (BlockingIOError, TimeoutError):
            raise GameSilentError from None
        except OSError:
            raise GameGoneError from None
        if not data:
            raise GameGoneError
        return data

    def _set_timeout(self, seconds: float) -> None:
        """Limit how long a call on the socket waits. Then it raises BlockingIOError, or TimeoutError on Windows."""
        if seconds == self._timeout:
            return
        self._timeout = seconds
        if os.name == "nt":
            self._socket.settimeout(seconds)
            return
        # With a timeout of Python's own, each call would first wait in a second call of the system.
        self._socket.settimeout(None)
        whole, part = divmod(max(1, ceil(seconds * 1e6)), 1_000_000)
        for option in (socket.SO_SNDTIMEO, socket.SO_RCVTIMEO):
            self._socket.setsockopt(socket.SOL_SOCKET, option, struct.pack("@ll", whole, part))


def _arrival(connection: socket.socket) -> Callable[[], object]:
    """Return a function that says, without waiting, whether bytes have arrived or the connection was closed."""
    if not hasattr(select, "poll"):
        return lambda: select.select([connection], [], [], 0)[0]
    poller = select.poll()
    poller.register(connection, select.POLLIN)
    return lambda: poller.poll(0)
