"""Several runs that count down together are folded in parallel: folded states agree, and no edge is lost."""

from __future__ import annotations

import pytest
from hypothesis import find, given
from hypothesis import strategies as st

from tests.backends.strategies import automata, hostile_automata, infinite_automata
from tests.backends.test_folding import automaton, chains, counting, endless
from tests.fixtures import cover_and_hide
from tests.fuzzing import times
from tltlc.automaton.fspa import Edge, Fspa, Guard
from tltlc.backends.drawing.counting_states import fold_parallel_runs
from tltlc.backends.drawing.folding import LEAST_FOLDED, fold_runs, whole_drawing
from tltlc.backends.drawing.picture_content import folded_drawing, notes
from tltlc.core.record import replace
from tltlc.logic.formula import atom

IN_STEP = (
    "F[0,{n}] a & F[0,{m}] b",
    "G !c & F[0,{n}] a & F[0,{m}] b",
    "G[0,{n}] a | F[0,{m}] b",
    "F[0,{n}] a & G[0,{m}] b & F[0,{n}] c",
    "F(c & F[0,{n}] a & F[0,{m}] b)",
)


def in_step() -> st.SearchStrategy[Fspa]:
    """Automata of formulas with several bounds, mostly of equal length."""
    bounds = st.integers(3, 9).flatmap(lambda n: st.tuples(st.just(n), st.sampled_from([n, n, n + 2])))
    return st.builds(
        lambda text, bounds: automaton(text.format(n=bounds[0], m=bounds[1])), st.sampled_from(IN_STEP), bounds
    )


GUARDS = [Guard(atom(name), (((index, True),),)) for index, name in enumerate("pqrs")]


@st.composite
def parallel_runs(draw: st.DrawFn) -> Fspa:
    """Three parallel runs, whose edges lead to the same run or to another one, with a few irregularities."""
    last = draw(st.integers(4, 9))
    ways = st.permutations(range(3)).flatmap(lambda way: st.integers(1, 3).map(lambda length: way[:length]))
    ahead = {0: [0, 1, 2], 1: draw(ways), 2: draw(ways)}
    edges = {(0, 1 + way): GUARDS[way] for way in ahead[0]}
    for place in range(last):
        for slot, way in ahead.items():
            for guard, target in zip(GUARDS, way, strict=False):
                edges[1 + 3 * place + slot, 1 + 3 * (place + 1) + target] = guard
    size = 1 + 3 * (last + 1)
    states = [replace(cover_and_hide().states[0], id=index) for index in range(size)]
    for _ in range(draw(st.integers(0, 2))):
        here, there = draw(st.integers(0, size - 1)), draw(st.integers(0, size - 1))
        edges.setdefault((here, there), draw(st.sampled_from(GUARDS)))
    if draw(st.booleans()):
        here = draw(st.integers(0, size - 1))
        states[here] = replace(states[here], accepting=True)
    rows = tuple(Edge(source, target, guard) for (source, target), guard in sorted(edges.items(), key=lambda e: e[0]))
    return replace(cover_and_hide(), states=tuple(states), edges=rows)


ANY = (
    in_step()
    | parallel_runs()
    | counting()
    | endless()
    | chains()
    | automata()
    | infinite_automata()
    | hostile_automata()
)


@times(40)
@given(ANY)
def test_every_edge_is_drawn_or_lies_along_a_run(fspa: Fspa) -> None:
    drawing = fold_parallel_runs(fspa)
    full = whole_drawing(fspa)
    first = {state.id: run for run, states in drawing.folded.items() for state in states}
    drawn = [state.id for state in drawing.states]
    assert sorted([*(set(drawn) - set(drawing.folded)), *first]) == list(range(len(full.states)))
    assert 0 not in first
    assert all(len(run) >= LEAST_FOLDED and run[0].id == state for state, run in drawing.folded.items())
    targets: dict[object, set[int]] = {}
    for edge in drawing.edges:
        assert {edge.source, edge.target} <= set(drawn)
        targets.setdefault((edge.source, edge.label), set()).add(edge.target)
    for edge in full.edges:
        source, target = first.get(edge.source, edge.source), first.get(edge.target, edge.target)
        for end in targets[source, edge.label]:
            if end == target:
                break
            if source == target:  # an edge along a run, drawn as an edge to the end of the run
                assert end not in drawing.folded
                break
            # An edge from the last inner counting state to the one after it.
            if end in drawing.folded and edge.target in {
                way.target for way in full.edges if way.source == drawing.folded[end][-1].id
            }:
                break
        else:
            raise AssertionError(edge)


@times(40)
@given(ANY)
def test_folded_states_agree(fspa: Fspa) -> None:
    drawing = fold_parallel_runs(fspa)
    full = whole_drawing(fspa)
    inner = {state.id for run in drawing.folded.values() for state in run}
    labels: dict[int, set[object]] = {state.id: set() for state in full.states}
    for edge in full.edges:
        labels[edge.source].add(edge.label)
        assert edge.target not in inner or edge.target in drawing.folded or edge.source in inner
    for run in drawing.folded.values():
        assert len({(state.verdict, state.accepting, frozenset(labels[state.id])) for state in run}) == 1


def test_some_random_parallel_runs_are_folded() -> None:
    assert fold_parallel_runs(find(parallel_runs(), lambda fspa: len(fold_parallel_runs(fspa).folded) == 3))


@pytest.mark.slow
@times(40)
@given(counting() | in_step())
def test_folding_parallel_runs_draws_no_more_states_than_folding_runs(fspa: Fspa) -> None:
    assert len(fold_parallel_runs(fspa).states) <= len(fold_runs(fspa).states)


@times(40)
@given(ANY)
def test_pictures_use_the_drawing_with_fewer_states_and_count_the_folded_ones(fspa: Fspa) -> None:
    drawing = folded_drawing(fspa)
    drawings = [fold_runs(fspa), fold_parallel_runs(fspa)]
    assert drawing in drawings
    assert len(drawing.states) == min(len(candidate.states) for candidate in drawings)
    hidden = len(fspa.states) - len(drawing.states)
    dashed_notes = [note for note in notes(fspa, drawing) if note.startswith("Dashed")]
    inside = hidden + len(drawing.folded)
    assert dashed_notes == ([f"Dashed: {inside} of the {len(fspa.states)} states, folded."] if hidden else [])


@pytest.mark.parametrize(
    ("formula", "inner", "states"),
    [
        ("F[0,40] a", [39], 5),
        ("F a & F b & F c", [], 8),
        ("F[0,100] a & F[0,100] b", [98, 98, 98], 12),
        ("F[0,40] a & F[0,40] b & F[0,40] c", [38] * 7, 24),
        ("G(a -> F[0,9] b) & G(b -> F[0,9] c)", [], 56),
    ],
)
def test_known_automata_have_these_folded_states(formula: str, inner: list[int], states: int) -> None:
    drawing = fold_parallel_runs(automaton(formula))
    assert [len(run) for run in drawing.folded.values()] == inner
    assert len(drawing.states) == states


@pytest.mark.parametrize("formula", ["F[0,40] a", "G[0,12] a", "G(a -> G[0,10] b)", "F a & F b"])
def test_a_single_run_is_folded_as_without_parallel_runs(formula: str) -> None:
    assert fold_parallel_runs(automaton(formula)) == fold_runs(automaton(formula))
