"""TLT0429: what speaks of the first step alone."""

from __future__ import annotations

import pytest

import tltlc
from tests.tools.lint.helpers import PLACES, SIGNALS, block, codes, found, of
from tltlc.automaton.compare import are_equivalent


def test_what_speaks_of_the_first_step() -> None:
    assert of("TLT0429", "require a and not b") == ["require a and not b"]
    assert of("TLT0429", "require a implies F b", "require true", "keep a", "require X a") == []
    assert "TLT0429" not in codes(f"{SIGNALS}spec s = a")


@pytest.mark.parametrize(
    ("formula", "expected", "way_out"),
    [
        ("eventually a and b", ["b"], "eventually (a and b)"),
        ("F a & b & (a or c) & G c", ["b & (a or c)"], "F (a and b and (a or c))"),
        ("always a until b and c", [], ""),
        ("eventually within 3 steps a and b", ["b"], "eventually within 3 steps (a and b)"),
        ("c and always a and b", ["b"], "always (a and b)"),
        ("a and eventually b", [], ""),
        ("eventually (a) and b", [], ""),
        ("(eventually a) and b", [], ""),
        ("eventually a and next b", [], ""),
        ("eventually a and b until c", [], ""),
    ],
)
def test_what_stands_behind_a_temporal_word_and_is_outside_of_it(
    formula: str, expected: list[str], way_out: str
) -> None:
    assert of("TLT0429", f"require {formula}") == expected
    told = [each.diagnostic for each in found(f"{SIGNALS}spec s = {formula}") if each.diagnostic.code == "TLT0429"]
    assert [each.help for each in told] == [f"both together are `{way_out}`" for _ in expected]
    for each in told:
        # What is shown is another formula, which compiles.
        ours, theirs = tltlc.compile_text(f"{SIGNALS}spec s = {formula}\nspec t = {way_out}")
        assert each.severity == "note" and not are_equivalent(ours, theirs)


@pytest.mark.parametrize(
    ("formula", "way_out"),
    [
        ("a and b", "at every step is `keep a and b`, at some step `reach a and b`"),
        # As a goal it would be met by a not holding.
        ("a implies b", "at every step is `keep a implies b`"),
        ("(a implies b)", "at every step is `keep a implies b`"),
        ("(a implies b) and (b -> c)", "at every step is `keep (a implies b) and (b -> c)`"),
        ("all e in (x, y): at(e) -> a", "at every step is `keep all e in (x, y): at(e) -> a`"),
        ("a and (a -> b)", "at every step is `keep a and (a -> b)`, at some step `reach a and (a -> b)`"),
    ],
)
def test_what_is_named_is_no_goal_that_is_met_by_nothing(formula: str, way_out: str) -> None:
    text = block("reach c", f"require {formula}", before=SIGNALS + PLACES)
    (said,) = (each for each in found(text) if each.diagnostic.code == "TLT0429")
    assert said.diagnostic.help == way_out
