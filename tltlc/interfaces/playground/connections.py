"""The connections of a small HTTP server: how many, for how long, and what each of them is at.

One thread serves all of them and sleeps until something happens. The server decides what is answered (:class:`Site`).

A client that sends no more may still wait for its answer, or may have hung up; the system shows both in the same way.
The server tells them apart by interim answers, which a client that waits passes over: a connection that nobody reads
refuses them.
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
"""How much may come while a request is answered: as much as the next one can have."""
_MOST_HEAD: Final = 2 * REQUEST_HEAD.size + REQUEST_LINE.size + 2
"""How much of what has come is looked at for a head: empty lines, the first line and headers, and a little more."""


_INTERIM: Final = b"HTTP/1.1 100 Continue\r\n\r\n"
_INTERIM_S: Final = 0.2
"""Seconds between two interim answers to a client that sends no more."""


@record
class Response:
    """What is sent: a status, headers besides those that every answer has, and a body."""

    status: HTTPStatus
    headers: Mapping[str, str]
    body: bytes


class Site(Protocol):
    """What a server answers."""

    def check(self, head: Head) -> None:
        """Raise RefusedError where a request is refused, whatever its body."""

    async def answer(self, head: Head, body: bytes, hung_up: Event) -> Response | None:
        """The answer to a request that :meth:`check` let pass; None where nobody waits for it."""

    def refusal(self, status: HTTPStatus) -> Response:
        """The answer that says that a request is refused."""


class Doing(Enum):
    """What a connection is at; its value is the order in which connections give way to new ones."""

    LEAVING = 0
    """The last answer is sent, and the other side is to hang up."""
    IDLE = 1
    READING = 2
    WRITING = 3
    ANSWERING = 4


class Open:
    """The connections that are open."""

    def __init__(self, limits: Connections) -> None:
        self.limits = limits
        self._all: dict[Connection, None] = {}

    def __len__(self) -> int:
        return len(self._all)

    def add(self, connection: Connection) -> bool:
        """Whether there is room for a connection; if need be, the oldest one that matters least gives way."""
        if len(self._all) >= self.limits.most and not self.make_room():
            return False
        self._all[connection] = None
        return True

    def make_room(self) -> bool:
        """Close the connection that matters least.

        None gives way that waits for its answer, or sends the body of a request whose head was good. One that sends no
        more does, since it may have hung up.
        """
        others = [connection for connection in self._all if connection.gives_way]
        if not others:
            return False
        min(others, key=lambda connection: (connection.doing.value, connection.since)).abort()
        return True

    def remove(self, connection: Connection) -> None:
        """Forget a connection."""
        self._all.pop(connection, None)

    def close(self) -> None:
        """Close all connections at once."""
        for connection in [*self._all]:
            connection.abort()


def report_failure(task: asyncio.Task[Any]) -> None:
    """Report what a task failed with, but for a signal, which ends the server and has its own report."""
    error = None if task.cancelled() else task.exception()
    if error is not None and not isinstance(error, KeyboardInterrupt):
        task.get_loop().call_exception_handler({"message": "a task failed", "exception": error, "task": task})


class Connection(asyncio.Protocol):
    """One connection: it reads a request, has it answered, writes the answer, and then reads the next one."""

    def __init__(self, site: Site, connections: Open) -> None:
        self.doing = Doing.IDLE
        self.since = 0.0
        self._site = site
        self._open = connections
        self._buffer = bytearray()
        self._head: Head | None = None
        self._hung_up = Event()
        self._timer: asyncio.TimerHandle | None = None
        self._task: asyncio.Task[None] | None = None
        self._closes = False
        self._is_old = False
        self._has_ended = False
        """Whether the other side sends no more."""

    @property
    def gives_way(self) -> bool:
        """Whether it may be closed for a new one."""
        is_sending = self.doing is Doing.READING and self._head is not None
        is_waiting = self.doing is Doing.ANSWERING and not self._has_ended
        return not is_sending and not is_waiting

    # --- what asyncio calls -------------------------------------------------------------------

    def connection_made(self, transport: asyncio.BaseTransport) -> None:
        """Begin; where there is no room, say so."""
        self._transport = cast("asyncio.Transport", transport)
        # Then `resume_writing` is called once everything is sent.
        self._transport.set_write_buffer_limits(high=0)
        self._now(Doing.IDLE)
        if not self._open.add(self):
            self._refuse(HTTPStatus.SERVICE_UNAVAILABLE)
            self._close()

    def data_received(self, data: bytes) -> None:
        """Take what has come; after the last answer it counts for nothing."""
        if self.doing is Doing.LEAVING:
            return
        self._buffer += data
        if self.doing in (Doing.IDLE, Doing.READING):
            self._advance()
        elif len(self._buffer) > _MOST_BYTES:
            self.abort()

    def eof_received(self) -> bool:
        """The other side sends no more; whether the connection stays open for the answers to what it has sent."""
        self._has_ended = True
        if self.doing is Doing.WRITING:
            return True
        if self.doing is Doing.ANSWERING:
            self._look_for_a_reader()
            return True
        self._end()
        return False

    def resume_writing(self) -> None:
        """Everything is sent."""
        if self.doing is Doing.WRITING:
            self._sent()

    def connection_lost(self, exc: Exception | None) -> None:
        """The other side has hung up, or this one."""
        self.abort()

    # --- what it is at ------------------------------------------------------------------------

    def abort(self) -> None:
        """Close the connection at once."""
        self._hung_up.set()
        self._open.remove(self)
        if self._timer is not None:
            self._timer.cancel()
        self._transport.abort()

    def _close(self) -> None:
        """Close the connection after what was written is sent."""
        self._hung_up.set()
        self._now(Doing.LEAVING)
        self._transport.close()

    def _end(self) -> None:
        """Close after the last answer; a request that is not complete never will be."""
        if self.doing is Doing.READING:
            self._refuse(HTTPStatus.BAD_REQUEST)
        self._close()

    def _look_for_a_reader(self) -> None:
        """Send interim answers until the answer is there: after one that nobody took, the next one fails."""
        if self.doing is not Doing.ANSWERING or self._is_old:
            return
        self._transport.write(_INTERIM)
        self._timer = asyncio.get_running_loop().call_later(_INTERIM_S, self._look_for_a_reader)

    def _now(self, doing: Doing) -> None:
        """Begin something, for which there is so much time."""
        limits = self._open.limits
        seconds = {
            Doing.IDLE: limits.idle_s,
            Doing.READING: limits.request_s,
            Doing.WRITING: limits.write_s,
            Doing.LEAVING: limits.linger_s,
        }.get(doing)
        loop = asyncio.get_running_loop()
        self.doing, self.since = doing, loop.time()
        if self._timer is not None:
            self._timer.cancel()
        self._timer = None if seconds is None else loop.call_later(seconds, self._late)

    def _late(self) -> None:
        if self.doing is Doing.READING:
            self._refuse(HTTPStatus.REQUEST_TIMEOUT)
        else:
            self.abort()

    def _advance(self) -> None:
        """Read as much of a request as has come."""
        if not self._buffer:
            return
        if self.doing is Doing.IDLE:
            self._now(Doing.READING)
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
        self._is_old = head.is_old
        self._now(Doing.ANSWERING)
        if self._has_ended:
            self._look_for_a_reader()
        self._task = asyncio.get_running_loop().create_task(self._answer(head, body))
        self._task.add_done_callback(report_failure)

    def _read_head(self) -> bool:
        """Whether the head is complete."""
        found = read_head(bytes(self._buffer[:_MOST_HEAD]))
        if found is None:
            return False
        self._head, end = head, _ = found
        self._site.check(head)
        del self._buffer[:end]
        if head.waits and not self._buffer:
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
        self._closes = not head.keeps
        self._send(response, with_body=head.method != "HEAD")

    def _refuse(self, status: HTTPStatus, head: Head | None = None) -> None:
        """Say that a request is refused, and close: where the next request begins is not known for sure."""
        self._closes = True
        self._buffer.clear()
        if not self._hung_up.is_set():
            self._send(self._site.refusal(status), with_body=head is None or head.method != "HEAD")

    def _send(self, response: Response, *, with_body: bool = True) -> None:
        headers = {
            "Date": formatdate(usegmt=True),
            **response.headers,
            "Content-Length": str(len(response.body)),
            "Connection": "close" if self._closes else "keep-alive",
        }
        first = f"HTTP/1.1 {response.status.value} {response.status.phrase}"
        head = "\r\n".join([first, *(f"{name}: {value}" for name, value in headers.items()), "", ""])
        self._now(Doing.WRITING)
        self._transport.write(head.encode("latin-1") + (response.body if with_body else b""))
        if self._transport.get_write_buffer_size() == 0:
            self._sent()

    def _sent(self) -> None:
        """Go on with the next request, or let the other side hang up: who closes first may cut off the answer."""
        if self._closes:
            self._leave()
        else:
            self._now(Doing.IDLE)
            self._advance()
            if self._has_ended and self.doing in (Doing.IDLE, Doing.READING):
                self._end()

    def _leave(self) -> None:
        if self._has_ended:
            self._close()
            return
        self._now(Doing.LEAVING)
        if self._transport.can_write_eof():
            self._transport.write_eof()
