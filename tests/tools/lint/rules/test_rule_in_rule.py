"""TLT0461: `a implies b and c implies d`, which is one rule, read as `a implies ((b and c) implies d)`."""

from __future__ import annotations

import re

import pytest

from tests.tools.lint.helpers import SIGNALS, accepted_traces, block, codes, findings_in, labelled_texts_in_block

BEFORE = f"{SIGNALS}signal d: bool\n"


@pytest.mark.parametrize(
    ("rule", "two", "one"),
    [
        ("a implies b and c implies d", "(a implies b) and (c implies d)", "a implies ((b and c) implies d)"),
        ("a -> b & c -> d", "(a implies b) and (c -> d)", "a implies ((b & c) implies d)"),
        (
            "(a or b) implies not b and d and c implies d",
            "((a or b) implies not b and d) and (c implies d)",
            "(a or b) implies ((not b and d and c) implies d)",
        ),
    ],
)
def test_both_readings_are_offered(rule: str, two: str, one: str) -> None:
    text = block(f"keep {rule}", before=BEFORE)
    (finding,) = (item.diagnostic for item in findings_in(text) if item.diagnostic.code == "TLT0461")
    assert finding.severity == "warning"
    assert re.findall("`([^`]*)`", finding.help or "") == [two, one]
    reported, joined, nested = (
        accepted_traces(block(f"keep {form}", before=BEFORE), "abcd", 2) for form in (rule, two, one)
    )
    assert reported == nested != joined
    assert "TLT0461" not in [code for form in (two, one) for code in codes(block(f"keep {form}", before=BEFORE))]


def test_a_definition_gets_a_finding() -> None:
    assert "TLT0461" in codes(f"{BEFORE}let rule = a implies b and c implies d\n{block('keep rule', before='')}")


@pytest.mark.parametrize(
    "clause",
    [
        "keep a implies b implies c",
        "keep a and b implies c",
        "keep a implies (b and c implies d)",
        "keep (a implies b) and (c implies d)",
        "keep a implies b and (c implies d)",
        "keep a implies b or c implies d",
        "keep a implies b and c implies d  // tltlc: allow TLT0461",
    ],
)
def test_other_rules_get_no_finding(clause: str) -> None:
    assert labelled_texts_in_block("TLT0461", clause, before=BEFORE) == []
