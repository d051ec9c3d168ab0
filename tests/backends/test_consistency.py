from __future__ import annotations

import itertools
import tracemalloc
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.backends.strategies import automata, infinite_automata
from tests.calls import calls
from tests.fixtures import cover_and_hide
from tests.fuzzing import times
from tltlc import compile_text
from tltlc.artefact import consistency, guards
from tltlc.artefact.consistency import problems
from tltlc.automaton.fspa import Edge, Fspa, Guard, Pair, State
from tltlc.core.record import replace
from tltlc.expression.tree import ParamValue, SignalValue
from tltlc.logic.formula import TRUE, atom, not_

SAFE = Guard(atom("alive"), (((3, True),),))


def messages(fspa: Fspa) -> list[str]:
    return [problem.message for problem in problems(fspa)]


def changed(table: str, index: int, **values: Any) -> Fspa:
    """Return the Cover and Hide automaton with other values in one row of one of its tables."""
    fspa = cover_and_hide()
    rows = list(getattr(fspa, table))
    rows[index] = replace(rows[index], **values)
    return replace(fspa, **{table: tuple(rows)})  # type: ignore[arg-type]


@times(40)
@given(automata() | infinite_automata())
def test_compiled_automata_are_consistent(fspa: Fspa) -> None:
    assert messages(fspa) == []


@pytest.mark.parametrize(
    ("fspa", "expected"),
    [
        (changed("signals", 1, base="health", arguments=()), "two signals are named `health`"),
        (changed("atoms", 1, base="alive", arguments=()), "two atoms are named `alive`"),
        (changed("atoms", 3, expression=SignalValue("mana")), "there is no signal `mana`"),
        (changed("atoms", 3, expression=ParamValue("mana")), "there is no param `mana`"),
        (changed("signals", 3, low=2.0), "the range of `health` is empty"),
        (changed("params", 0, value=1.0), "the value of `level_size` lies outside its range"),
        (changed("states", 1, id=0), "state 1 has the id 0"),
        (replace(cover_and_hide(), exclusive=((0, 4),)), "there are only 4 atoms"),
        (replace(cover_and_hide(), atoms=cover_and_hide().atoms[:1], exclusive=((1,),)), "there is only 1 atom"),
        (changed("edges", 3, target=9), "there is no state 9"),
        (changed("edges", 0, source=9), "there is no state 9"),
        (changed("edges", 1, target=0), "two edges lead from state 0 to state 0"),
        (changed("edges", 0, target=4), "the edges are not sorted by source and target"),
        (changed("edges", 2, guard=Guard(atom("x"), (((7, True),),))), "there are only 4 atoms"),
        (changed("states", 1, distance=1), "the distance of state 1 is 2, not 1"),
        (changed("states", 2, distance=7), "the distance of state 2 is null, not 7"),
        (changed("states", 4, verdict="satisfied"), "the verdict of state 4 is `holding`, not `satisfied`"),
        (replace(cover_and_hide(), spec_size=4), "spec_size is 3, not 4"),
        (
            changed("edges", 11, guard=Guard(TRUE, ((),))),
            "the guards from state 4 to states 2 and 4 can be true at once",
        ),
        (changed("edges", 6, guard=SAFE), "state 2 has no edge for some samples"),
        (changed("edges", 11, guard=Guard(atom("x"), (((3, True), (3, False)),))), "an implicant names an atom twice"),
        (
            changed("edges", 11, guard=Guard(atom("x"), (((0, True), (1, True)),))),
            "an implicant requires two exclusive atoms at once",
        ),
        (
            changed("edges", 11, guard=Guard(atom("alive"), (((3, True),), ((0, True), (3, True))))),
            "an implicant is contained in another",
        ),
        (
            changed("edges", 0, guard=Guard(atom("x"), (((0, False), (3, True)),))),
            "an implicant is missing, so that the guard's robustness would be wrong",
        ),
    ],
)
def test_an_inconsistency_is_reported(fspa: Fspa, expected: str) -> None:
    assert expected in messages(fspa)


def again_and_again(**values: Any) -> Fspa:
    """Return the automaton of ``F a & G F b`` over infinite traces, with other values.

    It has an initial state, and a goal with two loops.
    """
    (fspa,) = compile_text("signal a: bool signal b: bool spec s { semantics infinite reach a require G F b }")
    return replace(fspa, **values)


