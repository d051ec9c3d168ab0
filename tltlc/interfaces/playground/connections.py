"""The connections of a small HTTP server: their number, their time limits and their states.

One thread serves all connections and sleeps until something happens. A :class:`Site` makes the
answers.

A client that has stopped sending may still wait for its answer, or it may have hung up: the system
reports both in the same way. The server tells them apart by sending interim answers (RFC 9110,
15.2). A waiting client ignores them, and a closed connection rejects them.
"""

from __future__ import annotations

import asyncio
from collections.abc import Mapping
from email.utils import formatdate
from enum import Enum
from http import HTTPStatus
from threading import Event
from typing import Any, Final, Protocol, cast

from tltlc.core.record import record
from tltlc.interfaces.playground.request_head import Head, RefusedError, read_head
from tltlc.io.limits import MESSAGE, REQUEST_HEAD, REQUEST_LINE, Connections

_MOST_BYTES: Final = REQUEST_HEAD.size + MESSAGE.size
"""The most bytes that may arrive while a request is being answered: the size of the largest next request."""
_MOST_HEAD: Final = 2 * REQUEST_HEAD.size + REQUEST_LINE.size + 2
"""The most bytes that are searched for a head: empty lines, first line, headers, and a little more."""


_INTERIM: Final = b"HTTP/1.1 100 Continue\r\n\r\n"
_INTERIM_S: Final = 0.2
"""Seconds between two interim answers to a client that has stopped sending."""


@record
class Response:
    """A response: a status, a body, and the headers beyond those that all responses have."""

    status: HTTPStatus
    headers: Mapping[str, str]
    body: bytes


class Site(Protocol):
    """The interface of the object that makes the answers of a server."""

    def check(self, head: Head) -> None:
        """Raise RefusedError if a request must be refused because of its head, before its body is read."""

    async def answer(self, head: Head, body: bytes, hung_up: Event) -> Response | None:
        """Return the answer to a request that passed :meth:`check`.

        ``hung_up`` is set when the client no longer waits; the answer may then be None. Raises
        RefusedError if the request cannot be answered, for example because of its body.
        """

    def error_response(self, status: HTTPStatus) -> Response:
        """Return the response for a refused request, with this status."""


class ConnectionState(Enum):
    """The state of a connection.

    The values are an order: if there is no room for a new connection, a connection in the state with
    the least value is closed first.
    """

    LEAVING = 0
    """The last answer is sent, and the client should hang up."""
    IDLE = 1
    READING = 2
    WRITING = 3
    ANSWERING = 4


class OpenConnections:
    """The open connections of a server, at most ``limits.most``."""

    def __init__(self, limits: Connections) -> None:
        self.limits = limits
        self._all: dict[Connection, None] = {}

    def __len__(self) -> int:
        return len(self._all)

    def add(self, connection: Connection) -> bool:
        """Add a connection; return False if there is no room for it.

        If there are too many connections, first try to close another one (:meth:`make_room`).
        """
        if len(self._all) >= self.limits.most and not self.make_room():
            return False
        self._all[connection] = None
        return True

    def make_room(self) -> bool:
        """Close the least important connection, and return whether there was one that may be closed.

        It is the one in the lowest state (by the values of :class:`ConnectionState`), and of several
        the one that has been in this state longest. A connection stays open if the client waits for
        an answer, or sends a body after a valid head. A client that has stopped sending does not
        count as waiting, because it may have hung up.
        """
        candidates = [connection for connection in self._all if connection.gives_way]
        if not candidates:
            return False
        min(candidates, key=lambda connection: (connection.state.value, connection.since)).abort()
        return True

    def remove(self, connection: Connection) -> None:
        """Remove a connection that has been closed from the open connections."""
        self._all.pop(connection, None)

    def close(self) -> None:
        """Close all connections at once."""
        for connection in [*self._all]:
            connection.abort()


