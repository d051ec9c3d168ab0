"""Malformed messages: each is answered or logged, and the next message is handled."""

from __future__ import annotations

import io
import json
from collections.abc import Iterator
from itertools import count
from pathlib import Path
from typing import Any

import pytest

from tests.interfaces.lsp.client import Client
from tests.interfaces.lsp.texts import ENDLESS
from tests.waiting import HANG_S, until
from tltlc.interfaces.lsp.paths import location_at, location_of, source_at, uri_of
from tltlc.interfaces.lsp.server import create
from tltlc.io.limits import MESSAGE

HERE = "file:///nowhere/a.tltl"
START = {"line": 0, "character": 0}


def request(method: Any, number: Any = 900, **params: Any) -> dict[str, Any]:
    return {"jsonrpc": "2.0", "id": number, "method": method, **({"params": params} if params else {})}


def notification(method: str, **params: Any) -> dict[str, Any]:
    message = request(method, **params)
    del message["id"]
    return message


def hover(uri: object = HERE, **position: object) -> dict[str, Any]:
    return request("textDocument/hover", textDocument={"uri": uri}, position={**START, **position})


@pytest.fixture
def client(tmp_path: Path) -> Iterator[Client]:
    """A client whose log need not be empty at the end."""
    started = Client(tmp_path)
    yield started
    if started.process.poll() is None:
        started.kill()


@pytest.fixture(scope="module")
def shared_client(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Client]:
    """One server for all messages that do not end it; a message of one test must not affect the
    next test."""
    started = Client(tmp_path_factory.mktemp("malformed"))
    yield started
    assert started.close() == 0


def send(client: Client, data: bytes, header: bytes | None = None) -> None:
    assert client.process.stdin
    client.process.stdin.write((b"Content-Length: %d\r\n\r\n" % len(data) if header is None else header) + data)
    client.process.stdin.flush()


def code_of(client: Client, number: object) -> int | None:
    """Return the code of the error that answers a message, or None for a result."""
    answer = client._next(lambda message: "method" not in message and message["id"] == number)
    code: int | None = answer["error"]["code"] if "error" in answer else None
    return code


def is_alive(client: Client) -> bool:
    return client.ask("textDocument/documentSymbol", {"textDocument": {"uri": HERE}}) is None


NUMBERS = count()


def lines_so_far(client: Client) -> int:
    """Return how many lines the server has logged, including one that this function makes it log."""
    uri = f"file:///nowhere/{next(NUMBERS)}.tltl"
    change = notification(
        "textDocument/didChange", textDocument={"uri": uri, "version": 1}, contentChanges=[{"text": ""}]
    )
    send(client, json.dumps(change).encode())
    until(lambda: any(uri in line for line in client.errors), "a line of the log")
    return next(number for number, line in enumerate(client.errors, 1) if uri in line)


NO_JSON = {"broken": b'{"jsonrpc": "2.0", oh', "UTF-16": b"\xff\xfe{}", "deep": b"[" * 100_000, "no text": b"\x80"}


@pytest.mark.parametrize("data", NO_JSON.values(), ids=NO_JSON)
def test_invalid_json_is_answered_with_a_parse_error(data: bytes, shared_client: Client) -> None:
    send(shared_client, data)
    assert code_of(shared_client, None) == -32700
    assert is_alive(shared_client)


WRONG = [
    ([], None, -32600),
    ([hover()], None, -32600),
    (42, None, -32600),
    (None, None, -32600),
    ({"id": 900, "method": "shutdown"}, 900, -32600),
    ({**hover(), "jsonrpc": "1.0"}, 900, -32600),
    ({"jsonrpc": "2.0", "id": 900}, 900, -32600),
    (request(5), 900, -32600),
    (request([]), 900, -32600),
    (request("textDocument/hover", {"a": 1}), None, -32600),
    (request("initialize", capabilities={}), 900, -32600),
    (request("textDocument/foo", a=1), 900, -32601),
    (request("foo/bar"), 900, -32601),
    (request("$/foo"), 900, -32601),
    (request("textDocument/hover"), 900, -32602),
    ({**hover(), "params": [1]}, 900, -32602),
    (request("textDocument/hover", textDocument={"uri": HERE}), 900, -32602),
    (hover(line=-1), 900, -32602),
    (hover(line="one"), 900, -32602),
    (hover(line=10**30), 900, -32602),
    (request("workspace/executeCommand", command="foo"), 900, -32602),
    (request("workspace/executeCommand", command="tltlc.runTests"), 900, -32602),
    (request("workspace/executeCommand", command="tltlc.runTests", arguments=[HERE]), 900, -32602),
    # Valid messages that refer to nothing.
    (hover(), 900, None),
    (hover(line=2**31 - 1, character=2**31 - 1), 900, None),
    (hover(""), 900, None),
    (hover("no uri at all"), 900, None),
    (hover("file://[oh/a.tltl"), 900, None),
    (hover("file:///a%00b.tltl"), 900, None),
    (hover("file:///dev/zero"), 900, None),
    (request("textDocument/codeLens", textDocument={"uri": HERE}), 900, None),
]


