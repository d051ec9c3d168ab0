"""The statements of a transition in automata with registers: guards have many literals there, and many flags.

A monitor computes the same results as with :mod:`tltlc.program.states`, and does less for them:

- A flag, an atom that is only -1 or 1, is tested. It is no number in a minimum or maximum. Where a guard is
  true, its flags are known.
- A guard is tested only for what does not follow from the guards before it, which are false.
- Atoms each of which makes one guard true by itself are compared with 0 by their maximum, which is also a part
  of the robustness of all guards.
"""

from __future__ import annotations

from collections.abc import Collection, Iterable, Sequence
from functools import reduce
from typing import Final, Literal

from tltlc.automaton.fspa import Edge, Implicant
from tltlc.core.record import record
from tltlc.monitor.tables import MonitorTables
from tltlc.program.conjunctive_form import equivalent_clauses
from tltlc.program.states import LIMITING, NEAREST, OTHER, StateCode, shared_literals
from tltlc.program.tree import (
    All,
    Any,
    Assign,
    Bool,
    Choice,
    Compare,
    Declare,
    If,
    Int,
    Negate,
    NumericCall,
    ProgramExpression,
    ProgramVariable,
    Real,
    Statement,
)
from tltlc.program.used_names import variables_read

WORST: Final = "worst"
"""The variable with the maximum of the atoms each of which makes one guard true by itself."""

_ZERO: Final = Real(0.0)
_LOWEST: Final = Real(-1.0)

_Literal = tuple[int, bool]
"""The index of an atom, and whether the atom must be true."""


@record
class AtomVariables:
    """The variables of atoms. Those in ``booleans`` are Booleans: true where the atom is 1, false where it is -1.

    ``sharp`` has the indices of all atoms that are only -1 or 1.
    """

    names: tuple[str, ...]
    sharp: frozenset[int]
    booleans: frozenset[str]


@record
class _FalsePrime:
    """A prime implicant that is false: its literals of numbers, and those of flags that may be false.

    ``fails`` says that one of the flags is certainly false. Where a flag is false, ``least`` are the literals
    that may be -1.
    """

    numbers: list[_Literal]
    flags: list[_Literal]
    least: list[_Literal]
    fails: bool


