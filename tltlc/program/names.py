"""Names and texts of a specification, made safe to stand in source code; where no more is said, in Python."""

from __future__ import annotations

import re
from collections.abc import Iterable, Sequence
from textwrap import wrap
from typing import Final

_LONGEST: Final = 40

_WORDS: Final = {">": " over ", "<": " under ", "-": " minus ", "+": " plus ", "*": " times ", "/": " per "}


class Names:
    """Gives out names of variables, each once: short, readable, in ASCII, never one that is ``reserved``."""

    def __init__(self, reserved: Iterable[str]) -> None:
        self._taken = set(reserved)

    def give(self, name: str, suffix: str = "") -> str:
        """A new name that resembles the given one; ``suffix`` is tried first where that is taken."""
        spelt = "".join(_WORDS.get(character, character) for character in name)
        base = re.sub(r"[^A-Za-z0-9]+", "_", spelt)[:_LONGEST].strip("_") or "x"
        if base[0].isdigit():
            base = f"x{base}"
        candidate, number = base, 1
        while candidate in self._taken:
            candidate = f"{base}_{suffix}" if suffix and number == 1 else f"{base}_{number}"
            number += 1
        self._taken.add(candidate)
        return candidate


def visible(text: str) -> str:
    """The text on one line, with escapes for whatever does not print: line ends, control and direction marks."""
    return "".join(
        character if character.isprintable() else f"\\u{ord(character):04x}" for character in " ".join(text.split())
    )


def comment(text: str) -> list[str]:
    """The text as lines of comment."""
    return [f"# {line}" for line in wrap(visible(text), 100, break_long_words=False, break_on_hyphens=False)]


def call(head: str, arguments: Sequence[str], tail: str = "") -> list[str]:
    """``head(arguments)tail`` on one line, or on several where that would be long."""
    line = f"{head}({', '.join(arguments)}){tail}"
    if len(line) <= 110:
        return [line]
    return [f"{head}(", *wrap(", ".join(arguments), 106, initial_indent="    ", subsequent_indent="    "), f"){tail}"]


def in_docstring(text: str) -> str:
    """The text for a place between three quotation marks; its lines, and how far each is indented, stay."""
    lines = [" " * (len(line) - len(line.lstrip(" "))) + visible(line) for line in text.splitlines()]
    return "\n".join(lines).replace("\\", "\\\\").replace('"', '\\"')


def literal(text: str) -> str:
    """A Python string literal, in double quotes where that needs no escape."""
    quoted = repr(text)
    return f'"{quoted[1:-1]}"' if quoted[0] == "'" and '"' not in quoted else quoted


def number(value: float) -> str:
    """A Python float literal; ``inf`` by that name."""
    return repr(float(value))
