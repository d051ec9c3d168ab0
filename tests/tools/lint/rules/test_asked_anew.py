"""TLT0463: rules that ask for their answer anew while a count or a time stays at a number."""

from __future__ import annotations

import re

import pytest

from tests.tools.lint.helpers import SIGNALS, accepted_traces, block, codes, findings_in

BEFORE = f"clock 1 Hz\n{SIGNALS}"


@pytest.mark.parametrize(
    "condition",
    [
        "times(a) >= 2",
        "(times_since(a, b) > 1)",
        "times_within(a, 3 s) >= 2",
        "time_holding(a) >= 2 s",
        "times_within(a, 3 s) >= 2 and b",
        "b and time_holding(a) >= 2 s",
    ],
)
def test_a_count_or_a_time_as_the_condition_of_a_later_answer_gets_a_finding(condition: str) -> None:
    text = block(f"keep {condition} implies eventually within 2 s c", before=BEFORE)
    (finding,) = (item.diagnostic for item in findings_in(text) if item.diagnostic.code == "TLT0463")
    assert finding.severity == "note"
    clause = re.findall("`([^`]*)`", finding.help or "")[0]
    once = block(clause, before=BEFORE)
    assert "TLT0463" not in codes(once)


@pytest.mark.parametrize("answer", ["always for 2 s not c", "not c until b", "not c weak_until b"])
def test_an_answer_that_lasts_gets_a_finding(answer: str) -> None:
    text = block(f"keep times_within(a, 3 s) >= 2 implies {answer}", before=BEFORE)
    (finding,) = (item.diagnostic for item in findings_in(text) if item.diagnostic.code == "TLT0463")
    assert f"write `keep begins (times_within(a, 3 s) >= 2) implies {answer}`" in (finding.help or "")


def test_an_answer_beside_an_excuse_gets_a_finding() -> None:
    text = block("keep time_holding(a) >= 2 s implies b or (eventually within 2 s c)", before=BEFORE)
    (finding,) = (item.diagnostic for item in findings_in(text) if item.diagnostic.code == "TLT0463")
    offered = "keep begins (time_holding(a) >= 2 s) implies b or (eventually within 2 s c)"
    assert f"write `{offered}`" in (finding.help or "")


def test_the_help_keeps_what_else_the_rule_asks_for() -> None:
    text = block("keep times(a) >= 2 implies (eventually b) and c", before=BEFORE)
    (finding,) = (item.diagnostic for item in findings_in(text) if item.diagnostic.code == "TLT0463")
    assert "write `begins (times(a) >= 2) implies eventually b`" in (finding.help or "")


def test_the_help_asks_once() -> None:
    typed, once = (
        accepted_traces(block(f"keep {rule}", before=BEFORE), "abc", 3)
        for rule in ("times(a) >= 1 implies eventually c", "begins (times(a) >= 1) implies eventually c")
    )
    assert typed < once


@pytest.mark.parametrize(
    "rule",
    [
        "begins (times(a) >= 2) implies eventually within 2 s c",
        "times(a) >= 2 implies c",
        "time_holding(a) >= 2 s implies eventually not a",
        "times_since(a, b) >= 2 implies eventually b",
        "times(a) >= 2 implies next eventually b",
        "times(a) >= 2 implies eventually always b",
        "times(a) >= 2 and begins b implies eventually within 2 s c",
        "times(a) <= 2 implies eventually within 2 s c",
        "a implies eventually within 2 s times(c) >= 1",
    ],
)
def test_other_rules_get_none(rule: str) -> None:
    assert "TLT0463" not in codes(block(f"keep {rule}", before=BEFORE))
