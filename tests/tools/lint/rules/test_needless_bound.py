"""TLT0443: bounds that change nothing."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.fuzzing import times
from tests.tools.lint.helpers import APART, accepted_traces, codes, findings_in, labelled_texts_in_block
from tltlc.core.source import Span
from tltlc.diagnostics.diagnostic import Diagnostic

HEAD = "clock {} signal a: bool signal b: bool signal c: bool\nspec s {{ judge at limit limit 900 steps\n{}\n}}\n"
OPERAND = "write `{}` in its place, or say which steps it is about"
WITHOUT = "leave the time out"
FROM = "leave the time out; to count from where `{0}` begins, write `begins {0}`"
IMPLIED = "leave it out, or write what else it should ask for"
CASES = {
    "keep a implies always for 2 s a": FROM.format("a"),
    "keep a implies always for 2 s (a and b)": FROM.format("a"),
    "keep a implies not eventually within 2 s not a": WITHOUT,
    "require always (a implies always for 2 s a)": FROM.format("a"),
    "reach (eventually within 2 s a) or b": OPERAND.format("a"),
    "keep (always for 2 s a) and b": OPERAND.format("a"),
    "avoid eventually within 2 s a": OPERAND.format("a"),
    "avoid b or eventually within 2 s (a and c)": OPERAND.format("a and c"),
    "keep a implies next b\nkeep a implies eventually within 2 s b": WITHOUT,
    "avoid b\nkeep a implies eventually within 2 s b": OPERAND.format("b"),
    "avoid b\nkeep within 2 s of a, b": OPERAND.format("a implies b"),
    "avoid b\nkeep c implies (a then within 2 s b)": WITHOUT,
    "keep b\nkeep a implies eventually within 2 s b": IMPLIED,
    "keep a implies b\nkeep within 2 s of a, b": IMPLIED,
}
ONE_STEP = {
    "keep a implies always for 1 step b": "write `b`",
    "keep a implies always for 10 ms b": "write `b`, or a longer time: a step takes 0.0167 s",
    "keep a implies eventually within 0 s b": "write `b`",
    "keep a implies once within 0 s (b or c)": "write `b or c`",
    "keep a implies historically for 1 step b": "write `b`",
    "keep within 0 s of a, b or c": "write `a implies (b or c)`",
    "keep a implies G[0,0] b": "write `b`",
}


def found(text: str) -> list[Diagnostic]:
    return [finding.diagnostic for finding in findings_in(text) if finding.diagnostic.code == "TLT0443"]


@pytest.mark.parametrize(("clauses", "advice"), CASES.items(), ids=CASES)
def test_a_bound_that_changes_nothing_is_reported(clauses: str, advice: str) -> None:
    assert [diagnostic.help for diagnostic in found(HEAD.format("60 Hz", clauses))] == [advice]


@pytest.mark.parametrize(("clause", "advice"), ONE_STEP.items(), ids=ONE_STEP)
def test_a_bound_of_one_step_is_reported(clause: str, advice: str) -> None:
    assert [diagnostic.help for diagnostic in found(HEAD.format("60 Hz", clause))] == [advice]


@pytest.mark.parametrize(
    "clauses",
    [
        "keep begins a implies always for 2 s a",
        "keep a implies always for 2 s b",
        "keep a implies always for 2 s (a or b)",
        "keep a implies eventually within 2 s b",
        "keep a implies eventually within 2 s not a",
        "keep within 2 s of a, b",
        "keep eventually within 2 s a",
        "require eventually within 2 s a",
        "require always for 2 s a",
        "reach a and eventually within 2 s b",
        "reach a then within 2 s b then within 2 s a",
        "reach always for 2 s a",
        "avoid a then within 2 s b",
        "avoid (begins a) then within 2 s (begins a)",
        "require next after 1 s b",
        "keep a implies once within 1 step b",
        "keep a implies eventually within 1 step b",
        "keep a implies b\nkeep b implies eventually within 2 s c",
        "keep a iff always for 2 s a",
    ],
)
@pytest.mark.parametrize("clock", ["60 Hz", "2 Hz"])
def test_a_bound_that_matters_is_not_reported(clauses: str, clock: str) -> None:
    assert found(HEAD.format(clock, clauses)) == []


def test_nothing_is_proved_of_the_next_step_where_the_clock_varies() -> None:
    # The next step may come after the two seconds.
    assert found(HEAD.format("varies", "keep a implies always for 2 s a")) == []
    assert len(found(HEAD.format("varies", "avoid eventually within 2 s a"))) == 1


def test_infinite_traces_are_left_out() -> None:
    assert found(HEAD.format("2 Hz", "semantics infinite keep a implies always for 2 s a")) == []


def test_the_clauses_that_it_depends_on_are_labelled() -> None:
    text = HEAD.format("60 Hz", "avoid b\nkeep c\nkeep a implies eventually within 2 s b")
    (diagnostic,) = found(text)
    assert [text[label.span.start : label.span.end] for label in diagnostic.labels] == [
        "eventually within 2 s b",
        "avoid b",
    ]


@pytest.mark.parametrize(
    ("clauses", "code"),
    [
        ("reach a then (eventually within 2 s b)", "TLT0437"),
        ("keep always for 2 s a", "TLT0437"),
        ("keep a implies always for 2 s not a", "TLT0432"),
        ("keep a implies eventually within 2 s a\nreach c", "TLT0440"),
        ("keep a\nrequire eventually within 2 s a", "TLT0413"),
    ],
)
def test_rules_that_say_more_supersede_this_one(clauses: str, code: str) -> None:
    reported = codes(HEAD.format("60 Hz", clauses))
    assert code in reported and "TLT0443" not in reported


def test_a_bound_under_a_quantifier_is_reported_if_it_changes_nothing_for_each_entity() -> None:
    def labelled(clause: str) -> list[str]:
        return labelled_texts_in_block("TLT0443", "reach at(z)", clause, before="clock 2 Hz\n" + APART)

    assert labelled("keep all e in (x, y): at(e) implies always for 1 s at(e)") == ["always for 1 s at(e)"]
    assert labelled("keep all e in (x, y): at(e) implies always for 1 s at(z)") == []


_STATES = st.sampled_from(["a", "b", "not a", "(a and b)", "(a or b)"])
_OPERATORS = st.sampled_from(["F[0,{}]", "G[0,{}]", "always for {} steps", "eventually within {} steps"])
_BOUNDED = st.builds(
    lambda operator, steps, state: f"({operator.format(steps)} {state})", _OPERATORS, st.integers(1, 2), _STATES
) | st.builds(lambda steps, one, two: f"({one} then within {steps} steps {two})", st.integers(1, 2), _STATES, _STATES)
_CLAUSES = st.sampled_from(
    ["keep {state} implies {bounded}", "avoid {state} and {bounded}", "avoid {state} or {bounded}",
     "reach {state} or {bounded}", "require {state} weak_until {bounded}", "keep not {bounded} or {state}",
     "require {state} then {bounded}", "keep within 2 steps of {state}, {bounded}"]
)  # fmt: skip
_OTHERS = st.sampled_from(["", "keep {}", "keep a implies {}", "keep {} implies next b", "require always (b -> N {})"])


def simplified(text: str, diagnostic: Diagnostic) -> str:
    """Return the text with the simpler formula that a finding names."""
    label = diagnostic.labels[0]
    inside = text[label.span.start : label.span.end]
    if diagnostic.help == IMPLIED:
        simpler = "keep a or not a" if inside.startswith(("keep", "avoid", "reach")) else "(a or not a)"
    elif "in its place" in str(diagnostic.help) or "covers one step" in diagnostic.title:
        simpler = f"({str(diagnostic.help).split('`')[1]})"
    else:
        bound = next(part for part in (_words(inside), _brackets(inside)) if part)
        simpler = inside[: bound.start] + inside[bound.end :]
    return text[: label.span.start] + simpler + text[label.span.end :]


def _words(text: str) -> Span | None:
    for word in (" within ", " for "):
        if word in text and " steps" in text:
            return Span(text.index(word), text.index(" steps") + len(" steps"))
    return None


def _brackets(text: str) -> Span | None:
    return Span(text.index("["), text.index("]") + 1) if "[" in text else None


@times(40)
@given(_CLAUSES, _STATES, _BOUNDED, _OTHERS, _STATES)
def test_a_clause_means_the_same_without_a_bound_that_is_reported(
    template: str, state: str, bounded: str, other: str, second: str
) -> None:
    clauses = f"{other.format(second)}\n{template.format(state=state, bounded=bounded)}"
    text = f"signal a: bool signal b: bool\nspec s {{ judge at limit\n{clauses}\n}}\n"
    for diagnostic in found(text):
        assert accepted_traces(text, "ab", 4) == accepted_traces(simplified(text, diagnostic), "ab", 4)
