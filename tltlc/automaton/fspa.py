"""The finite state predicate automaton (FSPA), the result of a compilation.

It has exactly the fields of an artefact, the JSON file of a compiled automaton. So an automaton
that is written to JSON and read again stays the same.
"""

from __future__ import annotations

from typing import Any, Final, Literal

from tltlc.core.record import record
from tltlc.logic.formula import FlatNodes, Formula, flatten, unflatten
from tltlc.resolve.spec import Atom, JudgeMode, Param, Register, Signal

Verdict = Literal["satisfied", "holding", "pending", "violated"]
Implicant = tuple[tuple[int, bool], ...]
"""A conjunction of literals. A literal is an index into ``Fspa.atoms``, and the truth value of this atom."""
Mark = tuple[int, Literal["fin", "inf"]]
"""One of the two sets of edges of a Rabin pair: the pair's index in ``Fspa.acceptance``, and the set's name."""


Notation = Literal["unicode", "ascii", "english"]
"""The notation of formulas in texts and pictures; :mod:`tltlc.automaton.text` prints them."""
NOTATIONS: Final[tuple[Notation, ...]] = ("ascii", "unicode", "english")


@record
class Text:
    """A formula, label or guard of an automaton that another tool made, as text in three notations.

    The text need not be a formula of the spec language.
    """

    ascii: str
    unicode: str
    english: str

    def __str__(self) -> str:
        return self.ascii


@record
class State:
    """A state of the automaton.

    ``label`` is the formula that remains to be satisfied; ``str(label)`` is its ASCII notation. In
    an automaton that another tool made, the label may be a name. ``accepting`` is true if a trace
    that ends in this state is accepted; over infinite traces, if the state lies on an accepted
    cycle. ``verdict`` is the verdict of the trace so far. ``distance`` is the least number of
    transitions to an accepting state; None if no accepting state can be reached (a trap).
    """

    id: int
    label: Formula | Text
    accepting: bool
    verdict: Verdict
    distance: int | None


@record
class Guard:
    """The condition under which an edge is taken.

    ``formula`` states the condition as a short formula. In an automaton that another tool made,
    ``formula`` may be a :class:`Text`. ``primes`` are all prime implicants of the guard; a guard
    that is always true has ``((),)``. If atoms are declared ``exclusive``, let D be the condition
    that no two of these atoms hold together. Then ``primes`` are the prime implicants of ``guard or
    not D``, without those that contradict D (``docs/semantics.md``, "Guards and their robustness").
    """

    formula: Formula | Text
    primes: tuple[Implicant, ...]

    @property
    def text(self) -> str:
        """The formula in the ASCII notation, as in the JSON file of a compiled automaton."""
        return str(self.formula)


@record
class BrokenClause:
    """When an edge into a trap breaks a clause: from then on, no continuation of the trace can meet the clause.

    ``clause`` is the clause's index in ``Fspa.clauses``. The edge breaks it if one of the implicants in
    ``primes`` is true. These are all prime implicants of the condition, as in a :class:`Guard`.
    """

    clause: int
    primes: tuple[Implicant, ...]


@record
class Edge:
    """An edge of the automaton.

    At each sample that the ``exclusive`` declarations allow, exactly one of the edges that leave a
    state has a true guard. No two edges have the same source, the same target and the same marks
    (:meth:`Fspa.marks`).

    ``broken`` is for edges into a trap: the clauses that a step breaks there, in the order of the spec.
    Where none of them is broken, only several clauses together cannot be met any more. It is empty for
    other edges, and if the clauses are not known.
    """

    source: int
    target: int
    guard: Guard
    broken: tuple[BrokenClause, ...] = ()


@record
class Pair:
    """A Rabin pair: two sets of edges, as indices into ``Fspa.edges``.

    A run meets the pair if it takes no edge of ``fin`` infinitely often and some edge of ``inf``
    infinitely often.
    """

    fin: tuple[int, ...]
    inf: tuple[int, ...]


@record
class Fspa:
    """A deterministic, complete automaton. Over finite traces it is minimal, and its states decide acceptance.

    ``states[i].id == i``; states are numbered breadth-first, and state 0 is initial. ``edges`` are
    sorted by (source, target). ``spec_size`` is the greatest ``distance`` of a state; 0 if all
    states are traps.

    Over infinite traces, a run is accepted if it meets one of the pairs of ``acceptance``, and a
    state is accepting if it lies on an accepted cycle. Edges with the same source and target then
    differ in their :meth:`marks` (``docs/semantics.md``, "Infinite traces").

    ``registers`` are the memory that atoms read, each after the registers that its update reads at the
    same sample (``docs/semantics.md``, "Memory").

    ``clock_s`` is the time between two samples in seconds, None without a clock. ``clock_varies`` says
    that each sample brings its own time since the sample before; then ``clock_s`` is None.

    ``clauses`` has the texts of the clauses of the spec, in order: ``avoid on_lava``. It is empty if they
    are not known, as in an automaton that another tool made.
    """

    name: str
    doc: str
    formula: Formula | Text
    level: str | None
    limit_steps: int | None
    judge: JudgeMode
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
    registers: tuple[Register, ...] = ()
    clock_varies: bool = False
    clauses: tuple[str, ...] = ()

    @property
    def clock(self) -> float | Literal["varies"] | None:
        """The clock: its period in seconds, or ``varies``; None without one."""
        return "varies" if self.clock_varies else self.clock_s

    def edges_from(self, state: int) -> tuple[Edge, ...]:
        """Return the edges that leave a state, in order of target."""
        return tuple(edge for edge in self.edges if edge.source == state)

    def marks(self) -> tuple[tuple[Mark, ...], ...]:
        """Return, for each edge, its marks: which sets of Rabin pairs contain the edge.

        An edge in the sets ``fin`` of pair 0 and ``inf`` of pair 1 has the marks
        ``((0, "fin"), (1, "inf"))``. Over finite traces, no edge has marks.
        """
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
        edges = [(edge.source, edge.target, place[id(edge.guard)], edge.broken) for edge in self.edges]
        primes = [guard.primes for guard in guards.values()]
        fields = {name: getattr(self, name) for name in type(self).__match_args__}
        return _unpickle, (nodes, table, primes, {**fields, "formula": None, "states": states, "edges": edges})


def _unpickle(
    nodes: FlatNodes, table: list[int | Text], primes: list[tuple[Implicant, ...]], fields: dict[str, Any]
) -> Fspa:
    """Return the automaton whose parts :meth:`Fspa.__reduce__` pickled.

    ``table`` has the formula of the spec, then the labels of the states, then the formulas of the
    guards, each as a :class:`Text` or as an index into ``nodes``. ``primes`` has the prime
    implicants of each guard. ``fields`` has the fields of the automaton, without these formulas and
    prime implicants.
    """
    subformulas = unflatten(nodes)
    formulas = iter([entry if isinstance(entry, Text) else subformulas[entry] for entry in table])
    fields["formula"] = next(formulas)
    fields["states"] = tuple([State(number, next(formulas), *rest) for number, *rest in fields["states"]])
    guards = [Guard(next(formulas), implicants) for implicants in primes]
    edges = [Edge(source, target, guards[guard], broken) for source, target, guard, broken in fields["edges"]]
    fields["edges"] = tuple(edges)
    return Fspa(**fields)
