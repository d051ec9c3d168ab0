"""TLT0426: specs that are equivalent."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

import tltlc
from tests.fuzzing import times
from tests.tools.lint.helpers import SIGNALS, codes
from tests.tools.lint.strategies import EXCLUSIVE, SMALL, World, specs
from tltlc.automaton.compare import are_equivalent
from tltlc.core.source import SourceFile
from tltlc.pipeline import CompileOptions
from tltlc.tools.lint.rules import same_spec
from tltlc.tools.lint.run import view_of


@pytest.mark.parametrize(
    ("one", "other", "is_reported"),
    [
        ("F (a & X F b)", "a then b", True),
        ("F a", "F (a | a & b)", True),
        ("F a", "F b", False),
        ("G a", "!F !a", True),
        ("a U b", "b R a", False),
    ],
)
def test_equivalent_specs_are_reported(one: str, other: str, is_reported: bool) -> None:
    assert ("TLT0426" in codes(f"{SIGNALS}spec s = {one}\nspec t = {other}")) == is_reported


@times(40)
@given(SMALL, SMALL)
def test_specs_are_reported_if_and_only_if_their_automata_are_equivalent(one: str, other: str) -> None:
    original = tltlc.compile_text(f"{SIGNALS}spec s = {one}")[0]
    label = str(original.states[0].label)
    # The label is an equivalent formula, written differently. The order of the atoms must make no difference.
    for again in (other, label, f"(c | !c) & (({label}) & (b | !b))"):
        first, second = tltlc.compile_text(f"{SIGNALS}spec s = {one}\nspec t = {again}")
        is_settled = first.states[0].verdict in ("satisfied", "violated")
        is_same = first.judge == second.judge and are_equivalent(first, second) and not is_settled
        assert ("TLT0426" in codes(f"{SIGNALS}spec s = {one}\nspec t = {again}")) == is_same


def test_a_third_equivalent_spec_is_reported_once() -> None:
    assert codes("signal a: bool spec s = F a spec t = F a spec u = F a").count("TLT0426") == 2


def test_equivalent_specs_may_differ_in_exclusive_atoms() -> None:
    assert "TLT0426" in codes(f"{SIGNALS}exclusive a, c\nspec s = F b\nspec t = F (b | a & c)")


def test_trivial_specs_are_not_reported_as_equivalent() -> None:
    assert codes("signal a: bool spec s = F (a & !a) spec t = X (a & !a)") == ["TLT0410", "TLT0410"]
    assert codes("signal a: bool spec s = F (a | !a) spec t = a | !a") == ["TLT0411", "TLT0411"]


def test_specs_with_different_limits_differ() -> None:
    text = "signal a: bool spec s { limit 9 steps reach a } spec t { limit 19 steps reach a }"
    assert codes(text) == []


@times(40)
@given(st.lists(specs("keep {}", "avoid {}", "reach {}", worlds=[EXCLUSIVE], most=1), min_size=2, max_size=2))
def test_the_same_traces_satisfy_reported_specs(drawn: list[tuple[World, str]]) -> None:
    (world, one), (_, other) = drawn
    text = one + other.removeprefix(world.before).replace("spec s", "spec t")
    view = view_of(SourceFile("example.tltl", text), CompileOptions())
    for _ in same_spec.check(view):
        first, second = (world.traces.satisfying(spec.spec.formula) for spec in view.specs)
        assert first == second
