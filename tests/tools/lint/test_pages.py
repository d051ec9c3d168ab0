"""The page of each rule has an example to avoid and an example to prefer; both are linted."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from tests.docs.blocks import blocks
from tltlc.core.source import SourceFile
from tltlc.diagnostics import code_pages
from tltlc.tools.lint import allow
from tltlc.tools.lint import rules as package
from tltlc.tools.lint.rules import rules
from tltlc.tools.lint.run import lint

FOLDER = Path(code_pages.__file__).parent / "pages"
CODES = sorted([*(rule.code for rule in rules()), allow.CODE])


def codes_of_example(code: str, kind: str) -> list[str]:
    """Return the codes that the linter reports for an example of a page.

    ``kind`` is ``avoid`` for the first example, or ``prefer`` for the second.
    """
    avoid, prefer = (block for block in blocks(FOLDER / f"{code}.md") if block.kind == "tltl")
    block = avoid if kind == "avoid" else prefer
    return [finding.diagnostic.code for finding in lint(SourceFile("example.tltl", block.text))]


@pytest.mark.parametrize("code", CODES)
def test_the_example_to_avoid_causes_this_code_only(code: str) -> None:
    assert codes_of_example(code, "avoid") == [code]


@pytest.mark.parametrize("code", CODES)
def test_the_preferred_example_causes_no_finding(code: str) -> None:
    assert codes_of_example(code, "prefer") == []


@pytest.mark.parametrize("code", CODES)
def test_every_page_has_the_same_sections(code: str) -> None:
    text = code_pages.page(code)
    headings = re.findall(r"^## (.*)$", text, re.MULTILINE)
    assert headings == ["Example", "How to fix it", "Why"]
    assert re.findall(r"(\w+):\n\n```tltl\n", text) == ["Avoid", "Prefer"]


def test_every_rule_has_its_own_code() -> None:
    assert len(set(CODES)) == len(CODES) >= 16
    assert all("TLT0412" <= code <= "TLT0490" for code in CODES)


def test_every_rule_has_its_own_tests() -> None:
    folder, tests = Path(package.__file__).parent, Path(__file__).parent / "rules"
    names = {path.name for path in folder.glob("[!_]*.py")}
    assert {path.name.removeprefix("test_") for path in tests.glob("test_*.py")} == names
