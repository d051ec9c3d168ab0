"""How a session ends: in order, or in any other way, also while an automaton is built."""

from __future__ import annotations

import os
import signal
import time
from collections.abc import Callable
from pathlib import Path

import pytest

from tests.lsp.client import Client
from tests.lsp.texts import SLOW

SOON_S = 50.0
"""A hundred times what an end takes, and less than that after which the server itself gives up the automaton."""


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
@pytest.mark.parametrize(("end", "status"), ENDS, ids=lambda each: getattr(each, "__name__", None))
def test_an_end(end: Callable[[Client], None], status: int, busy: bool, client: Client, tmp_path: Path) -> None:
    if busy:
        uri = client.open(tmp_path / "slow.tltl", SLOW)
        assert client.diagnostics(uri) == []
        client.until_it_analyses(1.0)
    start = time.monotonic()
    end(client)
    assert client.process.wait(SOON_S) == status
    assert client.leaves_nobody_behind(SOON_S - (time.monotonic() - start))


def test_nobody_reads_any_more(client: Client, tmp_path: Path) -> None:
    uri = client.open(tmp_path / "a.tltl", "signal a: bool\n")
    client.diagnostics(uri)
    client.stop_reading()
    version = 2
    while client.process.poll() is None and version < 100:
        client.change(uri, f"signal a{version}: bool\n", version)
        version += 1
        time.sleep(0.1)
    assert client.process.wait(SOON_S) == 141


def test_what_nobody_asked_for_is_passed_over_in_silence(client: Client, tmp_path: Path) -> None:
    """The fixture looks at standard error, which editors show as errors."""
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


def test_a_document_that_is_closed_keeps_nobody_waiting(client: Client, tmp_path: Path) -> None:
    slow = client.open(tmp_path / "slow.tltl", SLOW)
    assert client.diagnostics(slow) == []
    client.until_it_analyses(1.0)
    other = client.open(tmp_path / "other.tltl", "signal a: bool\nspec s = G (a or not a)\n")
    assert client.diagnostics(other) == []
    client.tell("textDocument/didClose", {"textDocument": {"uri": slow}})
    start = time.monotonic()
    assert [each["code"] for each in client.diagnostics(other, bool)] == ["TLT0411"]
    assert time.monotonic() - start < SOON_S


def test_a_text_that_does_not_fit_into_a_pipe_stops_nobody(client: Client, tmp_path: Path) -> None:
    """It waits for the process that is to read it, and that has yet to start; the editor does not."""
    uri = client.open(tmp_path / "long.tltl", "signal a: bool\nspec s = G (a or not a)\n" + f"// {'a' * 900_000}\n")
    assert client.diagnostics(uri) == []
    assert [each["code"] for each in client.diagnostics(uri, bool)] == ["TLT0411"]
