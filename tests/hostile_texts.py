"""Make texts on which a regular expression backtracks as much as possible, from its pattern."""

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
    """Yield texts for each repetition in a pattern that has no upper limit.

    A text consists of a beginning that leads to the repetition, a text that it can repeat,
    ``times`` over, and an end that probably does not match.
    """
    for before, pumps in _repetitions(sre_parse.parse(pattern, flags)):
        for pump, end in product(pumps, _ENDS):
            yield before + pump * times + end


def _repetitions(parts: Any) -> Iterator[tuple[str, list[str]]]:
    """Yield for each unlimited repetition a text that leads to it and texts that it can repeat."""
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
    """Return texts that can be repeated: texts that ``body`` matches, and single characters.

    Several branches of ``body`` may match the same character.
    """
    samples = [text for text in _samples(body) if text]
    letters = sorted({letter for text in _samples(body, whole=True) for letter in text} | {"\\", "a"})
    usable = [letter for letter in letters if re.fullmatch("[^\x00]", letter)]
    return list(dict.fromkeys([*samples, *usable[:12]]))


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
    """Return a few texts that ``parts`` match.

    If ``whole``, optional repetitions occur in them once; otherwise they are left out.
    """
    texts = [""]
    for op, value in parts:
        name = str(op)
        if name in ("LITERAL", "NOT_LITERAL"):
            choices = [chr(value) if name == "LITERAL" else _other(chr(value))]
        elif name == "ANY":
            choices = ["a", "\\"]
        elif name == "IN":
            choices = _members(value)
        elif name == "BRANCH":
            choices = [text for branch in value[1] for text in _samples(branch, whole=whole)]
        elif name.endswith("_REPEAT"):
            choices = _samples(value[2], whole=whole) if value[0] or whole else [""]
            choices = [text * max(1, value[0]) for text in choices]
        else:
            choices = [text for inner in _inside(name, value) for text in _samples(inner, whole=whole)] or [""]
        texts = [left + right for left, right in product(texts, choices[:_MOST_SAMPLES])][:_MOST_SAMPLES]
    return texts


def _members(values: Any) -> list[str]:
    """Return a few characters of a set."""
    first = values[0][0]
    if str(first) == "NEGATE":
        barred = re.compile("[" + "".join(map(_set_text, values[1:])) + "]", re.DOTALL)
        return [letter for letter in 'a\\ "(\n' if not barred.match(letter)] or ["~"]
    characters = []
    for op, value in values:
        if str(op) == "LITERAL":
            characters.append(chr(value))
        elif str(op) == "RANGE":
            characters.append(chr(value[0]))
        else:
            characters.append(_CLASSES.get(str(value), "-"))
    return characters


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
