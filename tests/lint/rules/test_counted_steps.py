"""TLT0418: several `next` in a row."""

from __future__ import annotations

import pytest

from tests.lint.helpers import SIGNALS, of


@pytest.mark.parametrize(
    ("clause", "expected"),
    [
        ("require X X a", ["X X"]),
        ("require X F a", []),
        ("require X a", []),
        ("require next after 2 steps a", ["next after 2 steps"]),
        ("require next after 1 step a", []),
        ("require next after 2 s a", []),
        ("require N (N a)", ["N (N"]),
        ("require X (a and X b)", []),
        ("reach a then b then c", []),
    ],
)
def test_nexts_that_count(clause: str, expected: list[str]) -> None:
    assert [each.rstrip() for each in of("TLT0418", clause, before="clock 10 Hz\n" + SIGNALS)] == expected
