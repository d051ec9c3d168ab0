"""Play games that speak the protocol of Unity's ML-Agents, by translation to and from ``tltl/1``.

Facts, from the package mlagents-envs 0.28.0 on PyPI (``rpc_communicator.py``, ``environment.py``, ``rpc_utils.py``,
``side_channel`` and the descriptors in ``communicator_objects``), version 1.5.0 of the protocol:

- The trainer is a gRPC server, and the game its client. The service ``communicator_objects.UnityToExternalProto`` has
  the method ``Exchange``: the game sends what has happened, and the answer is what to do. A game takes the port
  from its arguments ``--mlagents-port N``; by default it is 5005, in the editor 5004.
- Both messages are a ``UnityMessageProto``. The first message of the game has its versions; the answer has a seed,
  versions and capabilities. The second message is empty; the answer to it is the first command.
- Commands are STEP (with the actions of each agent that waits for one), RESET and QUIT. The game answers STEP and
  RESET with a list of agents for each behavior: those that wait for a decision, and those whose episode has ended
  (``done``). An agent whose episode has ended, and which has begun the next one, is in the list twice.
- The first message in which a behavior occurs has its ``BrainParametersProto``, with the actions; the shapes of
  observations are those of the observations themselves.
- Side channels are in a field of bytes: for each message the id of a channel, a length and the message. One channel
  sets the speed of the engine, another one the environment parameters.

The package itself is not used: its generated code cannot be imported beside a protobuf of today.
"""

from __future__ import annotations

import queue
import secrets
import struct
import time
import uuid
from collections.abc import Callable, Iterable, Mapping, Sequence
from math import prod
from typing import Any, Final

import numpy as np

from tltl_runtime.wire import protobuf
from tltl_runtime.wire.channel import Channel
from tltl_runtime.wire.errors import GameGoneError, GameSilentError, MalformedMessageError
from tltl_runtime.wire.hello import VERSION
from tltl_runtime.wire.protobuf import Fields, field
from tltl_runtime.wire.server import cannot_listen, listen, place_text
from tltlc.api import Diagnostic, TltlError, fileio

COMMUNICATION_VERSION: Final = "1.5.0"
PACKAGE_VERSION: Final = "0.28.0"
SERVICE: Final = "communicator_objects.UnityToExternalProto"

_LOOK_S: Final = 0.05
"""Seconds between two checks whether the game has ended."""
_TO_SEND_S: Final = 1.0
"""Seconds in which the last answer reaches the game."""
_OTHER: Final = "`mlagents-learn`"
"""The program that also uses the ports of ML-Agents."""
_OK: Final = 200
_STEP, _RESET, _QUIT = 0, 1, 2
_SPEED: Final = uuid.UUID("e951342c-4f7e-11ea-b238-784f4387d1f7")
_PARAMETERS: Final = uuid.UUID("534c891e-810f-11ea-a9d0-822485860400")
_TIME_SCALE, _FRAME_RATE, _CAPTURE_RATE = 2, 3, 4
_CAPABILITIES: Final = (1, 4, 6)
"""The fields of UnityRLCapabilitiesProto that are true: the base, hybrid actions, observations of variable length."""


def with_arguments(words: Sequence[str], port: int) -> tuple[str, ...]:
    """Return the command of a game with the arguments that tell it the port."""
    return (*words, "--mlagents-port", str(port))


