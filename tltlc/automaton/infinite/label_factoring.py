"""Write Boolean combinations of temporal formulas in a short form, with common factors taken out.

The labels of states are often longer than necessary, because they are made from decision diagrams.
This module rewrites a label in two forms: a disjunction of prime implicants, and a conjunction of
prime implicates. (A prime implicate is a disjunction of literals that the label implies, none of
which can be left out.) ``b & !d | d`` becomes ``b | d``, and ``F b & G F c | F b & G F d`` becomes
``F b & (G F c | G F d)``.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Iterator, Sequence
from typing import Final, Literal

from tltlc.automaton.diagrams import Diagrams, OutOfSteps
from tltlc.automaton.infinite.after_automaton import ObligationAutomaton
from tltlc.automaton.infinite.normal_form import conjunction, disjunction
from tltlc.automaton.transitions import FALSE, TRUE
from tltlc.automaton.work import Work
from tltlc.logic.formula import Formula, not_

_MOST_TERMS: Final = 48
"""The most terms (prime implicants or prime implicates) of a form; a form with more terms is left out."""
_MOST_STEPS: Final = 20_000
"""The most steps of the diagrams for one form of a formula. A form that takes more is left out."""

_LiteralSet = frozenset[int]
"""A set of literals. The literal of variable ``v`` is ``2 * v``, its negation ``2 * v + 1``."""

_JoiningOp = Literal["or", "and"]
"""The operator that joins terms: ``or`` for implicants, which are conjunctions, ``and`` for implicates."""


class _TooManyTerms(Exception):
    """Raised when a formula has more than :data:`_MOST_TERMS` terms."""


class Factoring:
    """Rewrites formulas over ``atoms`` to shorter formulas that are equivalent on infinite traces.

    The formulas must be in the normal form of :mod:`tltlc.automaton.infinite.normal_form`. A *term*
    is a prime implicant (a conjunction of literals) or a prime implicate (a disjunction).
    """

    def __init__(self, atoms: Sequence[str]) -> None:
        self._after = ObligationAutomaton(atoms, Diagrams(Work(0)))
        nothing: _LiteralSet = frozenset()
        self._terms: dict[tuple[_JoiningOp, int], tuple[_LiteralSet, ...]] = {
            ("or", FALSE): (),
            ("or", TRUE): (nothing,),
            ("and", TRUE): (),
            ("and", FALSE): (nothing,),
        }
        self._redundant: dict[tuple[_JoiningOp, int], _LiteralSet] = {}

    def forms(self, formula: Formula) -> Iterator[Formula]:
        """Yield the formula as a disjunction of prime implicants, then as a conjunction of prime implicates.

        Common factors are taken out of both. A form with too many terms is left out, and the second
        form is left out if it equals the first.
        """
        operators: tuple[_JoiningOp, ...] = ("or", "and")
        for op in operators:
            try:
                with self._after.obligations.limit.at_most(_MOST_STEPS):
                    terms = self._drop_redundant_terms(self._primes(self._after.obligation(formula), op), op)
            except (_TooManyTerms, OutOfSteps):
                continue
            yield self._factor(terms, op)
            if len(terms) < 2:
                # With at most one term, both forms are the same.
                return

    # --- terms ------------------------------------------------------------------------------------

    def _primes(self, obligation: int, op: _JoiningOp) -> tuple[_LiteralSet, ...]:
        """Return all prime implicants (``op`` is ``or``) or all prime implicates (``and``) of an obligation."""
        primes = self._terms.get((op, obligation))
        if primes is None:
            obligations = self._after.obligations
            variable = obligations.variable[obligation]
            absent, present = obligations.low[obligation], obligations.high[obligation]
            primes = common = self._primes(
                (obligations.both if op == "or" else obligations.either)(absent, present), op
            )
            with_it, without = (present, absent) if op == "or" else (absent, present)
            for literal, rest in ((2 * variable, with_it), (2 * variable + 1, without)):
                new = (term for term in self._primes(rest, op) if not any(shared <= term for shared in common))
                primes += tuple(term | {literal} for term in new)
            if len(primes) > _MOST_TERMS:
                raise _TooManyTerms
            self._terms[op, obligation] = primes
        return primes

    def _drop_redundant_terms(self, terms: Sequence[_LiteralSet], op: _JoiningOp) -> list[_LiteralSet]:
        """Return the terms without those that are redundant beside the others, and without redundant literals."""
        kept = [self._drop_redundant_literals(term, op) for term in terms]
        for term in sorted(kept, key=len, reverse=True) if len(kept) > 1 else ():
            others = [other for other in kept if other is not term]
            implied = term.union(*(self._redundant_beside(literal, op) for literal in term))
            if any(other <= implied for other in others) or self._is_consensus(term, others, op):
                kept = others
        return kept

    def _drop_redundant_literals(self, term: _LiteralSet, op: _JoiningOp) -> _LiteralSet:
        for literal in sorted(term) if len(term) > 1 else ():
            if any(literal in self._redundant_beside(other, op) for other in term):
                term -= {literal}
        return term

    def _redundant_beside(self, literal: int, op: _JoiningOp) -> _LiteralSet:
        """Return the literals that are redundant in a term with ``literal``.

        For example, ``F b`` is redundant in an ``and`` with ``F(a & X F b)``.
        """
        redundant = self._redundant.get((op, literal))
        if redundant is None:
            redundant = frozenset()
            formula = self._after.formulas[literal // 2]
            if formula.op != "atom":
                with_literal = [term for term in self._primes(self._after.obligation(formula), op) if literal in term]
                redundant = frozenset.intersection(*with_literal) - {literal} if with_literal else redundant
            self._redundant[op, literal] = redundant
        return redundant

    def _is_consensus(self, term: _LiteralSet, others: Sequence[_LiteralSet], op: _JoiningOp) -> bool:
        """Whether a term is redundant because of several other terms, as ``b & c`` in ``a & b | !a & c | b & c``."""
        literals = frozenset().union(*others)
        if not any(literal ^ 1 in literals for literal in literals):
            return False
        combine = self._after.obligations.either if op == "or" else self._after.obligations.both
        without = self._obligation(others, op)
        return combine(without, self._obligation([term], op)) == without

    def _obligation(self, terms: Iterable[_LiteralSet], op: _JoiningOp) -> int:
        return self._after.obligation(self._join(terms, op))

    # --- factors ----------------------------------------------------------------------------------

    def _factor(self, terms: Sequence[_LiteralSet], op: _JoiningOp) -> Formula:
        """Return the terms as a formula, with common factors taken out.

        ``a & b | a & c`` becomes ``a & (b | c)``. If no literal is in all terms, the literal that
        is in most terms is taken out of these terms. In ``a & c | a & d | b & c | b & d | e``, this
        is ``a``, which leaves the rests ``c`` and ``d``. Since ``b`` also occurs with each of these
        rests, it becomes a factor too: ``(a | b) & (c | d) | e``. Other terms, such as ``e``, are
        factored separately.
        """
        if len(terms) < 2:
            return self._join(terms, op)
        shared = frozenset.intersection(*terms)
        if shared:
            return _join_factors(op, (self._term(shared, op), self._factor([term - shared for term in terms], op)))
        counts = Counter(literal for term in terms for literal in term)
        best = min(counts, key=lambda literal: (-counts[literal], literal))
        if counts[best] == 1:
            return self._join(terms, op)
        rests = [term - {best} for term in terms if best in term]
        shared = frozenset.intersection(*rests)
        rests = [rest - shared for rest in rests]
        # The factors that occur with every rest.
        before = (term - rests[0] for term in terms if rests[0] <= term)
        factors = [factor for factor in before if all(factor | rest in terms for rest in rests)]
        product = {factor | rest for factor in factors for rest in rests}
        others = [term for term in terms if term not in product]
        whole = _join_factors(op, (self._factor(factors, op), self._factor(rests, op)))
        return _join_terms(op, (whole, self._factor(others, op))) if others else whole

    def _join(self, terms: Iterable[_LiteralSet], op: _JoiningOp) -> Formula:
        return _join_terms(op, (self._term(term, op) for term in terms))

    def _term(self, term: _LiteralSet, op: _JoiningOp) -> Formula:
        return _join_factors(op, map(self._literal, sorted(term)))

    def _literal(self, literal: int) -> Formula:
        formula = self._after.formulas[literal // 2]
        return not_(formula) if literal % 2 else formula


def _join_terms(op: _JoiningOp, operands: Iterable[Formula]) -> Formula:
    return disjunction(operands) if op == "or" else conjunction(operands)


def _join_factors(op: _JoiningOp, operands: Iterable[Formula]) -> Formula:
    return conjunction(operands) if op == "or" else disjunction(operands)
