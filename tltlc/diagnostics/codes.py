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


@lru_cache(maxsize=1)
def codes() -> tuple[str, ...]:
    """Every code that a diagnostic can have, in order."""
    return tuple(sorted(match[1] for name in os.listdir(_PAGES) if (match := _NAME.fullmatch(name))))  # noqa: PTH208


def page(code: str) -> str:
    """The page of a code, in Markdown; raises KeyError for what is no code."""
    if code not in codes():
        raise KeyError(code)
    with open(os.path.join(_PAGES, f"{code}.md"), encoding="utf-8") as file:  # noqa: PTH118, PTH123
        return file.read()


def title(code: str) -> str:
    """What a code means in one line; raises KeyError for what is no code."""
    return page(code).splitlines()[0].removeprefix(f"# {code}: ")
