"""Convert records to JSON and back; the annotations of a record's fields determine its JSON.

A record is an instance of a class with the decorator ``record``, which is like a frozen dataclass.
A record becomes an object with a key for each field. A mapping with text keys becomes an object,
and a tuple becomes a list. A text, number, bool or None stays the same. A field annotated as
``Any`` must contain JSON data already, and stays the same, too.

The class of a record may have an attribute ``json_inlined``, for a field whose value is another
record. With ``{"size": ("width", "height")}``, the keys ``width`` and ``height`` of the inner
record are keys of the outer object, which then has no key ``size``. The inner fields must not have
defaults.

The class may also have an attribute ``json_texts``, for fields that are texts in JSON. It maps the
name of such a field to two functions: the first converts a value to its text, the second parses it.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import cache
from math import isfinite
from operator import attrgetter
from types import NoneType, UnionType
from typing import Any, Literal, TypeVar, cast, get_args, get_origin, get_type_hints

from tltlc.api import MissingFieldsError

T = TypeVar("T")
_Read = Callable[[object], object]

_PLAIN = {str: "a text", bool: "true or false", int: "a whole number", float: "a number", NoneType: "null"}


class RecordJsonError(ValueError):
    """Raised for JSON that does not fit a record; the message says where, and what was expected."""


class _Misfit(Exception):
    """Raised for a value that does not fit its type.

    ``problem`` is the end of the message, such as " is 3, but a text was expected"; the place of
    the value comes before it. ``place`` has the parts of the place, such as ``[3]`` and ``.name``,
    innermost first. Each function that passes the exception on appends its part.
    """

    def __init__(self, problem: str) -> None:
        super().__init__(problem)
        self.problem = problem
        self.place: list[str] = []


def to_json(value: object) -> Any:
    """Convert a record, a plain value, or a tuple or mapping of these to data for ``json.dumps``."""
    kind: Any = type(value)
    if kind in _PLAIN:
        return value
    if kind is tuple or kind is list:
        return [to_json(item) for item in cast("tuple[object, ...]", value)]
    getters = _getters(kind)
    if getters is not None:
        return {key: to_json(get(value)) for key, get in getters}
    if isinstance(value, Mapping):
        return {name: to_json(item) for name, item in value.items()}
    return [to_json(item) for item in value] if isinstance(value, (tuple, list)) else value


def from_json(kind: type[T], data: object, where: str, **known: object) -> T:
    """Convert parsed JSON to a value of type ``kind``; this is the inverse of :func:`to_json`.

    ``kind`` is the class of a record, or another type that a field of a record may have: a tuple, a
    mapping with text keys, a ``Literal`` of texts, a plain type, ``Any``, or a union of one of
    these with None. A key may be missing if its field has a default. Numbers must be finite.
    ``known`` are fields of the record that are not in the JSON. ``where`` is the name of the value
    in messages.

    Raises:
        RecordJsonError: the JSON does not fit.
    """
    try:
        return cast(T, _read_record(kind, data, known) if known else _reader(cast(Any, kind))(data))
    except _Misfit as misfit:
        place = where + "".join(reversed(misfit.place))
        raise RecordJsonError(f"`{place}`{misfit.problem}") from None


@cache
def _reader(kind: Any) -> _Read:
    """Return a function that converts JSON data to ``kind``; it raises _Misfit if the data does not fit."""
    origin = get_origin(kind)
    if origin is Literal:
        return _literal_reader(get_args(kind))
    if origin is UnionType:
        read = _reader(next(arg for arg in get_args(kind) if arg is not NoneType))
        return lambda data: None if data is None else read(data)
    if origin is tuple:
        return _tuple_reader(get_args(kind))
    if origin is Mapping:
        return _mapping_reader(_reader(get_args(kind)[1]))
    if kind is Any:
        return _read_any
    if kind is float:
        return _read_float
    if kind in _PLAIN:
        return _plain_reader(kind)
    return lambda data: _read_record(kind, data, {})


def _literal_reader(texts: tuple[str, ...]) -> _Read:
    def read(data: object) -> object:
        if isinstance(data, str) and data in texts:
            return data
        raise _mismatch("one of " + ", ".join(map(repr, texts)), data)

    return read


def _plain_reader(kind: type) -> _Read:
    def read(data: object) -> object:
        if type(data) is kind and _fits(data):
            return data
        raise _mismatch(_PLAIN[kind], data)

    return read


def _read_float(data: object) -> object:
    if type(data) is float and isfinite(data):
        return data
    if type(data) is int and abs(data) < 2**53:
        return float(data)
    raise _mismatch(_PLAIN[float], data)


def _fits(data: object) -> bool:
    """Whether an integer has at most 64 bits; True for a value of another type."""
    return not isinstance(data, int) or -(2**63) <= data < 2**63


def _read_any(data: object) -> object:
    """Return JSON data of any kind as it is.

    Raise _Misfit for numbers that are not finite, because ``json.loads`` accepts them.
    """
    if isinstance(data, dict):
        return _read_mapping(_read_any, data)
    if isinstance(data, list):
        return list(_read_items(_read_any, data))
    return _read_float(data) if isinstance(data, float) else data


def _mapping_reader(read: _Read) -> _Read:
    return lambda data: _read_mapping(read, _object(data))


def _read_mapping(read: _Read, data: dict[str, object]) -> dict[str, object]:
    values, name = {}, ""
    try:
        for name, item in data.items():
            values[name] = read(item)
    except _Misfit as misfit:
        misfit.place.append(f".{name}")
        raise
    return values


def _tuple_reader(kinds: tuple[Any, ...]) -> _Read:
    if kinds[-1] is Ellipsis:
        read_item = _reader(kinds[0])
        return lambda data: _read_items(read_item, _list(data))
    readers = tuple(map(_reader, kinds))

    def read(data: object) -> object:
        items = _list(data)
        if len(items) != len(readers):
            values = f"{len(items)} value{'s' * (len(items) != 1)}"
            raise _Misfit(f" has {values}, but {len(readers)} were expected")
        values_read: list[object] = []
        try:
            for read_item, item in zip(readers, items, strict=True):
                values_read.append(read_item(item))
        except _Misfit as misfit:
            misfit.place.append(f"[{len(values_read)}]")
            raise
        return tuple(values_read)

    return read


def _read_items(read: _Read, items: list[object]) -> tuple[object, ...]:
    values: list[object] = []
    try:
        values.extend(map(read, items))
    except _Misfit as misfit:
        misfit.place.append(f"[{len(values)}]")
        raise
    return tuple(values)


def _read_record(kind: Any, data: object, known: Mapping[str, object]) -> object:
    readers, items = _field_readers(kind), _object(data)
    unknown = items.keys() - (readers.keys() - known.keys() if known else readers.keys())
    if unknown:
        raise _Misfit(f" has an unknown key `{min(unknown)}`")
    values: dict[str, object] = {}
    name = ""
    try:
        for name, item in items.items():
            values[name] = readers[name](item)
    except _Misfit as misfit:
        misfit.place.append(f".{name}")
        raise
    missing = _gather_inlined(kind, values)
    try:
        instance: object = kind(**values, **known)
    except ValueError as error:
        raise _Misfit(f": {error}") from None
    except MissingFieldsError as error:
        missing += error.names
    if missing:
        keys = ", ".join(f"`{key}`" for key in missing)
        raise _Misfit(f" lacks the key{'s' * (len(missing) > 1)} {keys}")
    return instance


def _inlined(kind: type) -> Mapping[str, tuple[str, ...]]:
    """Return the fields of a record's class that are inlined, each with the keys that replace it in JSON."""
    inlined: Mapping[str, tuple[str, ...]] = getattr(kind, "json_inlined", {})
    return inlined


