"""Convert an automaton to a networkx graph, for analyses that tltlc does not offer."""

from __future__ import annotations

from typing import TYPE_CHECKING

from tltlc.automaton.fspa import Fspa
from tltlc.automaton.text import guard_texts

if TYPE_CHECKING:
    import networkx


def to_networkx(fspa: Fspa) -> networkx.DiGraph:
    """Return a directed graph with a node for each state id and an edge for each source and target.

    Nodes have the attributes ``label`` (ASCII), ``accepting``, ``verdict`` and ``distance`` (None
    for traps). Edges have ``guard`` (ASCII), ``primes`` (the prime implicants of the guard) and
    ``indices`` into ``fspa.edges``. The graph itself has the attributes ``name``, ``initial`` (the
    id of the initial state) and ``spec_size``. Over infinite traces, several edges of the automaton
    may join the same two states. The graph then has one edge for all of them: ``indices`` lists
    them, and ``guard`` and ``primes`` are the disjunction of their guards.

    >>> import networkx, tltlc
    >>> (fspa,) = tltlc.compile_text("signal a: bool signal b: bool spec s { reach a then b }")
    >>> graph = tltlc.to_networkx(fspa)
    >>> goals = [state for state, accepting in graph.nodes("accepting") if accepting]
    >>> networkx.shortest_path(graph, graph.graph["initial"], goals[0])
    [0, 1, 2]
    """
    from networkx import DiGraph

    graph = DiGraph(name=fspa.name, initial=0, spec_size=fspa.spec_size)
    for state in fspa.states:
        graph.add_node(
            state.id,
            label=str(state.label),
            accepting=state.accepting,
            verdict=state.verdict,
            distance=state.distance,
        )
    texts = guard_texts(fspa)
    joined: dict[tuple[int, int], list[int]] = {}
    for index, edge in enumerate(fspa.edges):
        joined.setdefault((edge.source, edge.target), []).append(index)
    for (source, target), indices in joined.items():
        text = " | ".join(texts[index] for index in indices)
        primes = tuple(prime for index in indices for prime in fspa.edges[index].guard.primes)
        graph.add_edge(source, target, guard=text, primes=primes, indices=tuple(indices))
    return graph
