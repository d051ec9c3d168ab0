"""Frozen records with slots: what ``dataclass(frozen=True, slots=True)`` gives, made twenty times faster.

The compiler's data are some ninety small classes.  ``dataclasses`` compiles the text of several
methods for each, 0.4 ms a class, which would be a quarter of the time of a whole ``tltlc compile``; here the
methods are shared closures (``docs/adr/0003``).
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from operator import attrgetter
from types import MappingProxyType
from typing import TYPE_CHECKING, Any, Final, TypeVar

EMPTY: Final[Mapping[Any, Any]] = MappingProxyType({})
"""The default of a field that is a mapping."""

T = TypeVar("T")
R = TypeVar("R")

if TYPE_CHECKING:
    from typing_extensions import dataclass_transform
else:

    def dataclass_transform(**_: object) -> Callable[[T], T]:
        """Nothing at run time."""
        return lambda function: function


@dataclass_transform(frozen_default=True)
def record(cls: type[R]) -> type[R]:
    """Class decorator: the annotated fields, in order, become slots and the arguments of the constructor.

    A value given in the class is a field's default.  Records compare and hash by class and fields,
    cannot be changed, can be pickled, and match positionally.  A method ``__post_init__`` checks the fields of a new
    one.  A class with ``hashed_once = True`` keeps its hash: that of a deep tree takes long.

    Raises TypeError where a field without default follows one with a default.
    """
    names = tuple(cls.__annotations__)
    body = {key: value for key, value in cls.__dict__.items() if key not in (*names, "__dict__", "__weakref__")}
    defaults = tuple(cls.__dict__[name] for name in names if name in cls.__dict__)
    if any(name in cls.__dict__ for name in names[: len(names) - len(defaults)]):
        raise TypeError(f"{cls.__name__}: a field without a default follows one with a default")
    body["__slots__"] = (*names, "_hash") if body.get("hashed_once") else names
    body["__match_args__"] = names
    made: Any = type(cls.__name__, cls.__bases__, body)
    fill = [(index, made.__dict__[name].__set__) for index, name in enumerate(names)]
    values_of = _values_getter(names)

    def initialise(self: Any, *given: Any, **named: Any) -> None:
        left = len(fill) - len(given)
        if named or not 0 <= left <= len(defaults):
            given = _arguments(made.__qualname__, names, defaults, given, named)
        elif left:
            given += defaults[-left:]
        for index, put in fill:
            put(self, given[index])

    def initialise_checked(self: Any, *given: Any, **named: Any) -> None:
        initialise(self, *given, **named)
        self.__post_init__()

    methods = {
        "__init__": initialise_checked if "__post_init__" in body else initialise,
        "__eq__": lambda self, other: values_of(self) == values_of(other) if type(other) is made else NotImplemented,
        "__hash__": lambda self: hash((made, values_of(self))),
        "__reduce__": lambda self: (made, values_of(self)),
        "__repr__": _shown,
        "__setattr__": _refused,
        "__delattr__": _refused,
    }
    if body.get("hashed_once"):
        methods["__hash__"] = _kept_hash(made, values_of)
    for name, method in methods.items():
        if name not in body:
            setattr(made, name, method)
    return made  # type: ignore[no-any-return]


def replace(value: R, /, **fields: object) -> R:
    """A copy of a record with some fields replaced."""
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


def _kept_hash(made: Any, values_of: Callable[[Any], tuple[Any, ...]]) -> Callable[[Any], int]:
    """The method ``__hash__`` that computes it once."""
    keep = made.__dict__["_hash"].__set__

    def kept_hash(self: Any) -> int:
        try:
            return self._hash  # type: ignore[no-any-return]
        except AttributeError:
            value = hash((made, values_of(self)))
            keep(self, value)
            return value

    return kept_hash


def _arguments(
    owner: str, names: tuple[str, ...], defaults: tuple[Any, ...], given: tuple[Any, ...], named: dict[str, Any]
) -> tuple[Any, ...]:
    """The fields' values in order, from positions, names and defaults."""
    if len(given) > len(names):
        raise TypeError(f"{owner} takes {len(names)} values, {len(given)} were given")
    values = dict(zip(names[len(names) - len(defaults) :], defaults, strict=True))
    values.update(zip(names[: len(given)], given, strict=True))
    for name, value in named.items():
        if name not in names or name in names[: len(given)]:
            raise TypeError(f"{owner} has {'two values for' if name in names else 'no'} field {name}")
        values[name] = value
    missing = [name for name in names if name not in values]
    if missing:
        raise TypeError(f"{owner} lacks {', '.join(missing)}")
    return tuple(values[name] for name in names)


def _shown(self: Any) -> str:
    fields = ", ".join(f"{name}={getattr(self, name)!r}" for name in self.__match_args__)
    return f"{type(self).__qualname__}({fields})"


def _refused(self: Any, name: str, *_: object) -> None:
    raise AttributeError(f"a {type(self).__qualname__} cannot be changed: {name}")
