"""The statements that compute the transition from each state of the automaton.

They find the edge to take, its robustness, and the progress. Begin with `StateCode`. States of one shape
(:mod:`tltlc.program.shapes`) share their statements.
"""

from __future__ import annotations

from collections.abc import Collection, Hashable, Iterable, Mapping, Sequence
from functools import lru_cache, reduce
from typing import Final

from tltlc.automaton.fspa import Edge, Guard, Implicant
from tltlc.monitor.failure import breaks, causes
from tltlc.monitor.tables import MonitorTables
from tltlc.program.conjunctive_form import shorter_clauses
from tltlc.program.tree import (
    All,
    Any,
    Assign,
    BinaryNumber,
    Bool,
    CommentLine,
    Compare,
    Declare,
    If,
    Int,
    Negate,
    Not,
    NumericCall,
    ProgramExpression,
    ProgramVariable,
    Real,
    Statement,
    TableEntry,
)
from tltlc.program.used_names import variables_read

TARGET, ROBUSTNESS, PROGRESS, LIMITING = "target", "robustness", "progress", "limiting"
"""The variables that the statements of a state assign.

They are the next state, the robustness of the edge taken, the progress of this step alone, and the
index of the limiting atom. This atom determines the robustness of the most robust edge towards a
goal; the index is -1 if the state changes or no edge leads towards a goal.
"""
FAILURE = "failure"
"""The variable that the statements of an edge into a trap assign: the index of what the step fails at.

It is an index into :attr:`StateCode.failures`. The statements of other edges leave the variable as it is.
"""
FAILED_STEP = "failed_step"
"""The variable that :func:`with_failed_step` assigns: the number, from 1, of the step that takes such an edge."""
FIRST_EDGE = "first_edge"
"""The place of the state's first edge in the table of targets, which statements that read tables need."""
NEAREST, OTHER = "nearest", "other"
"""Two local variables: the robustness of the best prime implicant so far, and of the one compared with it."""
_ZERO: Final = Real(0.0)


def with_failed_step(statements: Iterable[Statement], steps: ProgramExpression) -> tuple[Statement, ...]:
    """Return the statements, which also assign the number of the step, ``steps``, where they assign what it fails at.

    Only one step of a trace takes an edge into a trap, so the other steps need no test.
    """
    found: list[Statement] = []
    for statement in statements:
        if isinstance(statement, If):
            cases = tuple((test, with_failed_step(body, steps)) for test, body in statement.cases)
            statement = If(cases, with_failed_step(statement.otherwise, steps))
        found.append(statement)
        if isinstance(statement, Assign) and statement.name == FAILURE:
            found.append(Assign(FAILED_STEP, steps))
    return tuple(found)


def state_edges(tables: MonitorTables, state: int) -> list[Edge]:
    """Return the edges of a state, ordered by their guards and targets: the longest guard comes last."""
    return sorted(tables.edges[state], key=lambda edge: (_size(edge.guard), edge.target))


def shape_edges(tables: MonitorTables, state: int) -> list[Edge]:
    """Return the edges of a state, ordered by their guards: the longest guard comes last."""
    return sorted(tables.edges[state], key=lambda edge: (_size(edge.guard), edge.guard.primes))


def edge_shape(tables: MonitorTables, edge: Edge) -> Hashable:
    """Return what determines the statements of an edge, apart from entries of tables.

    These are the prime implicants of the edge's guard. For an edge from a state to itself, they are
    also those of the edges that would lead nearer to a goal. For an edge into a trap, they are also the
    clauses that it breaks.
    """
    broken = edge.broken if breaks(tables.fspa, edge) else None
    return edge.guard.primes, tuple(other.guard.primes for other in _improving(tables, edge)), broken


