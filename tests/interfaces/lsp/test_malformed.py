"""Messages that are wrong: each is answered or logged, and the next one counts."""

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
from tltlc.interfaces.lsp.paths import name_of
from tltlc.interfaces.lsp.server import create
from tltlc.io.limits import MESSAGE

HERE = "file:///nowhere/a.tltl"
START = {"line": 0, "character": 0}


def asked(method: Any, number: Any = 900, **params: Any) -> dict[str, Any]:
    return {"jsonrpc": "2.0", "id": number, "method": method, **({"params": params} if params else {})}


def told(method: str, **params: Any) -> dict[str, Any]:
    message = asked(method, **params)
    del message["id"]
    return message


def hover(uri: object = HERE, **position: object) -> dict[str, Any]:
    return asked("textDocument/hover", textDocument={"uri": uri}, position={**START, **position})


@pytest.fixture
def client(tmp_path: Path) -> Iterator[Client]:
    """Its log is not empty at the end."""
    started = Client(tmp_path)
    yield started
    if started.process.poll() is None:
        started.kill()


@pytest.fixture(scope="module")
def lasting(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Client]:
    """One server for all that does not end it: what one test sends may cost no message of the next one, either."""
    started = Client(tmp_path_factory.mktemp("malformed"))
    yield started
    assert started.close() == 0


def send(client: Client, data: bytes, header: bytes | None = None) -> None:
    assert client.process.stdin
    client.process.stdin.write((b"Content-Length: %d\r\n\r\n" % len(data) if header is None else header) + data)
    client.process.stdin.flush()


def code_of(client: Client, number: object) -> int | None:
    """The code of the error that answers a message; None for a result."""
    answer = client._next(lambda message: "method" not in message and message["id"] == number)
    code: int | None = answer["error"]["code"] if "error" in answer else None
    return code


def lives(client: Client) -> bool:
    return client.ask("textDocument/documentSymbol", {"textDocument": {"uri": HERE}}) is None


NUMBERS = count()


def lines_so_far(client: Client) -> int:
    """How many lines the server has logged, up to one that it is made to log now."""
    uri = f"file:///nowhere/{next(NUMBERS)}.tltl"
    change = told("textDocument/didChange", textDocument={"uri": uri, "version": 1}, contentChanges=[{"text": ""}])
    send(client, json.dumps(change).encode())
    until(lambda: any(uri in line for line in client.errors), "a line of the log")
    return next(number for number, line in enumerate(client.errors, 1) if uri in line)


NO_JSON = {"broken": b'{"jsonrpc": "2.0", oh', "UTF-16": b"\xff\xfe{}", "deep": b"[" * 100_000, "no text": b"\x80"}


@pytest.mark.parametrize("data", NO_JSON.values(), ids=NO_JSON)
def test_what_is_no_json(data: bytes, lasting: Client) -> None:
    send(lasting, data)
    assert code_of(lasting, None) == -32700
    assert lives(lasting)


WRONG = [
    ([], None, -32600),
    ([hover()], None, -32600),
    (42, None, -32600),
    (None, None, -32600),
    ({"id": 900, "method": "shutdown"}, 900, -32600),
    ({**hover(), "jsonrpc": "1.0"}, 900, -32600),
    ({"jsonrpc": "2.0", "id": 900}, 900, -32600),
    (asked(5), 900, -32600),
    (asked([]), 900, -32600),
    (asked("textDocument/hover", {"a": 1}), None, -32600),
    (asked("initialize", capabilities={}), 900, -32600),
    (asked("textDocument/foo", a=1), 900, -32601),
    (asked("foo/bar"), 900, -32601),
    (asked("$/foo"), 900, -32601),
    (asked("textDocument/hover"), 900, -32602),
    ({**hover(), "params": [1]}, 900, -32602),
    (asked("textDocument/hover", textDocument={"uri": HERE}), 900, -32602),
    (hover(line=-1), 900, -32602),
    (hover(line="one"), 900, -32602),
    (hover(line=10**30), 900, -32602),
    (asked("workspace/executeCommand", command="foo"), 900, -32602),
    (asked("workspace/executeCommand", command="tltlc.runTests"), 900, -32602),
    (asked("workspace/executeCommand", command="tltlc.runTests", arguments=[HERE]), 900, -32602),
    # What is right, but leads nowhere.
    (hover(), 900, None),
    (hover(line=2**31 - 1, character=2**31 - 1), 900, None),
    (hover(""), 900, None),
    (hover("no uri at all"), 900, None),
    (hover("file://[oh/a.tltl"), 900, None),
    (hover("file:///a%00b.tltl"), 900, None),
    (hover("file:///dev/zero"), 900, None),
    (asked("textDocument/codeLens", textDocument={"uri": HERE}), 900, None),
]


