"""The rules that the tutorial lists compile, and the linter finds nothing in them."""

from __future__ import annotations

import re

import pytest

from tests.docs.blocks import DOCS
from tltlc.core.source import SourceFile
from tltlc.tools.lint import run

TEXT = (DOCS / "tutorial.md").read_text(encoding="utf-8")
_, _, SECTION = TEXT.partition("## Other rules\n")
SECTION = SECTION.partition("\n## ")[0]
(DECLARED,) = re.findall(r"```tltl\n(.*?)```", SECTION, re.DOTALL)
CLAUSES = re.findall(r"(?m)^\| [^|`]+ \| `([^`]+)` \|$", SECTION)


def test_all_rules_are_found() -> None:
    assert len(CLAUSES) >= 12


@pytest.mark.parametrize("clause", CLAUSES)
def test_a_rule_has_no_finding(clause: str) -> None:
    """Except that a spec of rules has no goal, and that declarations for other rules are unused."""
    source = SourceFile("rules.tltl", f"{DECLARED}spec s {{\n    limit 60 s\n    {clause}\n}}\n")
    reported = {finding.diagnostic.code for finding in run.lint(source)}
    assert reported <= {"TLT0420", "TLT0421"}