@pytest.mark.parametrize(("message", "number", "code"), WRONG, ids=lambda value: json.dumps(value)[:60])
def test_an_invalid_request_is_answered_with_its_code(
    message: Any, number: int | None, code: int | None, shared_client: Client
) -> None:
    send(shared_client, json.dumps(message).encode())
    assert code_of(shared_client, number) == code
    assert is_alive(shared_client)


def test_invalid_notifications_are_only_logged(client: Client) -> None:
    change = notification(
        "textDocument/didChange", textDocument={"uri": HERE, "version": 1}, contentChanges=[{"text": "signal a: bool"}]
    )
    for message in (
        notification("textDocument/didOpen"),
        notification("textDocument/didOpen", textDocument={"uri": HERE}),
        change,
        notification("foo/bar"),
        {"jsonrpc": "2.0", "id": "7", "result": None},
        {"jsonrpc": "2.0", "id": [], "error": {}},
    ):
        send(client, json.dumps(message).encode())
    assert is_alive(client)
    assert [message for message in client.received if message.get("id", 0) is None or "method" in message] == []
    client.kill()
    client._listening.join()
    assert len(client.errors) == 4
    assert client.errors[2] == (
        f"a message was refused (method: textDocument/didChange): cannot change a document that is not open: {HERE}\n"
    )


NOTEBOOK = {"uri": "file:///a.ipynb", "version": 1, "notebookType": "jupyter", "cells": []}
FOLDER = {"uri": "file:///never", "name": "never"}
UNTIMELY = [
    notification("$/cancelRequest", id=[]),
    notification("$/cancelRequest", id={"a": 1}),
    notification("$/cancelRequest", id=None),
    notification("$/cancelRequest"),
    notification("$/cancelRequest", id="never asked"),
    {**notification("$/cancelRequest"), "params": [1]},
    notification("notebookDocument/didOpen", notebookDocument=NOTEBOOK, cellTextDocuments=[]),
    notification("notebookDocument/didChange", notebookDocument={"uri": "file:///b.ipynb", "version": 1}, change={}),
    notification("notebookDocument/didSave", notebookDocument={"uri": "file:///b.ipynb"}),
    notification("notebookDocument/didClose", notebookDocument={"uri": "file:///b.ipynb"}, cellTextDocuments=[]),
    notification("textDocument/didClose", textDocument={"uri": HERE}),
    notification("textDocument/didSave", textDocument={"uri": HERE}),
    notification("window/workDoneProgress/cancel", token=[]),
    notification("window/workDoneProgress/cancel", token="never"),
    notification("workspace/didChangeWorkspaceFolders", event={"added": [], "removed": [FOLDER]}),
    notification("workspace/didChangeWorkspaceFolders", event={"added": [{"uri": "", "name": ""}], "removed": []}),
    notification("workspace/didChangeConfiguration", settings=[]),
    notification("workspace/didChangeWatchedFiles", changes=[{"uri": "no uri", "type": 2}]),
    notification("workspace/didDeleteFiles", files=[{"uri": "file://[oh/a.tltl"}]),
    notification("$/setTrace", value="loud"),
    {"jsonrpc": "2.0", "id": [], "result": 1},
    {"jsonrpc": "2.0", "id": {}, "error": {"code": 1, "message": "x"}},
    {"jsonrpc": "2.0", "id": None, "error": {"code": 1, "message": "x"}},
]


@pytest.mark.parametrize("message", UNTIMELY, ids=lambda value: json.dumps(value)[17:70])
def test_invalid_notifications_show_nothing_to_the_user(message: Any, shared_client: Client) -> None:
    before = len(shared_client.received)
    send(shared_client, json.dumps(message).encode())
    assert is_alive(shared_client)
    window_messages = [
        message for message in shared_client.received[before:] if str(message.get("method", "")).startswith("window/")
    ]
    assert window_messages == []


def test_a_notification_sent_as_a_request_is_answered(shared_client: Client) -> None:
    send(shared_client, json.dumps(request("$/cancelRequest", id=[])).encode())
    assert code_of(shared_client, 900) == -32602
    send(shared_client, json.dumps(request("notebookDocument/didClose", a=1)).encode())
    assert code_of(shared_client, 900) == -32600


def test_messages_before_initialization_are_rejected() -> None:
    server, sent = create(), io.BytesIO()
    server.protocol.set_writer(sent, include_headers=False)
    server.protocol.handle_message(notification("textDocument/didClose", textDocument={"uri": HERE}))
    assert sent.getvalue() == b""
    server.protocol.handle_message(hover())
    assert json.loads(sent.getvalue())["error"]["code"] == -32002


def test_messages_after_shutdown_are_rejected(client: Client) -> None:
    client.ask("shutdown", None)
    send(client, json.dumps(hover()).encode())
    assert code_of(client, 900) == -32600
    client.tell("exit", None)
    assert client.process.wait(HANG_S) == 0


@pytest.mark.parametrize(
    "header",
    ["content-length: %d\r\n\r\n", "Content-Length:%d\r\n\r\n", "Content-Type: a/b\r\nContent-Length: %d\n\n"],
)
def test_other_spellings_of_headers_are_accepted(header: str, shared_client: Client) -> None:
    data = json.dumps(hover()).encode()
    send(shared_client, data, (header % len(data)).encode())
    assert code_of(shared_client, 900) is None