@pytest.mark.parametrize(("message", "number", "code"), WRONG, ids=lambda each: json.dumps(each)[:60])
def test_a_wrong_request(message: Any, number: int | None, code: int | None, lasting: Client) -> None:
    send(lasting, json.dumps(message).encode())
    assert code_of(lasting, number) == code
    assert lives(lasting)


def test_what_is_told_wrongly_is_logged_alone(client: Client) -> None:
    change = told(
        "textDocument/didChange", textDocument={"uri": HERE, "version": 1}, contentChanges=[{"text": "signal a: bool"}]
    )
    for message in (
        told("textDocument/didOpen"),
        told("textDocument/didOpen", textDocument={"uri": HERE}),
        change,
        told("foo/bar"),
        {"jsonrpc": "2.0", "id": "7", "result": None},
        {"jsonrpc": "2.0", "id": [], "error": {}},
    ):
        send(client, json.dumps(message).encode())
    assert lives(client)
    assert [each for each in client.said if each.get("id", 0) is None or "method" in each] == []
    client.kill()
    client._listening.join()
    assert len(client.errors) == 4
    assert client.errors[2] == (
        f"a message was refused (method: textDocument/didChange): a document was changed that is not open: {HERE}\n"
    )


NOTEBOOK = {"uri": "file:///a.ipynb", "version": 1, "notebookType": "jupyter", "cells": []}
FOLDER = {"uri": "file:///never", "name": "never"}
UNTIMELY = [
    told("$/cancelRequest", id=[]),
    told("$/cancelRequest", id={"a": 1}),
    told("$/cancelRequest", id=None),
    told("$/cancelRequest"),
    told("$/cancelRequest", id="never asked"),
    {**told("$/cancelRequest"), "params": [1]},
    told("notebookDocument/didOpen", notebookDocument=NOTEBOOK, cellTextDocuments=[]),
    told("notebookDocument/didChange", notebookDocument={"uri": "file:///b.ipynb", "version": 1}, change={}),
    told("notebookDocument/didSave", notebookDocument={"uri": "file:///b.ipynb"}),
    told("notebookDocument/didClose", notebookDocument={"uri": "file:///b.ipynb"}, cellTextDocuments=[]),
    told("textDocument/didClose", textDocument={"uri": HERE}),
    told("textDocument/didSave", textDocument={"uri": HERE}),
    told("window/workDoneProgress/cancel", token=[]),
    told("window/workDoneProgress/cancel", token="never"),
    told("workspace/didChangeWorkspaceFolders", event={"added": [], "removed": [FOLDER]}),
    told("workspace/didChangeWorkspaceFolders", event={"added": [{"uri": "", "name": ""}], "removed": []}),
    told("workspace/didChangeConfiguration", settings=[]),
    told("workspace/didChangeWatchedFiles", changes=[{"uri": "no uri", "type": 2}]),
    told("workspace/didDeleteFiles", files=[{"uri": "file://[oh/a.tltl"}]),
    told("$/setTrace", value="loud"),
    {"jsonrpc": "2.0", "id": [], "result": 1},
    {"jsonrpc": "2.0", "id": {}, "error": {"code": 1, "message": "x"}},
    {"jsonrpc": "2.0", "id": None, "error": {"code": 1, "message": "x"}},
]


@pytest.mark.parametrize("message", UNTIMELY, ids=lambda each: json.dumps(each)[17:70])
def test_nothing_that_is_told_wrongly_is_shown_to_the_user(message: Any, lasting: Client) -> None:
    before = len(lasting.said)
    send(lasting, json.dumps(message).encode())
    assert lives(lasting)
    shown = [each for each in lasting.said[before:] if str(each.get("method", "")).startswith("window/")]
    assert shown == []


def test_what_cannot_be_cancelled_is_answered_if_it_is_asked(lasting: Client) -> None:
    send(lasting, json.dumps(asked("$/cancelRequest", id=[])).encode())
    assert code_of(lasting, 900) == -32602
    send(lasting, json.dumps(asked("notebookDocument/didClose", a=1)).encode())
    assert code_of(lasting, 900) == -32600


def test_what_comes_before_the_beginning() -> None:
    server, sent = create(), io.BytesIO()
    server.protocol.set_writer(sent, include_headers=False)
    server.protocol.handle_message(told("textDocument/didClose", textDocument={"uri": HERE}))
    assert sent.getvalue() == b""
    server.protocol.handle_message(hover())
    assert json.loads(sent.getvalue())["error"]["code"] == -32002


