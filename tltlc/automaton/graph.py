"""The automaton as a networkx graph, for analyses that tltlc does not offer itself."""

from __future__ import annotations

from typing import TYPE_CHECKING

from tltlc.automaton.fspa import Fspa

if TYPE_CHECKING:
    import networkx


def to_networkx(fspa: Fspa) -> networkx.DiGraph:
    """A directed graph: a node for each state id, an edge for each edge.

    Nodes carry ``label`` (ASCII), ``accepting``, ``verdict`` and ``distance`` (None for traps), edges
    ``guard`` (the short text) and ``primes``; the graph carries ``name``, ``initial`` and ``spec_size``.

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
            label=state.label.ascii,
            accepting=state.accepting,
            verdict=state.verdict,
            distance=state.distance,
        )
    for edge in fspa.edges:
        graph.add_edge(edge.source, edge.target, guard=edge.guard.text, primes=edge.guard.primes)
    return graph
