"""TLT0467: `eventually always a` in a spec whose episodes end at the first step with a."""

from __future__ import annotations

import pytest

from tests.tools.lint.helpers import SIGNALS, codes, findings_in


@pytest.mark.parametrize(
    "clause",
    [
        "require eventually always a",
        "require eventually always (a and b)",
        "require (eventually (always a)) and (always c)",
    ],
)
def test_a_state_at_the_end_of_an_episode_gets_a_note(clause: str) -> None:
    text = f"{SIGNALS}spec s {{ limit 9 steps {clause} }}"
    (note,) = (item.diagnostic for item in findings_in(text) if item.diagnostic.code == "TLT0467")
    assert note.severity == "note"
    assert "judge at limit" in (note.help or "")


@pytest.mark.parametrize(
    "clause",
    [
        "judge at limit require eventually always a",
        "require eventually a",
        "require always eventually a",
        "require eventually always for 3 steps a",
        "reach a",
    ],
)
def test_other_clauses_get_none(clause: str) -> None:
    assert "TLT0467" not in codes(f"{SIGNALS}spec s {{ limit 9 steps {clause} }}")
