"""Random formulas and traces for property tests."""

from __future__ import annotations

from collections.abc import Sequence

from hypothesis import strategies as st

from tltlc.logic import formula as f
from tltlc.logic.formula import FALSE, TRUE, Formula

_UNARY_TEMPORAL = (f.next_, f.weak_next, f.eventually, f.always)
_BINARY_TEMPORAL = (f.until, f.weak_until, f.release, f.strong_release)


def formulas(atoms: Sequence[str] = ("a", "b", "c"), max_leaves: int = 8) -> st.SearchStrategy[Formula]:
    """Formulas over the atoms and the constants, with every operator."""
    return st.recursive(_leaves(atoms), lambda inner: _propositional(inner) | _temporal(inner), max_leaves=max_leaves)


def state_formulas(atoms: Sequence[str] = ("a", "b", "c"), max_leaves: int = 8) -> st.SearchStrategy[Formula]:
    """Formulas without temporal operators."""
    return st.recursive(_leaves(atoms), _propositional, max_leaves=max_leaves)


def traces(
    atoms: Sequence[str] = ("a", "b", "c"), min_length: int = 1, max_length: int = 6
) -> st.SearchStrategy[tuple[frozenset[str], ...]]:
    """Finite traces; a sample is the set of the true atoms."""
    sample = st.frozensets(st.sampled_from(list(atoms)))
    return st.lists(sample, min_size=min_length, max_size=max_length).map(tuple)


def _leaves(atoms: Sequence[str]) -> st.SearchStrategy[Formula]:
    # Atoms are more likely than constants, which often make the formula around them trivial.
    names = [f.atom(name) for name in atoms]
    return st.sampled_from([*names * 4, TRUE, FALSE])


def _propositional(inner: st.SearchStrategy[Formula]) -> st.SearchStrategy[Formula]:
    operand_lists = st.lists(inner, min_size=2, max_size=3)
    return st.one_of(
        inner.map(f.not_),
        operand_lists.map(lambda operands: f.and_(*operands)),
        operand_lists.map(lambda operands: f.or_(*operands)),
        st.builds(f.implies, inner, inner),
        st.builds(f.iff, inner, inner),
    )


def _temporal(inner: st.SearchStrategy[Formula]) -> st.SearchStrategy[Formula]:
    unary = st.builds(lambda make, operand: make(operand), st.sampled_from(_UNARY_TEMPORAL), inner)
    binary = st.builds(lambda make, left, right: make(left, right), st.sampled_from(_BINARY_TEMPORAL), inner, inner)
    return unary | binary
