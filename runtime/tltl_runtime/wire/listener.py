"""Wait for the game that was started to connect and say ``hello``."""

from __future__ import annotations

import hmac
import selectors
import socket
import time
from collections.abc import Callable
from contextlib import suppress
from typing import Any, Final

from tltl_runtime.wire import json_text
from tltl_runtime.wire.channel import Channel
from tltl_runtime.wire.errors import GameSilentError, MalformedMessageError
from tltl_runtime.wire.first_message import FirstMessage
from tltl_runtime.wire.hello import token_of

_LOOK_S: Final = 0.05
"""Seconds between two checks whether the game has ended."""
_MOST_PENDING: Final = 16
"""The most connections that have not said ``hello`` yet."""
_CHUNK: Final = 1 << 16


class Listener:
    """Listens on a free port of 127.0.0.1 for the one game that knows ``token``.

    It refuses any other connection with a reason, and closes it. ``refusal`` is the reason of the last
    refusal, such as "sent a wrong token"; empty if there was none.
    """

    def __init__(self, token: str) -> None:
        self._token = token
        self._socket = socket.create_server(("127.0.0.1", 0))
        self._socket.setblocking(False)
        self._pending: dict[socket.socket, FirstMessage] = {}
        self._selector = selectors.DefaultSelector()
        self._selector.register(self._socket, selectors.EVENT_READ)
        self.refusal = ""

    @property
    def port(self) -> int:
        """The number of the port."""
        port: int = self._socket.getsockname()[1]
        return port

    def hello(self, patience: float, has_ended: Callable[[], bool]) -> tuple[Channel, Any]:
        """Wait for the game; return its connection and its first message.

        Only the token and the version of the protocol in the message are checked. ``has_ended`` returns
        whether the game has ended.

        Raises:
            GameSilentError: no such message came within ``patience`` seconds, or before the game ended.
                ``refusal`` then says why the last connection was refused.
        """
        deadline = time.monotonic() + patience
        while True:
            # If the game has ended, still read what it sent before.
            is_last = has_ended()
            left = deadline - time.monotonic()
            ready = self._selector.select(0 if is_last else min(max(left, 0), _LOOK_S))
            for key, _ in ready:
                if key.fileobj is self._socket:
                    self._accept()
                elif (connection := self._read(key.fileobj)) is not None:
                    return connection
            if left <= 0 or (is_last and not ready):
                raise GameSilentError

    def close(self) -> None:
        """Close the port, and all connections that have not said ``hello``."""
        for connection in self._pending:
            connection.close()
        self._pending.clear()
        self._selector.close()
        self._socket.close()

    def _accept(self) -> None:
        with suppress(OSError):
            connection, _ = self._socket.accept()
            if len(self._pending) >= _MOST_PENDING:
                connection.close()
                return
            connection.setblocking(False)
            self._pending[connection] = FirstMessage()
            self._selector.register(connection, selectors.EVENT_READ)

    def _read(self, connection: Any) -> tuple[Channel, Any] | None:
        """Read from a connection; return it and its first message once this message has the right token.

        Return None if the message is not complete yet, or if the connection was refused.
        """
        first = self._pending[connection]
        try:
            received = connection.recv(_CHUNK)
        except BlockingIOError:
            return None
        except OSError:
            received = b""
        try:
            data = first.add(received)
            with suppress(OSError):
                connection.send(first.reply())
            if data is None:
                return None
            message = json_text.parse(data)
            self._check_token(message)
        except MalformedMessageError as error:
            self._drop(connection, str(error))
            return None
        self._selector.unregister(connection)
        del self._pending[connection]
        connection.setblocking(True)
        return first.channel(connection), message

    def _check_token(self, message: Any) -> None:
        token = token_of(message).encode(errors="surrogatepass")
        if not hmac.compare_digest(token, self._token.encode()):
            raise MalformedMessageError("sent a wrong token; it must send the value of the variable TLTL_TOKEN")

    def _drop(self, connection: socket.socket, refusal: str) -> None:
        self.refusal = refusal
        with suppress(OSError):
            connection.send(self._pending[connection].refusal(refusal))
        self._selector.unregister(connection)
        del self._pending[connection]
        connection.close()