@pytest.mark.parametrize(
    "header",
    [
        "Content-Length: many\r\n\r\n",
        "Content-Length: -5\r\n\r\n",
        "Content-Length: +5\r\n\r\n",
        "Content-Length: 0x5\r\n\r\n",
        "Content-Length: ²\r\n\r\n",
        f"Content-Length: {'9' * 5000}\r\n\r\n",
        f"{'a' * 100_000}\r\n\r\n",
        "\r\n",
        "\0 garbage\r\n\r\n",
        "Content-Length: 3\r\n\r\n",
    ],
    ids=lambda value: repr(value)[:24],
)
def test_an_invalid_header_loses_only_its_own_message(header: str, shared_client: Client) -> None:
    """The message is lost, but the following ones are read."""
    before = lines_so_far(shared_client)
    send(shared_client, json.dumps(hover()).encode(), header.encode())
    assert is_alive(shared_client)
    assert is_alive(shared_client)
    errors = shared_client.errors[before : lines_so_far(shared_client) - 1]
    assert errors
    assert all(line.startswith("a message ") for line in errors)


@pytest.mark.parametrize("length", [MESSAGE.size + 1, 10**9, 10**12, 10**40])
def test_a_length_above_the_limit_is_answered_without_waiting(length: int, shared_client: Client) -> None:
    """Either nothing or all of the message arrives; the server does not wait for missing bytes."""
    send(shared_client, b"", b"Content-Length: %d\r\n\r\n" % length)
    assert code_of(shared_client, None) == -32600
    send(shared_client, json.dumps(hover()).encode(), b"Content-Length: %d\r\n\r\n" % length)
    assert code_of(shared_client, None) == -32600
    assert is_alive(shared_client)


def test_a_message_above_the_limit_is_skipped_as_a_whole(shared_client: Client) -> None:
    item = {"uri": HERE, "languageId": "tltl", "version": 1, "text": "// Content-Length: 5\n" * (MESSAGE.size // 20)}
    send(shared_client, json.dumps(notification("textDocument/didOpen", textDocument=item)).encode())
    assert code_of(shared_client, None) == -32600
    assert is_alive(shared_client)


@pytest.mark.parametrize("more", [1, 10, 26, 100, 4000, MESSAGE.size - 1000])
def test_a_length_that_reaches_into_later_messages_loses_none(more: int, shared_client: Client) -> None:
    before = lines_so_far(shared_client)
    data = json.dumps(hover()).encode()
    send(shared_client, data, b"Content-Length: %d\r\n\r\n" % (len(data) + more))
    later = shared_client.start("textDocument/documentSymbol", {"textDocument": {"uri": HERE}})
    assert code_of(shared_client, 900) is None
    assert code_of(shared_client, later) is None
    assert is_alive(shared_client)
    errors = shared_client.errors[before : lines_so_far(shared_client) - 1]
    assert [line[:39] for line in errors] == ["a message is shorter than its header sa"]


@pytest.mark.parametrize("more", [1, 10, 4000, MESSAGE.size - 1000])
def test_a_length_that_is_too_large_delays_no_answer(more: int, shared_client: Client) -> None:
    """The editor waits for the answer before it sends anything else."""
    data = json.dumps(hover()).encode()
    send(shared_client, data, b"Content-Length: %d\r\n\r\n" % (len(data) + more))
    assert code_of(shared_client, 900) is None
    assert is_alive(shared_client)


def test_a_missing_empty_line_after_the_header_is_accepted(shared_client: Client) -> None:
    data = json.dumps(hover()).encode()
    send(shared_client, data, b"Content-Length: %d\r\n" % len(data))
    assert code_of(shared_client, 900) is None
    assert is_alive(shared_client)


@pytest.mark.parametrize("other", [-3, 0, 3])
def test_a_repeated_length_is_accepted(other: int, shared_client: Client) -> None:
    data = json.dumps(hover()).encode()
    header = b"Content-Length: %d\r\nContent-Length: %d\r\n\r\n" % (len(data) + other, len(data))
    send(shared_client, data, header)
    assert code_of(shared_client, 900) is None
    assert is_alive(shared_client)


def test_a_document_may_be_closed_during_a_request(client: Client, tmp_path: Path) -> None:
    uri = client.open(tmp_path / "slow.tltl", ENDLESS)
    running = client.start("workspace/executeCommand", {"command": "tltlc.runTests", "arguments": [uri, "slow"]})
    client.tell("textDocument/didClose", {"textDocument": {"uri": uri}})
    assert code_of(client, running) is None
    assert is_alive(client)


def test_invalid_uris_have_names() -> None:
    for uri in ("file://[oh/a.tltl", "untitled:a"):
        source = source_at(uri, "")
        assert (source.name, source.kind, source.location) == (f"<{uri}>", "text", uri)
        assert location_at(uri) == location_of(source) == uri_of(source) == uri
    assert Path(location_at(HERE)).is_absolute()
    assert source_at(HERE, "").kind == "file"
