"""TLT0483: rules with the condition `once a`, which ask again after their end."""

from __future__ import annotations

import pytest

from tests.tools.lint.helpers import accepted_traces, block, codes, findings_in


@pytest.mark.parametrize(
    ("clause", "offered"),
    [
        ("keep once a implies b weak_until c", "keep a implies (b weak_until c)"),
        ("keep once a implies (not b until c)", "keep a implies (not b until c)"),
        ("keep once a implies ((a or b) until (b and c))", "keep a implies ((a or b) until (b and c))"),
        ("keep once a implies (b until c) and (a or c)", "a implies (b until c)"),
        ("keep once (a and c) implies b weak_until c", "keep a and c implies (b weak_until c)"),
    ],
)
def test_a_rule_from_the_first_event_on_gets_a_note(clause: str, offered: str) -> None:
    (note,) = (item.diagnostic for item in findings_in(block(clause)) if item.diagnostic.code == "TLT0483")
    assert note.severity == "note"
    assert f"write `{offered}`" in (note.help or "")


def test_the_offered_rule_allows_what_comes_after_the_end() -> None:
    typed, offered = (
        accepted_traces(block(f"keep {condition} implies not b weak_until c"), "abc", 3)
        for condition in ("once a", "a")
    )
    assert ("a", "c", "b") in offered - typed
    assert typed < offered


@pytest.mark.parametrize(
    "clause",
    [
        "keep a implies b weak_until c",
        "keep once a implies b",
        "keep once within 3 steps a implies b weak_until c",
        "keep begins (once a) implies b weak_until c",
        "keep once a implies next (b weak_until c)",
    ],
)
def test_other_rules_get_none(clause: str) -> None:
    assert "TLT0483" not in codes(block(clause))
