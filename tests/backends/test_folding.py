from __future__ import annotations

import re
from itertools import pairwise

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.backends.strategies import automata, hostile_automata, infinite_automata
from tests.fixtures import cover_and_hide
from tests.fuzzing import times
from tests.unfolded import unfolded
from tltlc import compile_text
from tltlc.automaton.fspa import NOTATIONS, Edge, Fspa, Guard, Notation, Text
from tltlc.automaton.text import label_range_text, label_text
from tltlc.backends import Options
from tltlc.backends.dot import graph
from tltlc.backends.drawing.folding import LEAST_FOLDED, Drawing, EdgeLabel, distance_range, fold_runs, whole_drawing
from tltlc.core.record import replace
from tltlc.logic.formula import atom


def automaton(formula: str) -> Fspa:
    with unfolded():
        (fspa,) = compile_text(f"clock 1 Hz signal a: bool signal b: bool signal c: bool spec s = {formula}")
    return fspa


COUNTING = (
    "F[0,{n}] a",
    "G[0,{n}] a",
    "F[{n},30] a & G b",
    "G(a -> G[0,{n}] b)",
    "G(a -> F[0,{n}] (b | c))",
    "F G[0,{n}] a",
    "F[0,{n}] a | F[0,3] b",
    "F[0,{n}] a & F[2,6] b",
    "F(a & F[0,{n}] b)",
    "F a & G[0,{n}] (b -> c)",
)


def counting() -> st.SearchStrategy[Fspa]:
    """Automata of formulas with bounds, over finite traces."""
    return st.builds(lambda text, n: automaton(text.format(n=n)), st.sampled_from(COUNTING), st.integers(1, 12))


def endless() -> st.SearchStrategy[Fspa]:
    """Automata of the same formulas over infinite traces."""

    def compiled(text: str, n: int) -> Fspa:
        signals = "clock 1 Hz signal a: bool signal b: bool signal c: bool"
        (fspa,) = compile_text(f"{signals} spec s {{ semantics infinite require {text.format(n=n)} }}")
        return fspa

    return st.builds(compiled, st.sampled_from(COUNTING), st.integers(1, 12))


