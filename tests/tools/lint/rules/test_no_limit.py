"""TLT0419: specs without a limit."""

from __future__ import annotations

from tests.tools.lint.helpers import SIGNALS, codes


def test_a_spec_of_one_formula_needs_no_limit() -> None:
    assert codes(SIGNALS + "spec s = F (a & b & c)") == []
    assert codes(SIGNALS + "spec s { require F (a & b & c) }") == ["TLT0419"]
