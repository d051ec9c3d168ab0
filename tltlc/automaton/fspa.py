"""The finite state predicate automaton (FSPA) that tltlc compiles to: frozen, complete, self-contained.

It has the fields of an artefact and no others, so that reading an automaton from JSON returns the
automaton that was written.
"""

from __future__ import annotations

from typing import Any, Final, Literal

from tltlc.core.record import record
from tltlc.logic.formula import FlatNodes, Formula, flatten, unflatten
from tltlc.resolve.spec import Atom, Judge, Param, Signal

Verdict = Literal["satisfied", "holding", "pending", "violated"]
Implicant = tuple[tuple[int, bool], ...]
"""A conjunction of literals: pairs of an index into ``Fspa.atoms`` and a polarity."""
Mark = tuple[int, Literal["fin", "inf"]]
"""A pair, as an index into ``Fspa.acceptance``, and one of its two sets."""


Notation = Literal["unicode", "ascii", "english"]
"""The notation of formulas in texts and pictures; :mod:`tltlc.automaton.text` prints them."""
NOTATIONS: Final[tuple[Notation, ...]] = ("ascii", "unicode", "english")


@record
class Text:
    """A formula, label or guard that another tool wrote, in three notations.  It is no formula of the language."""

    ascii: str
    unicode: str
    english: str

    def __str__(self) -> str:
        return self.ascii


@record
class State:
    """A state of the automaton.

    ``label`` is the formula that remains to be satisfied; ``str(label)`` is its ASCII notation.  In
    an automaton of another tool, the label may be a name.  ``accepting`` is true if a trace that
    ends here is accepted (over infinite traces: if the state lies on an accepted cycle).
    ``verdict`` is the verdict of a trace that ends here.  ``distance`` is the least number of
    transitions to an accepting state, None for traps.
    """

    id: int
    label: Formula | Text
    accepting: bool
    verdict: Verdict
    distance: int | None


@record
class Guard:
    """The condition under which an edge is taken.

    ``formula`` states the condition as a short formula.  In an automaton of another tool,
    ``formula`` may be text that is no formula.  ``primes`` are all prime implicants of the guard
    (``((),)`` is true).  With ``exclusive`` declarations D, ``primes`` are the prime implicants of
    ``guard or not D`` that are not contained in ``not D`` (semantics, section 3).
    """

    formula: Formula | Text
    primes: tuple[Implicant, ...]

    @property
    def text(self) -> str:
        """The formula in the ASCII notation, as artefacts have it."""
        return str(self.formula)


@record
class Edge:
    """An edge.  On each letter, exactly one of the edges that leave a state has a true guard.

    No two edges have the same source, target and sets of pairs.
    """

    source: int
    target: int
    guard: Guard


@record
class Pair:
    """A Rabin pair of sets of edges, by index.

    A run meets the pair if it takes no edge of ``fin`` infinitely often and some edge of ``inf``
    infinitely often.
    """

    fin: tuple[int, ...]
    inf: tuple[int, ...]


@record
class Fspa:
    """A deterministic, complete automaton; over finite traces minimal, with acceptance on states.

    ``states[i].id == i``; states are numbered breadth-first, and state 0 is initial.  ``edges`` are
    sorted by (source, target).  ``spec_size`` is the greatest finite distance, at least 0.

    Over infinite traces a run is accepted if it meets one of the pairs of ``acceptance``.  There,
    accepting states lie on an accepted cycle, and edges with the same source and target differ in
    the sets of pairs that contain them (semantics, section 5).
    """

    name: str
    doc: str
    formula: Formula | Text
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
        """Return the edges that leave a state, in order of target."""
        return tuple(edge for edge in self.edges if edge.source == state)

    def marks(self) -> tuple[tuple[Mark, ...], ...]:
        """Return for each edge the sets of pairs that contain it, in order; none over finite traces."""
        marks: list[list[Mark]] = [[] for _ in self.edges]
        for number, pair in enumerate(self.acceptance):
            for edge in dict.fromkeys(pair.fin):
                marks[edge].append((number, "fin"))
            for edge in dict.fromkeys(pair.inf):
                marks[edge].append((number, "inf"))
        return tuple(map(tuple, marks))

    def __reduce__(self) -> tuple[object, ...]:
        # The formulas share one table of nodes: the labels of states that count down have most nodes in common.
        guards = {id(edge.guard): edge.guard for edge in self.edges}
        labels = [state.label for state in self.states]
        formulas = (self.formula, *labels, *(guard.formula for guard in guards.values()))
        nodes, indices = flatten(formula for formula in formulas if isinstance(formula, Formula))
        index = iter(indices)
        table = [next(index) if isinstance(formula, Formula) else formula for formula in formulas]
        states = [(state.id, state.accepting, state.verdict, state.distance) for state in self.states]
        place = {key: number for number, key in enumerate(guards)}
        edges = [(edge.source, edge.target, place[id(edge.guard)]) for edge in self.edges]
        primes = [guard.primes for guard in guards.values()]
        fields = {name: getattr(self, name) for name in type(self).__match_args__}
        return _unpickle, (nodes, table, primes, {**fields, "formula": None, "states": states, "edges": edges})


def _unpickle(
    nodes: FlatNodes, table: list[int | Text], primes: list[tuple[Implicant, ...]], fields: dict[str, Any]
) -> Fspa:
    """Return the automaton.

    ``table`` has the formula of the spec, then the labels of the states and the formulas of the
    guards, each as a text or as an index into ``nodes``.  ``primes`` are those of the guards.
    """
    subformulas = unflatten(nodes)
    formulas = iter([entry if isinstance(entry, Text) else subformulas[entry] for entry in table])
    fields["formula"] = next(formulas)
    fields["states"] = tuple([State(number, next(formulas), *rest) for number, *rest in fields["states"]])
    guards = [Guard(next(formulas), implicants) for implicants in primes]
    fields["edges"] = tuple([Edge(source, target, guards[guard]) for source, target, guard in fields["edges"]])
    return Fspa(**fields)
