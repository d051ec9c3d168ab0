"""TLT0441: conditions that count at the first step only."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.fuzzing import times
from tests.tools.lint.helpers import accepted_traces, findings_in
from tests.tools.lint.strategies import formula_texts
from tltlc.diagnostics.diagnostic import Diagnostic
from tltlc.pipeline import compile_text

HEAD = "clock {}\nsignal a: bool\nsignal b: bool\nsignal c: bool\nsignal x in [0, 10]\nparam p in [0, 9] = 5\n"
CASES = {
    "require a implies eventually b": "for every step, write `keep a implies eventually b`",
    "require (a implies next b)": "for every step, write `keep a implies next b`",
    "require c and (a implies always b)": "for every step, write `keep a implies always b`",
    "require within 1 s of a, b": "for every step, write `keep within 1 s of a, b`",
    "require a implies eventually within 1 s b": "for every step, write `keep a implies eventually within 1 s b`",
    "require all e in (k, l): at(e) implies eventually b": "for every step, write "
    "`keep all e in (k, l): at(e) implies eventually b`",
    "require previous(x) > 3 implies eventually b": "for every step, write `keep previous(x) > 3 implies eventually b`",
    "require always for 3 s (a implies b)": "for a time from `a` on, write `keep a implies always for 3 s b`",
    "require always for 3 s ((a or c) implies b)": "for a time from `a or c` on, write "
    "`keep (a or c) implies always for 3 s b`",
    "require always for 3 s (c and (a implies b))": "for a time from `a` on, write `keep a implies always for 3 s b`",
    "require always for 3 s (a implies eventually b)": "for every step, write `keep a implies eventually b`",
}


def found(clause: str, clock: str = "60 Hz") -> list[Diagnostic]:
    declared = f"{HEAD.format(clock)}entity k, l\nsignal at(e: entity): bool\n"
    text = f"{declared}spec s {{\n    limit 900 steps\n    judge at limit\n    {clause}\n}}\n"
    return [finding.diagnostic for finding in findings_in(text) if finding.diagnostic.code == "TLT0441"]


@pytest.mark.parametrize(("clause", "advice"), CASES.items(), ids=CASES)
@pytest.mark.parametrize("clock", ["60 Hz", "varies"])
def test_a_condition_that_counts_at_the_first_step_only_is_reported(clause: str, advice: str, clock: str) -> None:
    if clock == "varies" and "eventually" in clause and "always for" in clause:
        return  # Such a bound needs a fixed clock.
    (diagnostic,) = found(clause, clock)
    assert diagnostic.help == advice
    # What the advice says to write has no such finding.
    assert found(str(diagnostic.help).split("`")[-2]) == []


@pytest.mark.parametrize(
    "clause",
    [
        "keep a implies eventually b",
        "require always (a implies eventually b)",
        "require (eventually a) implies eventually b",
        "require (always a) implies eventually b",
        "require a implies b",
        "require a until b",
        "require a weak_until (a implies eventually b)",
        "require not (a implies eventually b)",
        "require true implies eventually b",
        "require initial(x) > 3 implies eventually b",
        "require p > 4 implies eventually b",
        "require always for 3 s a",
        "require always for 3 s (p > 4 implies a)",
        "require eventually within 3 s (a implies b)",
        "require any e in (k, l): at(e) implies eventually b",
        "reach a implies eventually b",
    ],
)
def test_other_clauses_are_not_reported(clause: str) -> None:
    assert found(clause) == []


def test_the_advice_for_a_spec_of_one_formula_is_a_formula() -> None:
    text = "signal a: bool signal b: bool\nspec s = a implies eventually b\n"
    helps = [finding.diagnostic.help for finding in findings_in(text) if finding.diagnostic.code == "TLT0441"]
    assert helps == ["for every step, write `always (a implies eventually b)`"]


@times(40)
@given(formula_texts(["a", "b"]), formula_texts(["a", "b"], max_leaves=2))
def test_what_comes_after_the_first_step_does_not_matter_without_the_condition(formula: str, condition: str) -> None:
    clause = f"require ({condition}) implies ({formula})"
    text = f"signal a: bool signal b: bool\nspec s {{ judge at limit {clause} }}\n"
    if any(finding.diagnostic.code == "TLT0441" for finding in findings_in(text)):
        at_first_step = accepted_traces(f"signal a: bool signal b: bool\nspec s {{ require {condition} }}\n", "ab", 1)
        accepted = accepted_traces(text, "ab", 3)
        every = accepted_traces("signal a: bool signal b: bool\nspec s { require a or not a }\n", "ab", 3)
        assert {trace for trace in every if trace[:1] not in at_first_step} <= accepted


@times(20)
@given(st.sampled_from(["a", "not a", "(a or b)"]), st.sampled_from(["b", "(a and b)"]))
def test_the_advice_is_stricter_at_later_steps(condition: str, result: str) -> None:
    before = "clock 2 Hz signal a: bool signal b: bool\n"
    text = f"{before}spec s {{ judge at limit require always for 1 s ({condition} implies {result}) }}\n"
    (diagnostic,) = (finding.diagnostic for finding in findings_in(text) if finding.diagnostic.code == "TLT0441")
    suggested = f"{before}spec s {{ judge at limit {str(diagnostic.help).split('`')[-2]} }}\n"
    compile_text(suggested)
    assert accepted_traces(suggested, "ab", 4) < accepted_traces(text, "ab", 4)
