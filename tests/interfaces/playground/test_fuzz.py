"""Fuzzing with any bytes in any pieces: each request is answered or rejected, independent of the
pieces."""

from __future__ import annotations

import asyncio
import json
from collections.abc import Iterator
from http import HTTPStatus
from threading import Event
from typing import Any, cast

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.interfaces.playground.raw import statuses
from tltlc.interfaces.playground.connections import Connection, OpenConnections, Response
from tltlc.interfaces.playground.protocol import Question, RequestError, question
from tltlc.interfaces.playground.request_head import Head, RefusedError, read_head
from tltlc.io.limits import PLAYGROUND, REQUEST_HEAD, REQUEST_LINE

LINES = [
    "GET",
    "POST",
    " ",
    "  ",
    "/",
    "*",
    "/api",
    "%2e",
    "%zz",
    "HTTP/",
    "1.1",
    "1.0",
    "2.0",
    "9.9",
    "²",
    "\0",
    "\r",
    "?a=b",
]
NAMES = [
    "Host",
    "host",
    "Content-Length",
    "Transfer-Encoding",
    "Connection",
    "Expect",
    "Origin",
    "A",
    "A ",
    " A",
    "é",
    "",
]
VALUES = [
    "",
    "localhost",
    "0",
    "3",
    "5",
    "-1",
    "+1",
    "1_0",
    "²",
    "٣",
    "9" * 30,
    "chunked",
    "close",
    "100-continue",
    "\0",
    "\x7f",
]
RIGHT = b"GET / HTTP/1.1\r\nHost: localhost\r\n\r\n"
LAST = b"GET /last HTTP/1.1\r\nHost: localhost\r\nConnection: close\r\n\r\n"


def encoded(texts: list[str]) -> bytes:
    return "".join(texts).encode("utf-8")


FIRST = st.one_of(
    st.just(b"POST /api HTTP/1.1"),
    st.just(b"GET / HTTP/1.1"),
    st.lists(st.sampled_from(LINES), max_size=8).map(encoded),
)
HEADER = st.tuples(st.sampled_from(NAMES), st.sampled_from([":", ": ", "", ":\t"]), st.sampled_from(VALUES)).map(
    lambda parts: encoded(list(parts))
)
END = st.sampled_from([b"\r\n", b"\r\n", b"\r\n", b"\n", b"\r", b""])
HEAD = st.builds(
    lambda first, headers, ends: b"".join(
        line + end for line, end in zip([first, b"Host: localhost", *headers, b""], ends, strict=False)
    ),
    FIRST,
    st.lists(HEADER, max_size=3),
    st.lists(END, min_size=6, max_size=6),
)
REQUEST = st.one_of(
    st.just(RIGHT),
    HEAD,
    st.builds(lambda body, more: post(body, more), st.binary(max_size=20), st.sampled_from([-1, 0, 0, 0, 1])),
    st.binary(max_size=30),
    st.sampled_from([b"\r\n" * 20, b"A" * REQUEST_LINE.size, b"GET / HTTP/1.1\r\n" + b"A:b\r\n" * 200]),
)


def post(body: bytes, more: int = 0) -> bytes:
    return b"POST /api HTTP/1.1\r\nHost: localhost\r\nContent-Length: %d\r\n\r\n%b" % (max(len(body) + more, 0), body)


class Echo:
    """A site that answers each request with its body."""

    def check(self, head: Head) -> None:
        if head.path == "/none":
            raise RefusedError(HTTPStatus.NOT_FOUND)

    async def answer(self, head: Head, body: bytes, hung_up: Event) -> Response | None:
        assert len(body) == (head.length or 0)
        return Response(HTTPStatus.OK, {}, body)

    def error_response(self, status: HTTPStatus) -> Response:
        assert status.value >= 400
        return Response(status, {}, b"refused")


class Wire:
    """A transport that accepts everything immediately."""

    def __init__(self) -> None:
        self.sent = b""
        self.is_closed = False

    def set_write_buffer_limits(self, high: int) -> None:
        pass

    def write(self, data: bytes) -> None:
        assert not self.is_closed
        self.sent += data

    def get_write_buffer_size(self) -> int:
        return 0

    def can_write_eof(self) -> bool:
        return True

    def write_eof(self) -> None:
        pass

    def abort(self) -> None:
        self.is_closed = True

    close = abort


