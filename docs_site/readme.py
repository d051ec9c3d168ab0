"""Make the first page of the site, and the page on installing, from the README."""

from __future__ import annotations

import re
from typing import Final

from docs_site.page import Page, read, slug

_INSTALLING: Final = "Installing"
"""The section that has a page of its own."""


def pages() -> list[Page]:
    """Return the first page, and the page on installing."""
    title, pitch, sections = _parts()
    installing = Page("installing.md", f"# {_INSTALLING}\n{sections.pop(_INSTALLING)}", "README.md")
    rest = "".join(f"## {heading}\n{text}" for heading, text in sections.items())
    home = read("docs_site/home.md").format(title=title, pitch=pitch, rest=rest)
    return [Page("index.md", home, "README.md"), installing]


def homes() -> dict[str, str]:
    """Return the URIs of the pages that stand for the README and for its sections, by path."""
    places = {
        f"README.md#{slug(heading)}": "installing.md" if heading == _INSTALLING else "index.md"
        for heading in _parts()[-1]
    }
    return {"README.md": "index.md"} | places


def _parts() -> tuple[str, str, dict[str, str]]:
    """Return the title, the text below it, and the sections by heading."""
    lead, *pieces = re.split(r"^## (.*)\n", read("README.md"), flags=re.MULTILINE)
    title, pitch = lead.split("\n\n", 1)
    return title.removeprefix("# "), pitch, dict(zip(pieces[::2], pieces[1::2], strict=True))
