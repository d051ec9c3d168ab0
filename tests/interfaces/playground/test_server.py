"""The server: the requests that it answers, and the requests that it rejects."""

from __future__ import annotations

import http.client
import json
import os
import signal
import socket
import struct
import subprocess
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from threading import Thread
from types import FrameType

import pytest

from tests.waiting import HANG_S, until
from tltlc.core.record import replace
from tltlc.diagnostics.diagnostic import TltlError
from tltlc.interfaces.playground import children, view
from tltlc.interfaces.playground.page_config import start
from tltlc.interfaces.playground.server import PlaygroundServer
from tltlc.io.limits import ANSWER, MESSAGE, PLAYGROUND, PLAYGROUND_CHILD, Connections

JSON = {"Content-Type": "application/json"}
PLACES = [f"place_{number}" for number in range(9)]
SLOW = "".join(
    [
        *(f"signal {name}: bool\n" for name in PLACES),
        *(f"spec s{number} = {' and '.join(f'eventually {name}' for name in PLACES)}\n" for number in range(200)),
    ]
)
"""Two hundred specs of 512 states. Each is within every budget, but all of them take minutes."""


PATIENT = replace(PLAYGROUND, idle_s=HANG_S, request_s=HANG_S, write_s=HANG_S, linger_s=HANG_S)
"""Limits that close no connection because a machine is slow."""


@contextmanager
def running_server(limit_s: float = HANG_S, connections: Connections = PATIENT) -> Iterator[PlaygroundServer]:
    """A running server, which by default has no short time limits."""
    with PlaygroundServer(0, limit_s, connections) as server:
        thread = Thread(target=server.serve_forever)
        thread.start()
        try:
            yield server
        finally:
            server.shutdown()
            thread.join()


@pytest.fixture(scope="module")
def server() -> Iterator[PlaygroundServer]:
    with running_server() as running:
        yield running


def ask(
    server: PlaygroundServer,
    method: str,
    path: str,
    body: str | bytes | None = None,
    headers: dict[str, str] | None = None,
) -> tuple[int, dict[str, str], bytes]:
    """Send a request with the server's token, unless the headers have another one; return status,
    headers and body."""
    connection = http.client.HTTPConnection("127.0.0.1", server.server_address[1], timeout=HANG_S)
    connection.request(method, path, body, {"Tltlc-Token": server.token, **(headers or {})})
    answer = connection.getresponse()
    result = answer.status, dict(answer.getheaders()), answer.read()
    connection.close()
    return result


def test_the_page_is_served_and_refers_to_no_other_site(server: PlaygroundServer) -> None:
    status, headers, page = ask(server, "GET", "/")
    assert (status, headers["Content-Type"]) == (200, "text/html; charset=utf-8")
    assert "default-src 'none'" in headers["Content-Security-Policy"]
    assert b"http" not in page.replace(b"http-equiv", b"")
    for name in server.page.files:
        status, headers, content = ask(server, "GET", f"/{name}")
        assert (status, content) == (200, server.page.files[name])
        assert name.endswith(".svg") or b"://" not in content, name
    assert headers["X-Content-Type-Options"] == "nosniff"


def test_the_server_answers_like_the_function(server: PlaygroundServer) -> None:
    text = "signal a: bool\nspec x = F a"
    body = json.dumps({"text": text, "spec": "x", "letters": [["a"]]})
    status, _, answer = ask(server, "POST", "/api", body, JSON)
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
        ("POST", "/api", "", {**JSON, "Content-Length": "-1"}, 400),
        ("POST", "/api", None, {**JSON, "Content-Length": str(MESSAGE.size + 1)}, 413),
        ("PUT", "/api", "{}", JSON, 405),
        ("GET", "/api", None, {}, 405),
        ("HEAD", "/api", None, {}, 405),
        ("OPTIONS", "/api", None, {}, 405),
        ("DELETE", "/main.js", None, {}, 405),
        ("POST", "/", "{}", JSON, 405),
        ("OPTIONS", "*", None, {}, 404),
        ("BREW", "/", None, {}, 501),
    ],
)
def test_invalid_requests_are_rejected(
    server: PlaygroundServer, method: str, path: str, body: str | bytes | None, headers: dict[str, str], status: int
) -> None:
    assert ask(server, method, path, body, headers)[0] == status


