"""The help for an operand of `then` that begins at the next step means what it says."""

from __future__ import annotations

import pytest

from tltlc.automaton.compare import are_equivalent
from tltlc.diagnostics.diagnostic import TltlError
from tltlc.pipeline import compile_text

SIGNALS = "signal a: bool\nsignal b: bool\nsignal c: bool\n"


@pytest.mark.parametrize(
    ("before", "written", "after", "meaning"),
    [
        ("{ reach ", "a then always b", " }", "F (a & X G b)"),
        ("{ reach ", "a then next b", " }", "F (a & X b)"),
        ("{ reach ", "a then weak_next b", " }", "F (a & N b)"),
        ("{ reach ", "a or c then always b", " }", "F ((a | c) & X G b)"),
        ("{ reach ", "a iff c then next b", " }", "F ((a <-> c) & X b)"),
        ("{ reach c then ", "a then always b", " }", "F (c & X F (a & X G b))"),
        ("{ reach (", "a then always b", ") }", "F (a & X G b)"),
        ("= ", "a then always b", "", "F (a & X G b)"),
        ("= c then ", "a then next b", "", "F (c & X F (a & X b))"),
        ("{ avoid ", "a then next b", " }", "!F (a & X b)"),
    ],
)
def test_the_suggested_formula_begins_at_the_next_step(before: str, written: str, after: str, meaning: str) -> None:
    with pytest.raises(TltlError) as error:
        compile_text(f"{SIGNALS}spec s {before}{written}{after}")
    (diagnostic,) = error.value.diagnostics
    assert diagnostic.help is not None
    suggested = diagnostic.help.split("`")[-2]
    first, second = compile_text(f"{SIGNALS}spec s {before}{suggested}{after}\nspec t = {meaning}")
    assert are_equivalent(first, second)