def test_the_automaton_of_the_next_tests_is_consistent() -> None:
    fspa = again_and_again()
    assert messages(fspa) == []
    assert [(state.accepting, state.verdict, state.distance) for state in fspa.states] == [
        (False, "pending", 1),
        (True, "holding", 0),
    ]
    assert [(edge.source, edge.target) for edge in fspa.edges] == [(0, 0), (0, 1), (1, 1), (1, 1)]
    assert fspa.acceptance == (Pair((), (3,)),)


def with_state(index: int, **values: Any) -> Fspa:
    states = list(again_and_again().states)
    states[index] = replace(states[index], **values)
    return again_and_again(states=tuple(states))


@pytest.mark.parametrize(
    ("fspa", "expected"),
    [
        (again_and_again(acceptance=(Pair((), (4,)),)), ["there are only 4 edges"]),
        (again_and_again(acceptance=(Pair((9,), (3,)),)), ["there are only 4 edges"]),
        (
            again_and_again(acceptance=()),
            ["two edges that are in the same `fin` and `inf` sets lead from state 1 to state 1"],
        ),
        (
            again_and_again(acceptance=(Pair((), (2, 3)),)),
            ["two edges that are in the same `fin` and `inf` sets lead from state 1 to state 1"],
        ),
        (
            again_and_again(acceptance=(Pair((3,), (3,)),)),
            [
                "the distance of state 0 is null, not 1",
                "the verdict of state 0 is `violated`, not `pending`",
                "state 1 is not on an accepted cycle, but is accepting",
                "the distance of state 1 is null, not 0",
                "the verdict of state 1 is `violated`, not `holding`",
                "spec_size is 0, not 1",
            ],
        ),
        (
            again_and_again(acceptance=(Pair((), (0, 3)),)),
            [
                "state 0 is on an accepted cycle, but is not accepting",
                "the distance of state 0 is 0, not 1",
                "the verdict of state 0 is `holding`, not `pending`",
                "spec_size is 0, not 1",
            ],
        ),
        (
            again_and_again(acceptance=(Pair((), (3,)), Pair((), (2,)))),
            ["the verdict of state 1 is `satisfied`, not `holding`"],
        ),
        (with_state(0, distance=2), ["the distance of state 0 is 1, not 2"]),
        (with_state(1, verdict="satisfied"), ["the verdict of state 1 is `holding`, not `satisfied`"]),
        (with_state(1, accepting=False), ["state 1 is on an accepted cycle, but is not accepting"]),
    ],
)
def test_an_inconsistency_with_accepted_cycles_is_reported(fspa: Fspa, expected: list[str]) -> None:
    assert messages(fspa) == expected


def test_cycles_are_followed_only_up_to_the_work_limit(monkeypatch: pytest.MonkeyPatch) -> None:
    broken = with_state(1, verdict="satisfied")
    monkeypatch.setattr(consistency, "CYCLES_WORK", 3)
    assert messages(broken) == []


def test_a_state_without_an_edge_from_an_earlier_state_is_reported() -> None:
    fspa = cover_and_hide()
    edges = tuple(edge for edge in fspa.edges if (edge.source, edge.target) != (1, 3))
    assert messages(replace(fspa, edges=edges)) == ["state 3 cannot be reached from a state before it"]


def test_a_numbering_that_is_not_breadth_first_is_reported() -> None:
    fspa = cover_and_hide()
    # Breadth-first search reaches state 3 from state 1, and the trap, state 2, only from state 3.
    edges = tuple(edge for edge in fspa.edges if (edge.source, edge.target) not in {(0, 2), (1, 2)})
    swapped = sorted(
        (Edge({2: 3, 3: 2}.get(e.source, e.source), {2: 3, 3: 2}.get(e.target, e.target), e.guard) for e in fspa.edges),
        key=lambda edge: (edge.source, edge.target),
    )
    assert "the states are not numbered breadth-first" in messages(replace(fspa, edges=tuple(swapped)))
    assert messages(replace(fspa, edges=edges)) == ["state 2 cannot be reached from a state before it"]


def test_large_automata_are_checked_only_up_to_the_work_limit(monkeypatch: pytest.MonkeyPatch) -> None:
    broken = changed("edges", 6, guard=SAFE)
    assert messages(broken)
    monkeypatch.setattr(guards, "WORK_LIMIT", 10)
    assert messages(broken) == []


cubes = st.dictionaries(st.integers(0, 3), st.booleans(), max_size=4).map(lambda cube: tuple(sorted(cube.items())))


def holds(primes: tuple[tuple[tuple[int, bool], ...], ...], sample: tuple[bool, ...]) -> bool:
    return any(all(sample[atom] is polarity for atom, polarity in prime) for prime in primes)


