"""Play games that speak the protocol of Godot RL Agents, by translation to and from ``tltl/1``.

Facts, from the public sources of https://github.com/edbeeching/godot_rl_agents (``godot_rl/core/godot_env.py``)
and https://github.com/edbeeching/godot_rl_agents_plugin (``addons/godot_rl_agents/sync.gd``), version 0.7 of
the protocol:

- The trainer listens on 127.0.0.1, by default at port 11008. The game connects; it takes the port from
  its argument ``--port=N``, its seed from ``--env_seed=N``, and may read other arguments ``--KEY=VALUE``.
- A message is four bytes with its length, the lowest byte first, and JSON in UTF-8: an object with a ``type``.
- The trainer sends ``handshake`` (``major_version`` and ``minor_version``, as texts), which is not answered, and
  ``env_info``. The game answers with ``env_info``: ``n_agents``, ``action_space`` and ``observation_space``. Each
  of the two is a list with an object for each agent; in older versions, one object for all agents.
- An action is ``{"size": N, "action_type": "discrete"}``, a whole number below N, or ``"continuous"``, N numbers
  from -1 to 1. An observation is ``{"size": N, "space": "discrete"}`` or ``{"size": [SHAPE], "space": "box"}``,
  perhaps with ``low`` and ``high``. If the name of a box contains ``2d``, its value is an array of bytes, as a text of
  hexadecimal digits.
- ``reset`` is answered by ``reset`` with ``obs``; ``action`` with ``action`` is answered by ``step`` with ``obs``,
  ``reward`` and ``done``. Each of these is a list with an item for each agent. ``call`` with ``method`` calls a
  method of each agent. ``close`` ends the game without an answer.

The protocol has no token, no scenes, and a seed only at the start of the game.
"""

from __future__ import annotations

import json
import secrets
import socket
import time
from base64 import b64encode
from collections.abc import Callable, Mapping, Sequence
from typing import Any, Final

from tltl_runtime.wire import json_text
from tltl_runtime.wire.byte_stream import ByteStream
from tltl_runtime.wire.channel import Channel
from tltl_runtime.wire.document import a_list, a_text, a_whole_number, an_object, member, wrong
from tltl_runtime.wire.errors import GameSilentError, MalformedMessageError
from tltl_runtime.wire.hello import VERSION
from tltlc.api import fileio

MAJOR_VERSION: Final = "0"
MINOR_VERSION: Final = "7"

_LOOK_S: Final = 0.05
"""Seconds between two checks whether the game has ended."""
_LENGTH_BYTES: Final = 4


def with_arguments(words: Sequence[str], port: int) -> tuple[str, ...]:
    """Return the command of a game with the arguments that tell it the port and, unless it has one, a random seed."""
    has_seed = any(word.startswith("--env_seed=") for word in words)
    seed = () if has_seed else (f"--env_seed={secrets.randbelow(2**31)}",)
    return (*words, f"--port={port}", *seed)


def accept(server: socket.socket, patience: float, has_ended: Callable[[], bool]) -> GodotRlChannel:
    """Wait until a game connects to ``server``, a listening socket; return the connection.

    ``has_ended`` returns whether the game has ended. Raises GameSilentError if it has, or after ``patience``
    seconds.
    """
    deadline = time.monotonic() + patience
    server.settimeout(_LOOK_S)
    while True:
        is_last = has_ended() or time.monotonic() > deadline
        try:
            connection, _ = server.accept()
        except TimeoutError:
            if is_last:
                raise GameSilentError from None
        else:
            connection.settimeout(None)
            return GodotRlChannel(ByteStream(connection))


