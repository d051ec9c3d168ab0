"""Convert values of spaces to and from messages, where they are numbers, nested lists, or arrays in base64."""

from __future__ import annotations

import binascii
from base64 import b64decode
from collections.abc import Callable, Sequence
from math import inf, prod
from typing import Any, Final

import numpy as np
from gymnasium import Space, spaces
from numpy.typing import NDArray

from tltl_runtime.wire.document import a_list, a_text, a_whole_number, an_object, member, wrong
from tltl_runtime.wire.errors import MalformedMessageError
from tltl_runtime.wire.json_text import value_text
from tltlc.api import fileio

_MOST_AXES: Final = fileio.limits.WIRE_HELLO.depth or 0

_INFINITE: Final = (inf, -inf)

Reader = Callable[[Any], Any]
Writer = Callable[[Any], Any]

_DTYPES: Final = {
    name: np.dtype(name).newbyteorder("<")
    for name in ("float32", "float64", "int8", "int16", "int32", "int64", "uint8", "uint16", "uint32", "uint64")
}


def value_reader(space: Space[Any], path: str) -> Reader:
    """Return a function that converts a value in a message to a value of ``space``.

    The function raises MalformedMessageError if the value is not in the space. ``path`` is the place of
    the value in the message, such as ``state.observation``; errors name it.
    """
    if isinstance(space, spaces.Dict):
        return _dict_reader({key: value_reader(part, member(path, key)) for key, part in space.items()}, path)
    if isinstance(space, spaces.Tuple):
        return _tuple_reader([value_reader(part, f"{path}[{index}]") for index, part in enumerate(space)], path)
    if isinstance(space, spaces.Discrete):
        least, most = int(space.start), int(space.start + space.n) - 1
        return lambda value: np.int64(a_whole_number(value, path, least, most))
    if isinstance(space, spaces.Box) and np.dtype(space.dtype).kind == "f":
        return _float_reader(space, path)
    if isinstance(space, (spaces.Box, spaces.MultiDiscrete, spaces.MultiBinary)):
        return _whole_number_reader(space, path)
    raise TypeError(f"the protocol has no space such as {space}")


def value_writer(space: Space[Any]) -> Writer:
    """Return a function that converts a value of ``space`` to a value of JSON.

    The function raises ValueError for what is not in the space.
    """
    write = _writer(space)

    def checked(value: Any) -> Any:
        try:
            return write(value)
        except (LookupError, TypeError, OverflowError) as error:
            raise ValueError(f"the action is {value!r:.200}, which is not in {space}") from error

    return checked


def _writer(space: Space[Any]) -> Writer:
    if isinstance(space, spaces.Dict):
        writers = {key: _writer(part) for key, part in space.items()}
        return lambda value: {key: write(value[key]) for key, write in writers.items()}
    if isinstance(space, spaces.Tuple):
        parts = [_writer(part) for part in space]
        return lambda value: [write(item) for write, item in zip(parts, value, strict=True)]
    if isinstance(space, spaces.Discrete):
        return _choice_writer(space)
    return _array_writer(space)


def array_from(value: Any, path: str) -> NDArray[Any]:
    """Return the numbers at ``path`` in a message, nested lists or an array in base64, as an array.

    Raises MalformedMessageError if ``value`` is neither. Numbers that are not finite are not refused here.
    """
    if isinstance(value, dict):
        return _decoded(value, path)
    try:
        array = np.array(value)
    except ValueError:
        raise MalformedMessageError(f"sent `{path}` with lists of unequal lengths") from None
    if array.dtype.kind not in "iuf":
        raise wrong(path, "numbers, in nested lists or in base64", value if array.ndim == 0 else array.flat[0])
    return array


def _decoded(table: dict[str, Any], path: str) -> NDArray[Any]:
    """Return the array that ``{"base64": …, "dtype": …, "shape": …}`` contains.

    Its bytes are little-endian, and the last index changes fastest. In MessagePack, the key ``bytes`` may
    have the bytes themselves, in place of ``base64``.
    """
    text, name, data = table.get("base64"), table.get("dtype"), table.get("bytes")
    if not isinstance(text, str) and not isinstance(data, bytes):
        raise wrong(path, 'numbers, in nested lists or as {"base64": …, "dtype": …, "shape": …}', table)
    if not isinstance(name, str) or name not in _DTYPES:
        raise wrong(f"{path}.dtype", f"one of {', '.join(_DTYPES)}", name)
    sizes = a_list(table.get("shape"), f"{path}.shape")
    shape = tuple(a_whole_number(number, f"{path}.shape", 0) for number in sizes)
    try:
        data = data if isinstance(data, bytes) else b64decode(text or "", validate=True)
    except (binascii.Error, ValueError):
        raise MalformedMessageError(f"sent `{path}.base64`, which is not base64") from None
    if len(data) != prod(shape) * _DTYPES[name].itemsize or len(shape) > _MOST_AXES:
        raise MalformedMessageError(
            f"sent `{path}` with {len(data):,} bytes, which do not fill its shape {list(shape)}"
        )
    return np.frombuffer(data, _DTYPES[name]).reshape(shape)