@st.composite
def chains(draw: st.DrawFn) -> Fspa:
    """States in a row, with few guards and targets, so that runs begin, end and have entrances anywhere."""
    size = draw(st.integers(2, 14))
    states = tuple(
        replace(cover_and_hide().states[draw(st.sampled_from([0, 0, 0, 0, 4]))], id=index) for index in range(size)
    )
    guards = st.sampled_from([Guard(atom("p"), (((0, True),),)), *3 * [Guard(atom("q"), (((1, True),),))]])
    aside = st.sampled_from([0, 0, 0, 0, size - 1, size // 2])
    edges = {}
    for index in range(size):
        edges[index, (index + 1) % size] = draw(guards)
        edges.setdefault((index, draw(aside)), Guard(atom("r"), (((2, True),),)))
    rows = tuple(Edge(source, target, guard) for (source, target), guard in sorted(edges.items(), key=lambda e: e[0]))
    return replace(cover_and_hide(), states=states, edges=rows)


def edges_of(drawing: Drawing, state: int) -> set[tuple[EdgeLabel, int]]:
    return {(edge.label, edge.target) for edge in drawing.edges if edge.source == state}


def check(fspa: Fspa) -> Drawing:
    """Assert by definition what folding promises, and return the drawing."""
    drawing = fold_runs(fspa)
    full = whole_drawing(fspa)
    inner = [state.id for run in drawing.folded.values() for state in run]
    drawn = [state.id for state in drawing.states]
    assert sorted([*(state for state in drawn if state not in drawing.folded), *inner]) == list(range(len(full.states)))
    assert 0 not in inner
    unfolded_edges = [edge for edge in full.edges if edge.source not in inner]
    for first, run in drawing.folded.items():
        assert len(run) >= LEAST_FOLDED
        assert run[0].id == first
        check_run(full, drawing, [state.id for state in run])
    remaining_edges = [edge for edge in drawing.edges if edge.source not in inner]
    assert remaining_edges == unfolded_edges, "all others are drawn as they are"
    assert {edge.source for edge in drawing.edges} | {edge.target for edge in drawing.edges} <= set(drawn)
    return drawing


def check_run(full: Drawing, drawing: Drawing, run: list[int]) -> None:
    """Assert that the run is entered only at its start, and that its states differ only in their next state."""
    entering = {state: [edge for edge in full.edges if edge.target == state] for state in run}
    assert all(len(edges) == 1 for edges in entering.values())
    path = [entering[run[0]][0].source, *run]
    (label,) = {entering[state][0].label for state in run}
    assert [entering[state][0].source for state in run] == path[:-1]
    (last,) = (target for other, target in edges_of(full, run[-1]) - common(full, run) if other == label)
    path.append(last)
    assert len({(full.states[state].verdict, full.states[state].accepting) for state in path}) == 1
    (beyond,) = {target for other, target in edges_of(full, last) - common(full, run) if other == label}
    assert beyond != last
    for state, following in zip(path, [*path[1:], beyond], strict=True):
        assert edges_of(full, state) == common(full, run) | {(label, following)}
    other_edges = {(edge.label, edge.target) for edge in drawing.edges if edge.source == run[0]}
    assert other_edges == common(full, run) | {(label, last)}


def common(full: Drawing, run: list[int]) -> set[tuple[EdgeLabel, int]]:
    return set.intersection(*(edges_of(full, state) for state in run))


@times(25)
@given(counting() | endless() | automata() | infinite_automata())
def test_only_runs_are_folded(fspa: Fspa) -> None:
    for run in check(fspa).folded.values():
        distances = [state.distance for state in run]
        steps = {None if a is None or b is None else a - b for a, b in pairwise(distances)}
        assert steps == {None} or steps <= {0, 1}


@times(80)
@given(chains() | hostile_automata())
def test_any_artefact_is_folded_by_the_same_rule(fspa: Fspa) -> None:
    check(fspa)


@times(60)
@given(chains() | counting())
def test_every_run_is_folded(fspa: Fspa) -> None:
    """Every path of five states that can be folded is folded."""
    inner = {state.id for run in fold_runs(fspa).folded.values() for state in run}
    full = whole_drawing(fspa)
    for edge in full.edges:
        path = [edge.source]
        shared = edges_of(full, edge.source) - {(edge.label, edge.target)}
        while len(path) < LEAST_FOLDED + 2 and continues(full, path, edge.label, shared):
            path += [target for label, target in edges_of(full, path[-1]) - shared if label == edge.label]
        if len(path) == LEAST_FOLDED + 2 and continues(full, path, edge.label, shared):
            assert inner.issuperset(path[1:-1])


def continues(full: Drawing, path: list[int], label: EdgeLabel, shared: set[tuple[EdgeLabel, int]]) -> bool:
    """Whether the last state of a path agrees with the others, so that the path may go on through it."""
    next_edges = [way for way in edges_of(full, path[-1]) - shared if way[0] == label]
    first, last = full.states[path[0]], full.states[path[-1]]
    entered = all(
        state and [edge.source for edge in full.edges if edge.target == state] == [before]
        for before, state in pairwise(path[:-1])
    )
    return (
        len(next_edges) == 1
        and edges_of(full, path[-1]) == shared | set(next_edges)
        and (first.verdict, first.accepting) == (last.verdict, last.accepting)
        and entered
        and next_edges[0][1] not in path
    )


@pytest.mark.parametrize(
    ("formula", "inner", "states"),
    [
        ("F[0,3] a", [], 6),
        ("F[0,4] a", [3], 7),
        ("F[0,40] a", [39], 43),
        ("G(a -> G[0,10] b)", [8], 12),
        ("F a & F b & F c", [], 8),
        ("G[0,12] a", [10], 15),
    ],
)
def test_known_automata_have_these_folded_states(formula: str, inner: list[int], states: int) -> None:
    fspa = automaton(formula)
    assert len(fspa.states) == states
    assert [len(run) for run in fold_runs(fspa).folded.values()] == inner


def test_an_entrance_from_outside_ends_a_run() -> None:
    fspa = automaton("F[0,40] a")
    middle = 20
    detour = Edge(1, middle, Guard(atom("b"), (((0, False),),)))
    runs = check(replace(fspa, edges=(*fspa.edges, detour))).folded.values()
    inner = [state.id for run in runs for state in run]
    assert [len(run) for run in runs] == [18, 20]
    assert middle not in inner


def test_an_automaton_without_runs_is_drawn_whole() -> None:
    fspa = cover_and_hide()
    assert fold_runs(fspa) == whole_drawing(fspa)
    assert graph(fspa, Options(), fold_runs(fspa)) == graph(fspa, Options())


@times(60)
@given(counting() | endless(), st.sampled_from(NOTATIONS))
def test_the_label_of_a_run_is_that_of_its_ends_with_ranges_of_counts(fspa: Fspa, notation: Notation) -> None:
    for run in fold_runs(fspa).folded.values():
        first, last = (label_text(fspa, state.id, notation) for state in (run[0], run[-1]))
        assert label_range_text(fspa, run[0].id, run[-1].id, notation) == with_ranges(first, last)


@pytest.mark.parametrize("notation", NOTATIONS)
def test_labels_of_an_imported_automaton_become_ranges_too(notation: Notation) -> None:
    fspa = automaton("F[0,40] a")
    states = [
        replace(state, label=Text(f"wait {state.id}", f"wait {state.id}", f"wait {state.id}")) for state in fspa.states
    ]
    imported = replace(fspa, states=tuple(states))
    assert label_range_text(imported, 5, 2, notation) == "wait 5…2"
    assert label_range_text(replace(imported, states=(states[0], fspa.states[1])), 0, 1, notation).startswith(
        "wait 0 … "
    )


def with_ranges(first: str, last: str) -> str:
    """Return two texts as one: their numbers as ranges if they differ in nothing else, or both with an ellipsis."""
    for texts in ((first, last), [re.sub(r"\b1 step\b", "1 steps", text) for text in (first, last)]):
        first_parts, last_parts = (re.split(r"(\d+)", text) for text in texts)
        if first_parts[::2] == last_parts[::2]:
            return "".join(a if a == b else f"{a}…{b}" for a, b in zip(first_parts, last_parts, strict=True))
    return f"{first} … {last}"


def test_distances_of_a_run_become_a_range() -> None:
    assert distance_range(12, 1) == "12…1"
    assert distance_range(2, 2) == "2"
    assert distance_range(None, None) == "∞"
    assert distance_range(None, None, none="-") == "-"
