"""Convert spaces of Gymnasium to JSON, and back."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from math import inf, isfinite, prod
from typing import Any, Final

import numpy as np
from gymnasium import Space, spaces
from numpy.typing import NDArray

from tltl_runtime.support.suggestion import suggestion
from tltl_runtime.wire.document import a_list, a_text, a_whole_number, an_object, member, wrong
from tltl_runtime.wire.errors import MalformedMessageError
from tltlc.api import fileio

_DTYPES: Final = {
    name: np.dtype(name)
    for name in ("float32", "float64", "int8", "int16", "int32", "int64", "uint8", "uint16", "uint32", "uint64")
}
_MOST_CHOICES: Final = 2**31 - 1
_MOST_NUMBERS: Final = fileio.limits.WIRE_HELLO.values or 0
_DEEPEST: Final = fileio.limits.WIRE_HELLO.depth or 0


def space_from(document: Any, path: str) -> Space[Any]:
    """Return the space that ``document``, a value of JSON, describes: ``{"type": "discrete", "n": 3}``.

    ``path`` is the place of the document in the message, such as ``hello.actions``.

    Raises:
        MalformedMessageError: the document describes no space, or one that nests too deep or has too many
            numbers. The text names the wrong part by its path.
    """
    space = _space(document, path, 1)
    if (count := size(space)) > _MOST_NUMBERS:
        raise MalformedMessageError(f"declares `{path}` with {count:,} numbers; at most {_MOST_NUMBERS:,} are allowed")
    return space


def document_of(space: Space[Any]) -> dict[str, Any]:
    """Return a space as a value of JSON, as :func:`space_from` reads it.

    Raises TypeError for a space that the protocol does not have.
    """
    if isinstance(space, spaces.Discrete):
        return {"type": "discrete", "n": int(space.n)} | ({"start": int(space.start)} if space.start else {})
    if isinstance(space, spaces.MultiDiscrete):
        return {"type": "multi_discrete", "nvec": space.nvec.tolist()} | (
            {"start": space.start.tolist()} if space.start.any() else {}
        )
    if isinstance(space, spaces.MultiBinary):
        return {
            "type": "multi_binary",
            "n": list(space.n) if isinstance(space.n, (tuple, list, np.ndarray)) else int(space.n),
        }
    if isinstance(space, spaces.Box) and str(space.dtype) in _DTYPES:
        low, high = _bound_document(space.low), _bound_document(space.high)
        return {"type": "box", "low": low, "high": high, "shape": list(space.shape), "dtype": str(space.dtype)}
    if isinstance(space, spaces.Dict):
        return {"type": "dict", "spaces": {key: document_of(part) for key, part in space.items()}}
    if isinstance(space, spaces.Tuple):
        return {"type": "tuple", "spaces": [document_of(part) for part in space]}
    raise TypeError(f"the protocol has no space such as {space}")


def size(space: Space[Any]) -> int:
    """Return how many numbers a value of a space has, all parts together."""
    if isinstance(space, spaces.Dict):
        return sum(map(size, space.values()))
    if isinstance(space, spaces.Tuple):
        return sum(map(size, space))
    return prod(space.shape or ())


def _space(document: Any, path: str, depth: int) -> Space[Any]:
    if depth > _DEEPEST:
        raise MalformedMessageError(f"declares `{path}` as a space that nests deeper than {_DEEPEST} levels")
    table = an_object(document, path)
    kind = a_text(table.get("type"), f"{path}.type")
    if kind == "dict":
        parts = an_object(table.get("spaces"), f"{path}.spaces")
        return spaces.Dict({key: _space(part, member(f"{path}.spaces", key), depth + 1) for key, part in parts.items()})
    if kind == "tuple":
        items = a_list(table.get("spaces"), f"{path}.spaces")
        return spaces.Tuple([_space(part, f"{path}.spaces[{index}]", depth + 1) for index, part in enumerate(items)])
    if kind not in _SIMPLE:
        hint = suggestion(kind, (*_SIMPLE, "dict", "tuple"))
        raise MalformedMessageError(f"declares `{path}` as a space of the unknown type `{kind}`; {hint}")
    return _SIMPLE[kind](table, path)


def _discrete(table: Mapping[str, Any], path: str) -> Space[Any]:
    start = a_whole_number(table.get("start", 0), f"{path}.start", -_MOST_CHOICES)
    return spaces.Discrete(a_whole_number(table.get("n"), f"{path}.n", 1, _MOST_CHOICES), start=start)


def _multi_discrete(table: Mapping[str, Any], path: str) -> Space[Any]:
    counts = _whole_numbers(table.get("nvec"), f"{path}.nvec", 1)
    start = table.get("start")
    if start is None:
        return spaces.MultiDiscrete(counts)
    starts = _whole_numbers(start, f"{path}.start", -_MOST_CHOICES)
    if starts.shape != counts.shape:
        raise wrong(f"{path}.start", "a list with a number for each number of `nvec`", start)
    return spaces.MultiDiscrete(counts, start=starts)


def _multi_binary(table: Mapping[str, Any], path: str) -> Space[Any]:
    count = table.get("n")
    if isinstance(count, list):
        return spaces.MultiBinary(_shape(count, f"{path}.n"))
    return spaces.MultiBinary(a_whole_number(count, f"{path}.n", 1, _MOST_NUMBERS))


def _box(table: Mapping[str, Any], path: str) -> Space[Any]:
    name = table.get("dtype", "float32")
    if not isinstance(name, str) or name not in _DTYPES:
        raise wrong(f"{path}.dtype", f"one of {', '.join(_DTYPES)}", name)
    dtype, shape = _DTYPES[name], _shape(table.get("shape"), f"{path}.shape")
    low = _bound(table.get("low"), dtype, shape, f"{path}.low", lowest=True)
    high = _bound(table.get("high"), dtype, shape, f"{path}.high", lowest=False)
    if (low > high).any():
        raise MalformedMessageError(f"declares `{path}` with a `low` above its `high`")
    return spaces.Box(low, high, shape, dtype.type)


_SIMPLE: Final[Mapping[str, Callable[[Mapping[str, Any], str], Space[Any]]]] = {
    "discrete": _discrete,
    "multi_discrete": _multi_discrete,
    "multi_binary": _multi_binary,
    "box": _box,
}


def _shape(value: Any, path: str) -> tuple[int, ...]:
    sizes = [
        a_whole_number(number, f"{path}[{index}]", 1, _MOST_NUMBERS) for index, number in enumerate(a_list(value, path))
    ]
    if len(sizes) > _DEEPEST or prod(sizes) > _MOST_NUMBERS:
        raise MalformedMessageError(f"declares `{path}` with more than {_MOST_NUMBERS:,} numbers")
    return tuple(sizes)


def _whole_numbers(value: Any, path: str, least: int) -> NDArray[np.int64]:
    """Return a list of whole numbers, or nested lists of them, as an array; each is at least ``least``."""
    array = np.array(a_list(value, path), dtype=object)
    if array.size == 0:
        raise wrong(path, "a list of whole numbers, at least one", value)
    flat = [a_whole_number(number, path, least, _MOST_CHOICES) for number in array.flat]
    return np.array(flat, dtype=np.int64).reshape(array.shape)


def _bound(value: Any, dtype: np.dtype[Any], shape: tuple[int, ...], path: str, *, lowest: bool) -> NDArray[Any]:
    """Return the lower or the upper bounds of a Box as an array of ``shape``.

    ``value`` is a number for all elements, or nested lists. None, also inside lists, means that there is
    no bound. ``lowest`` says whether these are the lower bounds.
    """
    kind: Any = np.iinfo(dtype) if dtype.kind in "iu" else np.finfo(dtype)
    # Numbers of NumPy cannot be compared with whole numbers that are too large for a float.
    least, most = (float(kind.min), float(kind.max)) if dtype.kind == "f" else (int(kind.min), int(kind.max))
    none = (-inf if lowest else inf) if dtype.kind == "f" else (least if lowest else most)
    try:
        array = np.array(value, dtype=object)
    except ValueError:
        raise wrong(path, "a number, or nested lists of the space's shape", value) from None
    if array.shape not in ((), shape):
        raise wrong(path, "a number, or nested lists of the space's shape", value)
    flat = [none if number is None else number for number in array.flat]
    for number in flat:
        if type(number) not in (int, float) or not (number == none or least <= number <= most):
            raise wrong(path, f"numbers of the type {dtype}", number)
        if dtype.kind != "f" and number != int(number):
            raise wrong(path, f"numbers of the type {dtype}", number)
    result = np.array([dtype.type(number) for number in flat], dtype=dtype).reshape(array.shape)
    return np.array(np.broadcast_to(result, shape))


def _bound_document(bound: NDArray[Any]) -> Any:
    """Return the lower or the upper bounds of a Box as JSON: one number if all are equal, else nested lists.

    None stands for an infinite bound.
    """
    if bound.size and (bound == bound.flat[0]).all():
        first = bound.flat[0].item()
        return first if isfinite(first) else None
    document = bound.astype(object)
    document[~np.isfinite(bound)] = None
    return document.tolist()
