"""Lines of the documentation are at most 100 columns long, except where they cannot be broken."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from tests.docs.blocks import DOCS, ROOT

COLUMNS = 100
PAGES = sorted([*DOCS.rglob("*.md"), ROOT / "README.md", ROOT / "CONTRIBUTING.md", ROOT / "CHANGELOG.md"])

_NOT_PROSE = re.compile(r"^ *```.*?^ *```$|<!--.*?-->|^(?:\||    |\[?!\[).*$", re.DOTALL | re.MULTILINE)
_LINK_TARGET = re.compile(r"\]\([^)\s]*\)")


def name(page: Path) -> str:
    return page.relative_to(ROOT).as_posix()


def long_lines(text: str) -> list[str]:
    """Return the lines of prose that are too long. Code, tables, images and HTML comments are not
    prose, and the targets of links do not count."""
    prose = _LINK_TARGET.sub("]", _NOT_PROSE.sub("", text))
    return [line for line in prose.splitlines() if len(line) > COLUMNS]


@pytest.mark.parametrize("page", PAGES, ids=name)
def test_lines_of_prose_are_at_most_100_columns_long(page: Path) -> None:
    too_long = long_lines(page.read_text(encoding="utf-8"))
    assert not too_long, f"{name(page)} has {len(too_long)} long lines, the first is:\n{too_long[0]}"


@pytest.mark.parametrize(
    ("text", "number"),
    [
        ("word " * 20 + "\n", 0),
        ("word " * 20 + "word\n", 1),
        ("- " + "word " * 20 + "\n", 1),
        ("| " + "word " * 30 + "|\n", 0),
        ("```text\n" + "word " * 30 + "\n```\n", 0),
        ("    " + "word " * 30 + "\n", 0),
        ("![" + "word " * 30 + "](picture.svg)\n", 0),
        ("<!-- " + "word " * 30 + "-->\n", 0),
        ("word " * 10 + "[a](" + "long/" * 30 + "page.md)\n", 0),
        ("word " * 20 + "[a](page.md)\n", 1),
    ],
)
def test_only_prose_that_can_be_broken_is_too_long(text: str, number: int) -> None:
    assert len(long_lines(text)) == number
