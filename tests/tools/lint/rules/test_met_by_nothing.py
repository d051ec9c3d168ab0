"""TLT0412: goals that a false condition meets."""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path

import pytest
from hypothesis import given

from tests.fuzzing import times
from tests.tools.lint.helpers import (
    RANGES,
    block,
    codes,
    findings_in,
    labelled_texts,
    labelled_texts_in_block,
    spec_and_findings,
)
from tests.tools.lint.strategies import World, specs
from tests.tools.lint.traces import intersection
from tltlc.logic.formula import TRUE, Formula, atom
from tltlc.tools.lint.file_view import SpecView
from tltlc.tools.lint.goals import goals
from tltlc.tools.lint.rule import RuleFinding
from tltlc.tools.lint.rules import met_by_nothing

EXAMPLES = Path(__file__).parents[4] / "examples"


@pytest.mark.parametrize(
    ("clause", "expected"),
    [
        ("reach a implies b", ["a implies b"]),
        ("reach (a -> b) then c", ["a -> b"]),
        ("reach a then ((b -> c))", ["b -> c"]),
        ("require F (a -> F b)", ["a -> F b"]),
        ("require G F (a -> b)", ["a -> b"]),
        ("require (a -> b) then c", ["a -> b"]),
        ("require eventually within 3 steps (a -> b)", ["a -> b"]),
        ("require F ((a -> b) & !c)", ["a -> b"]),
        ("keep a implies b", []),
        ("keep a -> F[0,2] (b or not a)", []),
        ("keep a implies eventually within 2 steps (b or not a)", []),
        ("keep a implies ((c -> b) then c)", []),
        ("keep within 2 steps of a, F (b or not a)", []),
        ("require G (c -> F (a -> b))", []),
        ("keep within 2 steps of a, b and F (b or not c)", []),
        ("require (a implies b) then (a implies F (b or not c))", ["a implies b", "a implies F (b or not c)"]),
        ("require G (a -> F b)", []),
        ("reach a and (b -> c)", []),
        ("reach not a implies b", []),
        ("reach not a", []),
        ("reach a then not b", ["not b"]),
        ("reach a then b then !c", ["!c"]),
        ("reach a then not a", []),
        ("reach a then not b then c", []),
        ("reach not a or b", ["not a or b"]),
        ("reach (b or not a) then c", ["b or not a"]),
        ("reach (not a and not b) or c", ["(not a and not b) or c"]),
        ("reach (a and not b) or c", []),
        ("reach not a and b", []),
        ("reach a implies (b until c)", ["a implies (b until c)"]),
        ("require not F (a -> b)", []),
        ("reach a iff b", []),
        ("reach (a iff b) or c", ["(a iff b) or c"]),
        # If `c` is false, both `a` and `b` must hold.
        ("reach (a iff b) and (b or c)", []),
    ],
)
def test_goals_that_a_false_condition_meets_are_reported(clause: str, expected: list[str]) -> None:
    assert labelled_texts_in_block("TLT0412", clause) == expected


@pytest.mark.parametrize(
    ("clauses", "is_reported"),
    [
        (("reach a implies b", "keep a"), False),
        (("reach not a or b", "keep c"), True),
        (("reach c and (a implies b)", "keep c"), True),
        (("reach c and (a implies b)",), False),
        (("reach a implies b", "require G (a or c)", "avoid c"), False),
        (("reach a implies b", "require a"), True),
        (("reach a implies b", "reach b"), True),
        (("reach F a implies b", "keep F a"), False),
    ],
)
def test_only_traces_that_satisfy_the_other_clauses_count(clauses: tuple[str, ...], is_reported: bool) -> None:
    assert bool(labelled_texts_in_block("TLT0412", *clauses)) == is_reported


def test_the_label_names_no_condition_that_another_clause_keeps() -> None:
    text = block("reach a implies (b or not c)", "keep a")
    (diagnostic,) = (finding.diagnostic for finding in findings_in(text) if finding.diagnostic.code == "TLT0412")
    assert [label.message for label in diagnostic.labels] == ["can be met without `b`"]


@pytest.mark.parametrize(
    ("clause", "expected"),
    [
        ("reach x < 7 implies x > 3", []),
        ("reach x > 3 implies x < 5", []),
        ("reach x > 5 implies x < 3", ["x > 5 implies x < 3"]),
        ("reach x > 5 implies y > 3", ["x > 5 implies y > 3"]),
    ],
)
def test_only_values_that_comparisons_can_have_together_count(clause: str, expected: list[str]) -> None:
    assert labelled_texts_in_block("TLT0412", clause, before=RANGES) == expected


def test_the_formula_that_the_paper_prints_is_reported() -> None:
    text = (EXAMPLES / "branching.tltl").read_text(encoding="utf-8").replace("tltlc: allow", "")
    assert labelled_texts(text, "TLT0412") == ["open_right implies near(e_right)"]
    assert len(codes(text)) == 1


@times(40)
@given(specs("reach {}", "reach {} implies {}", "reach {} then ({} or {})", "keep {}", "avoid {}"))
def test_some_trace_meets_a_reported_goal_while_the_atoms_are_false(drawn: tuple[World, str]) -> None:
    world, text = drawn
    spec, reported = spec_and_findings(met_by_nothing.check, text)
    satisfying = world.traces.satisfying(spec.spec.formula)
    for finding in reported:
        enclosing = [goal for goal in goals(spec) if goal.tree.span.covers(finding.labels[0].span)]
        met = [
            world.traces.holding_at_some_step(goal.formula() or TRUE, without=list(failing(finding, spec)))
            for goal in enclosing
        ]
        assert any(any(intersection(traces, satisfying)) for traces in met)


def failing(finding: RuleFinding, spec: SpecView) -> Iterator[Formula]:
    """Yield the formulas that a finding says may be false: conditions of implications, or atoms."""
    trees = {part.tree.span: part.formula() for clause in spec.formulas() for part in clause.parts()}
    for label in finding.labels:
        formula = trees[label.span]
        if label.message.startswith("true while") and formula:
            yield formula.args[0]
        yield from (atom(name) for name in re.findall("`([^`]*)`", label.message))


def test_a_comparison_whose_atom_is_the_opposite_is_a_goal() -> None:
    text = "signal a: bool\nsignal kills in [0, 9]\nspec s { limit 9 steps reach a then kills >= 1 }"
    assert "TLT0412" not in codes(text)
