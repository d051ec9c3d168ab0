"""The networkx graph of an automaton; its distances and traps agree with networkx's own algorithms."""

from __future__ import annotations

import networkx
from hypothesis import given

from tests.fuzzing import times
from tests.logic.strategies import formulas
from tltlc import compile_text
from tltlc.automaton.finite.build import build, spec_from_formula
from tltlc.automaton.networkx_graph import to_networkx
from tltlc.logic.formula import Formula


def test_parallel_edges_become_one() -> None:
    (fspa,) = compile_text("signal a: bool signal b: bool spec s { semantics infinite reach a require G F b }")
    graph = to_networkx(fspa)
    assert list(graph.edges(data="indices")) == [(0, 0, (0,)), (0, 1, (1,)), (1, 1, (2, 3))]
    assert graph[1][1]["guard"] == "!b | b"
    assert graph[1][1]["primes"] == (*fspa.edges[2].guard.primes, *fspa.edges[3].guard.primes)


@given(formulas(atoms=("a", "b", "c"), max_leaves=8))
@times(40)
def test_networkx_finds_the_same_distances_and_traps(formula: Formula) -> None:
    fspa = build(spec_from_formula(formula))
    graph = to_networkx(fspa)
    assert [graph.nodes[state.id]["label"] for state in fspa.states] == [str(state.label) for state in fspa.states]
    assert {(u, v): d["primes"] for u, v, d in graph.edges(data=True)} == {
        (edge.source, edge.target): edge.guard.primes for edge in fspa.edges
    }
    goals = {state.id for state in fspa.states if state.accepting}
    distances = networkx.multi_source_dijkstra_path_length(graph.reverse(), goals) if goals else {}
    assert {state.id: state.distance for state in fspa.states} == {s.id: distances.get(s.id) for s in fspa.states}
    assert networkx.descendants(graph, graph.graph["initial"]) | {0} == set(graph.nodes)
