"""Messages that are wrong: each is answered or logged, and the next one counts."""

from __future__ import annotations

import io
import json
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

from tests.lsp.client import Client
from tests.lsp.texts import SLOW
from tests.waiting import HANG_S
from tltlc.lsp.paths import name_of
from tltlc.lsp.server import create

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


NO_JSON = {"broken": b'{"jsonrpc": "2.0", oh', "UTF-16": b"\xff\xfe{}", "deep": b"[" * 100_000, "no text": b"\x80"}


@pytest.mark.parametrize("data", NO_JSON.values(), ids=NO_JSON)
def test_what_is_no_json(data: bytes, client: Client) -> None:
    send(client, data)
    assert code_of(client, None) == -32700
    assert lives(client)


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


@pytest.fixture(scope="module")
def lasting(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Client]:
    """One server for all of them."""
    started = Client(tmp_path_factory.mktemp("malformed"))
    yield started
    assert started.close() == 0


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
def test_headers_in_other_ways(header: str, client: Client) -> None:
    data = json.dumps(hover()).encode()
    send(client, data, (header % len(data)).encode())
    assert code_of(client, 900) is None


@pytest.mark.parametrize(
    ("header", "lost"),
    [
        ("Content-Length: many\r\n\r\n", 0),
        ("Content-Length: -5\r\n\r\n", 0),
        (f"Content-Length: {'9' * 5000}\r\n\r\n", 0),
        ("\r\n", 0),
        ("\0 garbage\r\n\r\n", 0),
        ("Content-Length: 3\r\n\r\n", 0),
        ("Content-Length: 300\r\n\r\n", 1),
    ],
    ids=lambda each: repr(each)[:24],
)
def test_headers_that_are_wrong(header: str, lost: int, client: Client) -> None:
    """The message is lost, and of those behind it, only what the header claims."""
    send(client, json.dumps(hover()).encode(), header.encode())
    for _ in range(lost):
        client.start("textDocument/documentSymbol", {"textDocument": {"uri": HERE}})
    assert lives(client)
    assert lives(client)
    client.kill()
    client._listening.join()
    assert client.errors
    assert all(each.startswith("a message ") for each in client.errors)


def test_a_document_is_closed_while_a_request_is_under_way(client: Client, tmp_path: Path) -> None:
    uri = client.open(tmp_path / "slow.tltl", SLOW)
    running = client.start("workspace/executeCommand", {"command": "tltlc.runTests", "arguments": [uri, "slow"]})
    client.tell("textDocument/didClose", {"textDocument": {"uri": uri}})
    assert code_of(client, running) is None
    assert lives(client)


def test_names_of_uris_that_are_no_uris() -> None:
    assert name_of("file://[oh/a.tltl") == "<file://[oh/a.tltl>"
    assert name_of("untitled:a") == "<untitled:a>"
    assert Path(name_of(HERE)).is_absolute()
