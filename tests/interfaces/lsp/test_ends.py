"""The ways in which a session ends, with and without a running analysis."""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
from collections.abc import Callable
from contextlib import suppress
from itertools import count
from pathlib import Path
from typing import Any

import pytest

from tests.interfaces.lsp.client import Client
from tests.interfaces.lsp.texts import ENDLESS
from tests.waiting import HANG_S, until


def shut_down(client: Client) -> None:
    client.ask("shutdown", None)
    client.tell("exit", None)


def leave(client: Client) -> None:
    client.tell("exit", None)


def hang_up(client: Client) -> None:
    assert client.process.stdin
    client.process.stdin.close()


def interrupt(client: Client) -> None:
    client.process.send_signal(signal.SIGINT)


def terminate(client: Client) -> None:
    client.process.send_signal(signal.SIGTERM)


def kill(client: Client) -> None:
    client.process.kill()


ENDS = [(shut_down, 0), (leave, 1), (hang_up, 1)]
if os.name == "posix":
    ENDS += [(interrupt, 130), (terminate, 128 + signal.SIGTERM), (kill, -signal.SIGKILL)]


@pytest.mark.parametrize("busy", [False, True], ids=["idle", "busy"])
@pytest.mark.parametrize(("end", "status"), ENDS, ids=lambda value: getattr(value, "__name__", None))
def test_the_server_and_its_processes_end(
    end: Callable[[Client], None], status: int, busy: bool, client: Client, tmp_path: Path
) -> None:
    if busy:
        uri = client.open(tmp_path / "slow.tltl", ENDLESS)
        assert client.diagnostics(uri) == []
        client.wait_for_analyses()
    end(client)
    assert client.process.wait(HANG_S) == status
    client.wait_for_processes()


_SIGNAL_IN_ANOTHER_THREAD = """
import signal, threading, time
from tltlc.interfaces.cli.main import main

def send():
    # Wait until the main thread sleeps, which it does while it waits for the editor.
    path = "/proc/self/task/%d/stat" % threading.main_thread().native_id
    while signal.getsignal(signal.SIGTERM) is signal.SIG_DFL or open(path).read().rpartition(")")[2].split()[0] != "S":
        time.sleep(0.01)
    time.sleep(0.2)
    signal.pthread_kill(threading.get_ident(), signal.SIGTERM)

threading.Thread(target=send, daemon=True).start()
main(["lsp"])
"""


@pytest.mark.skipif(sys.platform != "linux", reason="reads the state of a thread in /proc")
def test_a_signal_that_does_not_interrupt_the_main_thread_ends_the_server() -> None:
    process = subprocess.Popen([sys.executable, "-c", _SIGNAL_IN_ANOTHER_THREAD], stdin=subprocess.PIPE)
    try:
        assert process.wait(HANG_S) == 128 + signal.SIGTERM
    finally:
        process.kill()
        assert process.stdin is not None
        process.stdin.close()


def test_a_closed_pipe_ends_the_server(client: Client, tmp_path: Path) -> None:
    uri = client.open(tmp_path / "a.tltl", "signal a: bool\n")
    client.diagnostics(uri)
    client.stop_reading()
    versions = count(2)

    def ends_while_a_text_changes() -> bool:
        version = next(versions)
        # The server may end between two writes.
        with suppress(BrokenPipeError):
            client.change(uri, f"signal a{version}: bool\n", version)
        return client.process.poll() is not None

    until(ends_while_a_text_changes, "the end of the server")
    assert client.process.wait(HANG_S) == 141


def test_unknown_notifications_are_ignored_silently(client: Client, tmp_path: Path) -> None:
    """The fixture checks standard error, which editors show as errors."""
    client.tell("$/cancelRequest", {"id": 1})
    client.tell("workspace/didChangeConfiguration", {"settings": {}})
    client.tell("$/setTrace", {"value": "off"})
    client.tell("textDocument/didSave", {"textDocument": {"uri": "file:///nowhere/a.tltl"}})
    assert (
        client.ask(
            "textDocument/hover",
            {"textDocument": {"uri": "file:///nowhere/a.tltl"}, "position": {"line": 0, "character": 0}},
        )
        is None
    )
    assert client.close() == 0


def test_a_closed_document_does_not_block_others(client: Client, tmp_path: Path) -> None:
    slow = client.open(tmp_path / "slow.tltl", ENDLESS)
    assert client.diagnostics(slow) == []
    client.wait_for_analyses()
    other = client.open(tmp_path / "other.tltl", "signal a: bool\nspec s = G (a or not a)\n")
    assert client.diagnostics(other) == []
    client.tell("textDocument/didClose", {"textDocument": {"uri": slow}})
    assert [diagnostic["code"] for diagnostic in client.diagnostics(other, bool)] == ["TLT0411"]


def test_a_text_larger_than_a_pipe_blocks_nothing(client: Client, tmp_path: Path) -> None:
    """The text waits for the analysis process to start and read it; the editor does not wait."""
    uri = client.open(tmp_path / "long.tltl", "signal a: bool\nspec s = G (a or not a)\n" + f"// {'a' * 900_000}\n")
    assert client.diagnostics(uri) == []
    assert [diagnostic["code"] for diagnostic in client.diagnostics(uri, bool)] == ["TLT0411"]


def test_requests_pending_at_the_end_are_dropped_silently(tmp_path: Path) -> None:
    uri = (tmp_path / "a.tltl").as_uri()
    document = {"uri": uri, "languageId": "tltl", "version": 1, "text": "signal a: bool\nspec s = F a\n"}
    params = {"textDocument": {"uri": uri}, "position": {"line": 0, "character": 7}, "newName": "b"}
    messages: list[dict[str, Any]] = [
        {"id": 1, "method": "initialize", "params": {"processId": None, "rootUri": None, "capabilities": {}}},
        {"method": "initialized", "params": {}},
        {"method": "textDocument/didOpen", "params": {"textDocument": document}},
        {"id": 2, "method": "textDocument/rename", "params": params},
        {"id": 3, "method": "workspace/symbol", "params": {"query": ""}},
        {"id": 4, "method": "shutdown"},
        {"method": "exit"},
    ]
    bodies = [json.dumps({"jsonrpc": "2.0", **message}).encode() for message in messages]
    input_bytes = b"".join(b"Content-Length: %d\r\n\r\n%s" % (len(body), body) for body in bodies)
    completed = subprocess.run(
        [sys.executable, "-m", "tltlc", "lsp"], input=input_bytes, capture_output=True, timeout=HANG_S, check=False
    )
    assert (completed.returncode, completed.stderr) == (0, b"")