def report_failure(task: asyncio.Task[Any]) -> None:
    """Report the exception of a finished task to its event loop, unless it is a KeyboardInterrupt.

    A KeyboardInterrupt ends the server, which reports it itself.
    """
    error = None if task.cancelled() else task.exception()
    if error is not None and not isinstance(error, KeyboardInterrupt):
        task.get_loop().call_exception_handler({"message": "a task failed", "exception": error, "task": task})


class Connection(asyncio.Protocol):
    """One connection: reads a request, writes the answer, and then reads the next request."""

    def __init__(self, site: Site, connections: OpenConnections) -> None:
        self.state = ConnectionState.IDLE
        self.since = 0.0
        self._site = site
        self._connections = connections
        self._buffer = bytearray()
        self._head: Head | None = None
        self._hung_up = Event()
        self._timer: asyncio.TimerHandle | None = None
        self._task: asyncio.Task[None] | None = None
        self._closes = False
        self._is_http_1_0 = False
        self._client_has_ended = False
        """Whether the client has stopped sending."""

    @property
    def gives_way(self) -> bool:
        """Whether this connection may be closed to make room for a new one."""
        is_sending = self.state is ConnectionState.READING and self._head is not None
        is_waiting = self.state is ConnectionState.ANSWERING and not self._client_has_ended
        return not is_sending and not is_waiting

    # --- callbacks of asyncio -----------------------------------------------------------------

    def connection_made(self, transport: asyncio.BaseTransport) -> None:
        """Start the connection; refuse it if there is no room."""
        self._transport = cast("asyncio.Transport", transport)
        # With this limit, asyncio calls `resume_writing` once everything is sent.
        self._transport.set_write_buffer_limits(high=0)
        self._enter(ConnectionState.IDLE)
        if not self._connections.add(self):
            self._refuse(HTTPStatus.SERVICE_UNAVAILABLE)
            self._close()

    def data_received(self, data: bytes) -> None:
        """Take received data; after the last answer, ignore it. If too much arrives, close the connection."""
        if self.state is ConnectionState.LEAVING:
            return
        self._buffer += data
        if self.state in (ConnectionState.IDLE, ConnectionState.READING):
            self._advance()
        elif len(self._buffer) > _MOST_BYTES:
            self.abort()

    def eof_received(self) -> bool:
        """Handle a client that has stopped sending.

        Return whether the connection stays open, because an answer is still to be sent.
        """
        self._client_has_ended = True
        if self.state is ConnectionState.WRITING:
            return True
        if self.state is ConnectionState.ANSWERING:
            self._probe_client()
            return True
        self._end()
        return False

    def resume_writing(self) -> None:
        """Read the next request, or close the connection, now that the answer is sent."""
        if self.state is ConnectionState.WRITING:
            self._on_sent()

    def connection_lost(self, exc: Exception | None) -> None:
        """Clean up after either side has closed the connection."""
        self.abort()

    # --- states -------------------------------------------------------------------------------

    def abort(self) -> None:
        """Close the connection at once."""
        self._hung_up.set()
        self._connections.remove(self)
        if self._timer is not None:
            self._timer.cancel()
        self._transport.abort()

    def _close(self) -> None:
        """Close the connection after the written data is sent."""
        self._hung_up.set()
        self._enter(ConnectionState.LEAVING)
        self._transport.close()

    def _end(self) -> None:
        """Close the connection of a client that has stopped sending, after the last answer.

        Refuse an incomplete request, since it can never be completed.
        """
        if self.state is ConnectionState.READING:
            self._refuse(HTTPStatus.BAD_REQUEST)
        self._close()

    def _probe_client(self) -> None:
        """Send interim answers (100 Continue) until the answer to the current request is ready.

        If the client has hung up, sending an interim answer fails, and asyncio closes the
        connection. HTTP/1.0 has no interim answers, so none is sent to such a client.
        """
        if self.state is not ConnectionState.ANSWERING or self._is_http_1_0:
            return
        self._transport.write(_INTERIM)
        self._timer = asyncio.get_running_loop().call_later(_INTERIM_S, self._probe_client)

    def _enter(self, state: ConnectionState) -> None:
        """Change the state of the connection, and start the timer for the time limit of the new state."""
        limits = self._connections.limits
        seconds = {
            ConnectionState.IDLE: limits.idle_s,
            ConnectionState.READING: limits.request_s,
            ConnectionState.WRITING: limits.write_s,
            ConnectionState.LEAVING: limits.linger_s,
        }.get(state)
        loop = asyncio.get_running_loop()
        self.state, self.since = state, loop.time()
        if self._timer is not None:
            self._timer.cancel()
        self._timer = None if seconds is None else loop.call_later(seconds, self._on_timeout)

    def _on_timeout(self) -> None:
        if self.state is ConnectionState.READING:
            self._refuse(HTTPStatus.REQUEST_TIMEOUT)
        else:
            self.abort()

    def _advance(self) -> None:
        """Read the request in the received data; once it is complete, start to answer it."""
        if not self._buffer:
            return
        if self.state is ConnectionState.IDLE:
            self._enter(ConnectionState.READING)
        try:
            if self._head is None and not self._read_head():
                return
        except RefusedError as error:
            self._refuse(error.status, self._head)
            return
        assert self._head is not None
        length = self._head.length or 0
        if len(self._buffer) < length:
            return
        head, body, self._head = self._head, bytes(self._buffer[:length]), None
        del self._buffer[:length]
        self._is_http_1_0 = head.is_http_1_0
        self._enter(ConnectionState.ANSWERING)
        if self._client_has_ended:
            self._probe_client()
        self._task = asyncio.get_running_loop().create_task(self._answer(head, body))
        self._task.add_done_callback(report_failure)

    def _read_head(self) -> bool:
        """Try to read the head of a request (first line and headers); return whether it is complete."""
        result = read_head(bytes(self._buffer[:_MOST_HEAD]))
        if result is None:
            return False
        self._head, end = head, _ = result
        self._site.check(head)
        del self._buffer[:end]
        if head.expects_continue and not self._buffer:
            self._transport.write(_INTERIM)
        return True

    async def _answer(self, head: Head, body: bytes) -> None:
        try:
            response = await self._site.answer(head, body, self._hung_up)
        except RefusedError as error:
            self._refuse(error.status, head)
            return
        except Exception:
            self._refuse(HTTPStatus.INTERNAL_SERVER_ERROR, head)
            raise
        if response is None or self._hung_up.is_set():
            return
        self._closes = not head.keeps_alive
        self._send(response, with_body=head.method != "HEAD")

    def _refuse(self, status: HTTPStatus, head: Head | None = None) -> None:
        """Answer a request with an error ``status``, and close the connection afterwards.

        It cannot stay open, because nobody knows where the next request starts in the data.
        """
        self._closes = True
        self._buffer.clear()
        if not self._hung_up.is_set():
            self._send(self._site.error_response(status), with_body=head is None or head.method != "HEAD")

    def _send(self, response: Response, *, with_body: bool = True) -> None:
        headers = {
            "Date": formatdate(usegmt=True),
            **response.headers,
            "Content-Length": str(len(response.body)),
            "Connection": "close" if self._closes else "keep-alive",
        }
        first = f"HTTP/1.1 {response.status.value} {response.status.phrase}"
        head = "\r\n".join([first, *(f"{name}: {value}" for name, value in headers.items()), "", ""])
        self._enter(ConnectionState.WRITING)
        self._transport.write(head.encode("latin-1") + (response.body if with_body else b""))
        if self._transport.get_write_buffer_size() == 0:
            self._on_sent()

    def _on_sent(self) -> None:
        """After an answer is sent, read the next request, or wait for the client to hang up.

        If this was the last answer, the client closes the connection. If the server closed it first,
        the answer could be cut off.
        """
        if self._closes:
            self._leave()
        else:
            self._enter(ConnectionState.IDLE)
            self._advance()
            if self._client_has_ended and self.state in (ConnectionState.IDLE, ConnectionState.READING):
                self._end()

    def _leave(self) -> None:
        if self._client_has_ended:
            self._close()
            return
        self._enter(ConnectionState.LEAVING)
        if self._transport.can_write_eof():
            self._transport.write_eof()
