"""TLT0430: clauses that every trace satisfies."""

from __future__ import annotations

import pytest
from hypothesis import given

import tltlc
from tests.calls import calls
from tests.fuzzing import times
from tests.tools.lint.helpers import (
    APART,
    PLACES,
    RANGES,
    SIGNALS,
    findings_in,
    labelled_texts_in_block,
    spec_and_findings,
)
from tests.tools.lint.strategies import World, specs
from tltlc.core.source import SourceFile
from tltlc.pipeline import CompileOptions
from tltlc.tools.lint.rules import needless_clause
from tltlc.tools.lint.rules.needless_clause import RULE
from tltlc.tools.lint.run import view_of


@pytest.mark.parametrize(
    ("clauses", "expected"),
    [
        (("reach a", "keep x > 3 or x < 5"), ["keep x > 3 or x < 5"]),
        (("reach a", "avoid x > 5 and x < 3"), ["avoid x > 5 and x < 3"]),
        (("reach a", "avoid x > 5 and not x > 3"), ["avoid x > 5 and not x > 3"]),
        (("reach a", "require always (x > 5 implies x > 3)"), ["always (x > 5 implies x > 3)"]),
        (("reach a", "keep b or not b"), ["keep b or not b"]),
        (("reach a", "reach b or not b"), ["reach b or not b"]),
        (("reach a", "require b or not b"), ["b or not b"]),
        (("reach a", "avoid x + y > 15 and x < 4"), ["avoid x + y > 15 and x < 4"]),
        (("semantics infinite", "require G F a", "keep x > 3 or x < 5"), ["keep x > 3 or x < 5"]),
        (("reach a", "keep x > 5 or x < 3"), []),
        (("reach a", "keep x > 3 or x < 3"), []),
        (("reach a", "keep x > 3 or y < 5"), []),
        (("reach a", "avoid x + y > 13 and x < 4"), []),
        (("reach a", "avoid x > 3 and x < 5"), []),
        (("reach a", "keep b or not c"), []),
        # The compiler already warns that the whole spec is always satisfied.
        (("reach b or not b",), []),
    ],
)
def test_clauses_that_no_trace_breaks_are_reported(clauses: tuple[str, ...], expected: list[str]) -> None:
    assert labelled_texts_in_block("TLT0430", *clauses, before=RANGES) == expected


def test_a_clause_that_exclusive_atoms_satisfy_is_reported() -> None:
    assert labelled_texts_in_block("TLT0430", "reach at(z)", "avoid at(x) and at(y)", before=APART) == [
        "avoid at(x) and at(y)"
    ]
    assert labelled_texts_in_block("TLT0430", "reach at(z)", "avoid at(x) and at(y)", before=PLACES) == []


@times(40)
@given(specs("keep {}", "avoid {}", "reach {}", "require {}"))
def test_no_trace_breaks_a_reported_clause(drawn: tuple[World, str]) -> None:
    world, text = drawn
    spec, reported = spec_and_findings(needless_clause.check, text)
    for finding in reported:
        (formula,) = (part.formula for part in spec.spec.parts if part.span == finding.labels[0].span)
        assert world.traces.satisfying(formula) == world.traces.all_traces


@pytest.mark.parametrize(
    ("clauses", "judged"),
    [
        (("avoid a", "keep not a or b", "reach (b or not b)"), True),
        (("avoid a", "require F[0,0] (b or not b)"), True),
        (("judge at goal", "avoid a", "reach (b or not b)"), False),
        (("avoid a", "reach c", "reach (b or not b)"), False),
        (("avoid a", "keep (b or not b)"), False),
        (("avoid a", "reach (b or not b) require F (c or not c)"), True),
    ],
)
def test_the_help_names_judge_if_removing_the_clause_would_change_it(clauses: tuple[str, ...], judged: bool) -> None:
    *_, needless = clauses
    text = f"{SIGNALS}spec s {{ limit 9 steps {' '.join(clauses)} }}"
    diagnostics = [finding.diagnostic for finding in findings_in(text) if finding.diagnostic.code == "TLT0430"]
    original, changed = (tltlc.compile_text(source)[0] for source in (text, text.replace(needless, "")))
    assert (original.judge != changed.judge) == judged
    # Of several clauses, only the last has the hint: removing it too would leave the spec without a goal.
    assert ["`judge at goal`" in (diagnostic.help or "") for diagnostic in diagnostics] == [
        *[False] * (len(diagnostics) - 1),
        judged,
    ]


def test_the_work_is_linear_in_the_clauses() -> None:
    def work(clauses: int) -> int:
        text = f"{SIGNALS}spec s {{ reach b\n{'    keep a or not a' * clauses}\n}}"
        view = view_of(SourceFile("a.tltl", text), CompileOptions())
        return calls(lambda: list(RULE.check(view)))

    assert work(400) < 3 * work(200)
