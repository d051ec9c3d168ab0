"""Convert records to JSON and back; the annotations of a record's fields determine its JSON.

A record becomes an object with a key per field, a mapping with text keys an object, and a tuple a
list. A text, number, bool or None stays the same, and so does a field annotated as ``Any``, which
already contains JSON data.

The class of a record may have an attribute ``json_inlined``. It maps the name of a field whose
value is another record to names of fields of that inner record. In JSON, these inner fields are
keys of the outer object, in place of an inner object. The inner fields must not have defaults.
"""

from __future__ import annotations

from collections.abc import Mapping
from functools import cache
from math import isfinite
from types import NoneType, UnionType
from typing import Any, Literal, TypeVar, cast, get_args, get_origin, get_type_hints

from tltlc.api import MissingFieldsError

T = TypeVar("T")

_PLAIN = {str: "a text", bool: "true or false", int: "a whole number", float: "a number", NoneType: "null"}


class RecordJsonError(ValueError):
    """Raised for JSON that does not fit a record; the message says where, and what was expected."""


def to_json(value: object) -> Any:
    """Return the JSON data, for ``json.dumps``, of a record, a tuple of records or a plain value."""
    names = getattr(type(value), "__match_args__", None)
    if names is not None:
        inlined = _inlined(type(value))
        inner = {key: name for name, keys in inlined.items() for key in keys}
        keys = [key for name in names for key in inlined.get(name, (name,))]
        return {key: to_json(getattr(getattr(value, inner[key]) if key in inner else value, key)) for key in keys}
    if isinstance(value, Mapping):
        return {name: to_json(item) for name, item in value.items()}
    return [to_json(item) for item in value] if isinstance(value, (tuple, list)) else value


def from_json(kind: type[T], data: object, where: str, **known: object) -> T:
    """Return the value of type ``kind`` that parsed JSON represents; ``where`` names it in messages.

    ``kind`` is a record whose fields are records, tuples, mappings with text keys, ``Literal``
    texts, plain types, ``Any`` or unions of these with None. A key may be missing if its field has
    a default. Numbers must be finite. ``known`` are fields of the record that are not in the JSON.

    Raises:
        RecordJsonError: the JSON does not fit.
    """
    return cast(T, _record(kind, data, where, known) if known else _value(kind, data, where))


def _value(kind: Any, data: object, where: str) -> object:
    origin = get_origin(kind)
    if origin is Literal:
        if isinstance(data, str) and data in get_args(kind):
            return data
        raise _mismatch_error(where, "one of " + ", ".join(map(repr, get_args(kind))), data)
    if origin is UnionType:
        return None if data is None else _value(next(arg for arg in get_args(kind) if arg is not NoneType), data, where)
    if origin is tuple:
        return _tuple(get_args(kind), data, where)
    if origin is Mapping:
        inner = get_args(kind)[1]
        return {name: _value(inner, item, f"{where}.{name}") for name, item in _object(data, where).items()}
    if kind is Any:
        return _any_value(data, where)
    if kind in _PLAIN:
        return _plain_value(kind, data, where)
    return _record(kind, data, where, {})


def _plain_value(kind: type, data: object, where: str) -> object:
    if kind is float and type(data) is int and abs(data) < 2**53:
        return float(data)
    if type(data) is kind and _fits(data):
        return data
    raise _mismatch_error(where, _PLAIN[kind], data)


def _fits(data: object) -> bool:
    """Whether a plain value is finite and, if it is an integer, has at most 64 bits."""
    if isinstance(data, int):
        return -(2**63) <= data < 2**63
    return not isinstance(data, float) or isfinite(data)


def _any_value(data: object, where: str) -> object:
    """Return JSON data of any kind; raise RecordJsonError for numbers that are not finite.

    ``json.loads`` accepts such numbers.
    """
    if isinstance(data, dict):
        return {name: _any_value(item, f"{where}.{name}") for name, item in data.items()}
    if isinstance(data, list):
        return [_any_value(item, f"{where}[{index}]") for index, item in enumerate(data)]
    return _plain_value(float, data, where) if isinstance(data, float) else data


def _tuple(kinds: tuple[Any, ...], data: object, where: str) -> tuple[object, ...]:
    if not isinstance(data, list):
        raise _mismatch_error(where, "a list", data)
    if kinds[-1] is Ellipsis:
        kinds = kinds[:1] * len(data)
    if len(data) != len(kinds):
        values = f"{len(data)} value{'s' * (len(data) != 1)}"
        raise RecordJsonError(f"`{where}` has {values}, but {len(kinds)} were expected")
    pairs = enumerate(zip(kinds, data, strict=True))
    return tuple(_value(kind, item, f"{where}[{index}]") for index, (kind, item) in pairs)


def _record(kind: Any, data: object, where: str, known: Mapping[str, object]) -> object:
    kinds = {name: field_kind for name, field_kind in _fields(kind).items() if name not in known}
    unknown = _object(data, where).keys() - kinds.keys()
    if unknown:
        raise RecordJsonError(f"`{where}` has an unknown key `{min(unknown)}`")
    values = {name: _value(kinds[name], item, f"{where}.{name}") for name, item in _object(data, where).items()}
    missing = _gather_inlined(kind, values)
    try:
        instance: object = kind(**values, **known)
    except ValueError as error:
        raise RecordJsonError(f"`{where}`: {error}") from None
    except MissingFieldsError as error:
        missing += error.names
    if missing:
        keys = ", ".join(f"`{key}`" for key in missing)
        raise RecordJsonError(f"`{where}` lacks the key{'s' * (len(missing) > 1)} {keys}")
    return instance


def _inlined(kind: type) -> Mapping[str, tuple[str, ...]]:
    """Return the inlined fields of a record's class, each with the keys that replace it in JSON."""
    inlined: Mapping[str, tuple[str, ...]] = getattr(kind, "json_inlined", {})
    return inlined


def _gather_inlined(kind: Any, values: dict[str, object]) -> list[str]:
    """Replace in ``values`` the keys that stand for an inlined field by the inner record.

    Return the keys that are missing. An inlined field with missing keys gets the value None.
    """
    missing = []
    for name, keys in _inlined(kind).items():
        inner = {key: values.pop(key) for key in keys if key in values}
        missing_keys = [key for key in keys if key not in inner]
        values[name] = None if missing_keys else _hints(kind)[name](**inner)
        missing += missing_keys
    return missing


def _object(data: object, where: str) -> dict[str, object]:
    if isinstance(data, dict):
        return data
    raise _mismatch_error(where, "an object", data)


@cache
def _hints(kind: Any) -> Mapping[str, Any]:
    """Return the types of a record's fields."""
    return get_type_hints(kind)


@cache
def _fields(kind: Any) -> Mapping[str, Any]:
    """Return the types of a record's keys in JSON, in order."""
    hints, inlined = _hints(kind), _inlined(kind)
    fields: dict[str, Any] = {}
    for name in kind.__match_args__:
        inner = _hints(hints[name]) if name in inlined else hints
        fields |= {key: inner[key] for key in inlined.get(name, (name,))}
    return fields


def _mismatch_error(where: str, expected: str, data: object) -> RecordJsonError:
    return RecordJsonError(f"`{where}` is {data!r:.60}, but {expected} was expected")
