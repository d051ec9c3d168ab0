"""A formula that blows up is an error that labels the part at fault, in bounded time."""

from __future__ import annotations

import sys
from collections.abc import Callable

import pytest

from tests.automaton.test_bounds import within
from tests.reference_formulas import read_formula
from tltlc.automaton.finite import blowup
from tltlc.automaton.finite.build import build, spec_from_formula
from tltlc.core.record import replace
from tltlc.core.source import Span
from tltlc.diagnostics.diagnostic import TltlError
from tltlc.io.limits import WORK
from tltlc.logic.formula import Formula, and_, atom, eventually, next_, until, weak_next
from tltlc.pipeline import compile_text
from tltlc.resolve.spec import Conjunct, Spec


def with_parts(*formulas: Formula) -> Spec:
    """Return a spec with one part for each formula; a part spans one character of the source."""
    spec = spec_from_formula(and_(*formulas))
    return replace(
        spec, parts=tuple(Conjunct(formula, spec.source, Span(i, i + 1)) for i, formula in enumerate(formulas))
    )


def error(spec: Spec, budget: int) -> TltlError:
    with pytest.raises(TltlError) as raised:
        build(spec, state_budget=budget)
    return raised.value


def test_the_budget_names_the_part_that_is_too_large() -> None:
    large = read_formula("G(a -> X X X X X X X X X X X X b)")
    diagnostic = error(with_parts(read_formula("F c"), large), 3_000).diagnostics[0]
    assert diagnostic.code == "TLT0501"
    assert [label.span for label in diagnostic.labels] == [Span(1, 2)]


def test_parts_that_are_large_only_together_are_named_together() -> None:
    diagnostic = error(with_parts(*(eventually(atom(f"a{i}")) for i in range(8))), 100).diagnostics[0]
    assert [label.message for label in diagnostic.labels] == ["2 states alone; the parts multiply"] * 3


def test_a_part_with_one_state_is_named_in_the_singular() -> None:
    diagnostic = error(with_parts(read_formula("true"), read_formula("F(a & X F b)")), 1).diagnostics[0]
    assert [label.message for label in diagnostic.labels] == [
        "3 states alone; the parts multiply",
        "1 state alone; the parts multiply",
    ]


def test_measuring_stops_at_the_first_part_that_is_too_large_alone(monkeypatch: pytest.MonkeyPatch) -> None:
    large = read_formula("G(a -> X X X X X X X X X X X X b)")
    measured = record_measured_parts(monkeypatch)
    raised = error(with_parts(read_formula("F c"), large, *(eventually(atom(f"a{i}")) for i in range(9))), 3_000)
    assert [label.span for label in raised.diagnostics[0].labels] == [Span(1, 2)]
    assert measured == [Span(0, 1), Span(1, 2)]


def test_only_some_of_very_many_parts_are_measured(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(WORK, "states of blamed parts", 7)
    measured = record_measured_parts(monkeypatch)
    diagnostic = error(with_parts(*(eventually(atom(f"a{i}")) for i in range(30))), 100).diagnostics[0]
    assert [label.message for label in diagnostic.labels] == ["2 states alone; the parts multiply"] * 3
    assert len(measured) == 4


def record_measured_parts(monkeypatch: pytest.MonkeyPatch) -> list[Span]:
    """Return a list that records each part whose own automaton is built, by its span."""
    measured: list[Span] = []
    size = blowup._size

    def counted(part: Conjunct, spec: Spec) -> blowup.ClauseSize | None:
        measured.append(part.span)
        return size(part, spec)

    monkeypatch.setattr(blowup, "_size", counted)
    return measured


def test_an_automaton_may_have_as_many_states_as_its_budget() -> None:
    spec = with_parts(*(eventually(atom(f"a{i}")) for i in range(5)))
    assert len(build(spec, state_budget=32).states) == 32
    error(spec, 31)


def test_a_spec_without_parts_is_named_itself() -> None:
    assert error(spec_from_formula(read_formula("F a & F b & F c")), 3).diagnostics[0].labels


@pytest.mark.parametrize("wrap", [next_, weak_next, eventually])
def test_deep_formulas_need_no_deep_stack(wrap: Callable[[Formula], Formula]) -> None:
    formula = atom("a")
    for _ in range(1_000):
        formula = wrap(formula)
    before = sys.getrecursionlimit()
    assert build(spec_from_formula(formula)).states
    assert sys.getrecursionlimit() == before


def test_deep_nesting_is_not_reported_as_a_lack_of_memory(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(blowup, "_RECURSION_ROOM", 1_000)
    diagnostic = error(with_parts(read_formula("F c"), within(2_000)), 50_000).diagnostics[0]
    assert (diagnostic.code, diagnostic.title) == (
        "TLT0501",
        "the automaton of `spec` needs formulas that nest too deeply",
    )
    assert [label.span for label in diagnostic.labels] == [Span(1, 2)]


def test_a_long_chain_of_untils_takes_a_state_for_each_atom() -> None:
    names = [atom(f"a{i}") for i in range(40)]
    formula = names[-1]
    for name in reversed(names[:-1]):
        formula = until(name, formula)
    assert len(build(spec_from_formula(formula)).states) == 41


def test_a_goal_that_must_last_gets_a_time_that_needs_few_states() -> None:
    head = "clock 10 Hz signal a: bool signal b: bool spec s { keep a implies "
    with pytest.raises(TltlError) as raised:
        compile_text(f"{head}eventually within 60 s always for 3 s b }}")
    written = "eventually within 63 s time_holding(b) >= 3 s"
    assert f"write `{written.replace('(b)', '(q)')}` for " in (raised.value.diagnostics[0].help or "")
    (fspa,) = compile_text(f"{head}{written} }}")
    assert len(fspa.states) < 5
