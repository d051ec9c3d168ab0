"""The server: what it answers, and what it refuses."""

from __future__ import annotations

import http.client
import json
import os
import socket
import struct
import subprocess
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from threading import Thread
from time import monotonic, sleep

import pytest

from tltlc.diagnostics.diagnostic import TltlError
from tltlc.playground import children, view
from tltlc.playground.server import MOST_BYTES, Server
from tltlc.playground.start import start

JSON = {"Content-Type": "application/json"}
SLOW = "signal a: bool\nspec x = F[0,4000] a"


@contextmanager
def serving(limit_s: float = children.LIMIT_S) -> Iterator[Server]:
    with Server(0, limit_s) as server:
        thread = Thread(target=server.serve_forever)
        thread.start()
        try:
            yield server
        finally:
            server.shutdown()
            thread.join()


@pytest.fixture(scope="module")
def server() -> Iterator[Server]:
    # Long enough for a machine that has other work, too.
    with serving(60.0) as running:
        yield running


def ask(
    server: Server, method: str, path: str, body: str | bytes | None = None, headers: dict[str, str] | None = None
) -> tuple[int, dict[str, str], bytes]:
    connection = http.client.HTTPConnection("127.0.0.1", server.server_address[1], timeout=60)
    connection.request(method, path, body, headers or {})
    answer = connection.getresponse()
    found = answer.status, dict(answer.getheaders()), answer.read()
    connection.close()
    return found


def test_the_page_is_there_and_asks_nobody_else(server: Server) -> None:
    status, headers, page = ask(server, "GET", "/")
    assert (status, headers["Content-Type"]) == (200, "text/html; charset=utf-8")
    assert "default-src 'none'" in headers["Content-Security-Policy"]
    assert b"http" not in page.replace(b"http-equiv", b"")
    for name in server.files:
        status, headers, content = ask(server, "GET", f"/{name}")
        assert (status, content) == (200, server.files[name])
        assert name.endswith(".svg") or b"://" not in content, name
    assert headers["X-Content-Type-Options"] == "nosniff"


def test_it_answers_as_the_function_does(server: Server) -> None:
    text = "signal a: bool\nspec x = F a"
    asked = json.dumps({"text": text, "spec": "x", "letters": [["a"]]})
    status, _, answer = ask(server, "POST", "/api", asked, JSON)
    assert (status, json.loads(answer)) == (200, view(text, "x", [["a"]]))
    assert json.loads(ask(server, "POST", "/api", "{}", JSON)[2]) == start()


@pytest.mark.parametrize(
    ("method", "path", "body", "headers", "status"),
    [
        ("GET", "/../pyproject.toml", None, {}, 404),
        ("GET", "/none", None, {}, 404),
        ("GET", "/", None, {"Host": "game.example"}, 403),
        ("GET", "/", None, {"Host": "[nonsense"}, 403),
        ("GET", "/", None, {"Host": "127.0.0.1:x"}, 403),
        ("GET", "/", None, {"Host": ""}, 403),
        ("POST", "/api", "{}", {**JSON, "Host": "game.example"}, 403),
        ("POST", "/other", "{}", JSON, 404),
        ("POST", "/api", "{}", {"Content-Type": "text/plain"}, 415),
        ("POST", "/api", "nonsense", JSON, 400),
        ("POST", "/api", b"\xff", JSON, 400),
        ("POST", "/api", "[" * 100_000, JSON, 400),
        ("POST", "/api", "", JSON, 400),
        ("POST", "/api", "", {**JSON, "Content-Length": "-1"}, 411),
        ("POST", "/api", None, {**JSON, "Content-Length": str(MOST_BYTES + 1)}, 413),
        ("PUT", "/api", "{}", JSON, 501),
    ],
)
def test_what_it_refuses(
    server: Server, method: str, path: str, body: str | bytes | None, headers: dict[str, str], status: int
) -> None:
    assert ask(server, method, path, body, headers)[0] == status


def test_who_does_not_wait_for_an_answer_is_no_problem(server: Server, capfd: pytest.CaptureFixture[str]) -> None:
    for _ in range(3):
        with socket.create_connection(("127.0.0.1", server.server_address[1])) as gone:
            # Nothing is left to be sent, and what comes is refused at once.
            gone.setsockopt(socket.SOL_SOCKET, socket.SO_LINGER, struct.pack("ii", 1, 0))
            head = "POST /api HTTP/1.1\r\nHost: localhost\r\nContent-Type: application/json\r\nContent-Length: 2\r\n"
            gone.sendall(f"{head}\r\n{{}}".encode())
    assert ask(server, "POST", "/api", "{}", JSON)[0] == 200
    assert capfd.readouterr().err == ""


