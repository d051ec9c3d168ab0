"""TLT0435: an `always` that covers only the left side of `implies`."""

from __future__ import annotations

import re

import pytest

from tests.tools.lint.helpers import SIGNALS, codes, findings_in, labelled_texts
from tltlc.automaton.compare import are_equivalent
from tltlc.pipeline import compile_text


@pytest.mark.parametrize(
    ("formula", "condition", "correction"),
    [
        ("always a implies eventually b", "always a", "always (a implies eventually b)"),
        ("G a -> F b", "G a", "G (a -> F b)"),
        ("always a and b implies c", "always a and b", "always (a and b implies c)"),
        ("always for 3 steps not a iff b", "always for 3 steps not a", "always for 3 steps (not a iff b)"),
        ("F c and (always a implies F b)", "always a", "always (a implies F b)"),
    ],
)
def test_an_always_that_ends_before_implies_is_reported(formula: str, condition: str, correction: str) -> None:
    text = f"{SIGNALS}spec s = {formula}"
    assert labelled_texts(text, "TLT0435") == [condition]
    (diagnostic,) = (finding.diagnostic for finding in findings_in(text) if finding.diagnostic.code == "TLT0435")
    assert diagnostic.title.endswith("left side" if " iff " in formula else "condition")
    suggestion, bracketed = re.findall("`([^`]*)`", diagnostic.help or "")
    assert suggestion == correction
    # The suggestion is a different formula. With the brackets of the second suggestion, the formula is the
    # same and no longer reported.
    part = formula.partition("and (")[2].rstrip(")") or formula
    quiet = part.replace(condition, bracketed.partition(")")[0].lstrip("(").join("()"))
    original, suggested, same = compile_text(f"{SIGNALS}spec s = {part}\nspec t = {suggestion}\nspec u = {quiet}")
    assert are_equivalent(original, same) and not are_equivalent(original, suggested)
    assert "TLT0435" not in codes(f"{SIGNALS}spec s = {quiet}")


@pytest.mark.parametrize(
    "formula",
    [
        "always (a implies F b)",
        "(always a) implies F b",
        "always (a) implies F b",
        "eventually a implies eventually b",
        "always eventually a implies always eventually b",
        "a implies always b",
        "always a",
        "always a and (b implies c)",
    ],
)
def test_a_formula_with_brackets_or_without_such_an_always_is_not_reported(formula: str) -> None:
    assert "TLT0435" not in codes(f"{SIGNALS}spec s = {formula}")
