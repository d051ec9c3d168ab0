"""TLT0424: formulas that constrain only the last step."""

from __future__ import annotations

from collections.abc import Iterator

import pytest
from hypothesis import given
from hypothesis import strategies as st

import tltlc
from tests.fuzzing import times
from tests.tools.lint.helpers import (
    APART,
    PLACES,
    SIGNALS,
    block,
    codes,
    findings_in,
    labelled_texts,
    labelled_texts_in_block,
    spec_and_findings,
)
from tests.tools.lint.strategies import FREE, SMALL, World, specs
from tltlc.automaton.compare import are_equivalent
from tltlc.automaton.finite.build import build
from tltlc.core.source import SourceFile
from tltlc.grammar.tree import Unary
from tltlc.pipeline import compile_source
from tltlc.tools.lint.file_view import SpecView
from tltlc.tools.lint.rule import RuleFinding
from tltlc.tools.lint.rules import recurrence

CLAUSES = (
    *("keep {}", "avoid {}", "reach {}", "reach {} then {}", "require G {}", "require F {}"),
    *("keep {} and F {}", "keep {} or F {}", "avoid {} or G {}", "avoid {} and G {}", "reach {} and G {}"),
)


@pytest.mark.parametrize(
    ("clause", "expected"),
    [
        ("keep eventually a", ["keep eventually"]),
        ("keep (F (a))", ["keep (F"]),
        ("require G F a", ["G F"]),
        ("require b -> [] <> a", ["[] <>"]),
        ("require eventually always a", []),
        ("require F (G a)", []),
        ("require b and (F G a)", []),
        ("require not F G a", ["F G"]),
        ("require b implies F G a", ["F G"]),
        ("require F not F a", ["F not F"]),
        ("keep eventually always a", ["keep eventually", "eventually always"]),
        ("avoid eventually always a", ["eventually always"]),
        ("reach always a", ["reach always"]),
        ("keep b and eventually a", ["eventually"]),
        ("require always (b and eventually a)", ["eventually"]),
        ("require F (b or G a)", ["G"]),
        ("require F (b and G a)", []),
        ("require G (b or F a)", []),
        ("avoid always a", ["avoid always"]),
        ("avoid b or always a", ["always"]),
        ("avoid b and always a", []),
        ("avoid eventually a", []),
        ("require G not G a", ["G not G"]),
        ("reach b then (always a)", ["always"]),
        ("reach b then (always a) then c", []),
        ("keep a until b", ["keep a until"]),
        ("require a until b", []),
        ("require G F[0,3] a", []),
        ("require G (a -> F b)", []),
        ("keep a", []),
        ("reach a", []),
    ],
)
def test_formulas_about_the_last_step_are_reported(clause: str, expected: list[str]) -> None:
    assert labelled_texts_in_block("TLT0424", clause) == expected
    assert labelled_texts_in_block("TLT0424", clause, "semantics infinite") == []


def test_a_clause_about_the_last_step_implies_no_other_clause() -> None:
    before = "signal a: bool signal b: bool\n"
    assert codes(block("reach a", "keep b until a", before=before)) == ["TLT0424"]
    assert codes(block("reach a", "require b until a", before=before)) == ["TLT0413"]


@times(40)
@given(st.sampled_from(["keep", "avoid", "reach", "require G", "require F"]), SMALL)
def test_a_reported_clause_depends_on_the_last_step_only(clause: str, formula: str) -> None:
    """If the rule reports a whole clause, its automaton depends on the last sample of a trace only."""
    text = block(f"{clause} ({formula})")
    (spec,) = compile_source(SourceFile("example.tltl", text)).program.specs
    labels = [finding.diagnostic.labels[0] for finding in findings_in(text) if finding.diagnostic.code == "TLT0424"]
    start = text.index(clause)
    for label in labels:
        if label.span.start != start or " U " in formula:
            continue
        message = label.message
        last = message[message.index("`") + 1 : message.rindex("`")]
        (same,) = tltlc.compile_text(f"{SIGNALS}spec t = F ((N false) & ({last}))")
        assert are_equivalent(build(spec), same)


def test_a_quantified_formula_is_reported_once() -> None:
    assert labelled_texts_in_block("TLT0424", "require all e in (x, y): G F at(e)", before=PLACES) == ["G F"]
    assert labelled_texts_in_block("TLT0412", "require all e in (x, y): F (at(z) -> at(e))", before=PLACES) == [
        "at(z) -> at(e)"
    ]


@pytest.mark.parametrize(
    ("clause", "goal"),
    [
        ("reach always a", "; if once is enough, write `reach a`"),
        ("reach always (a and (b -> c))", "; if once is enough, write `reach a and (b -> c)`"),
        # As a goal, it would be met as soon as `a` is false.
        ("reach always (a implies b)", ""),
        ("keep F ((a -> b) and (b -> c))", ""),
        ("avoid G (a -> b)", "; if once is enough, write `reach not (a -> b)`"),
    ],
)
def test_the_suggestion_is_no_goal_that_a_false_condition_meets(clause: str, goal: str) -> None:
    (finding,) = (candidate for candidate in findings_in(block(clause)) if candidate.diagnostic.code == "TLT0424")
    assert (finding.diagnostic.help or "").partition(": then no trace that ends violates it")[2] == goal


