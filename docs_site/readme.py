"""Split the README: some sections become pages of their own, the others are on the first page."""

from __future__ import annotations

import re
from typing import Final

from docs_site import commands, facade
from docs_site.page import Page, read, slug

_PAGES_OF_SECTIONS: Final = {
    "The commands": "commands/index.md",
    "From Python": facade.URI,
    "In other engines": "guides/engines.md",
    "Environments": "guides/environments.md",
    "Installing": "installing.md",
}
"""The URIs of the sections that have a page of their own; the others are on the first page."""


def pages() -> list[Page]:
    """Return the first page, and the pages of sections."""
    title, pitch, sections = _parts()
    pages_of_sections = []
    for heading, uri in _PAGES_OF_SECTIONS.items():
        text = f"# {heading}\n{_raise_headings(sections.pop(heading))}"
        if uri == facade.URI:
            pages_of_sections.append(facade.page(text))
            continue
        pages_of_sections.append(
            Page(uri, commands.with_links(text) if heading == "The commands" else text, "README.md")
        )
    rest = "".join(f"## {heading}\n{text}" for heading, text in sections.items())
    home = read("docs_site/home.md").format(title=title, pitch=pitch, rest=rest)
    return [Page("index.md", home, "README.md"), *pages_of_sections]


def homes() -> dict[str, str]:
    """Return the URIs of the pages that stand for the README and for its sections, by path."""
    places = {f"README.md#{slug(heading)}": _PAGES_OF_SECTIONS.get(heading, "index.md") for heading in _parts()[-1]}
    return {"README.md": "index.md"} | places


def _parts() -> tuple[str, str, dict[str, str]]:
    """Return the title, the text below it, and the sections by heading."""
    lead, *pieces = re.split(r"^## (.*)\n", read("README.md"), flags=re.MULTILINE)
    title, pitch = lead.split("\n\n", 1)
    return title.removeprefix("# "), pitch, dict(zip(pieces[::2], pieces[1::2], strict=True))


def _raise_headings(text: str) -> str:
    return re.sub(r"^#(#+ )", r"\1", text, flags=re.MULTILINE)