class GodotRlChannel(Channel):
    """Sends and receives the messages of ``tltl/1`` to and from a game that speaks the other protocol."""

    def __init__(self, stream: ByteStream) -> None:
        self._stream = stream
        self._pictures: Mapping[str, list[int]] = {}
        """The shapes of the observations that are sent as hexadecimal digits."""
        self._step: dict[str, Any] = {}
        self._repeats = 0

    def hello(self, patience: float) -> dict[str, Any]:
        """Shake hands, and ask what the game is; return the answer as the ``hello`` of ``tltl/1``."""
        deadline = time.monotonic() + patience
        versions = {"major_version": MAJOR_VERSION, "minor_version": MINOR_VERSION}
        self._send({"type": "handshake", **versions}, deadline)
        self._send({"type": "env_info"}, deadline)
        info = self._receive("env_info", deadline, fileio.limits.WIRE_HELLO.size)
        agents = a_whole_number(info.get("n_agents"), "env_info.n_agents", 0)
        if agents != 1:
            raise MalformedMessageError(
                f"has {agents} agents, but tltlc plays games with one: let the others play by themselves"
            )
        observations = _of_first(info.get("observation_space"), "env_info.observation_space")
        actions = _of_first(info.get("action_space"), "env_info.action_space")
        path = "env_info.observation_space"
        self._pictures = {
            name: table["size"] for name, table in observations.items() if "2d" in name and "size" in table
        }
        parts = {name: _observation(name, table, member(path, name)) for name, table in observations.items()}
        path = "env_info.action_space"
        choices = {name: _action(table, member(path, name)) for name, table in actions.items()}
        body = {
            "tltl": VERSION,
            "name": "godot-rl",
            "signals": {},
            "actions": {"type": "dict", "spaces": choices},
            "observation": {"type": "dict", "spaces": parts},
        }
        return {"hello": body}

    def send(self, message: Any, patience: float) -> None:
        """Send a request."""
        deadline = time.monotonic() + patience
        self._stream.check_in_step()
        self._repeats = 0
        if "step" in message:
            body = message["step"]
            self._step = {"type": "action", "action": [body["action"]]}
            self._repeats = body.get("repeat", 1)
            self._send(self._step, deadline)
        else:
            self._send({"type": "close" if "close" in message else "reset"}, deadline)

    def receive(self, patience: float, limit: int = fileio.limits.WIRE_MESSAGE.size) -> Any:
        """Return the answer to the last request, as the message ``state``."""
        deadline = time.monotonic() + patience
        while True:
            kind = "step" if self._repeats else "reset"
            answer = self._receive(kind, deadline, limit)
            has_ended = bool(self._repeats) and _only(answer, "step", "done")
            if type(has_ended) is not bool:
                raise wrong("step.done[0]", "true or false", has_ended)
            self._repeats -= bool(self._repeats)
            if has_ended or not self._repeats:
                observation = self._observation(_only(answer, kind, "obs"), f"{kind}.obs[0]")
                return {"state": {"signals": {}, "observation": observation, "ended": has_ended}}
            self._stream.check_in_step()
            self._send(self._step, deadline)

    def close(self) -> None:
        """Close the connection."""
        self._stream.close()

    def with_msgpack(self) -> Channel:
        """Return this channel: the protocol has no MessagePack."""
        return self

    def _observation(self, value: Any, path: str) -> dict[str, Any]:
        parts = dict(an_object(value, path))
        for name, shape in self._pictures.items():
            if name in parts:
                text = a_text(parts[name], member(path, name))
                try:
                    data = bytes.fromhex(text)
                except ValueError:
                    raise wrong(member(path, name), "a text of hexadecimal digits", text) from None
                parts[name] = {"base64": b64encode(data).decode(), "dtype": "uint8", "shape": shape}
        return parts

    def _send(self, message: Mapping[str, Any], deadline: float) -> None:
        data = json.dumps(message, separators=(",", ":"), allow_nan=False).encode()
        self._stream.send(len(data).to_bytes(_LENGTH_BYTES, "little") + data, deadline - time.monotonic())

    def _receive(self, kind: str, deadline: float, limit: int) -> dict[str, Any]:
        """Return the next message, which must have the type ``kind``."""
        length = int.from_bytes(self._stream.exactly(_LENGTH_BYTES, deadline - time.monotonic()), "little")
        if length > limit:
            raise MalformedMessageError(f"sent a message of {length:,} bytes; at most {limit:,} are allowed")
        message = json_text.parse(self._stream.exactly(length, deadline - time.monotonic()))
        if not isinstance(message, dict) or message.get("type") != kind:
            sent = message.get("type") if isinstance(message, dict) else message
            raise MalformedMessageError(f"sent {json_text.value_text(sent)} instead of a message of the type `{kind}`")
        return message


def _of_first(value: Any, path: str) -> dict[str, Any]:
    """Return the spaces of the only agent: ``value`` itself, or the item of the list."""
    if isinstance(value, list) and len(value) == 1:
        value = value[0]
    spaces = an_object(value, path)
    return {name: an_object(table, member(path, name)) for name, table in spaces.items()}


def _only(message: dict[str, Any], kind: str, key: str) -> Any:
    """Return the value of the only agent in the list ``key`` of a message."""
    values = a_list(message.get(key), f"{kind}.{key}")
    if len(values) != 1:
        raise wrong(f"{kind}.{key}", "a list with one item", values)
    return values[0]


def _action(table: dict[str, Any], path: str) -> dict[str, Any]:
    """Return the space of an action as a space of ``tltl/1``."""
    if table.get("action_type") == "discrete":
        return {"type": "discrete", "n": table.get("size")}
    if table.get("action_type") == "continuous":
        return {"type": "box", "low": -1, "high": 1, "shape": [table.get("size")]}
    raise wrong(f"{path}.action_type", '"discrete" or "continuous"', table.get("action_type"))


def _observation(name: str, table: dict[str, Any], path: str) -> dict[str, Any]:
    """Return the space of a part of the observation as a space of ``tltl/1``.

    A box without ``low`` and ``high`` has no bounds: the plugin's default controller declares none, and its numbers
    may have any size.
    """
    if table.get("space") == "discrete":
        return {"type": "discrete", "n": table.get("size")}
    if table.get("space") == "box" and "2d" in name:
        return {"type": "box", "low": 0, "high": 255, "shape": table.get("size"), "dtype": "uint8"}
    if table.get("space") == "box":
        return {"type": "box", "low": table.get("low"), "high": table.get("high"), "shape": table.get("size")}
    raise wrong(f"{path}.space", '"box" or "discrete"', table.get("space"))
