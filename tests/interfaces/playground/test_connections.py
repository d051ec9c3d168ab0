"""Many connections, slow clients, and too few descriptors: the server answers, and sleeps in
between."""

from __future__ import annotations

import errno
import json
import os
import selectors
import socket
import subprocess
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

import pytest

from tests.interfaces.playground.raw import connect, read_to_end, statuses
from tests.interfaces.playground.test_server import JSON, PATIENT, SLOW, ask, request, running_server, wait_until
from tests.waiting import HANG_S, until
from tltlc.core.record import replace
from tltlc.interfaces.playground import children
from tltlc.interfaces.playground.page_config import start
from tltlc.interfaces.playground.server import PlaygroundServer
from tltlc.io.limits import PLAYGROUND

MANY = 300
FEW = replace(PATIENT, most=4)
NEVER_S = 1e6


@pytest.fixture
def room() -> Iterator[None]:
    """Raise the limit of descriptors, for both ends of many connections."""
    import resource

    soft, hard = resource.getrlimit(resource.RLIMIT_NOFILE)
    resource.setrlimit(resource.RLIMIT_NOFILE, (min(hard, 4 * MANY) if hard > 0 else 4 * MANY, hard))
    yield
    resource.setrlimit(resource.RLIMIT_NOFILE, (soft, hard))


@pytest.fixture
def wakeups(monkeypatch: pytest.MonkeyPatch) -> list[int]:
    """A list that grows by one whenever the server wakes up."""
    wakeups: list[int] = []
    select = selectors.DefaultSelector.select

    def count_wakeup(selector: Any, timeout: float | None = None) -> Any:
        wakeups.append(0)
        return select(selector, timeout)

    monkeypatch.setattr(selectors.DefaultSelector, "select", count_wakeup)
    return wakeups


@contextmanager
def open_connections(server: PlaygroundServer, number: int, data: bytes = b"") -> Iterator[list[socket.socket]]:
    """Connections on which this data is sent, and nothing more."""
    made = [connect(server) for _ in range(number)]
    try:
        for connection in made:
            connection.sendall(data)
        yield made
    finally:
        for connection in made:
            connection.close()


def is_answered(server: PlaygroundServer) -> bool:
    return json.loads(ask(server, "POST", "/api", "{}", JSON)[2]) == start()  # type: ignore[no-any-return]