class MlAgentsChannel(Channel):
    """Sends and receives the messages of ``tltl/1`` to and from a game that speaks the other protocol.

    The game connects to ``port`` of ``host``; 0 stands for a free one. ``parameters`` are the values of environment
    parameters by name.

    Raises:
        WireError: TLT0790, tltlc cannot listen at the port.
        TltlError: TLT0730, the package ``grpcio`` is not installed.
    """

    def __init__(self, host: str, port: int, parameters: Mapping[str, float]) -> None:
        self._from_game: queue.SimpleQueue[bytes] = queue.SimpleQueue()
        self._to_game: queue.SimpleQueue[bytes | None] = queue.SimpleQueue()
        self._server, self.port = _started(host, port, self._exchange)
        self._parameters = parameters
        self._has_ended: Callable[[], bool] = lambda: False
        self._behavior = ""
        self._names: tuple[str, ...] = ()
        self._continuous = 0
        self._branches: tuple[int, ...] = ()
        self._action: bytes = b""
        self._repeats = 0

    def hello(self, patience: float, has_ended: Callable[[], bool]) -> dict[str, Any]:
        """Wait for the game, and ask what it is; return the answer as the ``hello`` of ``tltl/1``.

        ``has_ended`` returns whether the game has ended.
        """
        self._has_ended = has_ended
        deadline = time.monotonic() + patience
        output = protobuf.message(self._take(deadline), 2)
        version = protobuf.text(protobuf.message(output, 2), 2)
        if version.partition(".")[0] != COMMUNICATION_VERSION.partition(".")[0]:
            raise MalformedMessageError(f"speaks version `{version}` of ML-Agents' protocol; tltlc speaks version 1")
        capabilities = b"".join(field(number, 1) for number in _CAPABILITIES)
        seed = field(1, secrets.randbelow(2**31))
        versions = field(2, COMMUNICATION_VERSION) + field(3, PACKAGE_VERSION)
        self._put(field(2, seed + versions + field(4, capabilities) + field(5, 1)))
        self._take(deadline)
        self._command(_RESET, _side_channels(self._parameters))
        while True:
            output = protobuf.message(self._take(deadline), 2)
            brains = protobuf.messages(protobuf.message(output, 2), 5)
            if brains:
                return {"hello": self._declaration(brains, output)}
            self._command(_STEP)

    def send(self, message: Any, patience: float) -> None:
        """Send a request."""
        self._repeats = 0
        if "step" in message:
            self._repeats = message["step"].get("repeat", 1)
            self._action = self._action_bytes(message["step"]["action"])
            self._command(_STEP, self._action)
        elif "close" in message:
            self._command(_QUIT)
        else:
            self._command(_RESET, _side_channels(self._parameters))

    def receive(self, patience: float, limit: int = fileio.limits.WIRE_MESSAGE.size) -> Any:
        """Return the answer to the last request, as the message ``state``."""
        deadline = time.monotonic() + patience
        is_step = self._repeats > 0
        while True:
            agents = self._agents(protobuf.message(self._take(deadline), 2))
            ended = [agent for agent in agents if protobuf.whole(agent, 8)]
            waiting = [agent for agent in agents if not protobuf.whole(agent, 8)]
            if max(len(ended), len(waiting)) > 1:
                raise MalformedMessageError("has several agents, but tltlc plays games with one")
            self._repeats -= bool(self._repeats and waiting)
            if is_step and ended:
                return self._state(ended[0], has_ended=True)
            if waiting and not self._repeats:
                return self._state(waiting[0], has_ended=False)
            # The agent asks for no decision yet, or the action is to be repeated.
            self._command(_STEP, self._action if waiting else b"")

    def close(self) -> None:
        """Close the connection."""
        self._to_game.put(None)
        self._server.stop(_TO_SEND_S).wait()

    def with_msgpack(self) -> Channel:
        """Return this channel: the protocol has no MessagePack."""
        return self

    def _exchange(self, request: bytes, context: Any) -> bytes:
        """Give the game's message to :meth:`_take`, and wait for the answer; gRPC calls this in a thread of its own."""
        import grpc

        self._from_game.put(request)
        reply = self._to_game.get()
        if reply is None:
            context.abort(grpc.StatusCode.UNAVAILABLE, "tltlc has closed the connection")
        return reply or b""

    def _take(self, deadline: float) -> Fields:
        """Return the fields of the game's next message."""
        while True:
            has_ended = self._has_ended()
            try:
                return protobuf.fields(self._from_game.get(timeout=_LOOK_S))
            except queue.Empty:
                if has_ended:
                    raise GameGoneError from None
                if time.monotonic() > deadline:
                    raise GameSilentError from None

    def _put(self, unity_input: bytes) -> None:
        self._to_game.put(field(1, field(1, _OK)) + field(3, unity_input))

    def _command(self, command: int, more: bytes = b"") -> None:
        self._put(field(1, more + field(4, command)))

    def _declaration(self, brains: list[Fields], output: Fields) -> dict[str, Any]:
        """Return the content of the ``hello``, and keep the names and the actions that the game declares."""
        names = [protobuf.text(brain, 7) for brain in brains]
        if len(names) != 1:
            raise MalformedMessageError(f"has {len(names)} behaviors, {', '.join(names)}, but tltlc plays one")
        self._behavior = names[0]
        agents = self._agents(output)
        waiting = [agent for agent in agents if not protobuf.whole(agent, 8)]
        if len(waiting) != 1:
            raise MalformedMessageError(f"has {len(waiting)} agents that wait, but tltlc plays games with one agent")
        seen = protobuf.messages(waiting[0], 13)
        self._names = _unique(protobuf.text(part, 8) or f"observation_{index}" for index, part in enumerate(seen))
        parts = {
            name: {"type": "box", "low": None, "high": None, "shape": protobuf.wholes(part, 1)}
            for name, part in zip(self._names, seen, strict=True)
        }
        actions = protobuf.message(brains[0], 9)
        self._continuous, self._branches = protobuf.whole(actions, 1), tuple(protobuf.wholes(actions, 3))
        if not self._continuous and not self._branches:
            raise MalformedMessageError(f"gives the behavior `{self._behavior}` no actions")
        return {
            "tltl": VERSION,
            "name": self._behavior or "ml-agents",
            "signals": {},
            "actions": self._action_space(),
            "observation": {"type": "dict", "spaces": parts},
        }

    def _action_space(self) -> dict[str, Any]:
        box = {"type": "box", "low": -1, "high": 1, "shape": [self._continuous]}
        choices: dict[str, Any] = {"type": "multi_discrete", "nvec": list(self._branches)}
        if len(self._branches) == 1:
            choices = {"type": "discrete", "n": self._branches[0]}
        if self._continuous and self._branches:
            return {"type": "dict", "spaces": {"continuous": box, "discrete": choices}}
        return box if self._continuous else choices

    def _action_bytes(self, action: Any) -> bytes:
        """Return the field of a command with the action of the only agent."""
        parts = action if isinstance(action, dict) else {"continuous": action, "discrete": action}
        body = b""
        if self._continuous:
            body += protobuf.packed_floats(6, np.array(parts["continuous"], np.float32))
        if self._branches:
            body += protobuf.packed_wholes(7, np.atleast_1d(np.array(parts["discrete"], np.int64)))
        return field(1, field(1, self._behavior) + field(2, field(1, body)))

    def _agents(self, output: Fields) -> list[Fields]:
        """Return the agents of the behavior in an output of the game."""
        entries = protobuf.messages(protobuf.message(output, 1), 2)
        lists = [protobuf.message(entry, 2) for entry in entries if protobuf.text(entry, 1) == self._behavior]
        return [agent for agents in lists for agent in protobuf.messages(agents, 1)]

    def _state(self, agent: Fields, *, has_ended: bool) -> dict[str, Any]:
        seen = protobuf.messages(agent, 13)
        if len(seen) != len(self._names):
            raise MalformedMessageError(f"sent {len(seen)} observations, but {len(self._names)} at first")
        values = {name: _array(part, name) for name, part in zip(self._names, seen, strict=True)}
        return {"state": {"signals": {}, "observation": values, "ended": has_ended}}


