"""Linting of whole files."""

from __future__ import annotations

from collections.abc import Mapping

import pytest

from tests.tools.lint.helpers import APART, block, codes, findings_in
from tltlc.core.source import SourceFile
from tltlc.tools.lint.file_view import FileView
from tltlc.tools.lint.rule import RuleFinding
from tltlc.tools.lint.run import lint

NO_TRACE, NO_GOAL = "TLT0410", "TLT0414"
IMPOSSIBLE = block("reach at(x) and at(y)", before=APART)


def severities(text: str, levels: Mapping[str, str]) -> dict[str, str]:
    """Return the severity of each code that linting a text with these levels reports."""
    reported = lint(SourceFile("a.tltl", text), levels=levels)
    return {finding.diagnostic.code: finding.diagnostic.severity for finding in reported}


def test_a_more_specific_rule_of_equal_severity_supersedes_a_message() -> None:
    assert severities(IMPOSSIBLE, {}).keys() & {NO_TRACE, NO_GOAL} == {NO_GOAL}
    assert severities(IMPOSSIBLE, {NO_TRACE: "error", NO_GOAL: "error"}).keys() & {NO_TRACE, NO_GOAL} == {NO_GOAL}


@pytest.mark.parametrize(
    ("text", "levels"),
    [
        (IMPOSSIBLE.replace("at(y)\n}", f"at(y) // tltlc: allow {NO_GOAL}\n}}"), {}),
        (f"// tltlc: allow {NO_GOAL}\n{IMPOSSIBLE}", {}),
        (IMPOSSIBLE, {NO_GOAL: "allow"}),
    ],
)
def test_a_silenced_rule_supersedes_no_message(text: str, levels: Mapping[str, str]) -> None:
    assert severities(text, levels).keys() & {NO_TRACE, NO_GOAL} == {NO_TRACE}


def test_an_error_is_kept_beside_a_more_specific_warning() -> None:
    reported = severities(IMPOSSIBLE, {NO_TRACE: "error"})
    assert reported[NO_TRACE] == "error"
    assert reported[NO_GOAL] == "warning"


@pytest.mark.parametrize(
    "formula",
    [
        " -> ".join(["a"] * 300),
        pytest.param(" -> ".join(["a"] * 900), marks=pytest.mark.slow, id="a -> a, longer"),
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
    """A rule that reports every declaration, and counts how often ``supersedes`` is read."""

    code, severity = "TLT0432", "warning"
    reads = 0

    def check(self, view: FileView) -> list[RuleFinding]:
        return [
            RuleFinding("odd", (view.label(declaration.span),), "mend it") for declaration in view.module.declarations
        ]

    @property
    def supersedes(self) -> tuple[str, ...]:
        self.reads += 1
        return ("TLT0410",)


def test_supersedes_is_read_once_per_rule(monkeypatch: pytest.MonkeyPatch) -> None:
    rule = _Rule()
    monkeypatch.setattr("tltlc.tools.lint.run.rules", lambda: (rule,))
    assert len(findings_in("".join(f"signal a{number}: bool\n" for number in range(100)))) == 100
    assert rule.reads == 1


def test_what_nothing_uses_comes_last() -> None:
    text = "signal unused: bool\nsignal a: bool\nsignal b: bool\nspec s {\n    limit 9 steps\n    avoid a until b\n}\n"
    assert [finding.diagnostic.code for finding in lint(SourceFile("a.tltl", text))][-1] == "TLT0421"
