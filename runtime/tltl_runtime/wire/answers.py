"""The messages that a game sends after its ``hello``."""

from __future__ import annotations

import sys
from collections.abc import Callable, Mapping
from math import inf
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from tltl_runtime.support.suggestion import suggestion
from tltl_runtime.wire.document import a_number, a_text, an_object, member, wrong
from tltl_runtime.wire.errors import MalformedMessageError
from tltl_runtime.wire.hello import POSITIONS, DeclaredSignal, Hello
from tltl_runtime.wire.json_text import shortened, value_text
from tltl_runtime.wire.values import array_from, value_reader
from tltlc.api import record

STATE: Final = "state"
SNAPSHOT: Final = "snapshot"
RELEASE: Final = "release"
SCREENSHOT: Final = "screenshot"
OUTLINE: Final = "outline"
ERROR: Final = "error"
_INFINITE: Final = (inf, -inf)
_LARGEST: Final = sys.float_info.max
_KINDS: Final = ("hello", STATE, SNAPSHOT, RELEASE, SCREENSHOT, OUTLINE, ERROR)

Position = tuple[float, ...]


class ReportedError(Exception):
    """Raised if a game sends the message ``error``; the text is that of the message."""


@record
class GameState:
    """The message ``state``.

    ``signals`` are floats and bools by name. ``observation`` is a value of the observation space.
    ``ended`` says whether the episode has ended. ``cause`` says who or what ended it; None if that is
    unknown. ``positions`` are the positions of the entities by name, each with two or three coordinates
    in metres; empty if the game gives none.
    """

    signals: Mapping[str, float]
    observation: Any
    ended: bool
    cause: str | None
    positions: Mapping[str, Position]


def body_of(message: Any, expected: str) -> Any:
    """Return the content of a message that must be of the kind ``expected``.

    For the kind ``state``, this is the value of the key ``state``. Keys that are no kinds are ignored.

    Raises:
        ReportedError: the message is an ``error``.
        MalformedMessageError: the message is of another kind.
    """
    if type(message) is not dict:
        raise MalformedMessageError(f"sent {value_text(message)} instead of an object")
    if expected in message and ERROR not in message:
        return message[expected]
    if ERROR in message:
        body = message[ERROR]
        text = body.get("message") if isinstance(body, dict) else body
        raise ReportedError(shortened(text) if isinstance(text, str) else "no reason given")
    kinds = [kind for kind in _KINDS if kind in message]
    if kinds:
        raise MalformedMessageError(f"sent a message `{kinds[0]}` instead of `{expected}`")
    names = ", ".join(f"`{shortened(key)}`" for key in list(message)[:3]) or "no key"
    hint = suggestion(str(next(iter(message), "")), _KINDS)
    raise MalformedMessageError(f"sent a message of an unknown kind, with {names}, instead of `{expected}`; {hint}")


class StateReader:
    """Reads the ``state`` messages of a game, which must agree with its ``hello``."""

    def __init__(self, hello: Hello) -> None:
        self._declared = hello.signals
        self._checks = tuple(
            (name, signal.type == "bool", signal.low, signal.high) for name, signal in hello.signals.items()
        )
        self._observation: Callable[[Any], Any] = value_reader(hello.observation, "state.observation")
        self._has_positions = POSITIONS in hello.capabilities

    def read(self, message: Any) -> GameState:
        """Return the state in a message.

        Raises:
            ReportedError: the message is an ``error``.
            MalformedMessageError: the message is no ``state``, or does not agree with the ``hello``.
        """
        body = an_object(body_of(message, STATE), STATE)
        ended, cause = body.get("ended", False), body.get("cause")
        if type(ended) is not bool:
            raise wrong("state.ended", "true or false", ended)
        return GameState(
            self._signals(body.get("signals")),
            self._observation(body.get("observation", {})),
            ended,
            None if cause is None or cause == "" else a_text(cause, "state.cause"),
            _positions(body.get("positions")) if self._has_positions else {},
        )

    def _signals(self, values: Any) -> dict[str, float]:
        """Return the signals of a state by name.

        Raises MalformedMessageError unless ``values`` has all declared signals and no others, each with
        its declared type and in its range.
        """
        if type(values) is not dict:
            raise wrong("state.signals", "an object", values)
        if values.keys() != self._declared.keys():
            raise _other_signals(values, self._declared)
        result = {}
        for name, is_bool, low, high in self._checks:
            value = values[name]
            kind = type(value)
            if is_bool:
                if kind is not bool:
                    raise wrong(member("state.signals", name), "true or false", value)
            elif kind is not float or not low <= value <= high or value in _INFINITE:
                value = a_number(value, member("state.signals", name))
                if not low <= value <= high:
                    raise _out_of_range(name, value, low, high)
            result[name] = value
        return result


