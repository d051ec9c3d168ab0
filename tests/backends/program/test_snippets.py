from __future__ import annotations

import pytest

from tltlc.automaton.finite.build import build, spec_from_formula
from tltlc.backends import emit
from tltlc.core.record import replace
from tltlc.expression.tree import Op
from tltlc.expression.tree import ParamValue as NamedParam
from tltlc.expression.tree import SignalValue as NamedSignal
from tltlc.logic import formula as f
from tltlc.program import snippets
from tltlc.program.printer import Printer
from tltlc.resolve import spec

SIGNALS = (spec.Signal("x", "number", None, None), spec.Signal("y", "bool", None, None))


def test_short_items_share_lines_and_stay_whole() -> None:
    items = [f'"F  b{number}"' for number in range(30)]
    lines = Printer.items(items, depth=1).split("\n")
    assert lines[0] == ""
    assert lines[-1] == "    "
    assert all(line.startswith(" " * 8) and line.endswith(",") and len(line) <= 108 for line in lines[1:-1])
    assert len(lines) < 8
    assert ", ".join(line.strip().rstrip(",") for line in lines[1:-1]) == ", ".join(items)


@pytest.mark.parametrize("items", [[], ["1", "2"], ["x" * 60]])
def test_few_items_share_one_line(items: list[str]) -> None:
    assert Printer.items(items) == ", ".join(items)


def test_long_items_have_separate_lines() -> None:
    assert Printer.items(["x" * 50, "y", "z" * 50]) == f"\n    {'x' * 50},\n    y,\n    {'z' * 50},\n"


def test_quotes_and_unprintable_characters_are_escaped_in_literals() -> None:
    text = 'a "b" \\ é\n'
    assert snippets.string_literal(text, lambda character: "·") == '"a \\"b\\" \\\\ é·"'
    assert snippets.string_literal(text, lambda character: "·", snippets.is_plain_ascii) == '"a \\"b\\" \\\\ ··"'


@pytest.mark.parametrize(
    ("name", "of", "text"),
    [
        ("v", spec.Signal("v", "speed", 0.0, 100.0), "In [0, 100] m/s."),
        ("v", spec.Signal("v", "speed", 0.0, 100.0, "Of the player"), "Of the player. In [0, 100] m/s."),
        ("d_key", spec.Signal("d(key)", "length", 0.0, None, "How far?"), "d(key): How far? In [0, inf] m."),
        ("t", spec.Param("t", "time", 1.0, 0.5, 2.0, "Of a tick."), "Of a tick. In [0.5, 2] s."),
        ("a", spec.Signal("a", "angle", -3.0, 3.0), "In [-3, 3] rad."),
        ("r", spec.Signal("r", "ratio", 0.0, 1.0, "Health."), "Health. A ratio in [0, 1]."),
        ("n_1", spec.Signal("n", "number", None, None), "n: In [-inf, inf]."),
        ("b", spec.Signal("b", "bool", 0.0, 1.0), "True or false."),
        ("b_1", spec.Signal("b", "bool", 0.0, 1.0, "Whether it is open."), "b: Whether it is open."),
    ],
)
def test_a_comment_on_a_field_has_its_name_doc_and_values(name: str, of: spec.Signal | spec.Param, text: str) -> None:
    assert snippets.field_comment(name, of) == text


@pytest.mark.parametrize("target", ["c", "csharp", "gdscript", "gdscript3", "javascript", "lua", "rust"])
def test_the_doc_comes_before_the_range_in_every_language(target: str) -> None:
    fspa = build(spec_from_formula(f.eventually(f.atom("p"))))
    fspa = replace(
        fspa,
        signals=(spec.Signal("pace", "speed", 0.0, 100.0, "Of the player"),),
        params=(spec.Param("far", "length", 5.0, 2.0, 10.0, "How far it is."),),
        atoms=(spec.Atom("p", Op("-", (NamedSignal("pace"), NamedParam("far")))),),
    )
    text = "\n".join(str(content) for content in emit(target, fspa).values())
    assert "Of the player. In [0, 100] m/s." in text
    assert "How far it is. In [2, 10] m." in text


def test_an_example_shows_two_signals_unless_it_is_too_long() -> None:
    assert snippets.example_sample((), str, ": ") == "{}"
    assert snippets.example_sample(SIGNALS, str, ": ") == "{ x: …, y: true }"
    assert snippets.example_sample(SIGNALS * 2, str, " = ") == "{ x = …, y = true, … }"
    assert snippets.example_sample(SIGNALS, lambda name: name * 60, ": ") == "signals"
