"""The index of guides lists all guides, and each row has a link."""

from __future__ import annotations

import re

from tests.docs.blocks import DOCS

PAGE = DOCS / "guides" / "index.md"
ROW = re.compile(r"^\| (?!to…|in…|I have…|---)([^|]+) \| ([^|]+) \|$", re.MULTILINE)


def test_every_guide_is_listed() -> None:
    text = PAGE.read_text(encoding="utf-8")
    guides = {path.name for path in PAGE.parent.glob("*.md")} - {PAGE.name}
    assert guides <= {link.partition("#")[0] for link in re.findall(r"\]\(([^)]+)\)", text)}


def test_every_row_has_a_link() -> None:
    rows = ROW.findall(PAGE.read_text(encoding="utf-8"))
    assert len(rows) >= 20
    for task, pages in rows:
        assert "](" in pages, task
