"""Convert the names and texts of a spec to names, comments and literals in source code."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Sequence
from textwrap import wrap
from typing import Final

_LONGEST: Final = 40

_WORDS: Final = {">": " over ", "<": " under ", "-": " minus ", "+": " plus ", "*": " times ", "/": " per "}


class VariableNames:
    """Chooses names of variables: short, readable ASCII identifiers, all different and none in ``reserved``."""

    def __init__(self, reserved: Iterable[str]) -> None:
        self._taken = set(reserved)

    def new_name(self, name: str, suffix: str = "", spell: Callable[[str], str] = str) -> str:
        """Return a new name that resembles ``name``: ``"distance(exit)"`` -> ``"distance_exit"``.

        ``spell`` converts it to the style of the language. If the name is taken, append ``_`` and
        ``suffix``. If there is no suffix, or this name is taken too, append ``_`` and a number instead.
        """
        spelt = "".join(_WORDS.get(character, character) for character in name)
        base = re.sub(r"[^A-Za-z0-9]+", "_", spelt)[:_LONGEST].strip("_") or "x"
        if base[0].isdigit():
            base = f"x{base}"
        base = spell(base)
        candidate, number = base, 1
        while candidate in self._taken:
            candidate = f"{base}_{suffix}" if suffix and number == 1 else f"{base}_{number}"
            number += 1
        self._taken.add(candidate)
        return candidate


def printable_line(text: str) -> str:
    """Return the text on one line, with escapes for characters that do not print, such as control characters."""
    return "".join(
        character if character.isprintable() else f"\\u{ord(character):04x}" for character in " ".join(text.split())
    )


def call_lines(head: str, arguments: Sequence[str], tail: str = "") -> list[str]:
    """Return the lines of the Python code ``head(arguments)tail``: one line if it fits, else several."""
    line = f"{head}({', '.join(arguments)}){tail}"
    if len(line) <= 110:
        return [line]
    return [f"{head}(", *wrap(", ".join(arguments), 106, initial_indent="    ", subsequent_indent="    "), f"){tail}"]


def docstring_text(text: str) -> str:
    """Return the text, escaped for a Python docstring. Its line breaks and indentation stay."""
    lines = [" " * (len(line) - len(line.lstrip(" "))) + printable_line(line) for line in text.splitlines()]
    return "\n".join(lines).replace("\\", "\\\\").replace('"', '\\"')


def string_literal(text: str) -> str:
    """Return the text as a Python string literal, in double quotes where they need no escape."""
    quoted = repr(text)
    return f'"{quoted[1:-1]}"' if quoted[0] == "'" and '"' not in quoted else quoted


def float_literal(value: float) -> str:
    """Return a Python float literal, or the name ``inf`` for infinity."""
    return repr(float(value))
