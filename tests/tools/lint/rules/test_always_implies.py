"""TLT0435: how far `always` reaches before `implies`."""

from __future__ import annotations

import re

import pytest

from tests.tools.lint.helpers import SIGNALS, codes, found, marked
from tltlc.automaton.compare import are_equivalent
from tltlc.pipeline import compile_text


@pytest.mark.parametrize(
    ("formula", "condition", "meant"),
    [
        ("always a implies eventually b", "always a", "always (a implies eventually b)"),
        ("G a -> F b", "G a", "G (a -> F b)"),
        ("always a and b implies c", "always a and b", "always (a and b implies c)"),
        ("always for 3 steps not a iff b", "always for 3 steps not a", "always for 3 steps (not a iff b)"),
        ("F c and (always a implies F b)", "always a", "always (a implies F b)"),
    ],
)
def test_what_ends_before_implies(formula: str, condition: str, meant: str) -> None:
    text = f"{SIGNALS}spec s = {formula}"
    assert marked(text, "TLT0435") == [condition]
    (said,) = (each.diagnostic.help for each in found(text) if each.diagnostic.code == "TLT0435")
    shown, as_it_is = re.findall("`([^`]*)`", said or "")
    assert shown == meant
    # What is shown is another formula; and with the brackets that are shown it is the same, and nothing is said.
    part = formula.partition("and (")[2].rstrip(")") or formula
    quiet = part.replace(condition, as_it_is.partition(")")[0].lstrip("(").join("()"))
    ours, theirs, same = compile_text(f"{SIGNALS}spec s = {part}\nspec t = {shown}\nspec u = {quiet}")
    assert are_equivalent(ours, same) and not are_equivalent(ours, theirs)
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
def test_what_seems_to_be_meant(formula: str) -> None:
    assert "TLT0435" not in codes(f"{SIGNALS}spec s = {formula}")
