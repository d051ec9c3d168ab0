"""TLT0419: specs without a limit."""

from __future__ import annotations

import re

import pytest

from tests.tools.lint.helpers import SIGNALS, codes, findings_in


def test_a_spec_of_one_formula_needs_no_limit() -> None:
    assert codes(SIGNALS + "spec s = F (a & b & c)") == []
    assert codes(SIGNALS + "spec s { require F (a & b & c) }") == ["TLT0419"]


@pytest.mark.parametrize("clock", ["", "clock 60 Hz ", "clock varies "])
def test_the_help_is_a_limit_that_the_clock_allows(clock: str) -> None:
    (finding,) = findings_in(f"{clock}{SIGNALS}spec s {{ reach a then b keep c }}")
    (limit,) = re.findall("`(limit [^`]+)`", str(finding.diagnostic.help))
    assert codes(f"{clock}{SIGNALS}spec s {{ {limit} reach a then b keep c }}") == []
