"""Linting a whole file."""

from __future__ import annotations

import pytest

from tests.lint.helpers import codes, found
from tltlc.lint.rule import Remark
from tltlc.lint.view import View


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


def test_a_rule_is_asked_once_for_each_finding_what_it_supersedes(monkeypatch: pytest.MonkeyPatch) -> None:
    rule = _Rule()
    monkeypatch.setattr("tltlc.lint.run.rules", lambda: (rule,))
    assert len(found("".join(f"signal a{number}: bool\n" for number in range(100)))) == rule.asked == 100
