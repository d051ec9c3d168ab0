"""Malformed requests, byte by byte: each gets its status code, the connection is closed, and the
server goes on."""

from __future__ import annotations

import json
import socket
from collections.abc import Callable, Iterator
from threading import Event

import pytest

from tests.interfaces.playground.raw import connect, read_to_end, statuses, statuses_until_closed
from tests.interfaces.playground.test_server import JSON, ask, request, running_server
from tests.waiting import HANG_S, printed
from tltlc.interfaces.playground.connections import Connection
from tltlc.interfaces.playground.page_config import start
from tltlc.interfaces.playground.request_head import read_head
from tltlc.interfaces.playground.server import PlaygroundServer
from tltlc.io.limits import MESSAGE, REQUEST_HEAD, REQUEST_LINE

HOST = b"Host: localhost\r\n"
GET = b"GET / HTTP/1.1\r\n" + HOST


@pytest.fixture(scope="module")
def server() -> Iterator[PlaygroundServer]:
    with running_server() as running:
        yield running
        assert json.loads(ask(running, "POST", "/api", "{}", JSON)[2]) == start()


@pytest.fixture(autouse=True)
def is_alive_and_silent(server: PlaygroundServer, capfd: pytest.CaptureFixture[str]) -> Iterator[None]:
    yield
    assert ask(server, "GET", "/")[0] == 200
    assert capfd.readouterr().err == ""


def post(server: PlaygroundServer, *headers: bytes, body: bytes = b"{}", host: bytes = HOST) -> bytes:
    own = b"POST /api HTTP/1.1\r\n" + host + b"Content-Type: application/json\r\nTltlc-Token: " + server.token.encode()
    return b"\r\n".join([own, *headers, b"", body])


LINES = [
    (b"GET /\r\n\r\n", 400),
    (b"GET\r\n\r\n", 400),
    (b"GET / HTTP/1.1 \r\n", 400),
    (b" GET / HTTP/1.1\r\n", 400),
    (b"GET  / HTTP/1.1\r\n", 400),
    (b"GET\t/ HTTP/1.1\r\n", 400),
    (b"GET / HTTP/1.1\r\r\n", 400),
    (b"GET / http/1.1\r\n", 400),
    (b"GET / HTTP/1\r\n", 400),
    (b"GET / HTTP/11.1\r\n", 400),
    (b"GET / HTTP/1.\xc2\xb2\r\n", 400),
    (b"GET / FTP/1.1\r\n", 400),
    (b"GET / HTTP/0.9\r\n", 505),
    (b"GET / HTTP/2.0\r\n", 505),
    (b"GET / HTTP/9.9\r\n", 505),
    (b"PRI * HTTP/2.0\r\n\r\nSM\r\n\r\n", 505),
    (b"G\0T / HTTP/1.1\r\n", 400),
    (b"GET /\0 HTTP/1.1\r\n", 400),
    (b"GET /\xff HTTP/1.1\r\n", 400),
    (b"GET /%zz HTTP/1.1\r\n", 400),
    (b"GET /% HTTP/1.1\r\n", 400),
    (b"GET /%00 HTTP/1.1\r\n", 400),
    (b"GET /%ff HTTP/1.1\r\n", 400),
    (b"GET /%0d%0aX:%20y HTTP/1.1\r\n", 400),
    (b"GET http://localhost/ HTTP/1.1\r\n", 400),
    (b"CONNECT localhost:80 HTTP/1.1\r\n", 400),
    (b"GET / HTTP/1.1\r\n\r\n", 400),
    (b"\x16\x03\x01\x02\x00\x01\x00\x01\xfc\x03\x03\n", 400),
    (b"\r\n" * REQUEST_HEAD.size, 400),
    (b"G" * REQUEST_LINE.size, 414),
    (b"GET /" + b"a" * REQUEST_LINE.size + b" HTTP/1.1\r\n", 414),
]


@pytest.mark.parametrize(("line", "status"), LINES, ids=lambda value: repr(value)[:40])
def test_invalid_request_lines_are_rejected(server: PlaygroundServer, line: bytes, status: int) -> None:
    assert statuses_until_closed(server, line) == [status]


