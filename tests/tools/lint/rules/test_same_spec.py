"""TLT0426: specs that ask for the same."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

import tltlc
from tests.tools.lint.helpers import SIGNALS, codes
from tests.tools.lint.strategies import EXCLUSIVE, SMALL, World, specs
from tltlc.automaton.compare import are_equivalent
from tltlc.core.source import SourceFile
from tltlc.pipeline import CompileOptions
from tltlc.tools.lint.rules import same_spec
from tltlc.tools.lint.run import view_of


@pytest.mark.parametrize(
    ("one", "other", "is_found"),
    [
        ("F (a & X F b)", "a then b", True),
        ("F a", "F (a | a & b)", True),
        ("F a", "F b", False),
        ("G a", "!F !a", True),
        ("a U b", "b R a", False),
    ],
)
def test_specs_that_ask_for_the_same(one: str, other: str, is_found: bool) -> None:
    assert ("TLT0426" in codes(f"{SIGNALS}spec s = {one}\nspec t = {other}")) == is_found


@given(SMALL, SMALL)
def test_specs_are_the_same_where_their_automata_accept_the_same(one: str, other: str) -> None:
    written = tltlc.compile_text(f"{SIGNALS}spec s = {one}")[0]
    label = written.states[0].label.ascii
    # The label says the same in other words; the order of atoms is to make no difference.
    for again in (other, label, f"(c | !c) & (({label}) & (b | !b))"):
        ours, theirs = tltlc.compile_text(f"{SIGNALS}spec s = {one}\nspec t = {again}")
        is_settled = ours.states[0].verdict in ("satisfied", "violated")
        is_same = ours.judge == theirs.judge and are_equivalent(ours, theirs) and not is_settled
        assert ("TLT0426" in codes(f"{SIGNALS}spec s = {one}\nspec t = {again}")) == is_same


def test_a_third_spec_is_told_once() -> None:
    assert codes("signal a: bool spec s = F a spec t = F a spec u = F a").count("TLT0426") == 2


def test_one_of_them_may_name_more_exclusive_atoms_than_the_other() -> None:
    assert "TLT0426" in codes(f"{SIGNALS}exclusive a, c\nspec s = F b\nspec t = F (b | a & c)")


def test_of_specs_that_every_trace_satisfies_or_none_nothing_more_is_said() -> None:
    assert codes("signal a: bool spec s = F (a & !a) spec t = X (a & !a)") == ["TLT0410", "TLT0410"]
    assert codes("signal a: bool spec s = F (a | !a) spec t = a | !a") == ["TLT0411", "TLT0411"]


def test_other_limits_make_other_specs() -> None:
    text = "signal a: bool spec s { limit 9 steps reach a } spec t { limit 19 steps reach a }"
    assert codes(text) == []


@given(st.lists(specs("keep {}", "avoid {}", "reach {}", worlds=[EXCLUSIVE], most=1), min_size=2, max_size=2))
def test_the_same_traces_satisfy_both(drawn: list[tuple[World, str]]) -> None:
    (world, one), (_, other) = drawn
    text = one + other.removeprefix(world.before).replace("spec s", "spec t")
    view = view_of(SourceFile("example.tltl", text), CompileOptions())
    for _ in same_spec.check(view):
        first, second = (world.traces.satisfying(spec.spec.formula) for spec in view.specs)
        assert first == second
