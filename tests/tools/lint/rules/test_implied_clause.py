"""TLT0413: clauses that others imply."""

from __future__ import annotations

from functools import reduce

import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

import tltlc
from tests.tools.lint.helpers import RANGES, SIGNALS, block, codes, found, of, remarks
from tests.tools.lint.strategies import SMALL, World, specs
from tests.tools.lint.traces import both, includes
from tltlc.automaton.compare import are_equivalent, is_included
from tltlc.automaton.finite.build import build, spec_from_formula
from tltlc.logic.formula import Formula, and_
from tltlc.tools.lint.rules import duplicate_clause, implied_clause, recurrence


def automaton(formulas: list[Formula]) -> tltlc.Fspa:
    return build(spec_from_formula(and_(*formulas)))


@given(st.lists(SMALL, min_size=2, max_size=4))
def test_what_is_implied_can_be_left_out_and_by_what_it_is_implied(clauses: list[str]) -> None:
    text = block(*(f"require ({clause})" for clause in clauses))
    view, told = remarks(implied_clause.check, text)
    parts = view.spec.parts
    assume(view.fspa.states[0].verdict != "violated")
    at = {part.span: part.formula for part in parts}
    for each in told:
        part, *reasons = (at[label.span] for label in each.labels)
        assert is_included(automaton(reasons), automaton([part]))
    gone = {each.labels[0].span for each in told}
    twice = {each.labels[0].span for each in remarks(duplicate_clause.check, text)[1]}
    left = [part for part in parts if part.span not in gone | twice]
    assert are_equivalent(automaton(list(at.values())), automaton([part.formula for part in left]))
    # From what speaks of the last step alone nothing is concluded.
    last = [each.labels[0].span for each in remarks(recurrence.check, text)[1]]
    reasons = [part.formula for part in left if not any(part.span.covers(span) for span in last)]
    for formula in (part.formula for part in left):
        others = [other for other in reasons if other is not formula]
        # What is always true is implied by nothing in particular; another warning speaks of it.  And clauses that
        # share no atom are not compared: the one could imply the other only by how long the trace may be.
        share = set(formula.atoms()) & {name for other in others for name in other.atoms()}
        if share and automaton([formula]).states[0].verdict != "satisfied":
            assert not is_included(automaton(others), automaton([formula]))


def test_over_infinite_traces_other_clauses_are_implied() -> None:
    clauses = ("require G F a", "require G F (a or b)")
    assert of("TLT0413", "semantics infinite", *clauses) == ["G F (a or b)"]
    assert of("TLT0413", "semantics infinite", "require F G a", "require G F (a or b)") == ["G F (a or b)"]


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
def test_what_comparisons_say_of_each_other_may_imply_a_clause(clauses: tuple[str, ...], expected: list[str]) -> None:
    assert of("TLT0413", *clauses, before=RANGES) == expected


def test_what_excludes_an_atom_may_imply_its_absence() -> None:
    exclusive = SIGNALS + "exclusive a, b\n"
    assert of("TLT0413", "keep a", "avoid b", before=exclusive) == ["avoid b"]
    assert of("TLT0413", "keep a", "avoid b") == []


@given(specs("keep {}", "avoid {}", "reach {}", "require {}"))
def test_no_trace_meets_the_reasons_and_breaks_what_they_imply(drawn: tuple[World, str]) -> None:
    world, text = drawn
    spec, told = remarks(implied_clause.check, text)
    satisfying = {part.span: world.traces.satisfying(part.formula) for part in spec.spec.parts}
    for remark in told:
        needless, *reasons = (satisfying[label.span] for label in remark.labels)
        together = reduce(both, reasons)
        assert any(together) and includes(needless, together)


@pytest.mark.parametrize(
    ("clauses", "expected"),
    [
        (("reach a", "keep b until a"), []),
        (("require G F a", "require F G a"), []),
        (("require G F a", "require G F b", "reach a and b"), []),
        (("reach a", "reach a and c", "keep b until a"), ["reach a"]),
        (("keep a", "require G F a"), ["G F a"]),
    ],
)
def test_what_speaks_of_the_last_step_alone_is_no_reason(clauses: tuple[str, ...], expected: list[str]) -> None:
    assert of("TLT0413", *clauses) == expected
    assert of("TLT0424", *clauses) != []


def test_clauses_that_contradict_each_other_by_their_values_imply_nothing() -> None:
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
def test_what_makes_a_clause_a_goal_is_said_where_it_may_be_left_out(clauses: tuple[str, ...], judged: bool) -> None:
    text = f"{SIGNALS}spec s {{ limit 9 steps {' '.join(clauses)} }}"
    (said,) = (each.diagnostic for each in found(text) if each.diagnostic.code == "TLT0413")
    left = text.replace(said.labels[0].source.slice(said.labels[0].span) + " }", "}")
    ours, theirs = (tltlc.compile_text(each)[0] for each in (text, left))
    assert left != text and (ours.judge != theirs.judge) == judged
    assert ("`judge at goal`" in (said.help or "")) == judged
