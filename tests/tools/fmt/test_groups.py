"""The layout of groups of entities."""

from __future__ import annotations

import pytest

from tltlc.tools.fmt import format_text

MANY = ", ".join(f"guard_number_{number}" for number in range(12))


@pytest.mark.parametrize(
    ("text", "formatted"),
    [
        ("entity  guards=g1,g2", "entity guards = g1, g2\n"),
        ("spec s=all g in  guards :p(g)", "spec s = all g in guards: p(g)\n"),
        ("spec s=any g in(guards,b):p(g)", "spec s = any g in (guards, b): p(g)\n"),
    ],
)
def test_a_group_has_one_layout(text: str, formatted: str) -> None:
    assert format_text(text) == formatted
    assert format_text(formatted) == formatted


def test_a_long_group_is_broken_into_lines() -> None:
    formatted = format_text(f"entity guards = {MANY}")
    assert len(formatted.splitlines()) > 1
    assert " ".join(formatted.split()) == f"entity guards = {MANY}"
    assert format_text(formatted) == formatted


def test_a_long_body_goes_below_its_group() -> None:
    long = " and ".join(f"is_seen_by_{number}(g)" for number in range(9))
    formatted = format_text(f"spec s = all g in guards: {long}")
    assert "all g in guards:\n" in formatted
    assert format_text(formatted) == formatted
