"""Every claim of the page on semantics has tests behind it: the tables quote the text, and leave no paragraph out."""

from __future__ import annotations

import re
from collections.abc import Iterator

import pytest

from tests.docs.blocks import DOCS, ROOT

PAGE = (DOCS / "semantics.md").read_text(encoding="utf-8")
HEAD = """<details markdown>
<summary>The tests behind these claims</summary>

| claim | held by |
|---|---|
"""
TESTS = re.compile(r"`(tests/[\w/]+\.py)` \(((?:`test_\w+`(?:, )?)+)\)")
PARTS = dict(re.findall(r"^## ([^\n]*)\n(.*?)(?=^## |\Z)", PAGE, re.MULTILINE | re.DOTALL))


def plain(text: str) -> str:
    """The words, whatever they are printed in."""
    return " ".join(re.sub(r"[`*▲]", "", text).split())


def claims(part: str) -> list[list[str]]:
    """The quotation of each claim, and what holds it."""
    table = PARTS[part].partition(HEAD)[2].partition("\n</details>")[0]
    return [[cell.strip() for cell in row.strip("|").split("|")] for row in table.splitlines()]


def statements(part: str) -> Iterator[str]:
    """What stands above the table: its paragraphs, and the rows of its tables; programs and headings are none."""
    text = re.sub(r"^```.*?^```$", "", PARTS[part].partition(HEAD)[0], flags=re.MULTILINE | re.DOTALL)
    for paragraph in re.split(r"\n\s*\n", text.strip()):
        rows = paragraph.splitlines()
        if rows and rows[0].startswith("|"):
            yield from rows[2:]
        elif paragraph.strip() and not paragraph.endswith(":"):
            yield paragraph


@pytest.mark.parametrize("part", PARTS)
def test_claims_are_quoted_as_they_stand(part: str) -> None:
    text = plain(PARTS[part].partition(HEAD)[0])
    assert claims(part)
    for quoted, _ in claims(part):
        assert plain(quoted) in text, quoted


@pytest.mark.parametrize("part", PARTS)
def test_no_statement_is_without_a_claim(part: str) -> None:
    quoted = [plain(claim) for claim, _ in claims(part)]
    for statement in statements(part):
        assert any(claim in plain(statement) for claim in quoted), statement


@pytest.mark.parametrize("part", PARTS)
def test_what_holds_a_claim_is_there(part: str) -> None:
    for quoted, held in claims(part):
        found = TESTS.findall(held)
        assert found, quoted
        assert plain(TESTS.sub("", held)).strip("; ") == "", held
        for file, names in found:
            source = (ROOT / file).read_text(encoding="utf-8")
            for name in re.findall(r"\w+", names):
                assert f"\ndef {name}(" in source, f"{file}: {name}"
