"""JSON texts of messages: strict, without NaN or infinite numbers, and fast to read and write."""

from __future__ import annotations

import json
from typing import Any, Final, NoReturn

from tltl_runtime.wire.errors import MalformedMessageError

_SHOWN: Final = 60
"""The most characters of a message that an error quotes."""


def _refuse_constant(name: str) -> NoReturn:
    raise MalformedMessageError(f"sent the number {name}, and numbers must be finite")


_DECODER: Final = json.JSONDecoder(parse_constant=_refuse_constant)
_ENCODER: Final = json.JSONEncoder(separators=(",", ":"), allow_nan=False)


def parse(line: bytes | bytearray) -> Any:
    """Return the value of a JSON text.

    A number that is too large for a float, such as ``1e999``, becomes infinite; the code that reads
    values refuses it later.

    Raises:
        MalformedMessageError: the text is not JSON, or contains NaN or Infinity.
    """
    try:
        return _DECODER.decode(line.decode())
    except MalformedMessageError:
        raise
    except UnicodeDecodeError:
        raise MalformedMessageError(f"sent a line that is not UTF-8: {quoted(line)}") from None
    except RecursionError:
        raise MalformedMessageError("sent a message that nests too deep") from None
    except ValueError:  # A JSONDecodeError, or an integer of thousands of digits.
        raise MalformedMessageError(f"sent a line that is not JSON: {quoted(line)}") from None


def line(message: Any) -> bytes:
    """Return a message as a line of JSON; raises ValueError if a number is not finite."""
    return _ENCODER.encode(message).encode() + b"\n"


def quoted(data: bytes | bytearray) -> str:
    """Return the beginning of ``data`` as text in backticks for an error message, without control characters."""
    text = data[: 4 * _SHOWN].decode(errors="replace")
    return f"`{shortened(text)}`"


def shortened(text: str) -> str:
    """Return the beginning of a text for an error message: at most 60 characters and ``…``, in one line."""
    printable = "".join(
        char if char.isprintable() else "\N{REPLACEMENT CHARACTER}" for char in text[: 2 * _SHOWN].strip()
    )
    return printable if len(printable) <= _SHOWN else printable[:_SHOWN] + "…"


def value_text(value: Any) -> str:
    """Return a value of JSON for an error message: ``true``, ``3``, ``"text"``, or only "a list" or "an object"."""
    if isinstance(value, list):
        return "a list"
    if isinstance(value, dict):
        return "an object"
    if isinstance(value, str):
        return f'"{shortened(value)}"'
    return shortened(json.dumps(value)) if isinstance(value, (bool, float, type(None))) else shortened(_whole(value))


def _whole(value: Any) -> str:
    # Python refuses to write a whole number of thousands of digits.
    return str(value) if isinstance(value, int) and value.bit_length() < 1000 else type(value).__name__
