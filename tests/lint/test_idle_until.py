"""TLT0433: of `a until b` at some step, or at no step, b alone is asked for."""

from __future__ import annotations

import pytest

from tests.lint.helpers import codes
from tltlc.comparison import are_equivalent
from tltlc.pipeline import compile_text

SIGNALS = "signal a: bool\nsignal b: bool\nsignal c: bool\n"


@pytest.mark.parametrize(
    ("clause", "same"),
    [
        ("reach a until b", "reach b"),
        ("avoid a until b", "avoid b"),
        ("reach c then (a until b)", "reach c then b"),
        ("avoid (a or c) until b", "avoid b"),
    ],
)
def test_the_first_half_has_no_say(clause: str, same: str) -> None:
    assert "TLT0433" in codes(spec(clause))
    written, simple = (compile_text(spec(each))[0] for each in (clause, same))
    assert are_equivalent(written, simple)


@pytest.mark.parametrize(
    "clause",
    ["reach (a until b) then c", "require a until b", "reach a and (c until b)", "reach a weak_until b", "avoid b"],
)
def test_where_it_has_one(clause: str) -> None:
    assert "TLT0433" not in codes(spec(clause))


def spec(clause: str) -> str:
    return f"{SIGNALS}spec s {{\n    limit 300 steps\n    {clause}\n}}\n"
