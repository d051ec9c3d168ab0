"""Show the changes of the formatter as a unified diff."""

from __future__ import annotations

from typing import Final

_COLOURS: Final = {"---": "1", "+++": "1", "@@": "36", "-": "31", "+": "32"}


def diff_text(name: str, before: str, after: str, *, color: bool = False) -> str:
    """Return the unified diff between two texts of the file ``name``; empty if they are equal.

    With ``color``, the lines are coloured with ANSI escape codes.
    """
    from difflib import unified_diff

    lines = unified_diff(_lines(before), _lines(after), name, name)
    return "".join(_diff_line(line, color) for line in lines)


def _lines(text: str) -> list[str]:
    """Return the lines of a text with their line ends."""
    *whole, last = text.split("\n")
    return [f"{line}\n" for line in whole] + ([last] if last else [])


def _diff_line(line: str, color: bool) -> str:
    text = line.removesuffix("\n")
    if color:
        colour = next((code for start, code in _COLOURS.items() if line.startswith(start)), None)
        text = f"\x1b[{colour}m{text}\x1b[0m" if colour else text
    return f"{text}\n" if line.endswith("\n") else f"{text}\n\\ No newline at end of file\n"