HEADERS = [
    (b"Host: localhost\r\n", 400),
    (b"no colon\r\n", 400),
    (b": no name\r\n", 400),
    (b"A : b\r\n", 400),
    (b" folded: line\r\n", 400),
    (b"A: b\r\n\tc\r\n", 400),
    (b"A: \0\r\n", 400),
    (b"A: b\rC: d\r\n", 400),
    (b"\xc3\xa9: b\r\n", 400),
    (b"Content-Length: -1\r\n", 400),
    (b"Content-Length: +1\r\n", 400),
    (b"Content-Length: 1_0\r\n", 400),
    (b"Content-Length: 0x1\r\n", 400),
    (b"Content-Length: 1.0\r\n", 400),
    (b"Content-Length:\r\n", 400),
    (b"Content-Length: 1, 1\r\n", 400),
    (b"Content-Length: \xc2\xb2\r\n", 400),
    (b"Content-Length: \xb2\r\n", 400),
    (b"Content-Length: \xd9\xa3\r\n", 400),
    (b"Content-Length: 0\r\nContent-Length: 0\r\n", 400),
    (b"Content-Length: 0\r\ncontent-length: 2\r\n", 400),
    (b"Content-Length: " + b"9" * 5000 + b"\r\n", 413),
    (b"Transfer-Encoding: chunked\r\n", 501),
    (b"Transfer-Encoding: identity\r\n", 501),
    (b"Transfer-Encoding: chunked\r\nContent-Length: 2\r\n", 400),
    (b"Expect: miracles\r\n", 417),
    (b"A: b\r\n" * 101, 431),
    (b"A: " + b"b" * REQUEST_HEAD.size + b"\r\n", 431),
    (b"Content-Length: 3\r\n", 400),
]


@pytest.mark.parametrize(("header", "status"), HEADERS, ids=lambda value: repr(value)[:40])
def test_invalid_headers_are_rejected(server: PlaygroundServer, header: bytes, status: int) -> None:
    # The bytes after the header are not read as a request.
    assert statuses_until_closed(server, GET + header + b"\r\n" + GET + b"\r\n") == [status]


def test_blanks_around_the_value_of_a_header_are_removed() -> None:
    result = read_head(GET + b"A:\t b\t c: \xe9 \t\r\nB:\r\nC: \t\r\n\r\n")
    assert result is not None
    assert [result[0].headers[name] for name in "abc"] == ["b\t c: é", "", ""]


LONG = {
    "blanks": b"a:" + b" " * 30_000 + b"\0",
    "blanks_and_tabs": b"a:" + b"\t " * 15_000 + b"\0",
    "blanks_between_words": b"a:" + b" b" * 15_000 + b"\0",
    "a_name": b"a" * 30_000 + b"\0:",
    "colons": b"a" + b":" * 30_000 + b"\0",
}


@pytest.mark.parametrize("header", LONG.values(), ids=LONG)
def test_a_long_invalid_header_is_rejected_in_linear_time(header: bytes) -> None:
    program = (
        "import sys; from tltlc.interfaces.playground.request_head import RefusedError, read_head\n"
        "try: read_head(sys.stdin.buffer.read())\n"
        "except RefusedError as error: print(error.status.value)"
    )
    assert printed(program, GET + header + b"\r\n\r\n").strip() == b"400"


def test_endless_heads_are_rejected(server: PlaygroundServer) -> None:
    assert statuses_until_closed(server, GET + b"A: " + b"b" * (REQUEST_HEAD.size + 2)) == [431]
    assert statuses_until_closed(server, GET + b"A:\n" * 200) == [431]


@pytest.mark.parametrize("path", ["/main.js", "/main%2Ejs", "/%6dain.js", "/main.js?a=%zz"])
def test_paths_may_have_escapes_and_queries(server: PlaygroundServer, path: str) -> None:
    assert ask(server, "GET", path)[::2] == (200, server.page.files["main.js"])


@pytest.mark.parametrize("path", ["//", "/./", "/../serve.py", "/%2e%2e/x", "/index.html/", "/api/", "/API", "/%2Fapi"])
def test_unknown_paths_are_not_found(server: PlaygroundServer, path: str) -> None:
    assert ask(server, "GET", path)[0] == 404


@pytest.mark.parametrize(
    ("headers", "body", "status"),
    [
        ([], b"{}", 411),
        ([b"Content-Length: %d" % (MESSAGE.size + 1)], b"{}", 413),
        ([b"Content-Length: %d" % 10**17], b"", 413),
        ([b"Content-Length: 1"], b"{}", 400),
        ([b"Content-Length: 0"], b"", 400),
        ([b"Transfer-Encoding: chunked"], b"2\r\n{}\r\n0\r\n\r\n", 501),
    ],
)
def test_invalid_bodies_are_rejected(server: PlaygroundServer, headers: list[bytes], body: bytes, status: int) -> None:
    assert statuses_until_closed(server, post(server, *headers, body=body)) == [status]


