"""Merging the states of a component: a state is removed where another one can replace it."""

from __future__ import annotations

from typing import Any

import pytest

from tltlc.automaton.diagrams import Diagrams
from tltlc.automaton.infinite.pairs import RabinComponent
from tltlc.automaton.infinite.state_merging import shrink
from tltlc.automaton.work import Work

A, B, C = ("a",), ("b",), ("c",)


def component(letters: Diagrams[Any], *, pairs: int, marked: frozenset[Any]) -> RabinComponent:
    """Return a component: ``a`` goes to ``c`` on one letter, ``c`` to ``b``, ``b`` to ``a``; ``a`` also has a loop.

    The loop has the marks ``marked``.
    """
    taken = frozenset({(0, "inf")})
    loop = letters.node(0, letters.leaf((A, marked)), letters.leaf((C, taken)))
    steps = {A: loop, B: letters.leaf((A, taken)), C: letters.leaf((B, taken))}
    return RabinComponent(dict.fromkeys(steps, 7), steps, pairs)


@pytest.mark.parametrize("pairs", [1, 600])
def test_states_reached_only_through_a_removed_state_are_removed(pairs: int) -> None:
    letters: Diagrams[Any] = Diagrams(Work(10**6))
    small = shrink(letters, component(letters, pairs=pairs, marked=frozenset({(0, "inf")})), letters.work, 10**6)
    assert list(small.steps) == [A]


def test_loops_with_other_marks_stay() -> None:
    letters: Diagrams[Any] = Diagrams(Work(10**6))
    whole = component(letters, pairs=1, marked=frozenset())
    small = shrink(letters, whole, letters.work, 10**6)
    marks = {marks for step in small.steps.values() for _, marks in letters.values(step)}
    assert marks == {frozenset(), frozenset({(0, "inf")})}


@pytest.mark.parametrize("pair", [0, 599])
def test_marks_of_many_pairs_are_distinct(pair: int) -> None:
    letters: Diagrams[Any] = Diagrams(Work(10**6))
    accepted, rejected = frozenset({(pair, "inf")}), frozenset({(pair, "fin")})
    steps = {
        A: letters.leaf((B, accepted)),
        B: letters.node(0, letters.leaf((A, rejected)), letters.leaf((A, accepted))),
    }
    whole = RabinComponent({A: 7, B: 7}, steps, 600)
    assert set(shrink(letters, whole, letters.work, 10**6).steps) == {A, B}
