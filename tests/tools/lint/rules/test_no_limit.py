"""TLT0419: specs without a limit."""

from __future__ import annotations

import re

import pytest

from tests.tools.lint.helpers import SIGNALS, codes, findings_in


def test_a_spec_of_one_formula_needs_no_limit() -> None:
    assert codes(SIGNALS + "spec s = F (a & b & c)") == []
    assert codes(SIGNALS + "spec s { judge at goal require F (a & b & c) }") == ["TLT0419"]


@pytest.mark.parametrize("setting", ["judge at goal", "level vault", "limit 9 steps"])
def test_a_setting_of_episodes_concerns_all_specs_of_the_file(setting: str) -> None:
    named = f"{SIGNALS}spec s {{ reach a then b then c }} spec t {{ {setting} reach c then b then a }}"
    assert codes(named) == ["TLT0419"] * (1 if "limit" in setting else 2)


@pytest.mark.parametrize("setting", ["", "tag quick", "semantics infinite"])
def test_a_spec_that_may_be_for_recordings_needs_no_limit(setting: str) -> None:
    assert codes(f"{SIGNALS}spec s {{ {setting} reach a then b then c }}") == []


@pytest.mark.parametrize("clock", ["", "clock 60 Hz ", "clock varies "])
def test_the_help_is_a_limit_that_the_clock_allows(clock: str) -> None:
    (finding,) = findings_in(f"{clock}{SIGNALS}spec s {{ judge at goal reach a then b keep c }}")
    (limit,) = re.findall("`(limit [^`]+)`", str(finding.diagnostic.help))
    assert codes(f"{clock}{SIGNALS}spec s {{ {limit} judge at goal reach a then b keep c }}") == []