def _started(host: str, port: int, exchange: Callable[[bytes, Any], bytes]) -> tuple[Any, int]:
    """Start a gRPC server whose method Exchange is ``exchange``; return it, and its port."""
    try:
        from concurrent.futures import ThreadPoolExecutor

        import grpc
    except ModuleNotFoundError:
        title = "games that speak `ml-agents` need the package `grpcio`, which is not installed"
        raise TltlError([Diagnostic("TLT0730", title, help="install it: `pip install grpcio`")]) from None
    place = place_text(host, port)
    size = fileio.limits.WIRE_MESSAGE.size
    options = (("grpc.so_reuseport", 0), ("grpc.max_receive_message_length", size))
    server = grpc.server(ThreadPoolExecutor(1), options=options)
    handler = grpc.unary_unary_rpc_method_handler(exchange)
    server.add_generic_rpc_handlers((grpc.method_handlers_generic_handler(SERVICE, {"Exchange": handler}),))
    try:
        chosen: int = server.add_insecure_port(place)
    except RuntimeError as error:
        listen(host, port, _OTHER).close()  # This says why the port cannot be used; gRPC does not.
        raise cannot_listen(place, error, _OTHER) from None
    server.start()
    return server, chosen


def _array(part: Fields, name: str) -> dict[str, Any]:
    """Return an observation as an array for a message."""
    if protobuf.whole(part, 2):
        raise MalformedMessageError(f"sent `{name}` as a PNG: set the compression of this sensor to None")
    data, shape = protobuf.floats(protobuf.message(part, 4), 1), protobuf.wholes(part, 1)
    if min(shape, default=1) < 0 or len(data) != 4 * prod(shape):
        raise MalformedMessageError(f"sent `{name}` with {len(data)} bytes, which do not fill its shape {shape}")
    return {"bytes": data, "dtype": "float32", "shape": shape}


def _unique(names: Iterable[str]) -> tuple[str, ...]:
    """Return the names; one that occurred before gets its number at the end."""
    result: dict[str, None] = {}
    for name in names:
        result[f"{name}_{len(result)}" if name in result else name] = None
    return tuple(result)


def _side_channels(parameters: Mapping[str, float]) -> bytes:
    """Return the field of a command that sets the speed, as ``mlagents-learn`` does, and environment parameters."""
    messages = [
        (_SPEED, struct.pack("<if", _TIME_SCALE, 20.0)),
        (_SPEED, struct.pack("<ii", _FRAME_RATE, -1)),
        (_SPEED, struct.pack("<ii", _CAPTURE_RATE, 60)),
    ]
    for name, value in parameters.items():
        key = name.encode("ascii", "replace")
        messages.append((_PARAMETERS, struct.pack("<i", len(key)) + key + struct.pack("<if", 0, value)))
    return field(5, b"".join(id_.bytes_le + struct.pack("<i", len(data)) + data for id_, data in messages))