def test_a_large_text_arrives_whole_at_a_child_that_is_slow_to_read(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(children, "_LOOK_S", 0.001)
    text = f"// {'far more than a pipe holds ' * 10_000}\nsignal a: bool\nspec x = F a"
    with serving(limit_s=20.0) as server:
        status, _, answer = ask(server, "POST", "/api", json.dumps({"text": text}), JSON)
    assert (status, json.loads(answer)["diagnostics"]) == (200, [])


def test_a_text_that_nobody_waits_for_any_more_is_given_up() -> None:
    with serving(limit_s=120.0) as server:
        # More than are answered at once: those that wait for their turn give it up as well.
        waiting = [
            socket.create_connection(("127.0.0.1", server.server_address[1])) for _ in range(children.MOST_AT_ONCE + 2)
        ]
        for connection in waiting:
            connection.sendall(slow_request())
        assert eventually(lambda: len(server.children._running) == children.MOST_AT_ONCE)
        for connection in waiting:
            connection.close()
        assert eventually(lambda: not server.children._running)
        assert json.loads(ask(server, "POST", "/api", "{}", JSON)[2]) == start()


def test_what_is_at_work_ends_with_the_server() -> None:
    with (
        serving(limit_s=120.0) as server,
        socket.create_connection(("127.0.0.1", server.server_address[1])) as connection,
    ):
        connection.sendall(slow_request())
        assert eventually(lambda: bool(server.children._running))
        (child,) = server.children._running
        server.server_close()
        assert child.wait(timeout=30)


def slow_request() -> bytes:
    body = json.dumps({"text": SLOW})
    head = ("POST /api HTTP/1.1", "Host: localhost", "Content-Type: application/json", f"Content-Length: {len(body)}")
    return "\r\n".join([*head, "", body]).encode()


def eventually(happens: Callable[[], bool]) -> bool:
    """Whether something happens within some seconds."""
    end = monotonic() + 30
    while not happens() and monotonic() < end:
        sleep(0.02)
    return happens()


def test_the_port_is_free_again_at_once() -> None:
    with serving() as server:
        port = server.server_address[1]
        connection = http.client.HTTPConnection("127.0.0.1", port, timeout=60)
        connection.request("GET", "/")
        connection.getresponse().read()
        # The server hangs up first, which keeps the address for a while.
    with Server(port) as again:
        assert again.server_address[1] == port
    connection.close()


def test_a_text_as_large_as_a_file_may_be_is_a_request(server: Server) -> None:
    asked = json.dumps({"text": '"\n' * (1 << 19)})
    status, _, answer = ask(server, "POST", "/api", asked, JSON)
    assert (status, len(json.loads(answer)["diagnostics"]) > 0) == (200, True)


def test_localhost_is_a_name_for_it(server: Server) -> None:
    for name in ("localhost:1", "LocalHost", "127.0.0.1"):
        assert ask(server, "GET", "/", None, {"Host": name})[0] == 200


def test_what_takes_too_long_is_ended_and_the_next_text_is_answered() -> None:
    with serving(limit_s=2.0) as server:
        (said,) = json.loads(ask(server, "POST", "/api", json.dumps({"text": SLOW}), JSON)[2])["diagnostics"]
        assert (said["code"], said["title"]) == ("TLT0775", "this takes longer than 2 s, and was given up")
        assert json.loads(ask(server, "POST", "/api", "{}", JSON)[2]) == start()


def test_a_child_that_hangs_is_ended(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    # The fixed text of a process that never answers stands in for a compilation that does not end.
    def hanging() -> subprocess.Popen[bytes]:
        command = ["sh", "-c", f"echo $$ > {tmp_path}/pid; exec sleep 60"]
        return subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE)

    monkeypatch.setattr(children, "_started", hanging)
    answering = children.Children(limit_s=0.3)
    pid = answering._ready.pid if answering._ready else 0
    answer = answering.answer(b"{}")
    answering.close()
    assert answer is not None
    assert json.loads(answer)["diagnostics"][0] == {
        "code": "TLT0775",
        "severity": "error",
        "title": "this takes longer than 0.3 s, and was given up",
        "help": "make the spec smaller: bounds and large conjunctions cost most",
        "labels": [],
        "ways_out": [],
    }
    with pytest.raises(ProcessLookupError):
        os.kill(pid, 0)


def test_a_port_that_is_taken(server: Server) -> None:
    with pytest.raises(TltlError) as caught:
        Server(server.server_address[1])
    (said,) = caught.value.diagnostics
    assert (said.code, said.help) == ("TLT0776", "give another port, or 0 for any: `--port 0`")
    assert said.title.startswith(f"cannot serve at 127.0.0.1:{server.server_address[1]}: ")
