"""How bytes are split into messages, however they arrive and whatever is wrong with them."""

from __future__ import annotations

import json

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tltlc.interfaces.lsp.frames import Body, Fault, Frames, MessageFrame
from tltlc.interfaces.lsp.json_end import JsonEnd
from tltlc.io.limits import MESSAGE, MESSAGE_HEAD

MESSAGES = (b"{}", b'{"a": [1, "}"]}', b'{"text": "Content-Length: 3\\r\\n\\r\\n"}', b"[" + b"7, " * 300 + b"8]")


def with_header(data: bytes, extra: int = 0) -> bytes:
    return b"Content-Length: %d\r\n\r\n%b" % (len(data) + extra, data)


def frames(*pieces: bytes) -> list[MessageFrame]:
    reader = Frames()
    return [frame for piece in pieces for frame in reader.feed(piece)] + reader.end()


def bodies(*pieces: bytes) -> list[bytes]:
    return [frame.data for frame in frames(*pieces) if isinstance(frame, Body)]


def test_messages_are_split_by_their_headers() -> None:
    data = b"".join(map(with_header, MESSAGES))
    assert frames(data) == [Body(message) for message in MESSAGES]
    assert frames(*(data[at : at + 1] for at in range(len(data)))) == [Body(message) for message in MESSAGES]


@pytest.mark.parametrize(
    "head",
    [
        b"content-length:%d\r\n\r\n",
        b"Content-Length: \t%d \r\n\r\n",
        b"Content-Type: a; charset=utf-8\r\nContent-Length: %d\r\n\r\n",
        b"Content-Length: %d\r\nContent-Type: a\r\n\r\n",
        b"Content-Length: 000%d\n\n",
        b"\r\n\r\nContent-Length: %d\r\n\r\n",
    ],
)
def test_headers_may_be_written_in_several_ways(head: bytes) -> None:
    assert frames(head % 2 + b"{}" + with_header(b"[]")) == [Body(b"{}"), Body(b"[]")]


@pytest.mark.parametrize("extra", [*range(1, 80), 1000, MESSAGE.size - 100])
def test_a_header_within_a_body_ends_the_body(extra: int) -> None:
    typed = b"Content-Type: a/b\r\n" + with_header(b"[]")
    for following in (with_header(b"[]") * 3, typed * 3):
        data = with_header(b"{}", extra) + following
        assert bodies(data) == [b"{}", b"[]", b"[]", b"[]"]
        assert bodies(*(data[at : at + 1] for at in range(len(data)))) == [b"{}", b"[]", b"[]", b"[]"]


def test_a_broken_body_also_ends_at_the_next_header() -> None:
    assert bodies(with_header(b'{"a": "b', 40) + with_header(b"[]")) == [b'{"a": "b', b"[]"]


@pytest.mark.parametrize("extra", [1, 2, 80, MESSAGE.size - 1000])
@pytest.mark.parametrize("message", MESSAGES)
def test_a_body_is_complete_at_its_last_bracket(message: bytes, extra: int) -> None:
    """An editor that waits for the answer sends nothing more."""
    data = with_header(message, extra)
    assert Frames().feed(data) == [Body(message)]
    reader = Frames()
    assert [reader.feed(data[at : at + 1]) for at in range(len(data))][-1] == [Body(message)]
    # The fault is detected only when more bytes arrive.
    assert reader.feed(with_header(b"[]")) == [
        Fault(f"a message is shorter than its header says: {len(message)} bytes, not {len(message) + extra}"),
        Body(b"[]"),
    ]


@pytest.mark.parametrize("padding", [b" ", b"\n", b"\r\n\r\n", b"\t" * 100])
def test_white_space_at_the_end_of_a_body_is_no_fault(padding: bytes) -> None:
    data = with_header(b"{}" + padding) * 2
    assert frames(data) == [Body(b"{}")] * 2
    assert frames(*(data[at : at + 1] for at in range(len(data)))) == [Body(b"{}")] * 2


def test_bytes_after_the_last_bracket_are_reported_once_and_skipped() -> None:
    fault = Fault("a message is shorter than its header says: 2 bytes, not 10")
    for data in (with_header(b"{} nothing", 0), with_header(b"{} no\nthin"), with_header(b"{}} = {}}", 1)):
        assert frames(data + with_header(b"[]")) == [Body(b"{}"), fault, Body(b"[]")]


