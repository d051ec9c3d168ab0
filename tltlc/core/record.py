"""Immutable records with slots, like ``dataclass(frozen=True, slots=True)`` but twenty times faster to define.

The compiler defines about ninety small classes. ``dataclasses`` would generate and compile the
source of several methods for each, in 0.4 ms. For all classes, this would take a quarter of the
time of ``tltlc compile``. Here, the methods are closures, which need no compilation
(``docs/adr/0003``).
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from operator import attrgetter
from types import MappingProxyType
from typing import TYPE_CHECKING, Any, Final, TypeVar

EMPTY: Final[Mapping[Any, Any]] = MappingProxyType({})
"""An empty mapping that cannot change: the default of fields that are mappings."""

T = TypeVar("T")
R = TypeVar("R")

if TYPE_CHECKING:
    from typing_extensions import dataclass_transform
else:

    def dataclass_transform(**_: object) -> Callable[[T], T]:
        """Do nothing: only type checkers need this decorator."""
        return lambda function: function


@dataclass_transform(frozen_default=True)
def record(cls: type[R]) -> type[R]:
    """Make a class an immutable record, whose annotated fields are slots and arguments of the constructor.

    A value assigned in the class is the field's default. Records of the same class with equal
    fields are equal and have the same hash. Records can be pickled, and can be matched by position in
    ``case``. If the class has a method ``__post_init__``, each new record calls it. If the class has
    ``hashed_once = True``, each record caches its hash, since the hash of a deep tree is slow to
    compute.

    Raises TypeError if a field without a default follows a field with a default.
    """
    names = tuple(cls.__annotations__)
    body = {key: value for key, value in cls.__dict__.items() if key not in (*names, "__dict__", "__weakref__")}
    defaults = tuple(cls.__dict__[name] for name in names if name in cls.__dict__)
    if any(name in cls.__dict__ for name in names[: len(names) - len(defaults)]):
        raise TypeError(f"{cls.__name__}: a field without a default follows one with a default")
    body["__slots__"] = (*names, "_hash") if body.get("hashed_once") else names
    body["__match_args__"] = names
    new_class: Any = type(cls.__name__, cls.__bases__, body)
    setters = [(index, new_class.__dict__[name].__set__) for index, name in enumerate(names)]
    values_of = _values_getter(names)

    def initialise(self: Any, *positional: Any, **keywords: Any) -> None:
        missing = len(setters) - len(positional)
        if keywords or not 0 <= missing <= len(defaults):
            positional = _field_values(new_class.__qualname__, names, defaults, positional, keywords)
        elif missing:
            positional += defaults[-missing:]
        for index, set_field in setters:
            set_field(self, positional[index])

    def initialise_checked(self: Any, *positional: Any, **keywords: Any) -> None:
        initialise(self, *positional, **keywords)
        self.__post_init__()

    methods = {
        "__init__": initialise_checked if "__post_init__" in body else initialise,
        "__eq__": lambda self, other: (
            values_of(self) == values_of(other) if type(other) is new_class else NotImplemented
        ),
        "__hash__": lambda self: hash((new_class, values_of(self))),
        "__reduce__": lambda self: (new_class, values_of(self)),
        "__repr__": _repr,
        "__setattr__": _refuse_change,
        "__delattr__": _refuse_change,
    }
    if body.get("hashed_once"):
        methods["__hash__"] = _cached_hash(new_class, values_of)
    for name, method in methods.items():
        if name not in body:
            setattr(new_class, name, method)
    return new_class  # type: ignore[no-any-return]


class MissingFieldsError(TypeError):
    """Raised when a new record gets no value for a field without a default; ``names`` lists all such fields."""

    def __init__(self, owner: str, names: list[str]) -> None:
        super().__init__(f"{owner} lacks {', '.join(names)}")
        self.names = names


def replace(value: R, /, **fields: object) -> R:
    """Return a copy of a record with some fields replaced; raise TypeError for an unknown field."""
    names = type(value).__match_args__  # type: ignore[attr-defined]
    unknown = fields.keys() - set(names)
    if unknown:
        raise TypeError(f"{type(value).__name__} has no field {', '.join(sorted(unknown))}")
    return type(value)(*(fields.get(name, getattr(value, name)) for name in names))


def _values_getter(names: tuple[str, ...]) -> Callable[[Any], tuple[Any, ...]]:
    if not names:
        return lambda _: ()
    get = attrgetter(*names)
    return get if len(names) > 1 else lambda value: (get(value),)


def _cached_hash(cls: Any, values_of: Callable[[Any], tuple[Any, ...]]) -> Callable[[Any], int]:
    """Return a method ``__hash__`` that computes the hash of each record only once."""
    set_hash = cls.__dict__["_hash"].__set__

    def cached_hash(self: Any) -> int:
        try:
            return self._hash  # type: ignore[no-any-return]
        except AttributeError:
            value = hash((cls, values_of(self)))
            set_hash(self, value)
            return value

    return cached_hash


def _field_values(
    owner: str, names: tuple[str, ...], defaults: tuple[Any, ...], positional: tuple[Any, ...], keywords: dict[str, Any]
) -> tuple[Any, ...]:
    """Return the values of the fields of a new record, in order.

    The values come from positional arguments, keyword arguments and defaults. Raises TypeError if
    the arguments do not fit the fields.
    """
    if len(positional) > len(names):
        raise TypeError(f"{owner} takes {len(names)} values, {len(positional)} were given")
    values = dict(zip(names[len(names) - len(defaults) :], defaults, strict=True))
    values.update(zip(names[: len(positional)], positional, strict=True))
    for name, value in keywords.items():
        if name not in names or name in names[: len(positional)]:
            raise TypeError(f"{owner} has {'two values for' if name in names else 'no'} field {name}")
        values[name] = value
    missing = [name for name in names if name not in values]
    if missing:
        raise MissingFieldsError(owner, missing)
    return tuple(values[name] for name in names)


def _repr(self: Any) -> str:
    fields = ", ".join(f"{name}={getattr(self, name)!r}" for name in self.__match_args__)
    return f"{type(self).__qualname__}({fields})"


def _refuse_change(self: Any, name: str, *_: object) -> None:
    raise AttributeError(f"a {type(self).__qualname__} cannot be changed: {name}")
