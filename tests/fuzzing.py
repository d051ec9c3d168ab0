"""Make damaged inputs for readers of files from valid inputs.

Pieces are cut out, doubled, nested or replaced. Every input is made from a seed, so that the seed
reproduces a failure.
"""

from __future__ import annotations

import json
import re
from collections.abc import Callable
from copy import deepcopy
from random import Random
from typing import Any, Final

from hypothesis import HealthCheck, settings
from hypothesis import strategies as st

from tltlc.diagnostics.diagnostic import TltlError
from tltlc.diagnostics.render import render

SEEDS: Final = st.integers(0, 2**64 - 1)


def times(usual: int) -> settings:
    """Return settings with ``usual`` examples, or with thirty times as many in `make fuzz`."""
    count = usual if settings().derandomize else 30 * usual
    return settings(max_examples=count, deadline=None, suppress_health_check=list(HealthCheck))


NUMBERS: Final = (
    *("0", "-0", "-0.0", "1", "-1", "0.5", "2147483648", "9223372036854775808", "-18446744073709551616", "1e16"),
    *("1e308", "-1e308", "1e309", "5e-324", "1" + "0" * 400, "-1" + "0" * 400, "1" + "0" * 5000, "NaN", "Infinity"),
)
"""Numbers of JSON, and NaN and Infinity, which only Python accepts."""

VALUES: Final = (
    *NUMBERS, *("true", "false", "null", '""', "[]", "{}", "[[]]", "[null]", '{"": 0}', '"\\u0000"', '"\\ud800"'),
    *('"nan"', '"1"', '"-"', '"é"', '"' + "a" * 300 + '"', "[" * 50 + "]" * 50, '{"a":' * 50 + "0" + "}" * 50),
)  # fmt: skip

PIECES: Final = (
    *("", "nan", "-inf", "+inf", "0x" + "f" * 40, "0b1" + "0" * 70, "1_000", "1979-05-27", "24:61:00", "1979-99-99"),
    *("\0", "\ufeff", "\r", "\n", "\t", "=", "[", "]", "[[", "{", "}", '"', "'", '"""', "#", ",", ".", ":", "&", "|"),
    *("!", "(", ")", "@", "é", "𝒰", "²", "\u2028", "t", "f", "/*", "*/"),
)


class _Raw(str):
    """A piece of JSON that :func:`json_text` writes as it is."""


def check(read: Callable[[], object]) -> bool:
    """Return whether a reader accepts its input.

    The reader may raise no error but a TltlError that can be rendered.
    """
    try:
        read()
    except TltlError as error:
        render(error.diagnostics, "text")
        return False
    return True


def mutated_text(random: Random, text: str) -> str:
    """Return a text with a few of its pieces changed."""
    for _ in range(random.choice((1, 1, 1, 2, 3, 6))):
        text = random.choice((_other_number, _other_number, _other_lines, _other_piece, _other_word))(random, text)
    return text


def _other_number(random: Random, text: str) -> str:
    matches = list(re.finditer(r"(?<![\w.])-?\d[\d._]*(?:[eE][-+]?\d+)?", text))
    if not matches:
        return text
    place = random.choice(matches)
    return text[: place.start()] + random.choice(VALUES if random.random() < 0.4 else NUMBERS) + text[place.end() :]


def _other_lines(random: Random, text: str) -> str:
    lines = text.split("\n")
    start = random.randrange(len(lines))
    end = min(len(lines), start + random.choice((1, 1, 1, 2, 5)))
    place = random.randrange(len(lines))
    change = random.randrange(4)
    if change == 0:
        del lines[start:end]
    elif change == 1:
        lines[place:place] = lines[start:end]
    elif change == 2:
        lines[place:place] = lines[start:end] * 3
    else:
        del lines[start:]
    return "\n".join(lines)


def _other_piece(random: Random, text: str) -> str:
    start = random.randint(0, len(text))
    end = min(len(text), start + random.choice((0, 1, 1, 5, 40)))
    piece = random.choice((*PIECES, *VALUES, text[start:end] * 2, text[start:end][::-1]))
    return text[:start] + piece + text[end:]


def _other_word(random: Random, text: str) -> str:
    """Replace a word of the text by another one."""
    matches = list(re.finditer(r"[\w.]+", text))
    if not matches:
        return text
    place, other = random.choice(matches), random.choice(matches)
    return text[: place.start()] + other.group() + text[place.end() :]


def mutated_bytes(random: Random, data: bytes) -> bytes:
    """Return data with some bits flipped, and some bytes replaced, doubled or cut off."""
    changed = bytearray(data)
    for _ in range(random.choice((1, 1, 2, 5, 20))):
        start = random.randint(0, len(changed))
        end = min(len(changed), start + random.choice((1, 1, 4, 100)))
        change = random.randrange(6)
        if change <= 2 and start < len(changed):
            changed[start] ^= 1 << random.randrange(8)
        elif change == 3:
            changed[start:end] = random.choice((b"", b"\0" * 8, b"\xff" * 8, bytes(changed[start:end]) * 2))
        elif change == 4:
            changed[start:end] = random.randbytes(end - start)
        elif random.random() < 0.3:
            del changed[start:]
    return bytes(changed)


def mutated_json(random: Random, document: Any) -> str:
    """Return a document as JSON, with a few values changed.

    In one case of ten, the text is changed as well.
    """
    document = [deepcopy(document)]
    for _ in range(random.choice((1, 1, 1, 2, 3))):
        _change(random, document)
    text = json_text(document[0])
    return text if random.random() < 0.9 else mutated_text(random, text)


def _change(random: Random, document: list[Any]) -> None:
    """Change one value in place.

    A random walk from the root chooses the value, so that long lists are not preferred.
    """
    holder: Any = document
    key: Any = 0
    while isinstance(holder[key], (dict, list)) and holder[key] and random.random() < 0.85:
        holder = holder[key]
        key = random.choice(list(holder)) if isinstance(holder, dict) else random.randrange(len(holder))
    change = random.randrange(8)
    if change <= 3:
        holder[key] = _Raw(random.choice(VALUES if change else NUMBERS))
    elif change == 4 and holder is not document:
        del holder[key]
    elif change == 5:
        holder[key] = random.choice(([holder[key]], {"a": holder[key]}, [holder[key]] * 2, {str(holder[key])[:20]: 1}))
    elif isinstance(holder, list) and holder is not document:
        holder.insert(random.randrange(len(holder)), deepcopy(holder[key]))
    elif isinstance(holder, dict):
        other = random.choice([*holder, "name", "", "version"])
        holder[other], holder[key] = deepcopy(holder[key]), deepcopy(holder.get(other, 0))


def json_text(document: Any) -> str:
    """Return a document as JSON, with pieces of :class:`_Raw` as they are."""
    if isinstance(document, _Raw):
        return str(document)
    if isinstance(document, dict):
        return "{" + ",".join(f"{json.dumps(name)}:{json_text(value)}" for name, value in document.items()) + "}"
    if isinstance(document, list):
        return "[" + ",".join(map(json_text, document)) + "]"
    return json.dumps(document)