ELSEWHERE = [
    {"Origin": "https://game.example"},
    {"Origin": "null"},
    {"Origin": ""},
    {"Origin": "http://127.0.0.1:1"},
    {"Origin": "http://localhost", "Host": "127.0.0.1"},
    {"Sec-Fetch-Site": "cross-site"},
    {"Sec-Fetch-Site": "same-site"},
    {"Sec-Fetch-Site": "cross-site", "Sec-Fetch-Mode": "navigate"},
    {"Tltlc-Token": ""},
    {"Tltlc-Token": "another"},
    {"Tltlc-Token": "\xe9"},
]


@pytest.mark.parametrize("headers", ELSEWHERE, ids=str)
def test_requests_from_other_pages_or_without_the_token_are_rejected(
    server: PlaygroundServer, headers: dict[str, str]
) -> None:
    for method, body in (("POST", "{}"), ("GET", None), ("OPTIONS", None)):
        status, answer_headers, answer = ask(server, method, "/api", body, {**JSON, **headers})
        assert (status, answer) == (403, b"Forbidden\n")
        # A browser passes an answer to a page of another origin only if a header allows it.
        assert not any(name.lower().startswith("access-control") for name in answer_headers)


@pytest.mark.parametrize("headers", [headers for headers in ELSEWHERE if "Tltlc-Token" not in headers][:-1], ids=str)
def test_files_are_served_only_to_the_page_itself(server: PlaygroundServer, headers: dict[str, str]) -> None:
    assert ask(server, "GET", "/main.js", None, headers)[0] == 403
    assert ask(server, "GET", "/", None, headers)[0] == 403


def test_a_link_from_another_site_opens_the_page(server: PlaygroundServer) -> None:
    link = {"Sec-Fetch-Site": "cross-site", "Sec-Fetch-Mode": "navigate", "Tltlc-Token": ""}
    assert ask(server, "GET", "/", None, link)[0] == 200
    assert ask(server, "GET", "/main.js", None, link)[0] == 403


def test_the_page_is_served_under_each_name_of_the_host(server: PlaygroundServer) -> None:
    for host in (f"127.0.0.1:{server.server_address[1]}", "localhost:9000"):
        own = {"Host": host, "Origin": f"http://{host}", "Sec-Fetch-Site": "same-origin"}
        assert ask(server, "POST", "/api", "{}", {**JSON, **own})[0] == 200


def test_each_server_has_its_own_token(server: PlaygroundServer) -> None:
    with PlaygroundServer(0) as other:
        assert other.token != server.token
        assert len(other.token) >= 32
        assert other.address.endswith(f"/#token={other.token}")


def test_a_head_request_has_no_body(server: PlaygroundServer) -> None:
    status, headers, body = ask(server, "HEAD", "/")
    assert (status, body, headers["Content-Length"]) == (200, b"", str(len(server.page.files["index.html"])))


def test_a_client_that_disconnects_causes_no_error(server: PlaygroundServer, capfd: pytest.CaptureFixture[str]) -> None:
    for _ in range(3):
        with socket.create_connection(("127.0.0.1", server.server_address[1])) as gone:
            # The connection is reset: no data is left to send, and answers are refused immediately.
            gone.setsockopt(socket.SOL_SOCKET, socket.SO_LINGER, struct.pack("ii", 1, 0))
            gone.sendall(request(server, "{}"))
    assert ask(server, "POST", "/api", "{}", JSON)[0] == 200
    assert capfd.readouterr().err == ""


