"""The help for an operand of `then` that begins at the next step means what it says."""

from __future__ import annotations

import re

import pytest

from tltlc.automaton.compare import are_equivalent
from tltlc.core.source import SourceFile
from tltlc.diagnostics.diagnostic import TltlError
from tltlc.pipeline import compile_text
from tltlc.tools.lint.scopes import apply_edits

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


@pytest.mark.parametrize(
    ("clause", "readings"),
    [
        ("avoid begins a then within 5 steps begins b", ["(begins a) then within 5 steps (begins b)"]),
        ("avoid begins a then within 5 steps b", ["(begins a) then within 5 steps b"]),
        ("avoid a then within 5 steps begins b", ["a then within 5 steps (begins b)"]),
        (
            "avoid a or c then within 5 steps b",
            ["(a or c) then within 5 steps b", "a or (c then within 5 steps b)"],
        ),
        (
            "avoid a then within 5 steps b or c",
            ["a then within 5 steps (b or c)", "(a then within 5 steps b) or c"],
        ),
        ("avoid a then within 5 steps next b", ["a then within 5 steps (next b)"]),
        (
            "reach a then within 5 steps eventually b",
            ["reach a then within 5 steps b", "a then within 5 steps (eventually b)"],
        ),
        ("avoid a then within 5 steps b then begins c", ["b then (begins c)"]),
    ],
)
def test_the_readings_keep_the_bound(clause: str, readings: list[str]) -> None:
    text = f"{SIGNALS}spec s {{ {clause} }}"
    with pytest.raises(TltlError) as error:
        compile_text(text)
    assert re.findall("`([^`]*)`", error.value.diagnostics[0].help or "") == readings
    bound = "within 5 steps"
    for fix in error.value.diagnostics[0].fixes:
        assert "then" not in fix.title or bound in fix.title
        compile_text(apply_edits(SourceFile("a.tltl", text), fix.edits).text)
