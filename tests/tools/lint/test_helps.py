"""A clause that a help of the linter says to write compiles, and causes no other finding."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Iterator
from functools import cache
from pathlib import Path
from typing import Final

import pytest

from tests.docs.blocks import blocks
from tests.golden.cases import cases
from tltlc.core.source import SourceFile, Span
from tltlc.diagnostics import code_pages
from tltlc.diagnostics.diagnostic import Diagnostic, Edit
from tltlc.grammar.tree import SpecDecl
from tltlc.pipeline import CompileOptions, compile_source
from tltlc.tools.lint.file_view import FileView
from tltlc.tools.lint.rules import implied_clause, rules, state_at_end, unused_declaration
from tltlc.tools.lint.run import findings, lint, view_of
from tltlc.tools.lint.scopes import apply_edits

CODES: Final = {rule.code for rule in rules()}
CLAUSE: Final = re.compile(
    r"(?<!leave it out and write )`((?:reach|keep|avoid|require|limit|judge|semantics) (?:(?!\b[pq]\b)[^`…])+)`"
)
"""A clause in a help that is to be written as it stands; p and q are no names of the file."""
SETTINGS: Final = ("limit", "judge", "semantics")


def sources() -> Iterator[tuple[str, str]]:
    """Yield the names and texts of the golden cases and pages that show findings of the linter."""
    for case in cases("error"):
        if case.name[:7] in CODES and [*case.files] == ["input.tltl"]:
            yield case.name, case.files["input.tltl"].decode()
    for code in sorted(CODES):
        page = Path(code_pages.__file__).parent / f"pages/{code}.md"
        yield f"page {code}", next(block.text for block in blocks(page) if block.kind == "tltl")


SOURCES: Final = [pytest.param(text, id=name) for name, text in sources()]


@cache
def suggestions(text: str) -> tuple[tuple[str, str], ...]:
    """Return the code of each finding in a text, and the text after its help is followed, for each clause in it."""
    view = view_of(SourceFile("input.tltl", text), CompileOptions())
    return tuple(
        (finding.diagnostic.code, edited)
        for finding in findings(view)
        for clause in CLAUSE.findall(finding.diagnostic.help or "")
        for edited in written(clause, finding.diagnostic, view)
    )


def written(clause: str, diagnostic: Diagnostic, view: FileView) -> Iterator[str]:
    """Yield the text with a clause in place of the one that a diagnostic marks, or of the same setting."""
    place = diagnostic.labels[0].span
    for declaration in view.module.declarations:
        if isinstance(declaration, SpecDecl) and declaration.block and declaration.span.covers(place):
            word = clause.split()[0]
            if word in SETTINGS:
                replaced = [old.span for old in declaration.clauses if old.kind == word]
                start = view.source.text.index("{", declaration.name_span.end) + 1
                replaced = replaced or [Span(start, start)]
            else:
                replaced = [old.span for old in declaration.clauses if old.span.covers(place)]
            for span in replaced:
                yield apply_edits(view.source, [Edit(span, f" {clause} ")]).text


@pytest.mark.parametrize("text", SOURCES)
def test_a_suggested_clause_compiles_and_causes_no_other_finding(text: str) -> None:
    before = count_codes(text)
    # What the compiler warns of may have been left out, because another finding is its cause.
    compiled = {diagnostic.code for diagnostic in compile_source(SourceFile("input.tltl", text)).diagnostics}
    for code, edited in suggestions(text):
        after = count_codes(edited)
        assert after[code] < before[code], edited
        # What only the old clause used may be unused now, and another clause may follow from the new one. A clause
        # about the end of a recording may end an episode early.
        others = {rule.RULE.code for rule in (unused_declaration, implied_clause, state_at_end)}
        assert set(after) <= {*before, *compiled, *others}, edited


def count_codes(text: str) -> Counter[str]:
    return Counter(finding.diagnostic.code for finding in lint(SourceFile("input.tltl", text)))


def test_there_are_many_suggestions() -> None:
    codes = [code for source in SOURCES for code, _ in suggestions(str(source.values[0]))]
    assert len(codes) >= 45 and len(set(codes)) >= 12