class CompactStateCode(StateCode):
    """Makes the statements of one state or shape."""

    def __init__(self, tables: MonitorTables, atoms: AtomVariables, *, reads_tables: bool) -> None:
        super().__init__(tables, atoms.names, atoms.booleans, reads_tables=reads_tables)
        self._atoms = atoms
        self._worst: frozenset[_Literal] = frozenset()
        """The literals of the atoms whose negated maximum is ``-worst``."""

    def statements(self, edges: Sequence[Edge]) -> tuple[Statement, ...]:
        """Return the statements of the ``edges`` that leave the state; the last one is the ``else``."""
        alone = max((self._alone(edge.guard.primes) for edge in edges), key=len) if len(edges) > 1 else ()
        self._worst = frozenset((atom, False) for atom in alone)
        statements = super().statements(edges)
        if WORST not in variables_read(statements):
            return statements
        return (
            Declare(WORST, "real", _fold("max", [ProgramVariable(self._atoms.names[atom]) for atom in alone])),
            *statements,
        )

    def _alone(self, primes: Sequence[Implicant]) -> tuple[int, ...]:
        """Return the atoms that are no flags and make a guard true by themselves, if there are two or more."""
        atoms = tuple(
            atom
            for prime in primes
            if len(prime) == 1
            for atom, positive in prime
            if positive and not self._sharp(atom)
        )
        return atoms if len(atoms) > 1 else ()

    def _sharp(self, atom: int) -> bool:
        return atom in self._atoms.sharp

    # --- tests ------------------------------------------------------------------------------------

    def _tests(self, edges: Sequence[Edge]) -> list[ProgramExpression]:
        tests: list[ProgramExpression] = []
        false: list[Implicant] = []
        for edge in edges[:-1]:
            tests.append(self._test(edge.guard.primes, false))
            false += edge.guard.primes
        return tests

    def _test(self, primes: Sequence[Implicant], false: Sequence[Implicant]) -> ProgramExpression:
        """Return a test that is true where a guard is, given that the prime implicants in ``false`` are not."""
        if self._makes_worst(primes):
            others = [prime for prime in primes if not (len(prime) == 1 and _opposite(prime[0]) in self._worst)]
            return _any([Compare(">", ProgramVariable(WORST), _ZERO), *(self._all(prime) for prime in others)])
        clauses = clauses_of(primes)
        if clauses is None:
            return _any([self._all(prime) for prime in primes])
        opposites = [{_opposite(literal) for literal in prime} for prime in false]
        open_ = [clause for clause in clauses if not any(opposite <= set(clause) for opposite in opposites)]
        return _all([_any([self._literal_test(literal) for literal in clause]) for clause in self._flags_first(open_)])

    def _makes_worst(self, primes: Sequence[Implicant]) -> bool:
        return bool(self._worst) and {(literal,) for literal in map(_opposite, self._worst)} <= set(map(tuple, primes))

    def _flags_first(self, clauses: list[list[_Literal]]) -> list[list[_Literal]]:
        return sorted(clauses, key=lambda clause: not all(self._sharp(atom) for atom, _ in clause))

    def _all(self, literals: Iterable[_Literal]) -> ProgramExpression:
        return _all([self._literal_test(literal) for literal in literals])

    # --- robustness -------------------------------------------------------------------------------

    def _robustness(self, primes: Sequence[Implicant]) -> ProgramExpression:
        """Return the robustness of a guard, which is true."""
        if self._makes_worst(primes):
            others = [prime for prime in primes if not (len(prime) == 1 and _opposite(prime[0]) in self._worst)]
            return self._greatest_of(others, [ProgramVariable(WORST)])
        clauses = clauses_of(primes)
        if clauses is not None:
            units = [clause[0] for clause in clauses if len(clause) == 1 and not self._sharp(clause[0][0])]
            longer = [self._true_clause(clause) for clause in clauses if len(clause) > 1]
            terms = [*self._numbers(units), *(value for value in longer if value is not None)]
            return _least(terms) if terms else Real(1.0)
        shared = shared_literals(primes)
        # A true flag is 1, and no value is greater.
        terms = self._numbers(literal for literal in shared if not self._sharp(literal[0]))
        rest = [[literal for literal in prime if literal not in shared] for prime in primes]
        return _least([*terms, self._greatest_of(rest, [])])

    def _true_clause(self, clause: Sequence[_Literal]) -> ProgramExpression | None:
        """Return the maximum of the literals of a clause that is true; None if that is 1."""
        numbers, flags = self._divided(clause)
        if not numbers:
            return None
        greatest = _fold("max", [self._value(*literal) for literal in numbers])
        return Choice(_any([self._literal_test(flag) for flag in flags]), Real(1.0), greatest) if flags else greatest

    def _greatest_of(self, primes: Sequence[Sequence[_Literal]], terms: list[ProgramExpression]) -> ProgramExpression:
        """Return the maximum of ``terms`` and of the minima of prime implicants; at least one of them is above 0."""
        certain: list[ProgramExpression] = []
        terms = list(terms)
        for prime in primes:
            numbers, flags = self._divided(prime)
            if not numbers:
                certain.append(self._all(flags))
                continue
            least = _least(self._numbers(numbers))
            terms.append(Choice(self._all(flags), least, _LOWEST) if flags else least)
        if not terms:
            return Real(1.0)
        greatest = _fold("max", terms)
        return Choice(_any(certain), Real(1.0), greatest) if certain else greatest

    def _numbers(self, literals: Iterable[_Literal]) -> list[ProgramExpression]:
        """Return the values of literals; ``-worst`` for those of which it is the minimum."""
        remaining = list(literals)
        if self._worst and self._worst <= set(remaining):
            rest = [literal for literal in remaining if literal not in self._worst]
            return [Negate(ProgramVariable(WORST)), *(self._value(*literal) for literal in rest)]
        return [self._value(*literal) for literal in remaining]

    def _divided(self, literals: Sequence[_Literal]) -> tuple[list[_Literal], list[_Literal]]:
        """Return the literals of atoms that are no flags, and those of flags."""
        numbers = [literal for literal in literals if not self._sharp(literal[0])]
        return numbers, [literal for literal in literals if self._sharp(literal[0])]

    # --- the way to a goal ------------------------------------------------------------------------

    def _nearest(self, primes: Sequence[Sequence[_Literal]], taken: Sequence[Implicant]) -> list[Statement]:
        """Return statements that find the most robust of prime implicants, all of them false, and its least literal.

        ``taken`` are the prime implicants of the guard that is true instead.
        """
        true = set(shared_literals(taken))
        facts = [clause for clause in clauses_of(taken) or () if all(self._sharp(atom) for atom, _ in clause)]
        first, *following = (self._open(prime, true, facts) for prime in primes)
        others = [prime for prime in following if not prime.fails]
        lines = self._first(first, changes=bool(others))
        for place, prime in enumerate(others):
            value = self._least_of(prime)
            declared = Assign(OTHER, value) if place else Declare(OTHER, "real", value, changes=len(others) > 1)
            better = (Assign(NEAREST, ProgramVariable(OTHER)), *self._limits(prime.numbers, OTHER))
            lines += [declared, If(((Compare(">", ProgramVariable(OTHER), ProgramVariable(NEAREST)), better),))]
        # Nothing else may be compared with the value of the first prime implicant.
        return lines if self._at_goal or NEAREST in variables_read(lines) else lines[1:]

    def _open(
        self, prime: Sequence[_Literal], true: Collection[_Literal], facts: Sequence[Sequence[_Literal]]
    ) -> _FalsePrime:
        numbers, flags = self._divided(prime)
        # A true flag is 1, so it is never the least literal of a prime implicant that is false.
        flags = [flag for flag in flags if flag not in true]
        fails = not numbers or any({_opposite(flag) for flag in fact} <= set(flags) for fact in facts)
        # Where a flag is false, its value -1 is the least. A number that is true, or not above 0 and negated, is more.
        least = [literal for literal in prime if literal in flags or (literal in numbers and literal not in true)]
        return _FalsePrime(numbers, flags, least, fails)

    def _least_of(self, prime: _FalsePrime) -> ProgramExpression:
        least = _least(self._numbers(prime.numbers))
        return Choice(self._all(prime.flags), least, _LOWEST) if prime.flags else least

    def _first(self, prime: _FalsePrime, *, changes: bool) -> list[Statement]:
        """Return the statements for the first prime implicant; they begin with the declaration of ``NEAREST``."""
        if prime.fails:
            return [Declare(NEAREST, "real", _LOWEST, changes), *self._limits(prime.least, NEAREST)]
        lines: list[Statement] = [Declare(NEAREST, "real", self._least_of(prime), changes)]
        of_numbers = self._limits(prime.numbers, NEAREST)
        if not prime.flags:
            return [*lines, *of_numbers]
        return [*lines, If(((self._all(prime.flags), tuple(of_numbers)),), tuple(self._limits(prime.least, NEAREST)))]

    def _limits(self, literals: Sequence[_Literal], variable: str) -> list[Statement]:
        """Return statements that find the first literal that is least: a false flag, or one with a variable's value."""
        *before, (last, _) = literals
        otherwise = Assign(LIMITING, Int(last))
        if not before:
            return [otherwise]
        cases = []
        for literal in before:
            atom, _ = literal
            if self._sharp(atom):
                test = self._literal_test(_opposite(literal))
            else:
                test = Compare("==", self._value(*literal), ProgramVariable(variable))
            cases.append((test, (Assign(LIMITING, Int(atom)),)))
        return [If(tuple(cases), (otherwise,))]


