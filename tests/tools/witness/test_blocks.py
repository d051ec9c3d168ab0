"""``test`` blocks of traces, which are valid in the file of the spec."""

from __future__ import annotations

from itertools import product

import pytest

import tltlc
from tltlc.core.source import SourceFile
from tltlc.monitor.spec_tests import run_tests
from tltlc.pipeline import compile_source
from tltlc.tools.witness import blocks

NAMES = """import spatial (near)
import core as c
import stealth as st
signal s: bool
signal x in [-10, 10]
signal y in [-10, 10]
signal step: bool
signal expect: bool
signal v: speed in [0 m/s, 60 m/s]
signal b(a: entity): angle in [-180 deg, 180 deg]
entity s1, s2, e.f
spec q {
    reach near(s1, close = 300 cm) and c.above(x, 0.1, 2e-7) then v >= 20 km/h then b(s2) < -30 deg
        then (x + y) * 2 > y - x then step then expect then s then x > -3 then st.alive then near(e.f, far = 5 m)
}
"""


def test_a_block_with_atoms_of_every_kind_parses_and_passes() -> None:
    (fspa,) = tltlc.compile_text(NAMES)
    names = [atom.name for atom in fspa.atoms]
    assert {"near(s1, close=3)", "above(x, 0.1, 2e-07)", "alive", "(x + y) * 2 > y - x"} <= set(names)
    letters = [*(frozenset({name}) for name in names), frozenset(names), frozenset(), frozenset(), frozenset({"other"})]
    text = blocks.test_block("all", fspa, letters, blocks.expectations(fspa, letters, range(1, 99)))
    compiled = compile_source(SourceFile("names.tltl", NAMES + text))
    (result,) = run_tests(compiled.program, compiled.automata)
    assert result.failure is None
    assert all(len(line) <= 100 for line in text.splitlines() if "expect state" not in line)


def test_the_steps_of_a_block_have_the_letters_of_the_trace() -> None:
    (fspa,) = tltlc.compile_text(NAMES)
    names = [atom.name for atom in fspa.atoms]
    letters = [frozenset(n for n, on in zip(names, bits, strict=False) if on) for bits in product((0, 1), repeat=5)]
    text = blocks.test_block("all", fspa, letters, {len(letters): ("pending",)})
    (test,) = compile_source(SourceFile("names.tltl", NAMES + text)).program.tests
    steps = [item for item in test.items if hasattr(item, "holds")]
    assert [step.holds for step in steps for _ in range(step.times)] == letters


def test_equal_letters_share_a_step_up_to_an_expectation() -> None:
    (fspa,) = tltlc.compile_text("signal a: bool  signal b: bool  spec s = G !(a & b)")
    none = frozenset[str]()
    text = blocks.test_block(
        'a "quoted"\ntitle', fspa, [none] * 3 + [frozenset("ab")], {2: ["holding"], 4: ["violated"]}
    )
    assert text == (
        "test \"a 'quoted' title\" for s {\n"
        "    step 2x not a\n"
        "    expect holding\n"
        "    step not a\n"
        "    step a, b\n"
        "    expect violated\n"
        "}\n"
    )


def test_a_step_without_atoms_names_the_atom_that_the_edge_forbids() -> None:
    (fspa,) = tltlc.compile_text("signal a: bool  signal alive: bool  spec s = F a & G alive")
    text = blocks.test_block("death", fspa, [frozenset()], {1: ["violated"]})
    assert "    step not alive\n" in text


def test_progress_is_rounded_down() -> None:
    (fspa,) = tltlc.compile_text("signal a: bool  spec s { reach a then a then a }")
    assert blocks.expectations(fspa, [frozenset("a")] * 2) == {2: ("pending", "progress >= 0.6666", 'state "F a"')}


@pytest.mark.parametrize(("spec", "letters", "expects"), [("X true", [{}], {1: ["pending"]}), ("G a", [], {1: ["x"]})])
def test_a_test_without_atoms_or_steps_is_rejected(
    spec: str, letters: list[frozenset[str]], expects: dict[int, list[str]]
) -> None:
    (fspa,) = tltlc.compile_text(f"signal a: bool  spec s = {spec}")
    with pytest.raises(ValueError, match="a test names atoms"):
        blocks.test_block("t", fspa, letters, expects)
