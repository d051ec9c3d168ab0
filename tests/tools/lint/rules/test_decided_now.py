"""TLT0440: operators that the present step decides."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.fuzzing import times
from tests.tools.lint.helpers import APART, accepted_traces, codes, findings_in, labelled_texts_in_block
from tltlc.diagnostics.diagnostic import Diagnostic

HEAD = "clock {} signal a: bool signal b: bool signal c: bool\nspec s {{ judge at limit limit 900 steps\n{}\n}}\n"

AGAIN = (
    "to forbid that it begins again, write `avoid (begins a) {} (begins a)`; to forbid `a` altogether, write `avoid a`"
)
BOTH_UNTILS = (
    "for the steps after it, write `weak_next ({0} weak_until b)` if `b` need not come, "
    "`weak_next ({0} until b)` if it must"
)
CASES = {
    # The clause, what the operator means, and the advice.
    "keep a implies (not a until b)": ("b", BOTH_UNTILS.format("not a")),
    "keep a implies not a weak_until b": ("b", "for the steps after it, write `weak_next (not a weak_until b)`"),
    "keep begins a implies (not a until b)": ("b", BOTH_UNTILS.format("not a")),
    "keep ends a implies (a until b)": ("b", BOTH_UNTILS.format("a")),
    "keep a implies (not a since b)": ("b", "for the steps before, write `previously (not a since b)`"),
    "keep a implies (a release b)": ("b", "for the steps after it, write `weak_next (a release b)`"),
    "avoid a and (not a until b)": ("b", "for the steps after it, write `next (not a until b)`"),
    "keep a implies eventually within 1 s a": ("true", "ask for what must come at a later step"),
    "keep a implies eventually (a or b)": ("true", "ask for what must come at a later step"),
    "keep within 1 s of a, a": ("true", "ask for what must come at a later step"),
    "keep a implies once within 1 s a": ("true", "ask for what must have come at an earlier step"),
    "reach a and eventually within 1 s a": ("true", "for a later step, write `next eventually within 1 s a`"),
    "avoid a and eventually within 1 s a": ("true", AGAIN.format("then within 1 s")),
    "avoid (eventually a) and a": ("true", AGAIN.format("then")),
    "avoid a and once within 2 s a": ("true", AGAIN.format("then within 2 s")),
    "keep a implies not once within 1 s a": ("true", AGAIN.format("then within 1 s")),
    "require always (a implies not once a)": ("true", AGAIN.format("then")),
    "keep a implies historically not a": ("false", AGAIN.format("then")),
    "keep begins a implies not once within 1 s begins a": (
        "true",
        "to forbid that it begins again, write `avoid (begins a) then within 1 s (begins a)`; "
        "to forbid `begins a` altogether, write `avoid begins a`",
    ),
    "keep a and b implies not once within 1 s a": (
        "true",
        "for the steps before, write `previously once within 1 s a`",
    ),
    "keep a implies b or always for 1 s not a": (
        "false",
        "for the steps after it, write `weak_next always for 1 s not a`",
    ),
    "require always for 3 s (a implies eventually a)": ("true", "ask for what must come at a later step"),
}


def found(text: str) -> list[Diagnostic]:
    return [finding.diagnostic for finding in findings_in(text) if finding.diagnostic.code == "TLT0440"]


def meaning(diagnostic: Diagnostic) -> str:
    """Return what a finding says that its operator means: true, false, or another formula."""
    message = diagnostic.labels[0].message
    known = {"always true here": "true", "never true here": "false"}.get(message.split(":")[0])
    return known or message.split("`")[1]


@pytest.mark.parametrize(("clause", "expected"), CASES.items(), ids=CASES)
def test_an_operator_that_the_present_step_decides_is_reported(clause: str, expected: tuple[str, str]) -> None:
    (diagnostic,) = found(HEAD.format("60 Hz", clause))
    assert (meaning(diagnostic), diagnostic.help) == expected


@pytest.mark.parametrize("clause", [clause for clause in CASES if "always for" not in clause])
def test_the_length_of_a_step_makes_no_difference(clause: str) -> None:
    assert len(found(HEAD.format("varies", clause))) == 1


@pytest.mark.parametrize(
    "clause",
    [
        "keep a implies (a until b)",
        "keep a implies eventually within 1 s b",
        "keep a implies not once within 1 s b",
        "keep a implies once b",
        "keep a implies next (not a until b)",
        "keep a implies eventually (a and b)",
        "keep a implies previously once a",
        "keep a implies G[1,5] not a",
        "keep (a iff eventually a)",
        "keep within 1 s of a, b",
        "avoid (begins a) then within 1 s (begins a)",
        "avoid a then within 1 s a",
        "reach a then (a and eventually b)",
        "require (not b) until b",
        "require (not b) weak_until b",
        "require a and eventually a until b",
        "keep eventually a",
        "reach a until b",
    ],
)
def test_an_operator_about_other_steps_is_not_reported(clause: str) -> None:
    assert found(HEAD.format("60 Hz", clause)) == []


def test_rules_that_another_rule_reports_in_more_detail_are_left_to_it() -> None:
    assert "TLT0440" not in codes(HEAD.format("60 Hz", "keep a implies always for 1 s not a"))
    # TLT0430 says less about the reason.
    reported = codes(HEAD.format("60 Hz", "reach b\nkeep a implies eventually within 9 s a"))
    assert "TLT0440" in reported and "TLT0430" not in reported


def test_relations_between_atoms_count() -> None:
    def labelled(clause: str) -> list[str]:
        return labelled_texts_in_block("TLT0440", "reach at(z)", clause, before=APART)

    assert labelled("keep at(x) implies (at(x) release at(y))") == ["at(x) release at(y)"]
    assert labelled("keep at(x) implies (at(y) until at(z))") == ["at(y) until at(z)"]
    assert labelled("keep at(x) implies (not at(y) until at(z))") == []


def test_an_operator_under_a_quantifier_is_reported_if_each_entity_decides_it() -> None:
    def labelled(clause: str) -> list[str]:
        return labelled_texts_in_block("TLT0440", "reach at(z)", clause, before=APART)

    assert labelled("keep all e in (x, y): at(e) implies eventually at(e)") == ["eventually at(e)"]
    assert labelled("keep all e in (x, y): at(e) implies eventually at(x)") == []


def formulas(inner: st.SearchStrategy[str], *templates: str) -> st.SearchStrategy[str]:
    """Return formulas made of at most four formulas ``inner``, with the formulas of the templates in brackets."""

    def larger(parts: st.SearchStrategy[str]) -> st.SearchStrategy[str]:
        return st.builds(lambda template, one, two: template.format(one, two), st.sampled_from(templates), parts, parts)

    return st.recursive(inner, larger, max_leaves=4)


_BOOLEAN = ("not ({})", "({}) and ({})", "({}) or ({})", "({}) implies ({})")
_PAST = formulas(
    st.sampled_from(["a", "b", "not a"]),
    *("once ({})", "historically ({})", "previously ({})", "begins ({})", "once within 1 step ({})", "({}) since ({})"),
    *_BOOLEAN[:2],
)
FORMULAS = formulas(
    st.sampled_from(["a", "b", "not a", "(a and b)"]) | _PAST,
    *("F ({})", "G ({})", "next ({})", "weak_next ({})", "F[0,2] ({})", "G[0,1] ({})", "F[1,2] ({})"),
    *("({}) until ({})", "({}) weak_until ({})", "({}) release ({})", *_BOOLEAN),
)


@times(50)
@given(
    st.sampled_from(["keep {} implies {}", "avoid {} and {}", "reach {} and {}", "require always ({} implies {})"]),
    FORMULAS,
    FORMULAS,
)
def test_an_operator_can_be_replaced_by_what_a_finding_says(template: str, one: str, two: str) -> None:
    clause = template.format(f"({one})", f"({two})")
    text = f"signal a: bool signal b: bool\nspec s {{ judge at limit {clause} }}\n"
    for diagnostic in found(text):
        span = diagnostic.labels[0].span
        simpler = f"{text[: span.start]}({meaning(diagnostic)}){text[span.end :]}"
        assert accepted_traces(text, "ab", 4) == accepted_traces(simpler, "ab", 4)