def test_a_rejection_arrives_although_a_large_body_follows(server: PlaygroundServer) -> None:
    body = b"a" * (8 << 20)
    with connect(server) as connection:
        connection.sendall(post(server, b"Content-Length: %d" % len(body), body=body))
        assert statuses(read_to_end(connection)) == [413]


def test_a_body_that_ends_early_is_rejected(server: PlaygroundServer) -> None:
    with connect(server) as connection:
        connection.sendall(post(server, b"Content-Length: 3"))
        connection.shutdown(socket.SHUT_WR)
        assert statuses(read_to_end(connection)) == [400]


@pytest.mark.parametrize("version", [b"1.1", b"1.0"])
def test_a_client_that_closes_its_sending_side_gets_its_answer(version: bytes, monkeypatch: pytest.MonkeyPatch) -> None:
    is_ended = Event()
    with running_server() as server, connect(server) as connection:
        answer = server.children.answer
        ended = Connection.eof_received

        def see_end(connection: Connection) -> bool:
            result = ended(connection)
            is_ended.set()
            return result

        def answer_after_the_end(body: bytes, is_abandoned: Callable[[], bool]) -> str | None:
            assert is_ended.wait(HANG_S)
            return answer(body, is_abandoned)

        monkeypatch.setattr(Connection, "eof_received", see_end)
        monkeypatch.setattr(server.children, "answer", answer_after_the_end)
        connection.sendall(request(server, "{}").replace(b"HTTP/1.1", b"HTTP/" + version))
        connection.shutdown(socket.SHUT_WR)
        codes = statuses(read_to_end(connection))
        # HTTP/1.0 has no interim answers.
        assert codes[-1] == 200
        assert set(codes[:-1]) == ({100} if version == b"1.1" else set())


def test_a_client_that_closes_its_sending_side_gets_all_answers_in_order(server: PlaygroundServer) -> None:
    requests = request(server, "{}") + GET + b"\r\n" + request(server, '{"text": ""}')
    for data, expected in ((requests * 2, [200] * 6), (requests + b"GET /", [200, 200, 200, 400]), (b"", [])):
        with connect(server) as connection:
            connection.sendall(data)
            connection.shutdown(socket.SHUT_WR)
            assert [status for status in statuses(read_to_end(connection)) if status != 100] == expected


def test_pipelined_requests_are_answered_in_order(server: PlaygroundServer) -> None:
    requests = request(server, "{}") + GET + b"\r\n" + request(server, '{"text": ""}')
    last = GET + b"Connection: close\r\n\r\n"
    assert statuses_until_closed(server, requests + b"\r\n" + requests + last) == [200] * 7
    assert statuses_until_closed(server, requests + b"nonsense\r\n\r\n" + requests) == [200, 200, 200, 400]


def test_requests_may_arrive_byte_by_byte(server: PlaygroundServer) -> None:
    with connect(server) as connection:
        for byte in request(server, "{}") + GET.replace(b"\r\n", b"\n") + b"Connection: close\n\n":
            connection.sendall(bytes([byte]))
        assert statuses(read_to_end(connection)) == [200, 200]


def test_a_body_is_sent_after_100_continue(server: PlaygroundServer) -> None:
    with connect(server) as connection:
        connection.sendall(post(server, b"Content-Length: 2", b"Expect: 100-continue", b"Connection: close", body=b""))
        assert connection.recv(1000) == b"HTTP/1.1 100 Continue\r\n\r\n"
        connection.sendall(b"{}")
        assert statuses(read_to_end(connection)) == [200]
    # A request that is rejected gets no `100 Continue`.
    assert statuses_until_closed(
        server, post(server, b"Content-Length: 99999999", b"Expect: 100-continue", body=b"")
    ) == [413]


def test_a_client_of_http_1_0_is_answered_once(server: PlaygroundServer) -> None:
    assert statuses_until_closed(server, b"GET / HTTP/1.0\r\n" + HOST + b"\r\n") == [200]
    assert statuses_until_closed(server, b"GET / HTTP/1.0\r\n\r\n") == [403]
    assert statuses_until_closed(server, b"HEAD /none HTTP/1.0\r\n" + HOST + b"\r\n")[:1] == [404]
