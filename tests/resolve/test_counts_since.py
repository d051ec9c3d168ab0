"""Counts and greatest values before `since`."""

from __future__ import annotations

import pytest

from tltlc.core.source import SourceFile
from tltlc.diagnostics.diagnostic import TltlError
from tltlc.pipeline import compile_source

HEAD = "clock 10 Hz\nsignal a: bool\nsignal b: bool\nsignal x in [0, 100]\n"


@pytest.mark.parametrize("number", ["times(a)", "total_time(a)", "highest(x)", "lowest(x)", "(highest(x))"])
def test_a_number_before_since_gets_the_function_that_begins_at_the_event(number: str) -> None:
    with pytest.raises(TltlError) as raised:
        compile_source(SourceFile("a.tltl", f"{HEAD}spec s {{ keep {number} since b <= 3 }}"))
    assert "_since(" in (raised.value.diagnostics[0].help or "")


@pytest.mark.parametrize("function", ["highest", "lowest"])
def test_the_greatest_value_of_a_bool_is_a_formula_and_may_stand_before_since(function: str) -> None:
    compile_source(SourceFile("a.tltl", f"{HEAD}spec s {{ keep {function}(a) since b }}"))
