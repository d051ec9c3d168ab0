"""A better order of the atoms makes large diagrams small, and changes nothing else."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.automaton.test_composition import _isomorphic
from tests.fuzzing import times
from tests.logic.strategies import formulas
from tests.reference_formulas import read_formula
from tltlc.automaton.finite import build as build_module
from tltlc.automaton.finite.build import build, spec_from_formula
from tltlc.automaton.finite.order import better_order, reorder, restore_order
from tltlc.automaton.transitions import TransitionDiagrams
from tltlc.io.limits import WORK
from tltlc.logic.formula import Formula, and_, atom, eventually, iff, or_
from tltlc.resolve.spec import Spec

ATOMS = ("a", "b", "c", "d")


def pairs(count: int) -> Spec:
    """Return a spec with ``count`` pairs of atoms that must be equal; all first atoms precede all second ones."""
    first = [atom(f"a{number}") for number in range(count)]
    second = [atom(f"b{number}") for number in range(count)]
    equal = and_(*map(iff, first, second))
    return spec_from_formula(or_(eventually(and_(*first)), eventually(equal)))


def test_the_atoms_of_a_pair_become_neighbours() -> None:
    spec = pairs(9)
    order = better_order(spec.formula, [atom.name for atom in spec.atoms])
    assert order is not None
    assert [spec.atoms[index].name for index in order] == [
        f"{letter}{number}" for number in range(9) for letter in "ab"
    ]


@pytest.mark.parametrize("text", ["F a", "a <-> b", "F(a & b) & F(c & d)", "G(a -> F b) & G(c -> F d)", "true"])
def test_a_good_order_is_kept(text: str) -> None:
    formula = read_formula(text)
    assert better_order(formula, [*formula.atoms()]) is None


@given(formulas(atoms=ATOMS, max_leaves=8), st.permutations(range(4)), st.sampled_from([(), (ATOMS[:2],)]))
@times(40)
def test_any_order_of_atoms_gives_the_same_automaton(
    formula: Formula, order: list[int], groups: tuple[tuple[str, ...], ...]
) -> None:
    spec = spec_from_formula(or_(formula, and_(*map(atom, ATOMS))), exclusive=groups)
    order = [index for index in order if index < len(spec.atoms)]
    reordered_back, expected = restore_order(build(reorder(spec, order)), spec, order), build(spec)
    assert (reordered_back.atoms, reordered_back.exclusive) == (expected.atoms, expected.exclusive)
    assert _isomorphic(reordered_back, expected)


def test_pairs_compile_in_few_steps(monkeypatch: pytest.MonkeyPatch) -> None:
    """In the given order, twelve pairs take fourteen seconds; thirteen fail after 23 s and a gigabyte of memory."""
    diagrams: list[TransitionDiagrams] = []
    monkeypatch.setattr(
        build_module, "TransitionDiagrams", lambda: diagrams.append(TransitionDiagrams()) or diagrams[-1]
    )
    fspa = build(pairs(13))
    assert len(fspa.states) == 2
    assert [atom.name for atom in fspa.atoms] == [*(f"a{n}" for n in range(13)), *(f"b{n}" for n in range(13))]
    assert sum(len(diagram.variable) for diagram in diagrams) < 400_000


def test_a_spec_that_takes_few_steps_keeps_its_order(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(build_module, "restore_order", None)
    assert build(pairs(6))
    monkeypatch.setitem(WORK, "steps in the given order of atoms", 10)
    with pytest.raises(TypeError):
        build(pairs(6))


def test_a_spec_compiled_in_a_better_order_has_the_same_automaton(monkeypatch: pytest.MonkeyPatch) -> None:
    expected = build(pairs(6))
    monkeypatch.setitem(WORK, "steps in the given order of atoms", 10)
    assert _isomorphic(build(pairs(6)), expected)