@given(st.recursive(st.none() | st.text(), st.lists, max_leaves=20), st.integers(1, 200), st.integers(0, 10**9))
def test_the_end_of_a_json_text_is_found_in_pieces_of_any_size(value: object, size: int, more: int) -> None:
    message = json.dumps({'\\"}': value}, ensure_ascii=more % 2 == 0).encode()
    end, data = JsonEnd(), bytearray()
    for at in range(0, len(message), size):
        assert end.find(data, len(message) + more) is None
        # Each byte is read only once, except the first half of an escape.
        assert end._at >= len(data) - 1
        data += message[at : at + size]
    assert end.find(data, len(message) + more) == len(message)


def test_a_length_above_the_limit_is_reported_at_once() -> None:
    reader = Frames()
    (fault,) = reader.feed(b"Content-Length: %d\r\n\r\n" % (MESSAGE.size + 1))
    assert fault == Fault("a message is larger than 4 MiB and is skipped", is_answered=True)
    assert reader.feed(b"{" + b"a" * 100_000 + b"}") == []
    # Of the skipped bytes, at most the size of a header is kept.
    assert len(reader._buffer) <= MESSAGE_HEAD.size
    assert reader.feed(with_header(b"{}")) == [Body(b"{}")]


def test_skipped_bytes_are_reported_once() -> None:
    (fault, *rest) = frames(b"Content-Length: -5\r\n\r\n{\n" + b' "a": 1,\n' * 1000 + b"}" + with_header(b"{}"))
    assert fault == Fault(r"a message without a header `Content-Length` is skipped: b'Content-Length: -5\r\n'")
    assert rest == [Body(b"{}")]


def test_the_bytes_left_at_the_end_are_a_message() -> None:
    assert bodies(with_header(b"{}", 5)) == [b"{}"]
    assert bodies(b"Content-Length: 5\r\n") == []


PIECES = st.one_of(
    st.sampled_from(MESSAGES).map(with_header),
    st.builds(with_header, st.sampled_from(MESSAGES), st.integers(-3, 100)),
    st.sampled_from(
        [
            b"Content-Length: ",
            b"Content-Type: a\r\n",
            b"\r\n",
            b"\n",
            b"-",
            b"+1",
            b"{",
            b"}",
            b'"',
            b"a" * 9000,
            b"9" * 20,
        ]
    ),
    st.binary(max_size=20),
)


@given(st.lists(PIECES, max_size=8).map(b"".join), st.lists(st.integers(1, 40), max_size=60))
def test_the_split_does_not_depend_on_the_pieces(data: bytes, sizes: list[int]) -> None:
    pieces, rest = [], data
    for size in sizes:
        pieces.append(rest[:size])
        rest = rest[size:]
    frames_at_once, frames_in_pieces = frames(data), frames(*pieces, rest)
    assert [frame for frame in frames_at_once if isinstance(frame, Body)] == [
        frame for frame in frames_in_pieces if isinstance(frame, Body)
    ]
    assert [type(frame) for frame in frames_at_once] == [type(frame) for frame in frames_in_pieces]


WRONG = st.sampled_from(
    [
        *(
            b"Content-Length: %b\r\n\r\n{}" % length
            for length in (b"-2", b"+2", b"many", b"", b"2.0", b"\xb2", b"9" * 70)
        ),
        *(with_header(b'{"a": 1}', extra) for extra in range(-7, 100)),
        with_header(b"{}", MESSAGE.size),
        b"Content-Length: 2\r\n{}",
        b"Content-Length: 1\r\nContent-Length: 2\r\n\r\n{}",
        b"a" * 10_000,
        b"\r\n",
        b"\0\n",
    ]
)


@given(st.lists(WRONG, max_size=5).map(b"".join), st.sampled_from(MESSAGES))
def test_a_valid_message_after_invalid_ones_is_read(wrong: bytes, right: bytes) -> None:
    assert bodies(wrong + with_header(right))[-1] == right


@given(st.recursive(st.none() | st.text(), st.lists, max_leaves=20).map(lambda value: json.dumps([value]).encode()))
def test_a_valid_message_is_never_cut(message: bytes) -> None:
    assert frames(with_header(message) * 2) == [Body(message)] * 2
