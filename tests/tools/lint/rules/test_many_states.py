"""TLT0423: automata that are far larger than their specs read."""

from __future__ import annotations

import pytest

from tests.tools.lint.helpers import block, found, of


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
def test_the_longest_bound_is_to_blame(clauses: tuple[str, ...], expected: list[str]) -> None:
    assert of("TLT0423", *clauses) == expected


def test_what_is_as_long_as_its_automaton_is_no_surprise() -> None:
    assert of("TLT0423", f"reach {' then '.join('abc' * 40)}") == []


def test_without_a_bound_the_parts_multiply() -> None:
    before = "".join(f"signal {name}: bool\n" for name in "abcdefg")
    text = block(*(f"reach {name}" for name in "abcdefg"), before=before)
    (remark,) = (each.diagnostic for each in found(text) if each.diagnostic.code == "TLT0423")
    assert [label.source.slice(label.span) for label in remark.labels] == ["reach a", "reach b", "reach c", "reach d"]
    assert "exclusive" in (remark.help or "")
