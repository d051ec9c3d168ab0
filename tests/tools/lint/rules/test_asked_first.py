"""TLT0466: rules for every step that say something has come already, which hardly any first step has."""

from __future__ import annotations

from itertools import pairwise

import pytest

from tests.tools.lint.helpers import SIGNALS, accepted_traces, block, codes, findings_in
from tltlc.diagnostics.diagnostic import Diagnostic

BEFORE = f"clock 1 Hz\n{SIGNALS}"


def warnings(clause: str) -> list[Diagnostic]:
    text = block(clause, before=BEFORE)
    return [finding.diagnostic for finding in findings_in(text) if finding.diagnostic.code == "TLT0466"]


@pytest.mark.parametrize(
    ("clause", "offered"),
    [
        ("keep times(a) == 1", "reach a"),
        ("keep times(a) >= 1", "reach a"),
        ("keep times(a) > 0", "reach a"),
        ("keep 1 <= times(a)", "reach a"),
        ("keep times(a) >= 1 and b", "reach a"),
        ("require always times(a) >= 1", "reach a"),
        ("avoid times(a) < 1", "reach a"),
        ("avoid times(a) == 0", "reach a"),
        ("keep once a", "reach a"),
        ("keep once ends a", None),
        ("keep times(begins b and previously a) >= 1", None),
        ("keep times_within(a, 3 s) == 1", None),
        ("keep time_since(a) < 3 s", None),
        ("avoid not once a", "reach a"),
        ("keep times_since(a, b) >= 1", "reach times_since(a, b) >= 1"),
        ("keep times_within(a, 3 s) >= 1", "keep time_holding(not a) < 3 s"),
        ("keep times_within(a or b, 3 s) >= 1", "keep time_holding(not (a or b)) < 3 s"),
        ("avoid times_within(a, 3 s) == 0", "keep time_holding(not a) < 3 s"),
        ("keep time_since(a) <= 3 s", "keep time_holding(not a) < 3 s"),
        ("keep once within 3 s a", "keep time_holding(not a) < 3 s"),
        ("keep times(a) <= 1", None),
        ("keep times(a) >= 2", None),
        ("keep times_since(a, b) >= 2", None),
        ("keep begins b implies once a", None),
        ("reach once a", None),
        ("reach times(a) >= 1", None),
        ("keep time_since(a, 9 s) <= 3 s", None),
    ],
)
def test_a_rule_for_what_the_first_step_must_have_gets_another_clause(clause: str, offered: str | None) -> None:
    given = warnings(clause)
    assert len(given) == (offered is not None)
    for warning in given:
        assert warning.title.startswith("the first step must already have `a")
        assert f"`{offered}`" in (warning.help or "")
        assert warning.severity == "warning"


@pytest.mark.parametrize(
    "clause",
    ["keep times_within(a, 3 s) >= 1", "keep time_since(a) <= 3 s", "keep once within 3 s a"],
)
def test_the_offered_time_breaks_at_the_same_step_and_may_begin_at_the_start(clause: str) -> None:
    """The traces have a at the first step, or not before the sixth, and steps in a row with a never."""
    typed = accepted_traces(block(clause, before=BEFORE), "a", 6)
    offered = accepted_traces(block("keep time_holding(not a) < 3 s", before=BEFORE), "a", 6)
    assert {trace for trace in typed if ("a", "a") not in pairwise(trace)} == {
        trace for trace in offered if trace[0] == "a" and ("a", "a") not in pairwise(trace)
    }
    assert ("", "", "") in offered - typed


def test_a_count_of_two_in_a_time_breaks_at_every_first_step() -> None:
    text = block("keep times_within(a, 3 s) >= 2", before=BEFORE)
    assert "TLT0466" in codes(text)
    assert not accepted_traces(text, "a", 3)
