"""TLT0413: clauses that other clauses imply."""

from __future__ import annotations

from functools import reduce

import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

import tltlc
from tests.fuzzing import times
from tests.tools.lint.helpers import (
    RANGES,
    SIGNALS,
    block,
    codes,
    findings_in,
    labelled_texts_in_block,
    spec_and_findings,
)
from tests.tools.lint.strategies import SMALL, World, specs
from tests.tools.lint.traces import includes, intersection
from tltlc.automaton.compare import are_equivalent, is_included
from tltlc.automaton.finite.build import build, spec_from_formula
from tltlc.logic.formula import Formula, and_
from tltlc.tools.lint.rules import duplicate_clause, implied_clause, recurrence


def automaton(formulas: list[Formula]) -> tltlc.Fspa:
    return build(spec_from_formula(and_(*formulas)))


@times(40)
@given(st.lists(SMALL, min_size=2, max_size=4))
def test_implied_clauses_can_be_removed(clauses: list[str]) -> None:
    text = block(*(f"require ({clause})" for clause in clauses))
    view, reported = spec_and_findings(implied_clause.check, text)
    parts = view.spec.parts
    assume(view.fspa.states[0].verdict != "violated")
    at = {part.span: part.formula for part in parts}
    for finding in reported:
        part, *reasons = (at[label.span] for label in finding.labels)
        assert is_included(automaton(reasons), automaton([part]))
    implied = {finding.labels[0].span for finding in reported}
    duplicates = {finding.labels[0].span for finding in spec_and_findings(duplicate_clause.check, text)[1]}
    remaining = [part for part in parts if part.span not in implied | duplicates]
    assert are_equivalent(automaton(list(at.values())), automaton([part.formula for part in remaining]))
    # A clause that constrains only the last step is not used as a reason.
    last = [finding.labels[0].span for finding in spec_and_findings(recurrence.check, text)[1]]
    reasons = [part.formula for part in remaining if not any(part.span.covers(span) for span in last)]
    for formula in (part.formula for part in remaining):
        others = [other for other in reasons if other is not formula]
        # A clause that is always true is covered by another warning. Clauses without a common atom are not
        # compared: one could imply the other only through the length of the trace.
        share = set(formula.atoms()) & {name for other in others for name in other.atoms()}
        if share and automaton([formula]).states[0].verdict != "satisfied":
            assert not is_included(automaton(others), automaton([formula]))


def test_infinite_semantics_imply_other_clauses() -> None:
    clauses = ("require G F a", "require G F (a or b)")
    assert labelled_texts_in_block("TLT0413", "semantics infinite", *clauses) == ["G F (a or b)"]
    assert labelled_texts_in_block("TLT0413", "semantics infinite", "require F G a", "require G F (a or b)") == [
        "G F (a or b)"
    ]


@pytest.mark.parametrize(
    ("clauses", "expected"),
    [
        (("reach a", "keep x > 5", "keep x > 3"), ["keep x > 3"]),
        (("reach a", "keep x > 3", "keep x > 5"), ["keep x > 3"]),
        (("reach a", "keep x > 5", "avoid x < 3"), ["avoid x < 3"]),
        (("reach x > 5", "reach x > 3"), ["reach x > 3"]),
        (("reach a", "keep x > 5", "keep x < 7"), []),
        (("reach a", "keep x > 5", "keep y > 3"), []),
        (("reach x > 3 then a", "reach x > 5"), []),
    ],
)
def test_a_comparison_may_imply_a_clause(clauses: tuple[str, ...], expected: list[str]) -> None:
    assert labelled_texts_in_block("TLT0413", *clauses, before=RANGES) == expected


def test_an_exclusive_atom_may_imply_an_avoid() -> None:
    exclusive = SIGNALS + "exclusive a, b\n"
    assert labelled_texts_in_block("TLT0413", "keep a", "avoid b", before=exclusive) == ["avoid b"]
    assert labelled_texts_in_block("TLT0413", "keep a", "avoid b") == []


@times(40)
@given(specs("keep {}", "avoid {}", "reach {}", "require {}"))
def test_no_trace_meets_the_reasons_and_breaks_the_implied_clause(drawn: tuple[World, str]) -> None:
    world, text = drawn
    spec, reported = spec_and_findings(implied_clause.check, text)
    satisfying = {part.span: world.traces.satisfying(part.formula) for part in spec.spec.parts}
    for finding in reported:
        needless, *reasons = (satisfying[label.span] for label in finding.labels)
        common = reduce(intersection, reasons)
        assert any(common) and includes(needless, common)


@pytest.mark.parametrize(
    ("clauses", "expected"),
    [
        (("reach a", "keep b until a"), []),
        (("require G F a", "require F not F not a"), []),
        (("require G F a", "require F G a"), ["G F a"]),
        (("require G F a", "require G F b", "reach a and b"), []),
        (("reach a", "reach a and c", "keep b until a"), ["reach a"]),
        (("keep a", "require G F a"), ["G F a"]),
    ],
)
def test_a_clause_about_the_last_step_is_no_reason(clauses: tuple[str, ...], expected: list[str]) -> None:
    assert labelled_texts_in_block("TLT0413", *clauses) == expected
    assert labelled_texts_in_block("TLT0424", *clauses) != []


def test_clauses_with_contradictory_values_imply_nothing() -> None:
    clauses = ("keep x > 5", "avoid x > 3", "reach x > 7")
    assert codes(block(*clauses, before="signal x in [0, 10]\n")) == ["TLT0431"]


@pytest.mark.parametrize(
    ("clauses", "judged"),
    [
        (("keep a", "reach a"), True),
        (("judge at goal", "keep a", "reach a"), False),
        (("keep a", "keep a or b"), False),
        (("keep c", "reach a and b", "reach a"), False),
    ],
)
def test_the_help_names_judge_if_removing_the_clause_would_change_it(clauses: tuple[str, ...], judged: bool) -> None:
    text = f"{SIGNALS}spec s {{ limit 9 steps {' '.join(clauses)} }}"
    (diagnostic,) = (finding.diagnostic for finding in findings_in(text) if finding.diagnostic.code == "TLT0413")
    shortened = text.replace(diagnostic.labels[0].source.slice(diagnostic.labels[0].span) + " }", "}")
    original, changed = (tltlc.compile_text(source)[0] for source in (text, shortened))
    assert shortened != text and (original.judge != changed.judge) == judged
    assert ("`judge at goal`" in (diagnostic.help or "")) == judged