def _float_reader(space: spaces.Box, path: str) -> Reader:
    kind: np.dtype[Any] = np.dtype(space.dtype)
    finite: Any = np.finfo(kind)
    # With finite bounds, one comparison also finds infinite numbers and NaN.
    low, high = np.maximum(space.low, finite.min), np.minimum(space.high, finite.max)
    # Most observations are short lists, for which Python's own comparisons are faster than those of arrays.
    is_flat = len(space.shape) == 1 and space.shape[0] > 0
    least, most = (float(low.max()), float(high.min())) if is_flat else (0.0, 0.0)

    def read(value: Any) -> NDArray[Any]:
        if is_flat and type(value) is list and len(value) == space.shape[0] and _all_between(value, least, most):
            return np.array(value, kind)
        array = _shaped(value, path, space.shape)
        if array.dtype == kind:
            result: NDArray[Any] = array.copy()
        else:
            with np.errstate(over="ignore"):
                result = array.astype(kind)
        if not ((result >= low) & (result <= high)).all():
            if not np.isfinite(array).all():
                raise MalformedMessageError(f"sent `{path}` with a number that is not finite")
            if not np.isfinite(result).all():
                raise MalformedMessageError(f"sent `{path}` with numbers that are too large for {kind}")
            raise _out_of_range(path, array, (result >= low) & (result <= high), space.low, space.high)
        return result

    return read


def _all_between(numbers: Sequence[Any], least: float, most: float) -> bool:
    """Whether all items are floats or whole numbers from ``least`` to ``most``, of which NaN is none."""
    for number in numbers:
        kind = type(number)
        if (kind is not float and kind is not int) or not least <= number <= most:
            return False
    return True


def _whole_number_reader(space: Space[Any], path: str) -> Reader:
    low, high = _bounds(space)

    def read(value: Any) -> NDArray[Any]:
        array = _shaped(value, path, space.shape)
        if array.dtype.kind == "f" and not (np.isfinite(array).all() and (array == np.trunc(array)).all()):
            raise MalformedMessageError(f"sent `{path}` with numbers that are not whole, but declared {space.dtype}")
        # Compare before the conversion, which would wrap numbers around.
        in_range = (array >= low) & (array <= high)
        if not in_range.all():
            raise _out_of_range(path, array, in_range, low, high)
        return array.astype(space.dtype)

    return read


def _out_of_range(
    path: str, array: NDArray[Any], in_range: NDArray[np.bool_], low: Any, high: Any
) -> MalformedMessageError:
    """Return the error for the first number that is not in its range; bounds are one for all, or have the shape."""
    index = tuple(np.argwhere(~in_range)[0].tolist())
    least, most = (np.broadcast_to(bound, array.shape)[index] for bound in (low, high))
    place = path + "".join(f"[{number}]" for number in index)
    return MalformedMessageError(
        f"sent {value_text(array[index].item())} as `{place}`, outside its declared range from {least:g} to {most:g}"
    )


def _shaped(value: Any, path: str, shape: tuple[int, ...] | None) -> NDArray[Any]:
    array = array_from(value, path)
    if array.shape != shape:
        raise MalformedMessageError(f"sent `{path}` in the shape {list(array.shape)}, but declared {list(shape or ())}")
    return array


def _dict_reader(readers: dict[str, Reader], path: str) -> Reader:
    def read(value: Any) -> dict[str, Any]:
        parts = an_object(value, path)
        for key in readers:
            if key not in parts:
                raise MalformedMessageError(f"sent `{path}` without the declared key `{key}`")
        return {key: read_part(parts[key]) for key, read_part in readers.items()}

    return read


def _tuple_reader(readers: list[Reader], path: str) -> Reader:
    def read(value: Any) -> tuple[Any, ...]:
        parts = a_list(value, path)
        if len(parts) != len(readers):
            raise MalformedMessageError(f"sent `{path}` with {len(parts)} parts, but declared {len(readers)}")
        return tuple(read_part(part) for read_part, part in zip(readers, parts, strict=True))

    return read


def _choice_writer(space: spaces.Discrete) -> Writer:
    least, end = int(space.start), int(space.start + space.n)

    def write(value: Any) -> int:
        choice = int(value)
        if choice != value or not least <= choice < end:
            raise ValueError(f"the action is {value}, which is not in {space}")
        return choice

    return write


def _array_writer(space: Space[Any]) -> Writer:
    low, high = _bounds(space)
    # Most actions are short lists, for which Python's own comparisons are faster than those of arrays.
    is_flat, kind = len(space.shape or ()) == 1, np.dtype(space.dtype)
    item = float if kind.kind == "f" else int
    least, most = (np.broadcast_to(bound, space.shape or ()).ravel().tolist() for bound in (low, high))

    def write(value: Any) -> Any:
        numbers = value.tolist() if type(value) is np.ndarray and value.dtype == kind else value
        if is_flat and type(numbers) is list and len(numbers) == len(least) and (item is int or numbers is not value):
            for number, low_, high_ in zip(numbers, least, most, strict=True):
                if type(number) is not item or not low_ <= number <= high_ or number in _INFINITE:
                    break
            else:
                return numbers
        array = np.asarray(value, dtype=space.dtype)
        if array.shape != space.shape or not ((array >= low) & (array <= high)).all() or not np.isfinite(array).all():
            raise ValueError(f"the action is {a_short_text(array)}, which is not in {space}")
        return array.tolist()

    return write


def a_short_text(array: NDArray[Any]) -> str:
    """Return the first eight numbers of an array as a text for an error message."""
    return a_text(str(array.ravel()[:8].tolist()), "action") + (" …" if array.size > 8 else "")


def _bounds(space: Space[Any]) -> tuple[Any, Any]:
    if isinstance(space, spaces.Box):
        return space.low, space.high
    if isinstance(space, spaces.MultiDiscrete):
        return space.start, space.start + space.nvec - 1
    return 0, 1
