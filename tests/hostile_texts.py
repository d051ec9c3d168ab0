"""Texts that make a backtracking regular expression try every way to match: made from the pattern's own parts."""

from __future__ import annotations

import re
import warnings
from collections.abc import Iterator, Sequence
from itertools import product
from typing import Any, Final

with warnings.catch_warnings():
    warnings.simplefilter("ignore", DeprecationWarning)
    import sre_parse

_CLASSES: Final = {"CATEGORY_DIGIT": "0", "CATEGORY_WORD": "a", "CATEGORY_SPACE": " "}
_ENDS: Final = ("", "!", "\0", "\n", '"')
_MOST_SAMPLES: Final = 4


def hostile_texts(pattern: str, flags: int, times: int) -> Iterator[str]:
    """For each repetition in a pattern: what leads there, what it repeats ``times`` over, and an end that fails."""
    for before, pumps in _repetitions(sre_parse.parse(pattern, flags)):
        for pump, end in product(pumps, _ENDS):
            yield before + pump * times + end


def _repetitions(parts: Any) -> Iterator[tuple[str, list[str]]]:
    """For each repetition without an end: a text that leads to it, and texts that it repeats."""
    before = ""
    for op, value in parts:
        name = str(op)
        if name.endswith("_REPEAT"):
            _, most, body = value
            if most == sre_parse.MAXREPEAT:
                yield before, _pumps(body)
        for inner in _inside(name, value):
            yield from ((before + lead, pumps) for lead, pumps in _repetitions(inner))
        before += _samples([(op, value)])[0]


def _pumps(body: Any) -> list[str]:
    """Texts of a repeated part, also characters that several of its branches share."""
    samples = [text for text in _samples(body) if text]
    letters = sorted({letter for text in _samples(body, whole=True) for letter in text} | {"\\", "a"})
    fitting = [letter for letter in letters if re.fullmatch("[^\x00]", letter)]
    return list(dict.fromkeys([*samples, *fitting[:12]]))


def _inside(name: str, value: Any) -> Sequence[Any]:
    if name.endswith("_REPEAT"):
        return [value[2]]
    if name == "SUBPATTERN":
        return [value[3]]
    if name == "BRANCH":
        return list(value[1])
    if name == "ATOMIC_GROUP":
        return [value]
    return []


def _samples(parts: Any, *, whole: bool = False) -> list[str]:
    """A few texts that a part matches; ``whole``: also what stands in repetitions that may be left out."""
    found = [""]
    for op, value in parts:
        name = str(op)
        if name in ("LITERAL", "NOT_LITERAL"):
            some = [chr(value) if name == "LITERAL" else _other(chr(value))]
        elif name == "ANY":
            some = ["a", "\\"]
        elif name == "IN":
            some = _members(value)
        elif name == "BRANCH":
            some = [text for branch in value[1] for text in _samples(branch, whole=whole)]
        elif name.endswith("_REPEAT"):
            some = _samples(value[2], whole=whole) if value[0] or whole else [""]
            some = [text * max(1, value[0]) for text in some]
        else:
            some = [text for inner in _inside(name, value) for text in _samples(inner, whole=whole)] or [""]
        found = [left + right for left, right in product(found, some[:_MOST_SAMPLES])][:_MOST_SAMPLES]
    return found


def _members(values: Any) -> list[str]:
    """A few characters of a set."""
    first = values[0][0]
    if str(first) == "NEGATE":
        barred = re.compile("[" + "".join(map(_set_text, values[1:])) + "]", re.DOTALL)
        return [letter for letter in 'a\\ "(\n' if not barred.match(letter)] or ["~"]
    found = []
    for op, value in values:
        if str(op) == "LITERAL":
            found.append(chr(value))
        elif str(op) == "RANGE":
            found.append(chr(value[0]))
        else:
            found.append(_CLASSES.get(str(value), "-"))
    return found


def _set_text(member: Any) -> str:
    op, value = member
    if str(op) == "LITERAL":
        return re.escape(chr(value))
    if str(op) == "RANGE":
        return f"{re.escape(chr(value[0]))}-{re.escape(chr(value[1]))}"
    letter = {"DIGIT": "d", "WORD": "w", "SPACE": "s"}[str(value).rpartition("_")[2]]
    return "\\" + (letter.upper() if "NOT" in str(value) else letter)


def _other(letter: str) -> str:
    return "a" if letter != "a" else "b"
