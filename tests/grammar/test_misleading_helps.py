"""Helps that once led users astray say what their clause may mean, in their own words, or what no clause can say."""

from __future__ import annotations

import pytest

from tltlc import compile_text
from tltlc.diagnostics.diagnostic import Diagnostic, TltlError

HEAD = """
clock 10 Hz
signal alarm: bool
signal hidden: bool
signal seen: bool
signal hit: bool
signal mode: (wave, dive, idle)
signal speed in [0, 10]
"""


def error_of(clause: str) -> Diagnostic:
    with pytest.raises(TltlError) as failure:
        compile_text(f"{HEAD}spec s {{\n    {clause}\n}}\n")
    return failure.value.diagnostics[0]


@pytest.mark.parametrize("word", ["in each", "per", "between", "during", "since the", "for", "within", "every", "each"])
def test_a_word_of_english_behind_a_number_is_no_unit(word: str) -> None:
    error = error_of(f"keep times(hit) <= 3 {word} hidden")
    assert error.code != "TLT0111"
    assert "the units are" not in (error.help or "")


def test_another_word_behind_a_number_is_no_unit() -> None:
    assert error_of("keep speed <= 3 feet").title == "`feet` is not a unit"