def test_what_comes_behind_the_end(client: Client) -> None:
    client.ask("shutdown", None)
    send(client, json.dumps(hover()).encode())
    assert code_of(client, 900) == -32600
    client.tell("exit", None)
    assert client.process.wait(HANG_S) == 0


@pytest.mark.parametrize(
    "header",
    ["content-length: %d\r\n\r\n", "Content-Length:%d\r\n\r\n", "Content-Type: a/b\r\nContent-Length: %d\n\n"],
)
def test_headers_in_other_ways(header: str, lasting: Client) -> None:
    data = json.dumps(hover()).encode()
    send(lasting, data, (header % len(data)).encode())
    assert code_of(lasting, 900) is None


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
    ids=lambda each: repr(each)[:24],
)
def test_headers_that_are_wrong(header: str, lasting: Client) -> None:
    """The message is lost, and none behind it."""
    before = lines_so_far(lasting)
    send(lasting, json.dumps(hover()).encode(), header.encode())
    assert lives(lasting)
    assert lives(lasting)
    errors = lasting.errors[before : lines_so_far(lasting) - 1]
    assert errors
    assert all(each.startswith("a message ") for each in errors)


@pytest.mark.parametrize("length", [MESSAGE.size + 1, 10**9, 10**12, 10**40])
def test_a_length_above_the_limit_is_answered_at_once_and_keeps_nobody_waiting(length: int, lasting: Client) -> None:
    """Nothing of the message comes, or all of it; the bytes that are missing are not waited for."""
    send(lasting, b"", b"Content-Length: %d\r\n\r\n" % length)
    assert code_of(lasting, None) == -32600
    send(lasting, json.dumps(hover()).encode(), b"Content-Length: %d\r\n\r\n" % length)
    assert code_of(lasting, None) == -32600
    assert lives(lasting)


def test_a_message_above_the_limit_is_passed_over_as_a_whole(lasting: Client) -> None:
    item = {"uri": HERE, "languageId": "tltl", "version": 1, "text": "// Content-Length: 5\n" * (MESSAGE.size // 20)}
    send(lasting, json.dumps(told("textDocument/didOpen", textDocument=item)).encode())
    assert code_of(lasting, None) == -32600
    assert lives(lasting)


@pytest.mark.parametrize("more", [1, 10, 26, 100, 4000, MESSAGE.size - 1000])
def test_a_length_that_reaches_into_the_next_messages_loses_none(more: int, lasting: Client) -> None:
    before = lines_so_far(lasting)
    data = json.dumps(hover()).encode()
    send(lasting, data, b"Content-Length: %d\r\n\r\n" % (len(data) + more))
    later = lasting.start("textDocument/documentSymbol", {"textDocument": {"uri": HERE}})
    assert code_of(lasting, 900) is None
    assert code_of(lasting, later) is None
    assert lives(lasting)
    errors = lasting.errors[before : lines_so_far(lasting) - 1]
    assert [each[:39] for each in errors] == ["a message is shorter than its header sa"]


@pytest.mark.parametrize("more", [1, 10, 4000, MESSAGE.size - 1000])
def test_a_length_that_is_too_large_keeps_no_answer_back(more: int, lasting: Client) -> None:
    """The editor waits for the answer before it sends anything else."""
    data = json.dumps(hover()).encode()
    send(lasting, data, b"Content-Length: %d\r\n\r\n" % (len(data) + more))
    assert code_of(lasting, 900) is None
    assert lives(lasting)


def test_an_empty_line_that_is_missing(lasting: Client) -> None:
    data = json.dumps(hover()).encode()
    send(lasting, data, b"Content-Length: %d\r\n" % len(data))
    assert code_of(lasting, 900) is None
    assert lives(lasting)


@pytest.mark.parametrize("other", [-3, 0, 3])
def test_a_length_that_is_repeated(other: int, lasting: Client) -> None:
    data = json.dumps(hover()).encode()
    header = b"Content-Length: %d\r\nContent-Length: %d\r\n\r\n" % (len(data) + other, len(data))
    send(lasting, data, header)
    assert code_of(lasting, 900) is None
    assert lives(lasting)


def test_a_document_is_closed_while_a_request_is_under_way(client: Client, tmp_path: Path) -> None:
    uri = client.open(tmp_path / "slow.tltl", ENDLESS)
    running = client.start("workspace/executeCommand", {"command": "tltlc.runTests", "arguments": [uri, "slow"]})
    client.tell("textDocument/didClose", {"textDocument": {"uri": uri}})
    assert code_of(client, running) is None
    assert lives(client)


def test_names_of_uris_that_are_no_uris() -> None:
    assert name_of("file://[oh/a.tltl") == "<file://[oh/a.tltl>"
    assert name_of("untitled:a") == "<untitled:a>"
    assert Path(name_of(HERE)).is_absolute()
