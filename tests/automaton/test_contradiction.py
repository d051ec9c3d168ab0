"""Which parts of an unsatisfiable spec contradict each other."""

from __future__ import annotations

from hypothesis import given
from hypothesis import strategies as st

from tests.fuzzing import times
from tests.logic.strategies import formulas
from tests.reference_formulas import read_formula
from tltlc.automaton.finite.build import build, spec_from_formula
from tltlc.automaton.finite.contradiction import contradiction
from tltlc.core.record import replace
from tltlc.logic.formula import Formula, and_
from tltlc.resolve.spec import Conjunct, Spec


def spec_of(parts: list[Formula], exclusive: tuple[tuple[str, ...], ...] = ()) -> Spec:
    spec = spec_from_formula(and_(*parts), exclusive=exclusive)
    return replace(spec, parts=tuple(Conjunct(part, spec.source, spec.name_span) for part in parts))


def is_unsatisfiable(parts: list[Formula]) -> bool:
    return build(spec_from_formula(and_(*parts))).states[0].verdict == "violated"


def contradicting_parts(*texts: str, exclusive: tuple[tuple[str, ...], ...] = ()) -> list[str]:
    spec = spec_of([read_formula(text) for text in texts], exclusive)
    return [str(part.formula) for part in contradiction(spec)]


def test_only_contradicting_parts_are_blamed() -> None:
    assert contradicting_parts("G a", "F b", "F !a", "G c") == ["G a", "F !a"]
    assert contradicting_parts("F b", "G F(a & X F b)") == ["G F(a & X F b)"]
    assert contradicting_parts("F(a & b)", "F a", exclusive=(("a", "b"),)) == ["F(a & b)"]


@given(st.lists(formulas(max_leaves=4), min_size=1, max_size=4))
@times(60)
def test_the_blamed_parts_are_a_minimal_unsatisfiable_set(parts: list[Formula]) -> None:
    if is_unsatisfiable(parts):
        core = [part.formula for part in contradiction(spec_of(parts))]
        assert is_unsatisfiable(core)
        for index in range(len(core)):
            rest = core[:index] + core[index + 1 :]
            assert not rest or not is_unsatisfiable(rest)
