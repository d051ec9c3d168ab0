"""The names of the keys of a keyboard, as pygame and game files have them."""

from __future__ import annotations

from collections.abc import Mapping
from string import ascii_lowercase, digits
from typing import Final

_ARROWS: Final = ("left", "right", "up", "down")
_SIDES: Final = tuple(f"{side} {key}" for key in ("shift", "ctrl", "alt") for side in ("left", "right"))
_WORDS: Final = ("space", "return", "tab", "backspace", "insert", "delete", "home", "end", "page up", "page down")

COMMANDS: Final[Mapping[str, str]] = {"r": "restarts the episode", "q": "ends the game", "escape": "ends the game"}
"""The keys that have a meaning in each game, with what they do."""

NAMES: Final = (
    *_ARROWS,
    *(letter for letter in ascii_lowercase if letter not in COMMANDS),
    *digits,
    *_WORDS,
    *_SIDES,
    *(f"f{number}" for number in range(1, 13)),
    *",./;'[]\\-=`",
)
"""The keys that a game file can give to actions."""

_SPECIAL: Final[Mapping[int, str]] = {
    8: "backspace",
    9: "tab",
    13: "return",
    27: "escape",
    32: "space",
    127: "delete",
    # The arrows in pygame 1, which some environments still name, and in pygame 2.
    **dict(zip(range(273, 277), ("up", "down", "right", "left"), strict=True)),
    **dict(zip(range(1073741903, 1073741907), ("right", "left", "down", "up"), strict=True)),
}


def named_key(key: str | int) -> str | int:
    """Return pygame's name of a key that an environment gives as a character or a number: ``32 -> "space"``.

    A number without a known name, and a text of several characters, are returned unchanged.
    """
    number = ord(key) if isinstance(key, str) and len(key) == 1 else key
    if isinstance(number, str):
        return number
    number = int(number)
    return _SPECIAL.get(number, chr(number).lower() if 32 < number < 127 else number)
