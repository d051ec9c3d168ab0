"""Each language prints the operators of a program in its own way."""

from __future__ import annotations

import pytest

from tltlc import compile_text
from tltlc.backends import emit
from tltlc.backends.languages.javascript_syntax import JavaScriptPrinter
from tltlc.backends.languages.lua_syntax import LuaPrinter
from tltlc.program.printer import Printer
from tltlc.program.tree import All, Compare, ProgramVariable

EQUAL = Compare("==", ProgramVariable("a"), ProgramVariable("b"))
OTHER = Compare("!=", ProgramVariable("a"), ProgramVariable("b"))


@pytest.mark.parametrize(
    ("printer", "expected"),
    [
        (Printer(), "a == b && a != b"),
        (JavaScriptPrinter(()), "a === b && a !== b"),
        (LuaPrinter({"a": "value['x != y']"}, ()), "value['x != y'] == b and value['x != y'] ~= b"),
    ],
    ids=["C", "JavaScript", "Lua"],
)
def test_comparisons_are_printed_with_the_operators_of_the_language(printer: Printer, expected: str) -> None:
    assert printer.text(All((EQUAL, OTHER))) == expected


@pytest.mark.parametrize(("range_", "expected"), [(" in [0 m, 9 m]", "isfinite, tanh"), ("", "inf, isfinite, tanh")])
def test_a_monitor_in_python_imports_inf_if_a_bound_is_missing(range_: str, expected: str) -> None:
    (fspa,) = compile_text(f"signal inf: length{range_}  predicate far in [-1, 1] = tanh(inf / 1 m)  spec s = F far")
    source = emit("python", fspa)["s_monitor.py"]
    assert isinstance(source, str)
    assert f"\nfrom math import {expected}\n" in source
