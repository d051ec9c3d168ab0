"""Equal formulas are one object, keep the order of their operands, and can be walked at any depth."""

from __future__ import annotations

import copy
import pickle

from hypothesis import given

from tests.logic.strategies import formulas
from tltlc.logic import formula as f
from tltlc.logic.formula import FALSE, TRUE, Formula

A, B, C = f.atom("a"), f.atom("b"), f.atom("c")


def test_equal_formulas_are_one_object() -> None:
    assert f.and_(A, f.next_(B)) is f.and_(f.atom("a"), f.next_(f.atom("b")))
    assert f.and_(A, B) is not f.and_(B, A)


@given(formulas())
def test_a_formula_survives_pickling_and_copying(formula: Formula) -> None:
    assert pickle.loads(pickle.dumps(formula)) is formula
    assert copy.deepcopy(formula) is formula


def test_conjunctions_flatten_and_keep_their_order() -> None:
    assert f.and_(f.and_(C, A), B).args == (C, A, B)
    assert f.or_(A, f.and_(B, C)).args == (A, f.and_(B, C))
    assert f.and_() is TRUE
    assert f.or_() is FALSE
    assert f.and_(A) is A


def test_nested_then_is_one_sequence() -> None:
    assert str(f.then(A, f.then(B, C))) == "F(a & X F(b & X F c))"


def test_atoms_follow_the_order_of_the_formula() -> None:
    assert f.until(f.or_(C, A), f.and_(A, B)).atoms() == ("c", "a", "b")


@given(formulas())
def test_bottom_up_gives_each_subformula_once_and_after_its_operands(formula: Formula) -> None:
    nodes = list(formula.bottom_up())
    assert set(nodes) == set(formula.walk())
    assert len(nodes) == len(set(nodes))
    assert nodes[-1] is formula
    place = {node: index for index, node in enumerate(nodes)}
    assert all(place[argument] < place[node] for node in nodes for argument in node.args)


@given(formulas())
def test_rebuilding_from_the_same_operands_changes_nothing(formula: Formula) -> None:
    assert f.rebuild(formula, formula.args) is formula


def test_a_walk_goes_from_left_to_right_even_with_shared_parts() -> None:
    a, b = f.atom("a"), f.atom("b")
    assert f.and_(f.or_(b, a), a, b).atoms() == ("b", "a")
    assert f.and_(f.eventually(f.and_(a, b)), b, a).atoms() == ("a", "b")
