"""TLT0489: rules about an event that ask for another event at any earlier step."""

from __future__ import annotations

import pytest

from tests.tools.lint.helpers import accepted_traces, block, codes, findings_in


@pytest.mark.parametrize(
    ("clause", "offered"),
    [
        (
            "keep begins a implies once begins b",
            "write `keep begins a implies begins b or previously (not begins a since begins b)`",
        ),
        (
            "keep ends a and c implies once (begins b and not c)",
            "write `keep ends a and c implies (begins b and not c) or "
            "previously (not ends a since (begins b and not c))`",
        ),
        ("keep begins a implies (c and once ends b)", "write `(ends b or previously (not begins a since ends b))`"),
    ],
)
def test_an_event_that_asks_for_another_one_gets_a_note(clause: str, offered: str) -> None:
    (note,) = (item.diagnostic for item in findings_in(block(clause)) if item.diagnostic.code == "TLT0489")
    assert note.severity == "note"
    assert offered in (note.help or "")


def test_the_offered_rule_asks_for_a_new_one() -> None:
    typed, offered = (
        accepted_traces(block(f"keep begins a implies {answer}"), "ab", 4)
        for answer in ("once begins b", "begins b or previously (not begins a since begins b)")
    )
    assert ("b", "a", "", "a") in typed - offered
    assert ("b", "a", "b", "a") in offered
    assert ("ab",) in offered
    assert offered < typed


@pytest.mark.parametrize(
    "clause",
    [
        "keep a implies once begins b",
        "keep begins a implies once b",
        "keep begins a implies once within 3 steps begins b",
        "keep begins a implies once begins (a and b)",
        "keep begins a implies previously (not begins a since begins b)",
    ],
)
def test_other_rules_get_none(clause: str) -> None:
    assert "TLT0489" not in codes(block(clause))