def snapshot_id(message: Any) -> int | str:
    """Return the id in a message ``snapshot``.

    Raises the errors of :func:`body_of`, and MalformedMessageError if the id is no whole number or text.
    """
    return _id_in(message, SNAPSHOT)


def released(message: Any, kept: int | str) -> None:
    """Check that a message ``release`` has the id of the snapshot ``kept``.

    Raises as :func:`snapshot_id`, and MalformedMessageError if it is another id.
    """
    value = _id_in(message, RELEASE)
    if value != kept:
        raise wrong(f"{RELEASE}.id", f"{value_text(kept)}, the id of the request", value)


def _id_in(message: Any, kind: str) -> int | str:
    value = an_object(body_of(message, kind), kind).get("id")
    if type(value) is not int and not (isinstance(value, str) and value):
        raise wrong(f"{kind}.id", "a whole number or a text", value)
    return value


def screenshot(message: Any) -> NDArray[np.uint8]:
    """Return the picture in a message ``screenshot``, (height, width, 3), without transparency.

    Raises the errors of :func:`body_of`, and MalformedMessageError if the content is no picture.
    """
    return picture_from(body_of(message, SCREENSHOT), SCREENSHOT, "a screenshot")


def picture_from(value: Any, path: str, what: str) -> NDArray[np.uint8]:
    """Return the picture at ``path`` in a message, (height, width, 3), without transparency; errors call it ``what``.

    Raises MalformedMessageError if ``value`` is no picture.
    """
    picture = array_from(value, path)
    if picture.ndim != 3 or picture.shape[2] not in (3, 4) or not picture.size:
        raise MalformedMessageError(f"sent {what} of the shape {list(picture.shape)}, not [height, width, 3]")
    if picture.dtype.kind not in "iu" or picture.min() < 0 or picture.max() > 255:
        raise MalformedMessageError(f"sent {what} with numbers that are not whole numbers from 0 to 255")
    return np.ascontiguousarray(picture[:, :, :3], dtype=np.uint8)


def _positions(value: Any) -> dict[str, Position]:
    """Return the positions in a state; an entity whose position is null is gone, and is left out."""
    points = an_object(value, "state.positions").items()
    return {name: _position(name, point) for name, point in points if point is not None}


def _position(name: str, point: Any) -> Position:
    # The path is only needed for an error, and to write it takes longer than to read the numbers.
    if type(point) is not list or len(point) not in (2, 3):
        raise wrong(member("state.positions", name), "a list of two or three numbers", point)
    for number in point:
        kind = type(number)
        if (kind is not float and kind is not int) or not -_LARGEST <= number <= _LARGEST:
            a_number(number, member("state.positions", name))
    return tuple(map(float, point))


def _other_signals(values: Mapping[str, Any], declared: Mapping[str, DeclaredSignal]) -> MalformedMessageError:
    missing = [name for name in declared if name not in values]
    if missing:
        return MalformedMessageError(f"did not send the signal `{missing[0]}`, which it declared")
    name = next(name for name in values if name not in declared)
    shown = shortened(name)
    return MalformedMessageError(f"sent the signal `{shown}`, which it did not declare; {suggestion(shown, declared)}")


def _out_of_range(name: str, value: float, low: float, high: float) -> MalformedMessageError:
    return MalformedMessageError(
        f"sent {value_text(value)} as the signal `{name}`, outside its declared range from {low:g} to {high:g}"
    )