def _texts(kind: type) -> Mapping[str, tuple[Callable[[Any], str], Callable[[str], object]]]:
    """Return the fields that are texts in JSON, each with a function to its text and one that parses the text."""
    texts: Mapping[str, tuple[Callable[[Any], str], Callable[[str], object]]] = getattr(kind, "json_texts", {})
    return texts


def _gather_inlined(kind: Any, values: dict[str, object]) -> list[str]:
    """For each inlined field, replace its keys in ``values`` by one record under the field's name.

    For example, ``width`` and ``height`` become ``size``, a record with these two fields. Return
    the keys that are missing; a field with missing keys gets the value None.
    """
    missing = []
    for name, keys in _inlined(kind).items():
        inner = {key: values.pop(key) for key in keys if key in values}
        missing_keys = [key for key in keys if key not in inner]
        values[name] = None if missing_keys else _hints(kind)[name](**inner)
        missing += missing_keys
    return missing


def _object(data: object) -> dict[str, object]:
    if isinstance(data, dict):
        return data
    raise _mismatch("an object", data)


def _list(data: object) -> list[object]:
    if isinstance(data, list):
        return data
    raise _mismatch("a list", data)


@cache
def _getters(kind: Any) -> tuple[tuple[str, Callable[[object], object]], ...] | None:
    """Return the keys of a record in JSON, each with a function that gets its value from a record.

    Return None if ``kind`` is not the class of a record.
    """
    names = getattr(kind, "__match_args__", None)
    if names is None:
        return None
    inlined = _inlined(kind)
    paths = {key: f"{name}.{key}" if name in inlined else name for name in names for key in inlined.get(name, (name,))}
    getters: dict[str, Callable[[object], object]] = {key: attrgetter(path) for key, path in paths.items()}
    for name, (text_of, _) in _texts(kind).items():
        getters[name] = _text_getter(name, text_of)
    return tuple(getters.items())


def _text_getter(name: str, text_of: Callable[[Any], str]) -> Callable[[object], object]:
    return lambda value: text_of(getattr(value, name))


@cache
def _hints(kind: Any) -> Mapping[str, Any]:
    """Return the types of a record's fields."""
    return get_type_hints(kind)


@cache
def _field_readers(kind: Any) -> Mapping[str, _Read]:
    """Return for each key of a record in JSON a function that converts its value, in the order of fields."""
    hints, inlined, texts = _hints(kind), _inlined(kind), _texts(kind)
    readers: dict[str, _Read] = {}
    for name in kind.__match_args__:
        inner = _hints(hints[name]) if name in inlined else hints
        readers |= {key: _reader(inner[key]) for key in inlined.get(name, (name,)) if key not in texts}
        if name in texts:
            readers[name] = _text_reader(texts[name][1])
    return readers


def _text_reader(parse: Callable[[str], object]) -> _Read:
    read = _plain_reader(str)
    return lambda data: parse(cast(str, read(data)))


def _mismatch(expected: str, data: object) -> _Misfit:
    return _Misfit(f" is {data!r:.60}, but {expected} was expected")
