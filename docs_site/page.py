"""Pages of the site, and the files of the project from which they are made."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Final

from tltlc.core.record import record

ROOT: Final = Path(__file__).parents[1]


@record
class Page:
    """A page that is made when the site is built.

    ``uri`` is its place in the site, and ``text`` is its Markdown. Its links are relative to
    ``origin``, a file of the project.
    """

    uri: str
    text: str
    origin: str


def read(path: str) -> str:
    """Return the text of a file of the project."""
    return (ROOT / path).read_text(encoding="utf-8")


def slug(heading: str) -> str:
    """Return the anchor of a heading, as GitHub makes it."""
    return re.sub(r"[^\w\s-]", "", heading.lower()).replace(" ", "-")
