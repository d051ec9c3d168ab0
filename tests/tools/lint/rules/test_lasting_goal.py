"""TLT0434: a bounded `always` as a goal can be met in a single step."""

from __future__ import annotations

import pytest
from hypothesis import given

from tests.fuzzing import times
from tests.tools.lint.helpers import codes, labelled_texts, spec_and_findings
from tests.tools.lint.strategies import FREE, World, specs
from tltlc.monitor.monitor import Monitor
from tltlc.pipeline import compile_text
from tltlc.tools.lint.rules import lasting_goal

SIGNALS = "clock 10 Hz\nsignal a: bool\nsignal b: bool\nsignal c: bool\n"


def spec(*clauses: str) -> str:
    return SIGNALS + "\n    ".join(["spec s {", "limit 300 steps", *clauses]) + "\n}\n"


@pytest.mark.parametrize(
    ("clause", "expected"),
    [
        ("reach (always for 3 s a)", "always for 3 s a"),
        ("reach always for 3 s a", "always for 3 s a"),
        ("require eventually (always for 3 s a)", "always for 3 s a"),
        ("require c and F[0,9] G[0,3] a", "G[0,3] a"),
        ("reach eventually within 5 s (always for 3 s a)", "always for 3 s a"),
        ("reach c and (always for 3 s a)", "always for 3 s a"),
        ("reach not (eventually within 3 s not a)", "eventually within 3 s not a"),
        ("reach (c and b) or (always for 3 s a)", "always for 3 s a"),
    ],
)
def test_a_reported_goal_is_met_in_one_step(clause: str, expected: str) -> None:
    assert labelled_texts(spec(clause), "TLT0434") == [expected]
    (fspa,) = compile_text(spec(clause))
    monitor = Monitor(fspa)
    assert monitor.step({"a": True, "b": False, "c": True}).done and monitor.success


@pytest.mark.parametrize("clause", ["reach b then (always for 3 s a)", "require b then c then (always for 3 s a)"])
def test_the_last_goal_of_a_chain_is_reported(clause: str) -> None:
    assert labelled_texts(spec(clause), "TLT0434") == ["always for 3 s a"]


@pytest.mark.parametrize(
    "clauses",
    [
        ("reach (always for 3 s a) then b",),
        ("reach (always for 3 s a) and (next after 29 steps true)",),
        ("reach (always for 3 s (a then b))",),
        ("reach b", "require always for 3 s a"),
        ("reach b", "keep b implies (always for 3 s a)"),
        ("reach eventually within 3 s a",),
        ("reach not (always for 3 s a)",),
        ("judge at limit", "reach (always for 3 s a)"),
        ("semantics infinite", "reach (always for 3 s a)"),
    ],
)
def test_a_spec_that_one_step_cannot_meet_or_that_is_no_goal_is_not_reported(clauses: tuple[str, ...]) -> None:
    assert "TLT0434" not in codes(spec(*clauses))


@pytest.mark.slow
def test_a_next_beside_the_goal_makes_it_take_the_whole_time() -> None:
    (fspa,) = compile_text(spec("reach (always for 3 s a) and (next after 29 steps true)"))
    monitor = Monitor(fspa)
    assert [monitor.step({"a": True}).done for _ in range(30)] == [False] * 29 + [True]


LASTING = "(always for 3 steps {} and {})"


@times(40)
@given(specs(f"reach {LASTING}", f"reach {LASTING} and {{}}", f"require F ({LASTING} | {{}})", worlds=[FREE], most=1))
def test_some_trace_of_one_step_meets_a_reported_goal(drawn: tuple[World, str]) -> None:
    world, text = drawn
    spec, reported = spec_and_findings(lasting_goal.check, text)
    for _ in reported:
        assert world.traces.satisfying(spec.spec.formula)[0]


@pytest.mark.parametrize(
    ("clause", "suggested"),
    [
        ("reach always for 3 s a", "time_holding(a) >= 3 s"),
        ("reach (b then (always for 3 s (a or c)))", "time_holding(a or c) >= 3 s"),
    ],
)
def test_the_suggested_goal_needs_the_whole_time(clause: str, suggested: str) -> None:
    _, (finding,) = spec_and_findings(lasting_goal.check, spec(clause))
    assert finding.help == f"ask how long it has held: `{suggested}`"
    (fspa,) = compile_text(spec(f"reach {suggested}"))
    monitor = Monitor(fspa)
    sample = {"a": True, "b": False, "c": False}
    assert [monitor.step(sample).done for _ in range(31)] == [False] * 30 + [True]
