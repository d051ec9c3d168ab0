"""Check a game that listens, in any language: it refuses a wrong token, and is played by one tltlc after the other."""

from __future__ import annotations

import json
import os
import socket
import subprocess
from collections.abc import Sequence
from typing import Any

from tests.runtime.wire.conversation import contains, state
from tests.waiting import HANG_S, until


def check_listening(command: Sequence[str]) -> None:
    """Start ``command --listen PORT``, play the counter game over several connections, and end the game."""
    port = _free_port()
    with subprocess.Popen([*command, "--listen", str(port)], env={**os.environ, "TLTL_TOKEN": "sesame"}) as game:
        try:
            hello = {"hello": {"tltl": 1, "token": "sesame"}}
            for first, reason in (
                ({"hello": {"tltl": 1, "token": "guessed"}}, "the token is wrong"),
                ({"hello": {"tltl": 9, "token": "sesame"}}, "this game speaks version 1"),
                ({"reset": {}}, "the first line must be a `hello`"),
                ("x" * 70000, "the first line must be a `hello`"),
            ):
                # The game may close the connection before it has read all of a long line.
                answer = _talk(port, [first])[-1:]
                assert not answer or reason in answer[0]["error"]["message"]
                assert answer or first == "x" * 70000
            for _ in range(2):
                declared, begun, moved = _talk(port, [hello, {"reset": {"seed": 2}}, {"step": {"action": 2}}])
                assert declared["hello"]["name"] == "counter" and "token" not in declared["hello"]
                assert contains(begun, state(3, 0)) and contains(moved, state(4, 1))
            assert game.poll() is None
        finally:
            game.kill()
            game.wait(HANG_S)


def _free_port() -> int:
    with socket.create_server(("127.0.0.1", 0)) as server:
        port: int = server.getsockname()[1]
        return port


def _talk(port: int, messages: Sequence[Any]) -> list[Any]:
    """Connect, as soon as the game listens, send each message and return the answers until there are no more."""
    answers = []
    connection = until(lambda: _connected(port), "the game to listen")
    assert connection is not None
    with connection, connection.makefile("rb") as lines:
        for message in messages:
            try:
                connection.sendall(json.dumps(message).encode() + b"\n")
                line = lines.readline()
            except ConnectionError:
                break
            if not line:
                break
            answers.append(json.loads(line))
    return answers


def _connected(port: int) -> socket.socket | None:
    try:
        return socket.create_connection(("127.0.0.1", port), HANG_S)
    except OSError:
        return None
