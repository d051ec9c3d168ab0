"""Read and write messages of Protocol Buffers by the numbers of their fields, without generated code.

The format: https://protobuf.dev/programming-guides/encoding. A message is a sequence of fields; a field is a number,
a type and a value.
"""

from __future__ import annotations

from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from tltl_runtime.wire.errors import MalformedMessageError

_VARINT, _EIGHT_BYTES, _BYTES, _FOUR_BYTES = 0, 1, 2, 5
_LONGEST_VARINT: Final = 10

Fields = dict[int, list[Any]]
"""The values of each field by its number: whole numbers from 0 to 2^64 - 1, or bytes."""


def fields(data: bytes) -> Fields:
    """Return the fields of a message; raises MalformedMessageError if ``data`` is no message."""
    result: Fields = {}
    place = 0
    while place < len(data):
        key, place = _varint(data, place)
        kind = key & 7
        if kind == _VARINT:
            value, place = _varint(data, place)
            result.setdefault(key >> 3, []).append(value)
            continue
        if kind not in (_BYTES, _EIGHT_BYTES, _FOUR_BYTES):
            raise _not_protobuf()
        length = 4 if kind == _FOUR_BYTES else 8
        if kind == _BYTES:
            length, place = _varint(data, place)
        if place + length > len(data):
            raise _not_protobuf()
        result.setdefault(key >> 3, []).append(data[place : place + length])
        place += length
    return result


def message(parts: Fields, number: int) -> Fields:
    """Return the fields of the message in the field ``number``; without it, those of an empty message."""
    return fields(_last(parts, number, b"", bytes))


def messages(parts: Fields, number: int) -> list[Fields]:
    """Return the fields of each message in the repeated field ``number``."""
    return [fields(_checked(value, bytes)) for value in parts.get(number, [])]


def text(parts: Fields, number: int) -> str:
    """Return the text in the field ``number``; empty without it."""
    try:
        result: str = _last(parts, number, b"", bytes).decode()
    except UnicodeDecodeError:
        raise _not_protobuf() from None
    return result


def whole(parts: Fields, number: int) -> int:
    """Return the whole number in the field ``number``, from -2^63 to 2^63 - 1; 0 without it."""
    return _signed(_last(parts, number, 0, int))


def wholes(parts: Fields, number: int) -> list[int]:
    """Return the whole numbers in the repeated field ``number``."""
    result: list[int] = []
    for value in parts.get(number, []):
        if isinstance(value, int):
            result.append(_signed(value))
            continue
        place = 0
        while place < len(value):
            packed, place = _varint(value, place)
            result.append(_signed(packed))
    return result


def floats(parts: Fields, number: int) -> bytes:
    """Return the numbers of the type float in the repeated field ``number``, as four little-endian bytes each."""
    return b"".join(_checked(value, bytes) for value in parts.get(number, []))


def field(number: int, value: int | str | bytes) -> bytes:
    """Return the bytes of a field with a whole number, or a text, or the bytes of a message."""
    if isinstance(value, int):
        return _varint_bytes(number << 3 | _VARINT) + _varint_bytes(value & (1 << 64) - 1)
    data = value.encode() if isinstance(value, str) else value
    return _varint_bytes(number << 3 | _BYTES) + _varint_bytes(len(data)) + data


def packed_wholes(number: int, values: NDArray[np.int64]) -> bytes:
    """Return the bytes of a repeated field with whole numbers."""
    return field(number, b"".join(_varint_bytes(int(value) & (1 << 64) - 1) for value in values))


def packed_floats(number: int, values: NDArray[np.float32]) -> bytes:
    """Return the bytes of a repeated field with numbers of the type float."""
    return field(number, values.astype("<f4").tobytes())


def _varint(data: bytes, place: int) -> tuple[int, int]:
    """Return the whole number that begins at ``place``, and the place after it."""
    value = 0
    for index, byte in enumerate(data[place : place + _LONGEST_VARINT]):
        value |= (byte & 127) << 7 * index
        if byte < 128:
            return value & (1 << 64) - 1, place + index + 1
    raise _not_protobuf()


def _varint_bytes(value: int) -> bytes:
    result = bytearray()
    while value > 127:
        result.append(value & 127 | 128)
        value >>= 7
    return bytes([*result, value])


def _signed(value: int) -> int:
    return value - (1 << 64) if value >> 63 else value


def _last(parts: Fields, number: int, default: Any, kind: type) -> Any:
    return _checked(parts[number][-1], kind) if number in parts else default


def _checked(value: Any, kind: type) -> Any:
    if not isinstance(value, kind):
        raise _not_protobuf()
    return value


def _not_protobuf() -> MalformedMessageError:
    return MalformedMessageError("sent a message that is not that of ML-Agents")
