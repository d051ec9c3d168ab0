"""Clauses that ask for a condition and its negation at one step."""

import pytest

from tltlc.grammar.english.contradictions import forbids_its_event


@pytest.mark.parametrize(
    "clause",
    [
        "keep a implies not a",
        "keep a and b implies always for 5 s not a",
        "keep begins a implies always not a",
        "keep begins (once a) implies not a",
        "keep begins (times(a) >= 2) implies always for 3 s not a",
        "keep begins a implies not once within 3 s a",
        "keep ends a implies always for 2 s a",
        "keep ends a implies time_holding(a) >= 2 s",
        "keep mode is menu implies not (mode is menu or b)",
        "require not a weak_until begins (times(a) >= 2)",
    ],
)
def test_a_clause_forbids_its_event(clause: str) -> None:
    assert forbids_its_event(["keep b", clause])


@pytest.mark.parametrize(
    "clause",
    [
        "avoid a",
        "keep a implies b",
        "keep a implies eventually within 3 s not a",
        "keep ends a implies always for 3 s not a",
        "keep a implies weak_next not a",
        "keep a implies not previously a",
        "keep a or b implies not a",
        "require not a weak_until a",
        "require not a weak_until begins (once a)",
        "avoid (begins a) then within 3 s (begins a)",
        "keep mode is menu implies mode is not play",
    ],
)
def test_a_clause_leaves_its_event_free(clause: str) -> None:
    assert not forbids_its_event([clause])
