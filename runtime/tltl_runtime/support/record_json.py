"""Records as JSON and back: the annotations of a record's fields say what its JSON looks like.

A record is an object with a key for each field, a mapping from texts an object, a tuple a list; what is a text, a
number, a bool or None stays what it is, and so does what is annotated as ``Any``, which is JSON data already.
"""

from __future__ import annotations

from collections.abc import Mapping
from functools import cache
from math import isfinite
from types import NoneType, UnionType
from typing import Any, Literal, TypeVar, cast, get_args, get_origin, get_type_hints

T = TypeVar("T")

_PLAIN = {str: "a text", bool: "true or false", int: "a whole number", float: "a number", NoneType: "null"}


class RecordJsonError(ValueError):
    """JSON that does not fit a record; the message says where and what was expected."""


def to_json(value: object) -> Any:
    """What ``json.dumps`` takes for a record, a tuple of such or a plain value."""
    names = getattr(type(value), "__match_args__", None)
    if names is not None:
        return {name: to_json(getattr(value, name)) for name in names}
    if isinstance(value, Mapping):
        return {name: to_json(each) for name, each in value.items()}
    return [to_json(each) for each in value] if isinstance(value, (tuple, list)) else value


def from_json(kind: type[T], data: object, where: str, **known: object) -> T:
    """The value of type ``kind`` that parsed JSON stands for; ``where`` names it in messages.

    ``kind`` is a record whose fields are records, tuples, mappings from texts, ``Literal`` texts, plain types, ``Any``
    or unions of these with None.
    A key may be missing where its field has a default; numbers are finite.  ``known`` are fields of the record that
    the JSON does not hold.

    Raises:
        RecordJsonError: anything else than that.
    """
    return cast(T, _record(kind, data, where, known) if known else _value(kind, data, where))


def _value(kind: Any, data: object, where: str) -> object:
    origin = get_origin(kind)
    if origin is Literal:
        if isinstance(data, str) and data in get_args(kind):
            return data
        raise _wrong(where, "one of " + ", ".join(map(repr, get_args(kind))), data)
    if origin is UnionType:
        return (
            None if data is None else _value(next(each for each in get_args(kind) if each is not NoneType), data, where)
        )
    if origin is tuple:
        return _tuple(get_args(kind), data, where)
    if origin is Mapping:
        inner = get_args(kind)[1]
        return {name: _value(inner, each, f"{where}.{name}") for name, each in _object(data, where).items()}
    if kind is Any:
        return _any(data, where)
    if kind in _PLAIN:
        return _plain(kind, data, where)
    return _record(kind, data, where, {})


def _plain(kind: type, data: object, where: str) -> object:
    if kind is float and type(data) is int and abs(data) < 2**53:
        return float(data)
    if type(data) is kind and _fits(data):
        return data
    raise _wrong(where, _PLAIN[kind], data)


def _fits(data: object) -> bool:
    """Whether a plain value is finite and, if it is whole, has 64 bits at most."""
    if isinstance(data, int):
        return -(2**63) <= data < 2**63
    return not isinstance(data, float) or isfinite(data)


def _any(data: object, where: str) -> object:
    """JSON data of any kind; what ``json.loads`` reads beyond JSON are numbers that are not finite."""
    if isinstance(data, dict):
        return {name: _any(each, f"{where}.{name}") for name, each in data.items()}
    if isinstance(data, list):
        return [_any(each, f"{where}[{index}]") for index, each in enumerate(data)]
    return _plain(float, data, where) if isinstance(data, float) else data


def _tuple(kinds: tuple[Any, ...], data: object, where: str) -> tuple[object, ...]:
    if not isinstance(data, list):
        raise _wrong(where, "a list", data)
    if kinds[-1] is Ellipsis:
        kinds = kinds[:1] * len(data)
    if len(data) != len(kinds):
        raise RecordJsonError(f"`{where}` has {len(data)} values, {len(kinds)} were expected")
    pairs = enumerate(zip(kinds, data, strict=True))
    return tuple(_value(kind, each, f"{where}[{index}]") for index, (kind, each) in pairs)


def _record(kind: Any, data: object, where: str, known: Mapping[str, object]) -> object:
    kinds = {name: each for name, each in _fields(kind).items() if name not in known}
    unknown = _object(data, where).keys() - kinds.keys()
    if unknown:
        raise RecordJsonError(f"`{where}` has a key `{min(unknown)}`, which nothing is known of")
    values = {name: _value(kinds[name], each, f"{where}.{name}") for name, each in _object(data, where).items()}
    try:
        made: object = kind(**values, **known)
        return made
    except ValueError as error:
        raise RecordJsonError(f"`{where}`: {error}") from None
    except TypeError as error:
        # Records name in their message those of the fields that have no default.
        missing = str(error).partition(" lacks ")[2]
        raise RecordJsonError(f"`{where}` lacks one of the keys {missing}") from None


def _object(data: object, where: str) -> dict[str, object]:
    if isinstance(data, dict):
        return data
    raise _wrong(where, "an object", data)


@cache
def _fields(kind: Any) -> Mapping[str, Any]:
    """The types of a record's fields, by name, in order."""
    hints = get_type_hints(kind)
    return {name: hints[name] for name in kind.__match_args__}


def _wrong(where: str, expected: str, data: object) -> RecordJsonError:
    return RecordJsonError(f"`{where}` is {data!r:.60}, and {expected} was expected")
