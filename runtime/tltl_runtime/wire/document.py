"""Check parts of a message, with errors that name the part by its path, such as ``state.signals.health``."""

from __future__ import annotations

from math import inf, isfinite
from typing import Any

from tltl_runtime.wire.errors import MalformedMessageError
from tltl_runtime.wire.json_text import shortened, value_text


def wrong(path: str, expected: str, value: Any) -> MalformedMessageError:
    """Return an error such as "sent `state.ended` as 3, but it must be true or false"; ``expected`` ends the text."""
    return MalformedMessageError(f"sent `{path}` as {value_text(value)}, but it must be {expected}")


def an_object(value: Any, path: str) -> dict[str, Any]:
    """Return ``value``, the part at ``path``; raises MalformedMessageError unless it is a JSON object."""
    if not isinstance(value, dict):
        raise wrong(path, "an object", value)
    return value


def a_list(value: Any, path: str) -> list[Any]:
    """Return ``value``, the part at ``path``; raises MalformedMessageError unless it is a list."""
    if not isinstance(value, list):
        raise wrong(path, "a list", value)
    return value


def a_text(value: Any, path: str) -> str:
    """Return ``value``, the part at ``path``.

    Raises MalformedMessageError unless it is a text of printable characters, and not empty.
    """
    if not isinstance(value, str):
        raise wrong(path, "a text", value)
    if not value or not value.isprintable():
        raise wrong(path, "a text of printable characters, and not empty", value)
    return value


def a_whole_number(value: Any, path: str, least: int, most: int = 2**53) -> int:
    """Return ``value``, the part at ``path``, as an int. A float such as 4.0 is a whole number, too.

    Raises MalformedMessageError unless it is a whole number from ``least`` to ``most``.
    """
    if isinstance(value, float) and value.is_integer():
        value = int(value)  # Some languages have no whole numbers, and write 4.0.
    if type(value) is not int or not least <= value <= most:
        raise wrong(path, f"a whole number from {least} to {most}", value)
    return value


def a_number(value: Any, path: str, low: float = -inf, high: float = inf) -> float:
    """Return ``value``, the part at ``path``, as a float.

    Raises MalformedMessageError unless it is a finite number from ``low`` to ``high``.
    """
    if type(value) is not float and type(value) is not int:
        raise wrong(path, "a number", value)
    try:
        number = float(value)
    except OverflowError:
        number = inf
    if not isfinite(number):
        raise MalformedMessageError(f"sent a number that is not finite as `{path}`")
    if not low <= number <= high:
        raise wrong(path, _range_text(low, high), value)
    return number


def member(path: str, key: str) -> str:
    """Return the path of the entry ``key`` of the object at ``path``: ``state.signals.health``."""
    return f"{path}.{shortened(key)}"


def _range_text(low: float, high: float) -> str:
    if low == -inf:
        return f"at most {high:g}"
    return f"at least {low:g}" if high == inf else f"from {low:g} to {high:g}"
