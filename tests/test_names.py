"""Names with arguments."""

from __future__ import annotations

import copy
import pickle

import pytest

from tltlc.core.names import ComparisonName, full_name, split_name, with_calls
from tltlc.logic.formula import and_, atom, not_
from tltlc.logic.text.phrases import phrase


@pytest.mark.parametrize(
    ("name", "base", "arguments"),
    [
        ("alive", "alive", ()),
        ("near(s1)", "near", ("s1",)),
        ("near(s1, close=3)", "near", ("s1", "close=3")),
        ("game.near(s1, close=(a + b)*2)", "game.near", ("s1", "close=(a + b)*2")),
        ("at(f(a, b), c)", "at", ("f(a, b)", "c")),
        ("distance(s1) > 3", "distance(s1) > 3", ()),
        ("near(s1) > far(s2)", "near(s1) > far(s2)", ()),
        ("near(a > 3)", "near", ("a > 3",)),
        ("(a + b)", "(a + b)", ()),
        ("near()", "near()", ()),
        ("near(a", "near(a", ()),
        ("", "", ()),
    ],
)
def test_a_name_is_split_into_its_base_and_arguments(name: str, base: str, arguments: tuple[str, ...]) -> None:
    assert split_name(name) == (base, arguments)
    assert full_name(base, arguments) == name


@pytest.mark.parametrize(
    ("name", "sides"),
    [
        ("distance(s1) > 3", ("distance(s1)", ">", "3")),
        ("a - b < c * 2", ("a - b", "<", "c * 2")),
        ("times(hp < 3) > 2", ("times(hp < 3)", ">", "2")),
    ],
)
def test_the_name_of_a_comparison_knows_its_sides(name: str, sides: tuple[str, str, str]) -> None:
    (base, _) = split_name(name)
    for comparison in (base, copy.deepcopy(base), pickle.loads(pickle.dumps(base))):
        assert isinstance(comparison, ComparisonName)
        assert (comparison.left, comparison.operator, comparison.right) == sides
        assert comparison == name


@pytest.mark.parametrize(
    ("name", "words"),
    [
        ("times(!a)", "times(not a)"),
        ("2 * times(!a) + abs(x - times(!a))", "2 * times(not a) + abs(x - times(not a))"),
        ("my.times(!a) + times(!b) + times(!a", "my.times(!a) + times(!b) + times(!a"),
        ("hp", "hp"),
    ],
)
def test_calls_in_a_name_get_other_texts(name: str, words: str) -> None:
    assert with_calls(name, {"times(!a)": "times(not a)"}.get) == words


@pytest.mark.parametrize("name", ["near(s1)", "a<b", "a > b > c", "> 3", "once (hp > 3)", "(p since (hp > 3))"])
def test_other_names_are_no_comparisons(name: str) -> None:
    assert not isinstance(split_name(name)[0], ComparisonName)


def test_an_atom_learns_that_it_is_a_comparison() -> None:
    plain = atom("mana > 1")
    assert atom(ComparisonName("mana", ">", "1")) is plain
    assert isinstance(plain.name, ComparisonName)


def test_a_pickled_formula_knows_its_comparisons() -> None:
    pickled = pickle.dumps(not_(atom(ComparisonName("ammo", ">", "1"))))
    plain = atom("ammo > 1")
    assert phrase(pickle.loads(pickled)) == "ammo <= 1"
    assert plain.name == "ammo > 1"


def test_a_comparison_may_stand_beside_an_atom_with_the_name_of_its_opposite() -> None:
    opposite = atom("heat <= 5")
    assert phrase(and_(not_(atom(ComparisonName("heat", ">", "5"))), not_(opposite))) == "heat <= 5 and not heat <= 5"