@pytest.mark.parametrize(
    "clause",
    ["keep eventually a", "reach always (a or b)", "require G F a", "avoid always a", "require G not G not (a and b)"],
)
def test_the_suggestion_for_the_last_step_is_equivalent_and_not_reported(clause: str) -> None:
    suggestion = last_step_advice(clause)
    (original,), (suggested,) = tltlc.compile_text(block(clause)), tltlc.compile_text(block(suggestion))
    assert suggestion.startswith("require eventually always ") and are_equivalent(original, suggested)
    assert "TLT0424" not in codes(block(suggestion))


@pytest.mark.parametrize("clause", ["reach b then (always a)", "require b implies G F a"])
def test_a_part_about_the_last_step_can_be_allowed(clause: str) -> None:
    assert not {"TLT0424", "TLT0427"} & {*codes(block(f"{clause}  {last_step_advice(clause)}"))}


def last_step_advice(clause: str) -> str:
    """Return what the finding on a clause says to write if the last step is meant."""
    (help_,) = (
        finding.diagnostic.help for finding in findings_in(block(clause)) if finding.diagnostic.code == "TLT0424"
    )
    assert help_ is not None
    return help_.split("`")[1]


@pytest.mark.parametrize(
    ("clause", "advice"),
    [
        ("reach always a", "write `reach a`"),
        ("require G F a", "write `reach a`"),
        ("keep b and eventually a", "write `reach a`"),
        ("reach b then (always a)", "leave out this `always`"),
        ("require F (b or G a)", "leave out this `G`"),
        ("require b implies G F (a or c)", "write `eventually (a or c)`"),
        ("reach b then (c and G not G a)", "write `eventually not a`"),
        ("require b implies G (c and F a)", "take it out of the `always`"),
        ("require b implies G (c and (a until b))", "take it out of the `always`"),
    ],
)
def test_the_suggestion_keeps_the_rest_of_the_clause(clause: str, advice: str) -> None:
    (help_,) = (
        finding.diagnostic.help for finding in findings_in(block(clause)) if finding.diagnostic.code == "TLT0424"
    )
    assert (help_ or "").partition("if once is enough, ")[2] == advice


@pytest.mark.parametrize(
    ("clause", "strong", "weak"),
    [
        ("require G (a until b)", "require a until b", "require a weak_until b"),
        ("keep c and (a until b)", "require a until b", "require a weak_until b"),
        ("keep not a until b", "require not a until b", "require not a weak_until b"),
        ("require b implies G (a until c)", "(a until c)", "(a weak_until c)"),
    ],
)
def test_an_until_at_every_step_gets_both_readings(clause: str, strong: str, weak: str) -> None:
    (help_,) = (
        finding.diagnostic.help for finding in findings_in(block(clause)) if finding.diagnostic.code == "TLT0424"
    )
    assert help_ is not None
    assert help_.split("`")[1::2][::3][:2] == [strong, weak]


def test_the_suggestion_fits_a_spec_or_let_without_clauses() -> None:
    for text in ("spec s = G F a", "let often = G F a spec s = often"):
        diagnostics = [finding.diagnostic for finding in findings_in(f"{SIGNALS}{text}")]
        (diagnostic,) = (diagnostic for diagnostic in diagnostics if diagnostic.code == "TLT0424")
        assert (diagnostic.help or "").endswith("if once is enough, write `eventually a`")


def test_lets_are_checked_if_all_specs_are_finite() -> None:
    text = "signal a: bool let often = G F a spec s = often"
    assert labelled_texts(text, "TLT0424") == ["G F"]
    assert labelled_texts(text.replace("G F", "F G"), "TLT0424") == []
    assert codes(f"{text} spec t {{ semantics infinite limit 9 steps judge at limit require often }}") == []
    assert codes("signal a: bool let often = G F a") == []


@times(40)
@given(specs(*CLAUSES, worlds=[FREE], most=1))
def test_a_reported_part_depends_on_the_last_step_only(drawn: tuple[World, str]) -> None:
    """Replacing the part by its condition on the last step gives an equivalent spec."""
    world, text = drawn
    spec, reported = spec_and_findings(recurrence.check, text)
    for part in last_steps(spec, reported):
        awaited = text[part.operand.span.start : part.operand.span.end]
        alone = f"{text[: part.span.start]}(F ((N false) & ({awaited}))){text[part.span.end :]}"
        same, _ = spec_and_findings(recurrence.check, alone)
        assert world.traces.satisfying(spec.spec.formula) == world.traces.satisfying(same.spec.formula)


def last_steps(spec: SpecView, reported: list[RuleFinding]) -> Iterator[Unary]:
    """Yield the `eventually` and `always` at whose operator the label of a finding ends."""
    ends = {finding.labels[0].span.end for finding in reported}
    for formula in spec.formulas():
        for part in formula.parts():
            if isinstance(part.tree, Unary) and part.tree.op in ("F", "G") and part.tree.op_span.end in ends:
                yield part.tree


@pytest.mark.parametrize(
    ("clauses", "expected"),
    [
        (("keep eventually at(x)", "keep eventually at(y)"), ["TLT0424", "TLT0424"]),
        (("require G F at(x) and G F at(y)",), ["TLT0424", "TLT0424"]),
        # The contradiction stays when the first clause is `reach at(x)`.
        (("keep eventually at(x)", "avoid at(x)"), ["TLT0410", "TLT0424"]),
        (("keep eventually at(x)", "reach at(y) and always at(y)"), ["TLT0410", "TLT0424"]),
    ],
)
def test_a_contradiction_of_clauses_that_are_all_reported_is_left_out(
    clauses: tuple[str, ...], expected: list[str]
) -> None:
    found = [code for code in codes(block(*clauses, before=APART)) if code in ("TLT0410", "TLT0424")]
    assert sorted(found) == expected