def test_a_large_text_reaches_a_child_that_reads_slowly(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(children, "_CHECK_S", 0.001)
    text = f"// {'far more than a pipe holds ' * 10_000}\nsignal a: bool\nspec x = F a"
    with running_server() as server:
        status, _, answer = ask(server, "POST", "/api", json.dumps({"text": text}), JSON)
    assert (status, json.loads(answer)["diagnostics"]) == (200, [])


def test_the_text_of_a_client_that_disconnected_is_abandoned() -> None:
    with running_server() as server:
        # There are more requests than children at once, so the waiting ones must be abandoned too.
        waiting = [
            socket.create_connection(("127.0.0.1", server.server_address[1])) for _ in range(children.MOST_AT_ONCE + 2)
        ]
        for connection in waiting:
            connection.sendall(slow_request(server))
        assert wait_until(lambda: len(server.children._running) == children.MOST_AT_ONCE)
        for connection in waiting:
            connection.close()
        assert wait_until(lambda: not server.children._running)
        assert json.loads(ask(server, "POST", "/api", "{}", JSON)[2]) == start()


def test_running_children_end_with_the_server() -> None:
    with (
        running_server() as server,
        socket.create_connection(("127.0.0.1", server.server_address[1])) as connection,
    ):
        connection.sendall(slow_request(server))
        assert wait_until(lambda: bool(server.children._running))
        (child,) = server.children._running
        server.server_close()
        assert child.wait(timeout=HANG_S)


def slow_request(server: PlaygroundServer) -> bytes:
    return request(server, json.dumps({"text": SLOW}))


def request(server: PlaygroundServer, body: str) -> bytes:
    head = (
        *("POST /api HTTP/1.1", "Host: localhost", "Content-Type: application/json"),
        *(f"Tltlc-Token: {server.token}", f"Content-Length: {len(body)}"),
    )
    return "\r\n".join([*head, "", body]).encode()


def wait_until(happens: Callable[[], bool]) -> bool:
    """Wait until the condition is true."""
    return until(happens, "the server")


def test_the_port_can_be_reused_at_once() -> None:
    with running_server() as server:
        port = server.server_address[1]
        connection = http.client.HTTPConnection("127.0.0.1", port, timeout=HANG_S)
        connection.request("GET", "/")
        connection.getresponse().read()
        # The server closes the connection first, which keeps the address in use for a while.
    with PlaygroundServer(port) as again:
        assert again.server_address[1] == port
    connection.close()


def test_a_text_of_the_maximal_file_size_is_accepted(server: PlaygroundServer) -> None:
    body = json.dumps({"text": '"\n' * (1 << 19)})
    status, _, answer = ask(server, "POST", "/api", body, JSON)
    assert (status, len(json.loads(answer)["diagnostics"]) > 0) == (200, True)


def test_localhost_is_accepted_as_host(server: PlaygroundServer) -> None:
    for name in ("localhost:1", "LocalHost", "127.0.0.1"):
        assert ask(server, "GET", "/", None, {"Host": name})[0] == 200


def test_a_slow_compilation_is_abandoned_and_the_next_text_answered() -> None:
    with running_server(limit_s=2.0) as server:
        (diagnostic,) = json.loads(ask(server, "POST", "/api", json.dumps({"text": SLOW}), JSON)[2])["diagnostics"]
        assert (diagnostic["code"], diagnostic["title"]) == ("TLT0775", "this takes longer than 2 s, so it was stopped")
        server.children._limit_s = HANG_S
        assert json.loads(ask(server, "POST", "/api", "{}", JSON)[2]) == start()


def test_a_child_that_hangs_is_killed(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    # A process that never answers stands in for an endless compilation.
    def hanging() -> subprocess.Popen[bytes]:
        command = ["sh", "-c", f"echo $$ > {tmp_path}/pid; exec sleep 60"]
        return subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE)

    monkeypatch.setattr(children, "_start_child", hanging)
    answering = children.Children(limit_s=0.3)
    pid = answering._ready.pid if answering._ready else 0
    answer = answering.answer(b"{}")
    answering.close()
    assert answer is not None
    assert json.loads(answer)["diagnostics"][0] == {
        "code": "TLT0775",
        "severity": "error",
        "title": "this takes longer than 0.3 s, so it was stopped",
        "help": "make the spec smaller: bounds and large conjunctions cost most",
        "labels": [],
        "fixes": [],
    }
    with pytest.raises(ProcessLookupError):
        os.kill(pid, 0)


def test_a_port_in_use_is_reported(server: PlaygroundServer) -> None:
    with pytest.raises(TltlError) as caught:
        PlaygroundServer(server.server_address[1])
    (diagnostic,) = caught.value.diagnostics
    assert (diagnostic.code, diagnostic.help) == (
        "TLT0776",
        "choose another port, or let the system choose one: `--port 0`",
    )
    assert diagnostic.title.startswith(f"cannot serve at 127.0.0.1:{server.server_address[1]}: ")


def program(code: str) -> list[str]:
    return [sys.executable, "-c", f"import sys; sys.path[:] = {sys.path!r}\n{code}"]


def replace_program(code: str, monkeypatch: pytest.MonkeyPatch) -> None:
    """Replace the program of the children."""
    pipe = subprocess.PIPE
    monkeypatch.setattr(children, "_start_child", lambda: subprocess.Popen(program(code), stdin=pipe, stdout=pipe))


@pytest.mark.skipif(sys.platform != "linux", reason="elsewhere the system holds no process to its memory")
def test_the_memory_of_a_child_is_limited(monkeypatch: pytest.MonkeyPatch) -> None:
    limits = subprocess.run(
        program(
            "import resource; from tltlc.interfaces.playground.child import limit_resources; limit_resources()\n"
            "print(*resource.getrlimit(resource.RLIMIT_AS), *resource.getrlimit(resource.RLIMIT_CPU))"
        ),
        capture_output=True,
        text=True,
        check=True,
    )
    memory, work = PLAYGROUND_CHILD.memory, PLAYGROUND_CHILD.work_s
    assert limits.stdout.split() == [str(limit) for limit in (memory, memory, work, work)]
    replace_program(
        "from tltlc.interfaces.playground import child, protocol\n"
        "protocol.view = lambda *_: bytearray(child.PLAYGROUND_CHILD.memory)\n"
        "child.main()",
        monkeypatch,
    )
    with running_server() as server:
        (diagnostic,) = json.loads(ask(server, "POST", "/api", '{"text": ""}', JSON)[2])["diagnostics"]
        assert (diagnostic["code"], diagnostic["title"]) == (
            "TLT0775",
            "this takes more memory than the playground has",
        )


ENDS = {
    "sys.exit(0)": "the compiler's process ended with exit status 0",
    "sys.exit(7)": "the compiler's process ended with exit status 7",
    "raise ImportError('a broken installation')": "the compiler's process ended with exit status 1",
    "raise MemoryError": "this takes more memory than the playground has",
}
if os.name == "posix":
    for name in ("SIGKILL", "SIGSEGV", "SIGXCPU"):
        ENDS[f"import os, signal; os.kill(os.getpid(), signal.{name})"] = (
            f"the signal {name} ended the compiler's process"
        )


@pytest.mark.parametrize(("code", "title"), ENDS.items(), ids=str)
def test_the_failure_of_a_child_is_reported(code: str, title: str, monkeypatch: pytest.MonkeyPatch) -> None:
    replace_program(
        "from tltlc.interfaces.playground import child, protocol\n"
        f"def fail(_): {code}\nprotocol.answer = fail\nchild.main()",
        monkeypatch,
    )
    answering = children.Children(HANG_S)
    try:
        answered = answering.answer(b'{"text": ""}')
    finally:
        answering.close()
    assert answered is not None
    (diagnostic,) = json.loads(answered)["diagnostics"]
    assert (diagnostic["code"], diagnostic["title"]) == ("TLT0775", title)
    assert ("spec" in diagnostic["help"]) == ("memory" in title or "SIGKILL" in title)


def test_a_child_that_died_while_idle_is_replaced() -> None:
    with running_server() as server:
        ready = server.children._ready
        assert ready is not None
        ready.kill()
        ready.wait()
        assert json.loads(ask(server, "POST", "/api", "{}", JSON)[2]) == start()


def test_pending_requests_are_abandoned_when_the_server_ends() -> None:
    answering = children.Children(HANG_S)
    outcomes: list[str] = []

    def wait_for_answer() -> None:
        try:
            outcomes.append(str(answering.answer(json.dumps({"text": SLOW}).encode())))
        except children.AbandonedError:
            outcomes.append("abandoned")

    asking = Thread(target=wait_for_answer)
    asking.start()
    assert wait_until(lambda: bool(answering._running))
    answering.close()
    asking.join()
    assert outcomes == ["abandoned"]


@pytest.mark.skipif(os.name != "posix", reason="limits of this kind are those of POSIX")
def test_an_existing_lower_limit_is_kept() -> None:
    code = (
        "import resource; from tltlc.interfaces.playground.child import limit_resources\n"
        "resource.setrlimit(resource.RLIMIT_CPU, (7, 7)); limit_resources()\n"
        "print(*resource.getrlimit(resource.RLIMIT_CPU))"
    )
    completed = subprocess.run(program(code), capture_output=True, text=True, check=True)
    assert completed.stdout.split() == ["7", "7"]


@pytest.mark.parametrize(
    "code",
    [
        "from tltlc.interfaces.playground import child, protocol\n"
        f"protocol.view = lambda *_: 'a' * {ANSWER.size}\nchild.main()",
        "while True: sys.stdout.write('a' * 100_000)",
    ],
    ids=["told", "without end"],
)
def test_an_answer_that_is_too_large_is_rejected(code: str, monkeypatch: pytest.MonkeyPatch) -> None:
    replace_program(code, monkeypatch)
    with running_server() as server:
        (diagnostic,) = json.loads(ask(server, "POST", "/api", '{"text": ""}', JSON)[2])["diagnostics"]
        assert (diagnostic["code"], diagnostic["title"]) == (
            "TLT0775",
            "the answer is larger than 32 MiB, so it was not sent",
        )


def test_the_next_request_retries_after_a_failed_start(monkeypatch: pytest.MonkeyPatch) -> None:
    with running_server() as server:
        with monkeypatch.context() as failing:
            failing.setattr(children, "_start_child", fails)
            # One process is running already.
            assert [ask(server, "POST", "/api", "{}", JSON)[0] for _ in range(3)] == [200, 503, 503]
        assert ask(server, "POST", "/api", "{}", JSON)[0] == 200


def fails() -> subprocess.Popen[bytes]:
    raise BlockingIOError("Resource temporarily unavailable")


@pytest.mark.filterwarnings("ignore:coroutine .* was never awaited:RuntimeWarning")
def test_an_interrupt_at_any_point_of_serving_ends_it(monkeypatch: pytest.MonkeyPatch) -> None:
    steps = 0
    while is_interrupted_at(steps, monkeypatch):
        steps += 1
    assert steps > 100


def is_interrupted_at(step: int, monkeypatch: pytest.MonkeyPatch) -> bool:
    """Run a server and interrupt it after ``step`` instructions; return False if it stops before."""
    code = (PlaygroundServer.serve_forever.__code__, PlaygroundServer._signals_wake_loop.__wrapped__.__code__)  # type: ignore[attr-defined]
    left = step

    def trace(frame: FrameType, event: str, _: object) -> object:
        nonlocal left
        if frame.f_code not in code:
            return None
        frame.f_trace_opcodes = True
        left -= event == "opcode"
        if left < 0:
            raise KeyboardInterrupt
        return trace

    def stop() -> None:
        if left >= 0:
            server._loop.stop()

    with PlaygroundServer(0) as server:
        monkeypatch.setattr(server._stopped, "wait", lambda: pytest.fail("it waits for itself"))
        server._loop.call_soon(stop)
        before = sys.gettrace()
        sys.settrace(trace)  # type: ignore[arg-type]
        try:
            server.serve_forever()
        except KeyboardInterrupt:
            return True
        finally:
            sys.settrace(before)
            # An interrupt while the server ends leaves its own one.
            signal.set_wakeup_fd(-1)
    return False
