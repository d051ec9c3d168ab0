"""TLT0459: `keep a weak_until b`, which starts again at every step, and so means `keep a or b`."""

from __future__ import annotations

import re

import pytest

from tests.tools.lint.helpers import SIGNALS, accepted_traces, block, codes, findings_in, labelled_texts_in_block


def offered(text: str) -> list[str]:
    """Return what the help of the only finding says to write."""
    (finding,) = (item.diagnostic for item in findings_in(text) if item.diagnostic.code == "TLT0459")
    assert finding.severity == "warning"
    once, _, always = re.findall("`([^`]*)`", finding.help or "")
    return [once, always]


@pytest.mark.parametrize(
    ("clause", "once", "always"),
    [
        ("keep a weak_until b", "require a weak_until b", "keep a or b"),
        ("keep not a W b", "require not a W b", "keep not a or b"),
        ("require always (a weak_until b)", "require a weak_until b", "keep a or b"),
        ("keep (a or b) weak_until c", "require (a or b) weak_until c", "keep a or b or c"),
        ("keep (a and b) weak_until c", "require (a and b) weak_until c", "keep (a and b) or c"),
    ],
)
def test_the_two_readings_are_offered(clause: str, once: str, always: str) -> None:
    text = block(clause)
    assert offered(text) == [once, always]
    reported, first, every = (accepted_traces(written, "abc", 3) for written in (text, block(once), block(always)))
    assert reported == every < first
    assert "TLT0459" not in [*codes(block(once)), *codes(block(always))]


def test_one_of_several_rules_becomes_a_clause_of_its_own() -> None:
    (finding,) = findings_in(block("keep (a weak_until b) and c"))
    assert (finding.diagnostic.help or "").startswith("write `require a weak_until b` as a clause of its own if")


def test_in_a_formula_only_the_formula_is_offered() -> None:
    assert offered(f"{SIGNALS}spec s = always (a weak_until b)") == ["a weak_until b", "always (a or b)"]


@pytest.mark.parametrize(
    "clause",
    [
        "require a weak_until b",
        "keep c implies a weak_until b",
        "keep a until b",
        "keep c or (a weak_until b)",
        "avoid a weak_until b",
        "require eventually always (a weak_until b)",
        "keep a weak_until b  // tltlc: allow TLT0459",
    ],
)
def test_other_clauses_get_no_finding(clause: str) -> None:
    assert labelled_texts_in_block("TLT0459", clause) == []
