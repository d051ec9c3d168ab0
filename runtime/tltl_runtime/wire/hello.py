"""The first message of a game, ``hello``: what the game is and can do."""

from __future__ import annotations

from collections.abc import Mapping
from math import inf
from typing import Any, Final

from gymnasium import Space, spaces

from tltl_runtime.wire.document import a_list, a_number, a_text, an_object, member, wrong
from tltl_runtime.wire.errors import MalformedMessageError
from tltl_runtime.wire.spaces import space_from
from tltlc.api import record, specs

VERSION: Final = 1
"""The version of the protocol."""

SEED: Final = "seed"
SNAPSHOT: Final = "snapshot"
RELEASE: Final = "release"
POSITIONS: Final = "positions"
SCREENSHOT: Final = "screenshot"
OUTLINE: Final = "outline"

JSON: Final = "json"
MSGPACK: Final = "msgpack"


@record
class DeclaredSignal:
    """A signal of a game: its type, such as ``bool`` or ``length``, and its range in SI units.

    A signal without bounds has an infinite range. ``bool`` has the range from 0 to 1.
    """

    type: str
    low: float
    high: float


@record
class Hello:
    """What a game declares in its message ``hello``.

    ``token`` proves that this is the game that was started; empty if the game sent none. ``clock_hz`` is
    the number of its ticks in a second; None if the game does not say. ``params`` are values for the
    params of specs, in SI units. ``scenes`` are the names of its scenes; empty if it has only one.
    ``capabilities`` are words such as ``seed``; unknown words are kept. ``encoding``, ``json`` or
    ``msgpack``, is the encoding of further messages that the game asks for.
    """

    name: str
    token: str
    clock_hz: float | None
    signals: Mapping[str, DeclaredSignal]
    params: Mapping[str, float]
    actions: Space[Any]
    observation: Space[Any]
    scenes: tuple[str, ...]
    capabilities: frozenset[str]
    encoding: str


def token_of(message: Any) -> str:
    """Return the token of a ``hello``, empty if it has none. Only the version of the protocol is checked.

    Raises:
        MalformedMessageError: the message is no ``hello``, it has another version of the protocol, or the
            token is no text.
    """
    if not isinstance(message, dict) or not isinstance(body := message.get("hello"), dict):
        raise MalformedMessageError('must first send a line such as `{"hello": {"tltl": 1, …}}`, but sent another one')
    version = body.get("tltl")
    if version != VERSION or isinstance(version, bool):
        if type(version) is int:
            raise MalformedMessageError(
                f"speaks version {version} of the protocol, and this tltlc speaks version {VERSION}"
            )
        raise wrong("hello.tltl", f"the version of the protocol, {VERSION}", version)
    token = body.get("token", "")
    if not isinstance(token, str):
        raise wrong("hello.token", "a text", token)
    return token


def hello_from(message: Any) -> Hello:
    """Return the ``hello`` in a message.

    Raises:
        MalformedMessageError: a part is missing or wrong; the text names this part by its path, such as
            ``hello.signals``.
    """
    token = token_of(message)
    body = message["hello"]
    clock_hz, encoding = body.get("clock_hz"), body.get("encoding", JSON)
    if encoding not in (JSON, MSGPACK):
        raise wrong("hello.encoding", "`json` or `msgpack`", encoding)
    signals = an_object(body.get("signals"), "hello.signals")
    params = an_object(body.get("params", {}), "hello.params")
    observation = body.get("observation")
    return Hello(
        name=a_text(body.get("name", "game"), "hello.name"),
        token=token,
        clock_hz=None if clock_hz is None else a_number(clock_hz, "hello.clock_hz", 1e-9, 1e9),
        signals={name: _signal(value, member("hello.signals", name)) for name, value in signals.items()},
        params={name: a_number(value, member("hello.params", name)) for name, value in params.items()},
        actions=space_from(body.get("actions"), "hello.actions"),
        observation=spaces.Dict({}) if observation is None else space_from(observation, "hello.observation"),
        scenes=_scenes(body.get("scenes", [])),
        capabilities=frozenset(
            a_text(word, f"hello.capabilities[{index}]")
            for index, word in enumerate(a_list(body.get("capabilities", []), "hello.capabilities"))
        ),
        encoding=encoding,
    )


def _signal(value: Any, path: str) -> DeclaredSignal:
    table = an_object(value, path)
    type_ = table.get("type", "number")
    if not isinstance(type_, str) or type_ not in specs.TYPES:
        raise wrong(f"{path}.type", f"one of {', '.join(specs.TYPES)}", type_)
    if type_ == "bool":
        return DeclaredSignal(type_, 0.0, 1.0)
    ends = table.get("range", [None, None])
    if not isinstance(ends, list) or len(ends) != 2:
        raise wrong(f"{path}.range", "a list of two numbers, or null where there is no bound", ends)
    low = -inf if ends[0] is None else a_number(ends[0], f"{path}.range")
    high = inf if ends[1] is None else a_number(ends[1], f"{path}.range")
    if low > high:
        raise wrong(f"{path}.range", "a list of the least and the greatest value", ends)
    return DeclaredSignal(type_, low, high)


def _scenes(value: Any) -> tuple[str, ...]:
    """Return the names of the scenes. In the message, a scene is its name, or an object with a ``name``."""
    names = []
    for index, scene in enumerate(a_list(value, "hello.scenes")):
        name = scene.get("name") if isinstance(scene, dict) else scene
        names.append(a_text(name, f"hello.scenes[{index}]"))
    return tuple(names)
