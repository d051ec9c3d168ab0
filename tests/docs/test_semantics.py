"""Every claim on the page on semantics has tests: the tables quote the text and cover every
paragraph."""

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
    """The text without markup, with single spaces."""
    return " ".join(re.sub(r"[`*▲]", "", text).split())


def claims(part: str) -> list[list[str]]:
    """Return each claim's quotation, and the tests that check it."""
    table = PARTS[part].partition(HEAD)[2].partition("\n</details>")[0]
    return [[cell.strip() for cell in row.strip("|").split("|")] for row in table.splitlines()]


def statements(part: str) -> Iterator[str]:
    """Yield the statements above the table: paragraphs and rows of tables, but neither programs nor
    headings."""
    text = re.sub(r"^```.*?^```$", "", PARTS[part].partition(HEAD)[0], flags=re.MULTILINE | re.DOTALL)
    for paragraph in re.split(r"\n\s*\n", text.strip()):
        rows = paragraph.splitlines()
        if rows and rows[0].startswith("|"):
            yield from rows[2:]
        elif paragraph.strip() and not paragraph.startswith("#") and not paragraph.endswith(":"):
            yield paragraph


@pytest.mark.parametrize("part", PARTS)
def test_claims_are_quoted_exactly(part: str) -> None:
    text = plain(PARTS[part].partition(HEAD)[0])
    assert claims(part)
    for quoted, _ in claims(part):
        assert plain(quoted) in text, quoted


@pytest.mark.parametrize("part", PARTS)
def test_every_statement_has_a_claim(part: str) -> None:
    quoted = [plain(claim) for claim, _ in claims(part)]
    for statement in statements(part):
        assert any(claim in plain(statement) for claim in quoted), statement


@pytest.mark.parametrize("part", PARTS)
def test_the_tests_of_a_claim_exist(part: str) -> None:
    for quoted, held in claims(part):
        test_references = TESTS.findall(held)
        assert test_references, quoted
        assert plain(TESTS.sub("", held)).strip("; ") == "", held
        for file, names in test_references:
            source = (ROOT / file).read_text(encoding="utf-8")
            for name in re.findall(r"\w+", names):
                assert f"\ndef {name}(" in source, f"{file}: {name}"
