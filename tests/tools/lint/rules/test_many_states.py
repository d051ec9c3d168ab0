"""TLT0423: automata that are far larger than their specs suggest."""

from __future__ import annotations

import pytest

from tests.tools.lint.helpers import block, findings_in, labelled_texts_in_block
from tests.unfolded import unfolded


@pytest.mark.parametrize(
    ("clauses", "expected"),
    [
        (("require eventually within 200 steps a",), ["within 200 steps"]),
        (("reach b", "require always (a implies eventually within 120 steps b)"), ["within 120 steps"]),
        (("require always for 50 steps a", "require eventually within 60 steps b"), ["within 60 steps"]),
        (("require eventually within 90 steps a",), []),
        (("reach a", "reach b", "reach c"), []),
    ],
)
def test_the_longest_bound_is_reported(clauses: tuple[str, ...], expected: list[str]) -> None:
    with unfolded():
        assert labelled_texts_in_block("TLT0423", *clauses) == expected


def test_bounds_that_timers_keep_are_not_reported() -> None:
    assert labelled_texts_in_block("TLT0423", "reach b", "keep a implies eventually within 120 steps b") == []


def test_a_long_spec_with_a_large_automaton_is_not_reported() -> None:
    assert labelled_texts_in_block("TLT0423", f"reach {' then '.join('abc' * 40)}") == []


def test_without_a_bound_the_goals_are_reported() -> None:
    before = "".join(f"signal {name}: bool\n" for name in "abcdefg")
    text = block(*(f"reach {name}" for name in "abcdefg"), before=before)
    (diagnostic,) = (finding.diagnostic for finding in findings_in(text) if finding.diagnostic.code == "TLT0423")
    assert [label.source.slice(label.span) for label in diagnostic.labels] == [
        "reach a",
        "reach b",
        "reach c",
        "reach d",
    ]
    assert "exclusive" in (diagnostic.help or "")