class StateCode:
    """Makes the statements that compute the transition from a state, or from any state of one shape.

    The statements find the edge to take, its robustness, the progress, and the limiting atom: the atom that
    determines how robust the most robust edge towards a goal is. If the code ``reads_tables``, they read the
    next state and its progress from tables. ``atoms`` are the names of the variables with the values of the
    atoms. Those in ``booleans`` are Booleans: true where the atom is above 0.

    ``failures`` has what a step can fail at, each with its number: the index of the clause, None if several
    clauses together fail or the clauses are not known, and the index of the atom that decides it.
    """

    def __init__(
        self, tables: MonitorTables, atoms: Sequence[str], booleans: Collection[str] = (), *, reads_tables: bool
    ) -> None:
        self._tables, self._reads_tables = tables, reads_tables
        # Large automata have millions of literals: equal ones share one expression.
        self._values, self._literals = _literals(tuple(atoms), frozenset(booleans))
        self._at_goal = tables.fspa.judge == "goal"
        self.failures: dict[tuple[int | None, int | None], int] = {}

    def statements(self, edges: Sequence[Edge]) -> tuple[Statement, ...]:
        """Return an ``if`` with a case for each of the ``edges`` that leave the state.

        Without tables they are ordered by :func:`state_edges`, with tables by :func:`shape_edges`.

        Exactly one guard is true, so the last edge, which has the longest guard, is the ``else``,
        without a test. If there is only one edge, return its statements without an ``if``.
        """
        bodies = [self._edge_statements(place, edge) for place, edge in enumerate(edges)]
        if len(edges) == 1:
            return bodies[0]
        return (If(tuple(zip(self._tests(edges), bodies[:-1], strict=True)), bodies[-1]),)

    def transition(self, edges: Sequence[Edge]) -> tuple[Statement, ...]:
        """Return statements like those of :meth:`statements` that find only the next state."""
        bodies = [(Assign(TARGET, self._target(place, edge)),) for place, edge in enumerate(edges)]
        return (If(tuple(zip(self._tests(edges), bodies[:-1], strict=True)), bodies[-1]),) if bodies[1:] else bodies[0]

    def _tests(self, edges: Sequence[Edge]) -> list[ProgramExpression]:
        """Return the tests of the guards of all edges but the last."""
        return [self._truth(edge.guard) for edge in edges[:-1]]

    def _edge_statements(self, place: int, edge: Edge) -> tuple[Statement, ...]:
        """Return the statements that run when the automaton takes an edge.

        They assign the next state, the robustness of the edge, the progress, and the limiting atom
        (the atom that determines how robust the most robust edge towards a goal is). ``place`` is
        the place of the edge among those that leave the state.
        """
        improving = _improving(self._tables, edge)
        lines: list[Statement] = [CommentLine(edge.guard.text), Assign(TARGET, self._target(place, edge))]
        lines.append(Assign(ROBUSTNESS, self._robustness(edge.guard.primes)))
        lines += self._failure(edge) if breaks(self._tables.fspa, edge) else ()
        base = self._base_progress(edge)
        if not improving:
            return (*lines, *self._progress(base), Assign(LIMITING, Int(-1)))
        # The guards of the edges towards a goal are false, so each of their prime implicants has a literal at or
        # below 0. A literal that the guard of this edge makes positive is therefore never the least one.
        above = [literal for literal in shared_literals(edge.guard.primes) if literal[1]]
        primes = [prime for candidate in improving for prime in candidate.guard.primes]
        primes_left = [[literal for literal in prime if literal not in above] for prime in primes]
        lines += self._nearest(primes_left, edge.guard.primes)
        # The guards of the edges towards a goal are false, so their robustness is at most 0 without `min(0, …)`.
        share = BinaryNumber(
            "/", BinaryNumber("+", Real(1.0), ProgramVariable(NEAREST)), Real(float(self._tables.fspa.spec_size))
        )
        return (*lines, *self._progress(share if base == _ZERO else BinaryNumber("+", base, share)))

    def _failure(self, edge: Edge) -> tuple[Statement, ...]:
        """Return statements that assign the number of the first cause that applies."""
        groups: list[tuple[int, list[Implicant]]] = []
        for cause in causes(edge):
            number = self.failures.setdefault((cause.clause, cause.atom), len(self.failures))
            if groups and groups[-1][0] == number:
                groups[-1][1].append(cause.prime)
            else:
                groups.append((number, [cause.prime]))
        *others, (last, _) = groups
        otherwise = (Assign(FAILURE, Int(last)),)
        cases = ((self._any_of(primes), (Assign(FAILURE, Int(number)),)) for number, primes in others)
        return (If(tuple(cases), otherwise),) if others else otherwise

    def _target(self, place: int, edge: Edge) -> ProgramExpression:
        if not self._reads_tables:
            return Int(edge.target)
        first = ProgramVariable(FIRST_EDGE)
        return TableEntry("edge_targets", BinaryNumber("+", first, Int(place)) if place else first)

    def _base_progress(self, edge: Edge) -> ProgramExpression:
        if not self._reads_tables:
            return Real(self._tables.base_progress[edge.target])
        return TableEntry("level_progress", TableEntry("state_levels", ProgramVariable(TARGET)))

    def _progress(self, value: ProgramExpression) -> list[Statement]:
        """Return the statement that assigns ``value`` to the progress, as a list.

        Return an empty list if the spec is judged at its limit: then the progress does not depend
        on the edge taken.
        """
        return [Assign(PROGRESS, value)] if self._at_goal else []

    def _truth(self, guard: Guard) -> ProgramExpression:
        return self._any_of(guard.primes)

    def _any_of(self, primes: Sequence[Implicant]) -> ProgramExpression:
        """Return the test whether one of the prime implicants is true."""
        tests: list[ProgramExpression] = []
        for prime in primes:
            literals = [self._literal_test(literal) for literal in prime]
            tests.append(Bool(True) if not literals else literals[0] if len(literals) == 1 else All(tuple(literals)))
        return tests[0] if len(tests) == 1 else Any(tuple(tests))

    def _literal_test(self, literal: tuple[int, bool]) -> ProgramExpression:
        return self._literals[literal]

    def _robustness(self, primes: Sequence[Implicant]) -> ProgramExpression:
        """Return the robustness of a guard: the maximum of the robustness of its prime implicants.

        The robustness of a prime implicant is the value of its least literal. If an equivalent
        minimum of maxima has fewer literals, return that instead; only the sign of a 0 may differ.
        """
        shared = shared_literals(primes)
        rest = [[literal for literal in prime if literal not in shared] for prime in primes]
        terms = [self._value(*literal) for literal in shared]
        if not all(rest):
            return _fold("min", terms)
        clauses = shorter_clauses(rest)
        if clauses is None:
            return _fold("min", [*terms, _fold("max", [self._least(prime) for prime in rest])])
        return _fold("min", [*terms, *(self._greatest(clause) for clause in clauses)])

    def _nearest(self, primes: Sequence[Sequence[tuple[int, bool]]], _: Sequence[Implicant]) -> list[Statement]:
        """Return statements that find the most robust of the prime implicants, and its least literal.

        If several prime implicants or literals have the same value, the first one counts. The
        statements assign the robustness to the variable ``NEAREST``, and the index of the literal's
        atom to the variable ``LIMITING``.
        """
        first, *following = primes
        lines: list[Statement] = [Declare(NEAREST, "real", self._least(first), changes=bool(following))]
        lines += self._limiting_statements(first, NEAREST)
        if following:
            lines.append(Declare(OTHER, "real", self._least(following[0]), changes=len(following) > 1))
        for index, prime in enumerate(following):
            if index:
                lines.append(Assign(OTHER, self._least(prime)))
            better = (Assign(NEAREST, ProgramVariable(OTHER)), *self._limiting_statements(prime, OTHER))
            lines.append(If(((Compare(">", ProgramVariable(OTHER), ProgramVariable(NEAREST)), better),)))
        # A single prime implicant with one literal is compared with nothing: drop NEAREST if nothing reads it.
        return lines if self._at_goal or NEAREST in variables_read(lines) else lines[1:]

    def _limiting_statements(self, prime: Sequence[tuple[int, bool]], value: str) -> list[Statement]:
        """Return statements that find the first literal of ``prime`` whose value is that of a variable.

        ``value`` is the name of this variable. The statements assign the index of the literal's
        atom to ``LIMITING``.
        """
        *before, (last, _) = prime
        otherwise = Assign(LIMITING, Int(last))
        if not before:
            return [otherwise]
        cases = [
            (Compare("==", self._value(atom, polarity), ProgramVariable(value)), (Assign(LIMITING, Int(atom)),))
            for atom, polarity in before
        ]
        return [If(tuple(cases), (otherwise,))]

    def _least(self, prime: Sequence[tuple[int, bool]]) -> ProgramExpression:
        return _fold("min", [self._value(*literal) for literal in prime])

    def _greatest(self, clause: Sequence[tuple[int, bool]]) -> ProgramExpression:
        return _fold("max", [self._value(*literal) for literal in clause])

    def _value(self, atom: int, polarity: bool) -> ProgramExpression:
        return self._values[atom, polarity]


