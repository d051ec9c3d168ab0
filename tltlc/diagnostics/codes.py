"""The closed list of diagnostic codes: the pages in the folder ``pages``, one file per code.

The first line of a page is ``# TLTnnnn: title``.
"""

from __future__ import annotations

import os
import re
from functools import lru_cache
from typing import Final

_PAGES: Final = os.path.join(os.path.dirname(__file__), "pages")  # noqa: PTH118, PTH120 (pathlib costs 5 ms)
_NAME: Final = re.compile(r"(TLT[0-9]{4})\.md")

_ALIKE: Final = 0.8
"""How alike two codes are where a digit is wrong, or two have changed places."""


@lru_cache(maxsize=1)
def codes() -> tuple[str, ...]:
    """Every code that a diagnostic can have, in order."""
    return tuple(sorted(match[1] for name in os.listdir(_PAGES) if (match := _NAME.fullmatch(name))))  # noqa: PTH208


def family(beginning: str) -> tuple[str, ...]:
    """The codes that begin so, in order."""
    return tuple(code for code in codes() if code.startswith(beginning))


def nearest(code: str, most: int = 3) -> tuple[str, ...]:
    """The codes that are most like one that is none: those that differ by a slip, else the next ones; in order."""
    from difflib import get_close_matches

    number = int("0" + "".join(sign for sign in code if sign.isdecimal()))
    alike = get_close_matches(code, codes(), n=len(codes()), cutoff=_ALIKE) or codes()

    def distance(each: str) -> tuple[bool, int]:
        return sorted(each) != sorted(code), abs(int(each[3:]) - number)

    return tuple(sorted(sorted(alike, key=distance)[:most]))


def page(code: str) -> str:
    """The page of a code, in Markdown; raises KeyError for what is no code."""
    if code not in codes():
        raise KeyError(code)
    with open(os.path.join(_PAGES, f"{code}.md"), encoding="utf-8") as file:  # noqa: PTH118, PTH123
        return file.read()


def title(code: str) -> str:
    """What a code means in one line; raises KeyError for what is no code."""
    return page(code).splitlines()[0].removeprefix(f"# {code}: ")
