"""Requests of tltlc, and the same lines damaged: what the readers of the clients are tested with."""

from __future__ import annotations

import json
import math
import random
import struct
from collections.abc import Iterator
from typing import Any

TEXTS = ("", "crypt", "v0", "ä", "日本", "🎮", 'a"b\\c/', "a\tb\x7f", "\u2028", "x" * 300)
PIECES: tuple[bytes, ...] = (
    *(b"\\u0000", b"\\ud83d\\ude00", b"\\ud83d", b"\\udc00", b"\\u00e4", b"\\n", b"\\x", b"\\", b'"'),
    *(b"[", b"]", b"{", b"}", b",", b":", b"[" * 80, b'"seed":', b'"action":', b"null", b"true", b"falsch"),
    *(b"-", b"0", b"01", b"1e5", b"1E+2", b".5", b"1.", b"-0.0", b"1e999", b"NaN", b"Infinity", b"1" * 30),
    *(b" ", b"\t", b"\r", b"\x00", b"\x1f", b"\xff", b"\xc3", b"\xed\xa0\x80", b"\xf4\x90\x80\x80", b"\xef\xbb\xbf"),
)


def request(chance: random.Random) -> dict[str, Any]:
    """Return a request, or something like one."""
    kind = chance.choice(
        ("reset", "step", "step", "restore", "release", "snapshot", "screenshot", "outline", "close", "telepathy")
    )
    body: dict[str, Any] = {}
    if kind == "reset":
        body = {"scene": chance.choice(TEXTS), "variant": chance.choice(TEXTS), "seed": chance.randrange(1 << 53)}
    elif kind == "step":
        body = {"action": _value(chance, 0), "repeat": chance.randrange(1, 9)}
    elif kind in ("restore", "release"):
        body = {"id": chance.choice((1, -3, 2**40, "three", 1.5, None))}
    if chance.random() < 0.3:
        body[chance.choice(("later", "seed", "action", "id"))] = _value(chance, 0)
    return {kind: body, **({"also": _value(chance, 0)} if chance.random() < 0.1 else {})}


def _value(chance: random.Random, depth: int) -> Any:
    kind = chance.randrange(8 if depth < 5 else 5)
    if kind == 0:
        return chance.choice((None, True, False))
    if kind == 1:
        return chance.choice(TEXTS)
    if kind == 2:
        return chance.choice((0, 1, -1, 2**53 - 1, -(2**53), 10**20, chance.randrange(-1000, 1000)))
    if kind < 5:
        return a_float(chance)
    if kind == 5:
        return {chance.choice(TEXTS): _value(chance, depth + 1) for _ in range(chance.randrange(4))}
    return [_value(chance, depth + 1) for _ in range(chance.randrange(5))]


def a_float(chance: random.Random) -> float:
    """Return a finite number of any size, with any bits."""
    if chance.random() < 0.3:
        return chance.choice((0.0, -0.0, 0.1, 1 / 3, 5e-324, 1.7976931348623157e308, 2.0**53, 1e15, 1e16, 1e22, -1e-7))
    while not math.isfinite(value := float(struct.unpack("<d", chance.randbytes(8))[0])):
        pass
    return value


def lines(seed: int, count: int) -> Iterator[bytes]:
    """Yield lines without their ends: three of four are damaged or cut."""
    chance = random.Random(seed)
    for _ in range(count):
        text = json.dumps(request(chance), ensure_ascii=chance.random() < 0.5)
        line = bytearray(text.encode())
        way = chance.randrange(4)
        for _ in range(chance.randrange(1, 4) if way else 0):
            place = chance.randrange(len(line) + 1)
            if way == 1:
                del line[place:]
            elif way == 2:
                line[place : place + chance.randrange(3)] = chance.choice(PIECES)
            else:
                line[place : place + chance.randrange(8)] = chance.randbytes(chance.randrange(4))
        yield bytes(line).replace(b"\n", b" ")


def parsed(line: bytes, first_of_equals: bool = False) -> Any:
    """Return the value of a line as Python reads it.

    Of equal keys the last counts, or the first with ``first_of_equals``.

    Raises:
        ValueError: the line is not JSON in UTF-8, or a number is not finite.
    """
    return json.loads(
        line.decode(),
        parse_constant=_refuse,
        parse_float=_finite,
        parse_int=_whole,
        object_pairs_hook=_first_of_equals if first_of_equals else dict,
    )


def depth(value: Any) -> int:
    """Return how many lists and objects are around the deepest value."""
    if isinstance(value, dict):
        return 1 + max(map(depth, value.values()), default=0)
    return 1 + max(map(depth, value), default=0) if isinstance(value, list) else 0


def _first_of_equals(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
    table: dict[str, Any] = {}
    for key, value in pairs:
        table.setdefault(key, value)
    return table


def _refuse(text: str) -> float:
    raise ValueError(text)


def _finite(text: str) -> float:
    return float(text) if math.isfinite(float(text)) else _refuse(text)


def _whole(text: str) -> float:
    value = int(text)
    return value if abs(value) <= 2**53 else _finite(text)