@pytest.mark.slow
@pytest.mark.skipif(os.name != "posix", reason="raises a limit that only POSIX has")
@pytest.mark.parametrize("data", [b"", b"GET / HT", b"POST /api HTTP/1.1\r\nHost: localhost\r\nA"], ids=repr)
@pytest.mark.usefixtures("room")
def test_hundreds_of_idle_connections_block_nothing(data: bytes, wakeups: list[int]) -> None:
    with running_server(connections=replace(PATIENT, idle_s=NEVER_S, request_s=NEVER_S)) as server:
        with open_connections(server, MANY) as made:
            for connection in made[-PLAYGROUND.most // 2 :]:
                connection.sendall(data)
            for _ in range(3):
                assert is_answered(server)
            assert len(server.connections) <= PLAYGROUND.most
            # Every event wakes the server a few times, and nothing else wakes it, however long the test takes.
            assert len(wakeups) < 20 * MANY
        assert wait_until(lambda: len(server.connections) == 0)
        assert is_answered(server)


def test_the_connection_idle_longest_is_closed_first() -> None:
    with running_server(connections=replace(FEW, idle_s=NEVER_S)) as server, open_connections(server, FEW.most) as made:
        assert wait_until(lambda: len(server.connections) == FEW.most)
        # Every connection but the second has had an answer since.
        for connection in (made[0], *made[2:]):
            connection.sendall(
                b"GET /none HTTP/1.1\r\nHost: localhost\r\n\r\n" if connection is made[3] else index(b"")
            )
            assert connection.recv(1 << 16)
        with connect(server) as another:
            another.sendall(index(b"Connection: close\r\n"))
            assert statuses(read_to_end(another)) == [200]
        # The fourth connection was rejected and is to be closed, so it gives way to connections that may be
        # used again.
        assert read_to_end(made[3]) == b""
        made[1].sendall(index(b"Connection: close\r\n"))
        assert statuses(read_to_end(made[1])) == [200]


def index(headers: bytes) -> bytes:
    return b"HEAD / HTTP/1.1\r\nHost: localhost\r\n" + headers + b"\r\n"


def test_an_idle_connection_is_closed_after_a_while() -> None:
    with running_server(connections=replace(PATIENT, idle_s=0.05)) as server, connect(server) as connection:
        assert read_to_end(connection) == b""
        assert wait_until(lambda: len(server.connections) == 0)


@pytest.mark.parametrize(
    "begun",
    [b"G", b"GET / HTTP/1.1\r\nHost: local", b"\r\n\r\n"],
    ids=repr,
)
def test_a_request_that_is_not_completed_in_time_is_rejected(begun: bytes) -> None:
    with running_server(connections=replace(PATIENT, request_s=0.05)) as server, connect(server) as connection:
        connection.sendall(begun)
        assert statuses(read_to_end(connection)) == [408]


def test_a_slow_body_has_no_more_time_than_the_whole_request() -> None:
    with running_server(connections=replace(PATIENT, request_s=0.5)) as server, connect(server) as connection:
        head = request(server, " " * 1_000_000).partition(b"\r\n\r\n")[0]
        connection.sendall(head + b"\r\n\r\n")
        connection.settimeout(0.02)

        def answer() -> bytes:
            try:
                return connection.recv(1 << 16)
            except TimeoutError:
                # Single bytes do not extend the time limit.
                connection.sendall(b" ")
                return b""

        assert statuses(until(answer, "the answer")) == [408]


def test_a_client_that_does_not_read_its_answer_is_disconnected() -> None:
    with running_server(connections=replace(PATIENT, write_s=0.05)) as server:
        server.page.files["main.js"] = b"a" * (64 << 20)
        with connect(server) as connection:
            assert wait_until(lambda: len(server.connections) == 1)
            connection.sendall(b"GET /main.js HTTP/1.1\r\nHost: localhost\r\n\r\n")
            assert wait_until(lambda: len(server.connections) == 0)


def test_too_many_bytes_after_a_request_end_the_connection() -> None:
    with running_server() as server, connect(server) as connection:
        connection.sendall(request(server, json.dumps({"text": SLOW})))
        with pytest.raises(OSError, match=r"(?i)reset|pipe|abort"):
            for _ in range(100):
                connection.sendall(b"\r\n" * (1 << 20))
        assert wait_until(lambda: not server.children._running)


def test_a_new_connection_is_rejected_while_all_others_wait(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(children, "MOST_AT_ONCE", FEW.most)
    with running_server(connections=FEW) as server:
        with open_connections(server, FEW.most, request(server, json.dumps({"text": SLOW}))):
            assert wait_until(lambda: len(server.children._running) == FEW.most)
            with connect(server) as another:
                assert statuses(read_to_end(another)) == [503]
        assert is_answered(server)


class Full:
    """A listener that reports missing file descriptors until the test clears ``is_full``."""

    def __init__(self, listener: socket.socket) -> None:
        self.listener = listener
        self.is_full = True
        self.looks = 0

    def accept(self) -> tuple[socket.socket, Any]:
        self.looks += 1
        if self.is_full:
            raise OSError(errno.EMFILE, "Too many open files")
        return self.listener.accept()

    def __getattr__(self, name: str) -> Any:
        return getattr(self.listener, name)


def test_without_descriptors_the_server_retries_after_a_pause(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("tltlc.interfaces.playground.server._AGAIN_S", NEVER_S)
    with running_server() as server, open_connections(server, 3) as made:
        assert wait_until(lambda: len(server.connections) == 3)
        full = Full(server._listener)
        server._loop.call_soon_threadsafe(setattr, server, "_listener", full)
        with connect(server) as waiting:
            # At each attempt one of the three idle connections gives way; after that, the server only waits.
            assert [read_to_end(connection) for connection in made] == [b""] * 3
            assert wait_until(lambda: server._retry_timer is not None)
            full.is_full = False
            assert full.looks == 4
            server._loop.call_soon_threadsafe(server._watch_listener)
            waiting.sendall(index(b"Connection: close\r\n"))
            assert statuses(read_to_end(waiting)) == [200]


LOW = f"""
import resource, selectors, sys, threading
resource.setrlimit(resource.RLIMIT_NOFILE, (64, 64))
from tltlc.interfaces.playground.server import PlaygroundServer

turns = []
select = selectors.DefaultSelector.select
selectors.DefaultSelector.select = lambda *given: turns.append(0) or select(*given)
with PlaygroundServer(0, {HANG_S}) as server:
    threading.Thread(target=server.serve_forever).start()
    print(server.server_address[1], server.token, flush=True)
    sys.stdin.readline()
    print(len(turns), flush=True)
"""


@pytest.mark.skipif(os.name != "posix", reason="lowers a limit that only POSIX has")
@pytest.mark.usefixtures("room")
def test_a_server_with_few_descriptors_answers_beside_idle_connections() -> None:
    program = f"import sys; sys.path[:] = {sys.path!r}\n{LOW}"
    with subprocess.Popen(
        [sys.executable, "-c", program],
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
    ) as running:
        assert running.stdin
        assert running.stdout
        port, token = running.stdout.readline().split()

        class Other:
            server_address = ("127.0.0.1", int(port))

        Other.token = token  # type: ignore[attr-defined]
        other: Any = Other()
        with open_connections(other, MANY):
            for _ in range(3):
                assert is_answered(other)
            woken, errors = running.communicate("\n")
        assert int(woken) < 20 * MANY
        assert errors == ""