_Literals = Mapping[tuple[int, bool], ProgramExpression]
"""An expression for each literal. A literal is the index of an atom, and whether the atom must be true."""


@lru_cache(maxsize=1)
def _literals(atoms: tuple[str, ...], booleans: frozenset[str]) -> tuple[_Literals, _Literals]:
    """Return two tables with an expression for each literal over the variables ``atoms``.

    An expression in the first table computes the value of the literal, and an expression in the
    second table tests whether the literal is true. The variables in ``booleans`` are tests themselves.
    """
    values: dict[tuple[int, bool], ProgramExpression] = {}
    tests: dict[tuple[int, bool], ProgramExpression] = {}
    for index, name in enumerate(atoms):
        variable = ProgramVariable(name)
        values[index, True], values[index, False] = variable, Negate(variable)
        if name in booleans:
            tests[index, True], tests[index, False] = variable, Not(variable)
        else:
            tests[index, True], tests[index, False] = Compare(">", variable, _ZERO), Compare("<=", variable, _ZERO)
    return values, tests


def _improving(tables: MonitorTables, edge: Edge) -> tuple[Edge, ...]:
    """Return the edges that would lead nearer to a goal, if ``edge`` leads from a state to itself."""
    return tables.improving[edge.source] if edge.source == edge.target else ()


def shared_literals(primes: Sequence[Implicant]) -> list[tuple[int, bool]]:
    """Return the literals that all prime implicants contain."""
    return [literal for literal in primes[0] if all(literal in prime for prime in primes)]


def _size(guard: Guard) -> int:
    return sum(map(len, guard.primes))


def _fold(function: str, terms: Sequence[ProgramExpression]) -> ProgramExpression:
    """Return the minimum or the maximum of the terms; ``function`` is ``min`` or ``max``.

    Return 1 if there are no terms: the robustness of a guard that is always true.
    """
    if not terms:
        return Real(1.0)
    return reduce(lambda left, right: NumericCall("min" if function == "min" else "max", (left, right)), terms)
