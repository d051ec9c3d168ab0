"""The README, section by section where a reader of the site looks for it."""

from __future__ import annotations

import re
from typing import Final

from docs_site import commands, facade
from docs_site.page import Page, read, slug

_ELSEWHERE: Final = {
    "The commands": "commands/index.md",
    "From Python": facade.URI,
    "In other engines": "guides/engines.md",
    "Environments": "guides/environments.md",
    "Installing": "installing.md",
}
"""Sections with a page of their own; every other one is on the first page."""


def pages() -> list[Page]:
    """The first page, and those of the sections."""
    title, start, after_start, pitch, sections = _parts()
    made = []
    for heading, uri in _ELSEWHERE.items():
        text = f"# {heading}\n{_raised(sections.pop(heading))}"
        if uri == facade.URI:
            made.append(facade.page(text))
            continue
        made.append(Page(uri, commands.linked(text) if heading == "The commands" else text, "README.md"))
    rest = "".join(f"## {heading}\n{text}" for heading, text in sections.items())
    home = read("docs_site/home.md").format(title=title, pitch=pitch, rest=rest, start=f"{start}\n\n{after_start}")
    return [Page("index.md", home, "README.md"), *made]


def homes() -> dict[str, str]:
    """The pages of the README, whole and by heading."""
    places = {f"README.md#{slug(heading)}": _ELSEWHERE.get(heading, "index.md") for heading in _parts()[-1]}
    return {"README.md": "index.md"} | places


def _parts() -> tuple[str, str, str, str, dict[str, str]]:
    """Title, how to start, what that brought, the pitch with its picture, and the sections by heading."""
    lead, *pieces = re.split(r"^## (.*)\n", read("README.md"), flags=re.MULTILINE)
    title, start, after_start, pitch = lead.split("\n\n", 3)
    return title.removeprefix("# "), start, after_start, pitch, dict(zip(pieces[::2], pieces[1::2], strict=True))


def _raised(text: str) -> str:
    return re.sub(r"^#(#+ )", r"\1", text, flags=re.MULTILINE)
