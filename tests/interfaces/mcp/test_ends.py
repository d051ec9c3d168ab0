"""The ways in which a connection ends, with and without a running call."""

from __future__ import annotations

import json
import os
import signal
import subprocess
from collections.abc import Callable, Iterator
from contextlib import suppress
from pathlib import Path
from typing import Any

import pytest

from tests.interfaces.mcp.client import COMMAND, ENVIRONMENT, SPEC
from tests.interfaces.mcp.pipes import open_for_writing, wait_until_broken
from tests.waiting import HANG_S, until

Server = subprocess.Popen[str]
INITIALIZE = {"protocolVersion": "2025-06-18", "capabilities": {}, "clientInfo": {"name": "test", "version": "1"}}


def send(server: Server, **message: Any) -> None:
    assert server.stdin is not None
    server.stdin.write(json.dumps({"jsonrpc": "2.0", **message}) + "\n")
    server.stdin.flush()


def call(server: Server, number: int, tool: str, **arguments: Any) -> None:
    send(server, id=number, method="tools/call", params={"name": tool, "arguments": arguments})


def answer(server: Server) -> dict[str, Any]:
    assert server.stdout is not None
    message: dict[str, Any] = json.loads(server.stdout.readline())
    return message


@pytest.fixture
def server(tmp_path: Path) -> Iterator[Server]:
    """A connected server in the folder ``tmp_path``."""
    with subprocess.Popen(
        COMMAND,
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        cwd=tmp_path,
        env={**os.environ, **ENVIRONMENT},
        encoding="utf-8",
    ) as started:
        send(started, id=1, method="initialize", params=INITIALIZE)
        assert answer(started)["id"] == 1
        send(started, method="notifications/initialized")
        yield started
        if started.poll() is None:
            started.kill()


def hang_up(server: Server) -> None:
    assert server.stdin is not None
    server.stdin.close()


def interrupt(server: Server) -> None:
    server.send_signal(signal.SIGINT)


def terminate(server: Server) -> None:
    server.send_signal(signal.SIGTERM)


def kill(server: Server) -> None:
    server.kill()


ENDS = [(hang_up, 0)]
if os.name == "posix":
    ENDS += [(interrupt, 130), (terminate, 128 + signal.SIGTERM), (kill, -signal.SIGKILL)]


@pytest.mark.parametrize(("end", "status"), ENDS, ids=lambda value: getattr(value, "__name__", None))
def test_an_idle_server_and_its_processes_end(end: Callable[[Server], None], status: int, server: Server) -> None:
    call(server, 2, "check", text=SPEC)
    assert answer(server)["result"]["structuredContent"]["ok"]
    end(server)
    assert server.wait(HANG_S) == status
    assert server.stderr is not None
    # All processes of the server share its standard error, so it ends only with the last of them.
    assert server.stderr.read() == ""


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="needs named pipes")
@pytest.mark.parametrize("tool", ["explain", "regress"])
@pytest.mark.parametrize(("end", "status"), ENDS, ids=lambda value: getattr(value, "__name__", None))
def test_a_busy_server_and_its_processes_end(
    end: Callable[[Server], None], status: int, tool: str, server: Server, tmp_path: Path
) -> None:
    """The call reads from a pipe that nothing is written to, so it never ends by itself."""
    (tmp_path / "leave.tltl").write_text(SPEC, encoding="utf-8")
    pipe = tmp_path / "endless.csv"
    os.mkfifo(pipe)
    if tool == "explain":
        call(server, 2, "explain", path=pipe.name)
    else:
        call(server, 2, "regress", spec="leave.tltl", baseline=pipe.name, now=pipe.name)
    writing = open_for_writing(pipe)
    end(server)
    assert server.wait(HANG_S) == status
    wait_until_broken(writing)
    assert server.stderr is not None
    assert server.stderr.read() == ""


@pytest.mark.skipif(os.name != "posix", reason="a closed pipe is an error of POSIX systems")
def test_a_closed_pipe_ends_the_server(server: Server) -> None:
    assert server.stdout is not None
    os.dup2(os.open(os.devnull, os.O_RDONLY), server.stdout.fileno())

    def ends_while_it_answers() -> bool:
        # The server may end between two writes.
        with suppress(BrokenPipeError):
            send(server, id=2, method="ping")
        return server.poll() is not None

    until(ends_while_it_answers, "the end of the server")
    assert server.wait(HANG_S) == 141
    assert server.stderr is not None
    assert server.stderr.read() == ""
    with suppress(BrokenPipeError):
        hang_up(server)
