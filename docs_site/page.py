"""A page of the site, and the files of the project that pages are made of."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Final

from tltlc.core.record import record

ROOT: Final = Path(__file__).parents[1]


@record
class Page:
    """A page that is made at build time.

    ``uri`` is its place in the site, ``text`` its Markdown, and ``origin`` the file of the project that its links are
    relative to.
    """

    uri: str
    text: str
    origin: str


def read(path: str) -> str:
    """The text of a file of the project."""
    return (ROOT / path).read_text(encoding="utf-8")


def slug(heading: str) -> str:
    """The anchor of a heading, as hosts of repositories make it."""
    return re.sub(r"[^\w\s-]", "", heading.lower()).replace(" ", "-")