async def answers_to(pieces: list[bytes]) -> bytes:
    """Return the bytes sent in answer to these pieces, after which the connection ends."""
    wire = Wire()
    connections = OpenConnections(PLAYGROUND)
    connection = Connection(Echo(), connections)
    connection.connection_made(cast("Any", wire))
    for piece in pieces:
        connection.data_received(piece)
        # Wait until the piece is answered, before more data arrives.
        while connection._task and not connection._task.done():
            await connection._task
    connection.eof_received()
    connection.connection_lost(None)
    assert len(connections) == 0
    return wire.sent


@pytest.fixture(scope="module")
def loop() -> Iterator[asyncio.AbstractEventLoop]:
    made = asyncio.new_event_loop()
    yield made
    made.close()


def without_dates(answers: bytes) -> list[bytes]:
    return [line for line in answers.split(b"\r\n") if not line.startswith(b"Date: ")]


@given(st.lists(REQUEST, max_size=5).map(b"".join), st.lists(st.integers(1, 60), max_size=40))
def test_answers_do_not_depend_on_the_pieces(loop: asyncio.AbstractEventLoop, data: bytes, sizes: list[int]) -> None:
    pieces, rest = [], data
    for size in sizes:
        pieces.append(rest[:size])
        rest = rest[size:]
    whole = loop.run_until_complete(answers_to([data]))
    cut = loop.run_until_complete(answers_to([*pieces, rest]))
    codes = statuses(whole)
    # Whether `100 Continue` is sent depends on whether the body has already arrived.
    assert [code for code in statuses(cut) if code != 100] == [code for code in codes if code != 100]
    if b"100-continue" not in data:
        assert without_dates(whole) == without_dates(cut)
    # Nothing is answered after a rejection.
    assert all(status < 400 for status in codes[:-1])


@given(st.lists(st.one_of(st.just(RIGHT), st.builds(post, st.binary(max_size=20))), max_size=6))
def test_all_valid_requests_are_answered(loop: asyncio.AbstractEventLoop, requests: list[bytes]) -> None:
    sent = loop.run_until_complete(answers_to([b"".join(requests) + LAST + RIGHT]))
    assert statuses(sent) == [200] * (len(requests) + 1)


@given(st.one_of(REQUEST, st.binary(), st.lists(REQUEST).map(b"".join)))
def test_a_head_is_read_or_rejected(data: bytes) -> None:
    try:
        result = read_head(data)
    except RefusedError as error:
        assert 400 <= error.status.value < 600
        return
    if result is None:
        assert len(data) <= 2 * REQUEST_HEAD.size + REQUEST_LINE.size + 2
        return
    head, end = result
    assert 0 < end <= len(data)
    assert head.path == "*" or head.path.startswith("/")
    assert head.path.isprintable() or not head.path.isascii()
    assert head.length is None or 0 <= head.length < 10**18
    assert all(name == name.lower() and "\n" not in value and "\r" not in value for name, value in head.headers.items())
    # Bytes after a head do not change it.
    assert read_head(data[:end]) == read_head(data[:end] + b"\r\n: junk") == result


VALUE = st.recursive(
    st.none() | st.booleans() | st.integers() | st.floats() | st.text(max_size=5),
    lambda inner: st.lists(inner, max_size=3) | st.dictionaries(st.text(max_size=5), inner, max_size=3),
    max_leaves=8,
)
KEYS = st.sampled_from(["text", "spec", "letters", "lengths", "notation", "other"])
ASKED = st.one_of(
    VALUE, st.dictionaries(KEYS, VALUE), st.fixed_dictionaries({"text": st.text()}, optional={"letters": VALUE})
)


@given(st.one_of(ASKED.map(json.dumps), st.text(), st.text(alphabet='{}[]",:text0e9.-NaIfiny')))
def test_a_json_request_is_read_or_rejected(request_: str) -> None:
    try:
        parsed = question(request_)
    except RequestError:
        return
    if parsed is not None:
        assert isinstance(parsed, Question)
        assert isinstance(parsed.text, str)
        assert all(isinstance(letter, (list, dict)) for letter in parsed.letters)
        assert all(length is None or isinstance(length, (int, float)) for length in parsed.lengths)
