"""Linting a whole file."""

from __future__ import annotations

from collections.abc import Mapping

import pytest

from tests.tools.lint.helpers import APART, block, codes, found
from tltlc.core.source import SourceFile
from tltlc.tools.lint.file_view import View
from tltlc.tools.lint.rule import Remark
from tltlc.tools.lint.run import lint

NO_TRACE, NO_GOAL = "TLT0410", "TLT0414"
IMPOSSIBLE = block("reach at(x) and at(y)", before=APART)


def told(text: str, levels: Mapping[str, str]) -> dict[str, str]:
    """Lint a text with these levels; return the severity of each code."""
    found = lint(SourceFile("a.tltl", text), levels=levels)
    return {each.diagnostic.code: each.diagnostic.severity for each in found}


def test_a_message_is_left_out_where_a_rule_says_more_and_counts_as_much() -> None:
    assert told(IMPOSSIBLE, {}).keys() & {NO_TRACE, NO_GOAL} == {NO_GOAL}
    assert told(IMPOSSIBLE, {NO_TRACE: "error", NO_GOAL: "error"}).keys() & {NO_TRACE, NO_GOAL} == {NO_GOAL}


@pytest.mark.parametrize(
    ("text", "levels"),
    [
        (IMPOSSIBLE.replace("at(y)\n}", f"at(y) // tltlc: allow {NO_GOAL}\n}}"), {}),
        (f"// tltlc: allow {NO_GOAL}\n{IMPOSSIBLE}", {}),
        (IMPOSSIBLE, {NO_GOAL: "allow"}),
    ],
)
def test_a_silenced_rule_stands_for_no_other_message(text: str, levels: Mapping[str, str]) -> None:
    assert told(text, levels).keys() & {NO_TRACE, NO_GOAL} == {NO_TRACE}


def test_an_error_stays_where_a_warning_says_more() -> None:
    found = told(IMPOSSIBLE, {NO_TRACE: "error"})
    assert found[NO_TRACE] == "error"
    assert found[NO_GOAL] == "warning"


@pytest.mark.parametrize(
    "formula",
    [
        " -> ".join(["a"] * 900),
        " U ".join(["a"] * 900),
        "F " * 990 + "a",
        "X " * 900 + "a",
        "F (" + "!" * 900 + "a -> b)",
    ],
    ids=lambda formula: formula[:6],
)
def test_long_formulas_are_linted(formula: str) -> None:
    assert set(codes(f"signal a: bool signal b: bool let both = a & b spec x = {formula}")) >= {"TLT0421"}


class _Rule:
    """A rule that says something of each declaration, and counts how often it is asked what it supersedes."""

    code, severity = "TLT0432", "warning"
    asked = 0

    def check(self, view: View) -> list[Remark]:
        return [Remark("odd", (view.label(each.span),), "mend it") for each in view.module.declarations]

    @property
    def supersedes(self) -> tuple[str, ...]:
        self.asked += 1
        return ("TLT0410",)


def test_a_rule_is_asked_once_what_it_supersedes(monkeypatch: pytest.MonkeyPatch) -> None:
    rule = _Rule()
    monkeypatch.setattr("tltlc.tools.lint.run.rules", lambda: (rule,))
    assert len(found("".join(f"signal a{number}: bool\n" for number in range(100)))) == 100
    assert rule.asked == 1