def clauses_of(primes: Sequence[Implicant]) -> list[list[_Literal]] | None:
    """Return clauses that are equivalent to the disjunction of prime implicants; None if they are longer."""
    shared = shared_literals(primes)
    rest = [[literal for literal in prime if literal not in shared] for prime in primes]
    clauses = equivalent_clauses(rest) if all(rest) else []
    if clauses is None or sum(map(len, clauses)) > sum(map(len, rest)):
        return None
    return [*([literal] for literal in shared), *clauses]


def _opposite(literal: _Literal) -> _Literal:
    return literal[0], not literal[1]


def _all(tests: Sequence[ProgramExpression]) -> ProgramExpression:
    return (tests[0] if len(tests) == 1 else All(tuple(tests))) if tests else Bool(True)


def _any(tests: Sequence[ProgramExpression]) -> ProgramExpression:
    return tests[0] if len(tests) == 1 else Any(tuple(tests))


def _fold(function: Literal["min", "max"], terms: Sequence[ProgramExpression]) -> ProgramExpression:
    return reduce(lambda left, right: NumericCall(function, (left, right)), terms)


def _least(terms: Sequence[ProgramExpression]) -> ProgramExpression:
    """Return the minimum of terms; that of ``-a`` and ``-b`` is ``-max(a, b)``."""
    negated = [term.operand for term in terms if isinstance(term, Negate)]
    others = [term for term in terms if not isinstance(term, Negate)]
    if len(negated) < 2:
        return _fold("min", terms)
    return _fold("min", [Negate(_fold("max", negated)), *others])
