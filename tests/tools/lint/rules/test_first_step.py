"""TLT0429: formulas that apply to the first step only."""

from __future__ import annotations

import pytest

import tltlc
from tests.tools.lint.helpers import (
    PLACES,
    SIGNALS,
    accepted_traces,
    block,
    codes,
    findings_in,
    labelled_texts_in_block,
)
from tltlc.automaton.compare import are_equivalent


def test_clauses_about_the_first_step_are_reported() -> None:
    assert labelled_texts_in_block("TLT0429", "require a and not b") == ["require a and not b"]
    assert labelled_texts_in_block("TLT0429", "require a implies F b", "require true", "keep a", "require X a") == []
    assert "TLT0429" not in codes(f"{SIGNALS}spec s = a")


@pytest.mark.parametrize(
    ("formula", "expected", "correction"),
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
def test_operands_outside_a_temporal_operator_are_reported(formula: str, expected: list[str], correction: str) -> None:
    assert labelled_texts_in_block("TLT0429", f"require {formula}") == expected
    diagnostics = [
        finding.diagnostic
        for finding in findings_in(f"{SIGNALS}spec s = {formula}")
        if finding.diagnostic.code == "TLT0429"
    ]
    together = "all of them" if any(" & " in text for text in expected) else "both"
    assert [diagnostic.help for diagnostic in diagnostics] == [
        f"for {together} together, write `{correction}`" for _ in expected
    ]
    for diagnostic in diagnostics:
        # The suggestion compiles, and is a different formula.
        original, suggested = tltlc.compile_text(f"{SIGNALS}spec s = {formula}\nspec t = {correction}")
        assert diagnostic.severity == "warning" and not are_equivalent(original, suggested)


@pytest.mark.parametrize(
    ("formula", "correction", "operand"),
    [
        ("a and b", "for every step, write `keep a and b`; for some step, write `reach a and b`", "(a and b)"),
        ("not a", "for every step, write `keep not a`; for some step, write `reach not a`", "not a"),
        # As a goal, it would be met as soon as `a` is false.
        ("a implies b", "for every step, write `keep a implies b`", "(a implies b)"),
        ("(a implies b)", "for every step, write `keep a implies b`", "(a implies b)"),
        ("(a implies b) and (b -> c)", "for every step, write `keep (a implies b) and (b -> c)`", None),
        ("all e in (x, y): at(e) -> a", "for every step, write `keep all e in (x, y): at(e) -> a`", None),
        (
            "a and (a -> b)",
            "for every step, write `keep a and (a -> b)`; for some step, write `reach a and (a -> b)`",
            None,
        ),
    ],
)
def test_the_suggestion_is_no_goal_that_a_false_condition_meets(
    formula: str, correction: str, operand: str | None
) -> None:
    text = block("reach c", f"require {formula}", before=SIGNALS + PLACES)
    (finding,) = (candidate for candidate in findings_in(text) if candidate.diagnostic.code == "TLT0429")
    last = f"require eventually always {operand or f'({formula})'}"
    assert finding.diagnostic.help == f"{correction}; for the last step, write `{last}`"
    assert not {"TLT0424", "TLT0429"} & {*codes(block("reach c", last, before=SIGNALS + PLACES))}


def test_the_last_step_is_the_last_step() -> None:
    accepted = accepted_traces("signal a: bool signal b: bool\nspec s = eventually always (a and b)", "ab", 4)
    assert {trace for trace in accepted if trace[-1] != "ab"} == set()
    assert len(accepted) == sum(4**length for length in range(4))


def test_over_infinite_traces_there_is_no_last_step() -> None:
    text = block("semantics infinite", "require a", before=SIGNALS).replace(
        "    limit 9 steps\n    judge at goal\n", ""
    )
    (finding,) = (candidate for candidate in findings_in(text) if candidate.diagnostic.code == "TLT0429")
    assert finding.diagnostic.help == "for every step, write `keep a`; for some step, write `reach a`"
