"""Look up the codes of diagnostics, such as ``TLT0201``, and the pages that explain them.

A code exists if it has a page: a Markdown file in the folder ``pages``, with the first line
``# TLTnnnn: title``.
"""

from __future__ import annotations

import os
import re
from functools import lru_cache
from typing import Final

_PAGES: Final = os.path.join(os.path.dirname(__file__), "pages")  # noqa: PTH118, PTH120 (pathlib costs 5 ms)
_NAME: Final = re.compile(r"(TLT[0-9]{4})\.md")

_ALIKE: Final = 0.8
"""The similarity, by :mod:`difflib`, of two codes that differ in one digit or have two digits exchanged."""


@lru_cache(maxsize=1)
def codes() -> tuple[str, ...]:
    """Return all codes of diagnostics, in order."""
    return tuple(sorted(match[1] for name in os.listdir(_PAGES) if (match := _NAME.fullmatch(name))))  # noqa: PTH208


def codes_with_prefix(prefix: str) -> tuple[str, ...]:
    """Return the codes of diagnostics that begin with ``prefix``, in order."""
    return tuple(code for code in codes() if code.startswith(prefix))


def nearest_codes(code: str, most: int = 3) -> tuple[str, ...]:
    """Return at most ``most`` codes that resemble an unknown code, sorted.

    The result has codes that a typo may have turned into ``code``. If there are none, it has the codes
    with the nearest numbers.
    """
    from difflib import get_close_matches

    number = int("0" + "".join(character for character in code if character.isdecimal()))
    alike = get_close_matches(code, codes(), n=len(codes()), cutoff=_ALIKE) or codes()

    def distance(candidate: str) -> tuple[bool, int]:
        return sorted(candidate) != sorted(code), abs(int(candidate[3:]) - number)

    return tuple(sorted(sorted(alike, key=distance)[:most]))


def page(code: str) -> str:
    """Return the page of a code, in Markdown; raise KeyError if the code does not exist."""
    if code not in codes():
        raise KeyError(code)
    with open(os.path.join(_PAGES, f"{code}.md"), encoding="utf-8") as file:  # noqa: PTH118, PTH123
        return file.read()


def title(code: str) -> str:
    """Return the title of a code's page; raise KeyError if the code does not exist."""
    return page(code).splitlines()[0].removeprefix(f"# {code}: ")