def all_primes(guard: set[tuple[bool, ...]]) -> set[tuple[tuple[int, bool], ...]]:
    """Return the prime implicants by definition: implicants from which no literal can be dropped."""
    inside = set()
    for choice in itertools.product((None, False, True), repeat=4):
        product = tuple((atom, polarity) for atom, polarity in enumerate(choice) if polarity is not None)
        samples = [s for s in itertools.product((False, True), repeat=4) if holds((product,), s)]
        if guard.issuperset(samples):
            inside.add(product)
    return {p for p in inside if not any(q != p and set(q) < set(p) for q in inside)}


@times(50)
@given(st.lists(cubes, min_size=1, max_size=4, unique=True), st.booleans())
def test_exactly_the_complete_sets_of_primes_pass(terms: list[tuple[tuple[int, bool], ...]], complete: bool) -> None:
    samples = set(itertools.product((False, True), repeat=4))
    guard = {sample for sample in samples if holds(tuple(terms), sample)}
    primes = tuple(sorted(all_primes(guard))) if complete else tuple(terms)
    rest = tuple(sorted(all_primes(samples - guard)))
    fspa = cover_and_hide()
    states = tuple(replace(fspa.states[2], id=index) for index in range(2))
    edges = [Edge(0, 0, Guard(atom("g"), primes)), Edge(1, 1, Guard(TRUE, ((),)))]
    if rest:
        edges.insert(1, Edge(0, 1, Guard(not_(atom("g")), rest)))
    else:
        states, edges = states[:1], edges[:1]
    fspa = replace(fspa, exclusive=(), states=states, edges=tuple(edges), spec_size=0)
    assert (messages(fspa) == []) == (set(primes) == all_primes(guard))


@times(40)
@given(automata(), st.data())
def test_a_guard_that_covers_too_little_or_too_much_is_reported(fspa: Fspa, data: st.DataObject) -> None:
    index = data.draw(st.integers(0, len(fspa.edges) - 1))
    edge = fspa.edges[index]
    names = len(fspa.atoms)
    other = Guard(
        atom("?"),
        data.draw(
            st.lists(
                st.dictionaries(st.integers(0, names - 1), st.booleans(), max_size=2).map(
                    lambda c: tuple(sorted(c.items()))
                ),
                min_size=1,
                max_size=2,
                unique=True,
            ).map(tuple)
        )
        if names
        else ((),),
    )
    edges = (*fspa.edges[:index], replace(edge, guard=other), *fspa.edges[index + 1 :])
    damaged = replace(fspa, edges=edges)
    letters = [
        letter
        for letter in itertools.product((False, True), repeat=names)
        if all(sum(letter[atom] for atom in group) <= 1 for group in fspa.exclusive)
    ]
    partitioned = all(
        sum(holds(e.guard.primes, letter) for e in damaged.edges_from(state.id)) == 1
        for state in fspa.states
        for letter in letters
    )
    if not partitioned:
        assert messages(damaged)
    if set(other.primes) == set(edge.guard.primes):
        assert not messages(damaged)


def test_a_large_group_of_exclusive_atoms_takes_little_memory() -> None:
    count = 3_000
    fspa = cover_and_hide()
    extra_atoms = tuple(replace(fspa.atoms[0], base=f"a{number}", arguments=()) for number in range(count))
    fspa = replace(
        fspa, atoms=(*fspa.atoms, *extra_atoms), exclusive=(tuple(range(len(fspa.atoms), len(fspa.atoms) + count)),)
    )
    tracemalloc.start()
    try:
        assert not list(guards.guard_problems(fspa))
        peak = tracemalloc.get_traced_memory()[1]
    finally:
        tracemalloc.stop()
    assert peak < 10_000_000


def test_work_on_guards_beside_many_exclusive_atoms_is_limited() -> None:
    fspa = cover_and_hide()
    extra_atoms = tuple(replace(fspa.atoms[0], base=f"a{number}", arguments=()) for number in range(200))
    group = tuple(range(len(fspa.atoms), len(fspa.atoms) + 200))
    states = tuple(State(number, fspa.states[0].label, False, "pending", None) for number in range(2_000))
    edges = tuple(Edge(number, number, Guard(atom("alive"), (((3, True),),))) for number in range(2_000))
    fspa = replace(fspa, atoms=(*fspa.atoms, *extra_atoms), exclusive=(group,), states=states, edges=edges)
    assert calls(lambda: list(guards.guard_problems(fspa))) < 10 * guards.WORK_LIMIT
