"""TLT0433: `a until b` as a goal or below `avoid`, where only `b` matters."""

from __future__ import annotations

import pytest
from hypothesis import given

from tests.fuzzing import times
from tests.tools.lint.helpers import SIGNALS, accepted_traces, codes, findings_in, spec_and_findings
from tests.tools.lint.strategies import FREE, World, specs
from tltlc.automaton.compare import are_equivalent
from tltlc.pipeline import compile_text
from tltlc.tools.lint.rules import idle_until


@pytest.mark.parametrize(
    ("clause", "same"),
    [
        ("reach a until b", "reach b"),
        ("avoid a until b", "avoid b"),
        ("reach c then (a until b)", "reach c then b"),
        ("avoid (a or c) until b", "avoid b"),
        ("avoid a or c until b", "avoid a or b"),
        ("avoid a until b or c", "avoid b or c"),
        ("reach a or (c until b)", "reach a or b"),
    ],
)
def test_an_until_whose_first_operand_is_irrelevant_is_reported(clause: str, same: str) -> None:
    assert "TLT0433" in codes(spec(clause))
    original, simplified = (compile_text(spec(source_clause))[0] for source_clause in (clause, same))
    assert are_equivalent(original, simplified)


@pytest.mark.parametrize(
    "clause",
    ["reach (a until b) then c", "require a until b", "reach a and (c until b)", "reach a weak_until b", "avoid b"],
)
def test_an_until_whose_first_operand_matters_is_not_reported(clause: str) -> None:
    assert "TLT0433" not in codes(spec(clause))


@pytest.mark.parametrize(
    ("clause", "suggested_clause"),
    [
        ("avoid a until b", "require (not a) weak_until b"),
        ("avoid (a or c) until b", "require (not (a or c)) weak_until b"),
        ("reach a until b", "require a until b"),
        ("avoid a or c until b", "require (not (a or c)) weak_until b"),
        ("avoid a until b or c", "require (not a) weak_until (b or c)"),
    ],
)
def test_the_suggested_clause_is_judged_at_the_same_moment(clause: str, suggested_clause: str) -> None:
    (finding,) = spec_and_findings(idle_until.check, spec(clause))[1]
    assert finding.help == f"write `{suggested_clause}`"
    original, suggested = (compile_text(spec(source_clause))[0] for source_clause in (clause, suggested_clause))
    assert original.judge == suggested.judge


def spec(clause: str) -> str:
    return f"{SIGNALS}spec s {{\n    limit 300 steps\n    {clause}\n}}\n"


@times(40)
@given(specs("reach {} until {}", "avoid {} until {}", "reach {} then ({} until {})", worlds=[FREE], most=1))
def test_the_simplified_clause_is_equivalent(drawn: tuple[World, str]) -> None:
    world, text = drawn
    spec, reported = spec_and_findings(idle_until.check, text)
    for finding in reported:
        span = finding.labels[0].span
        goal = finding.labels[0].message.split("`")[1].removeprefix("reach ").removeprefix("avoid ")
        same, _ = spec_and_findings(idle_until.check, f"{text[: span.start]}({goal}){text[span.end :]}")
        assert world.traces.satisfying(spec.spec.formula) == world.traces.satisfying(same.spec.formula)


def test_an_until_beside_and_forbids_its_end() -> None:
    (finding,) = (
        item.diagnostic for item in findings_in(spec("avoid a until b and c")) if item.diagnostic.code == "TLT0433"
    )
    assert finding.title == "this forbids the end of its `until`"
    assert finding.help == "write `require (not a) weak_until (b and c)`"
    assert "TLT0446" not in codes(spec("avoid a until b and c"))
    typed, forbidden = (
        accepted_traces(spec(clause), "abc", 3) for clause in ("avoid a until b and c", "avoid b and c")
    )
    assert typed < forbidden
