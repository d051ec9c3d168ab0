"""The finite state predicate automaton (FSPA) that tltlc compiles to: frozen, complete, self-contained.

Everything that an artefact holds is here and nothing else, so that an automaton that was read
from JSON is the one that was written.
"""

from __future__ import annotations

from typing import Literal

from tltlc.core.record import record
from tltlc.resolve.spec import Atom, Judge, Param, Signal

Verdict = Literal["satisfied", "holding", "pending", "violated"]
Implicant = tuple[tuple[int, bool], ...]
"""Pairs of an index into ``Fspa.atoms`` and a polarity."""
Mark = tuple[int, Literal["fin", "inf"]]
"""An index into ``Fspa.acceptance``, and one of the two sets of the pair."""


@record
class Text:
    """A formula in three notations."""

    ascii: str
    unicode: str
    english: str


@record
class State:
    """A state: what remains to be satisfied, and what its verdict would be if the trace ended here.

    ``distance`` is the least number of transitions to an accepting state, None for traps.
    """

    id: int
    label: Text
    accepting: bool
    verdict: Verdict
    distance: int | None


@record
class Guard:
    """When an edge is taken: ``primes`` are ALL prime implicants (``((),)`` is true), ``text`` a short form.

    Where atoms are exclusive, the primes are those of ``guard or not D`` that are not contained in
    ``not D`` (semantics, section 3).
    """

    text: str
    primes: tuple[Implicant, ...]


@record
class Edge:
    """At most one per (source, target) and pairs; of the edges that leave a state exactly one guard is true."""

    source: int
    target: int
    guard: Guard


@record
class Pair:
    """A Rabin pair, by indices of edges: none of ``fin`` may be taken infinitely often, one of ``inf`` must be."""

    fin: tuple[int, ...]
    inf: tuple[int, ...]


@record
class Fspa:
    """A deterministic, complete automaton; over finite traces minimal, with acceptance on states.

    ``states[i].id == i``, state 0 is initial, numbered breadth-first; ``edges`` are sorted by
    (source, target).  ``spec_size`` is the greatest finite distance, at least 0.  Over infinite traces a run is
    accepted that meets one of the pairs of ``acceptance``; ``accepting`` states lie on an accepted cycle, and edges of
    one source and target are told apart by their pairs (semantics, section 5).
    """

    name: str
    doc: str
    formula: Text
    level: str | None
    limit_steps: int | None
    judge: Judge
    semantics: Literal["finite", "infinite"]
    tags: tuple[str, ...]
    clock_s: float | None
    signals: tuple[Signal, ...]
    params: tuple[Param, ...]
    atoms: tuple[Atom, ...]
    exclusive: tuple[tuple[int, ...], ...]
    states: tuple[State, ...]
    edges: tuple[Edge, ...]
    spec_size: int
    acceptance: tuple[Pair, ...] = ()

    def edges_from(self, state: int) -> tuple[Edge, ...]:
        """The edges that leave a state, in order of target."""
        return tuple(edge for edge in self.edges if edge.source == state)

    def marks(self) -> tuple[tuple[Mark, ...], ...]:
        """Of each edge the sets of pairs that name it, in order; none over finite traces."""
        found: list[list[Mark]] = [[] for _ in self.edges]
        for number, pair in enumerate(self.acceptance):
            for edge in dict.fromkeys(pair.fin):
                found[edge].append((number, "fin"))
            for edge in dict.fromkeys(pair.inf):
                found[edge].append((number, "inf"))
        return tuple(map(tuple, found))
