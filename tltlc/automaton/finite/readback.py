"""Convert obligations to formulas, with common factors taken out and operands in the order of the source."""

from __future__ import annotations

from collections.abc import Callable, Collection

from tltlc.automaton.finite.successors import Successors
from tltlc.automaton.transitions import FALSE, TRUE
from tltlc.logic import formula as build
from tltlc.logic.bounded_operators import bounded_operator, count_down
from tltlc.logic.formula import Formula

_TERM_LIMIT = 64
"""The most terms of a disjunction of conjunctions.

A longer disjunction is written as nested ``a & … | …`` instead.
"""

_MOST_FACTORED = 40
"""The most variables of an obligation that are all tried as common factors.

In larger obligations, only the first variable is tried.
"""

_Term = frozenset[tuple[int, bool]]
_Positioned = tuple[int, Formula]
"""The position of a formula's first part in the source, and the formula."""


class ObligationWriter:
    """Converts obligations (Boolean functions of temporal subformulas) to formulas.

    The operands have the order of ``source``, the formula of the spec.
    """

    __slots__ = ("_formulas", "_long_bounds", "_position", "_successors", "_sums", "_without_shorter")

    def __init__(self, successors: Successors, source: Formula) -> None:
        self._successors = successors
        self._position = {part: index for index, part in enumerate(source.walk())}
        self._long_bounds = {successors.obligation(part): part for part in self._position if _is_long_bound(part)}
        self._without_shorter: dict[int, int] = {}
        self._formulas: dict[int, _Positioned] = {}
        self._sums: dict[int, list[_Term] | None] = {FALSE: [], TRUE: [frozenset()]}

    def formula(self, obligation: int) -> Formula:
        """Return an obligation as a formula."""
        return self._with_position(obligation)[1]

    def long_bound(self, obligation: int) -> Formula | None:
        """Return the subformula ``F[0,n] p`` or ``G[0,n] p`` of the source with this obligation, if ``n`` is large.

        Returns None if there is no such subformula, or if ``n`` is at most
        :data:`_MOST_FACTORED`. Callers use the subformula unchanged: no shorter formula has the
        same obligation, and a search for one takes n² steps.
        """
        return self._long_bounds.get(obligation)

    def support(self, obligation: int) -> list[int]:
        """Return the variables (such as temporal subformulas) on which the obligation depends, in ascending order."""
        obligations = self._successors.diagrams.obligations
        seen, stack = {FALSE, TRUE, obligation}, [obligation]
        variables: set[int] = set()
        while stack:
            node = stack.pop()
            if node in (FALSE, TRUE):
                continue
            variables.add(obligations.variable[node])
            for child in (obligations.low[node], obligations.high[node]):
                if child not in seen:
                    seen.add(child)
                    stack.append(child)
        return sorted(variables)

    def restrict(self, obligation: int, variables: Collection[int], value: bool) -> int:
        """Return the obligation with each of ``variables`` replaced by the truth value ``value``."""
        obligations = self._successors.diagrams.obligations
        last = max(variables)
        memo: dict[int, int] = {}

        def restrict(node: int) -> int:
            tested = obligations.variable[node]
            if tested > last:
                return node
            if tested in variables:
                return restrict(obligations.high[node] if value else obligations.low[node])
            result = memo.get(node)
            if result is None:
                absent, present = restrict(obligations.low[node]), restrict(obligations.high[node])
                result = memo[node] = obligations.node(tested, absent, present)
            return result

        return restrict(obligation)

    def without_shorter_bounds(self, obligation: int) -> int:
        """Return the obligation without the variables of bounds that a longer bound makes redundant.

        The obligation of ``F[0,3] p`` also has variables for ``F[0,2] p`` and ``F[0,1] p``, which
        are redundant beside ``F[0,3] p``. Without this method, the search for short labels would
        need a proof for each of them.
        """
        known = self._without_shorter.get(obligation)
        if known is None:
            known = self._without_shorter[obligation] = self._with_longest_bounds(obligation)
        return known

    def _with_longest_bounds(self, obligation: int) -> int:
        successors = self._successors
        obligations = successors.diagrams.obligations
        removed: set[int] = set()
        for variable in self.support(obligation):
            formula = successors.formulas[variable]
            if formula is None or variable in removed:
                continue
            shorter = count_down(formula)
            if shorter is None:
                continue
            shorter_variables = set()
            while shorter is not None:
                shorter_variables.add(successors.variable(shorter))
                shorter = count_down(shorter)
            smaller = self.restrict(obligation, shorter_variables, formula.args[0].op == "and")
            if smaller == obligation:
                continue
            # Obligations are monotone in their temporal variables.
            without, with_ = (self.restrict(smaller, (variable,), value) for value in (False, True))
            if obligations.either(without, obligations.both(successors.obligation(formula), with_)) == obligation:
                obligation = smaller
                removed |= shorter_variables
        return obligation

    def _with_position(self, obligation: int) -> _Positioned:
        """Return the obligation as a formula, with the position of its first part in the source formula."""
        known = self._formulas.get(obligation)
        if known is None:
            known = self._formulas[obligation] = self._write(obligation)
        return known

    def _write(self, obligation: int) -> _Positioned:
        if obligation == FALSE:
            return 0, build.FALSE
        if obligation == TRUE:
            return 0, build.TRUE
        first = self._successors.diagrams.obligations.variable[obligation]
        formula = self._successors.formulas[first]
        if formula is not None and self._successors.obligation(formula) == obligation:
            return self._literal(first, True)
        smaller = self.without_shorter_bounds(obligation)
        if smaller != obligation:
            return self._with_position(smaller)
        for absorbing, join in ((FALSE, build.and_), (TRUE, build.or_)):
            factors, rest = self._factors(obligation, absorbing)
            if factors:
                operands = [self._literal(*factor) for factor in self._drop_redundant(factors, absorbing)]
                if rest not in (FALSE, TRUE):
                    operands.append(self._with_position(rest))
                return _join(join, operands)
        terms = self._terms(obligation)
        if terms is not None:
            products = [[self._literal(*literal) for literal in self._drop_redundant(term, FALSE)] for term in terms]
            return _join(build.or_, [_join(build.and_, product) for product in products])
        obligations = self._successors.diagrams.obligations
        test = self._literal(obligations.variable[obligation], True)
        present = _join(build.and_, [test, self._with_position(obligations.high[obligation])])
        return _join(build.or_, [present, self._with_position(obligations.low[obligation])])

    def _factors(self, obligation: int, absorbing: int) -> tuple[list[tuple[int, bool]], int]:
        """Return the common factors of the obligation, and the obligation without them.

        If ``absorbing`` is FALSE, the obligation is the conjunction of its factors and the rest:
        ``a`` is a factor of ``a & (b | c)``. If ``absorbing`` is TRUE, it is their disjunction:
        ``a`` is a factor of ``a | b & c``.
        """
        factors: list[tuple[int, bool]] = []
        wanted = absorbing == FALSE
        support = self.support(obligation)
        for variable in support if len(support) <= _MOST_FACTORED else support[:1]:
            for polarity in (True, False):
                if self.restrict(obligation, (variable,), polarity != wanted) == absorbing:
                    factors.append((variable, polarity))
                    obligation = self.restrict(obligation, (variable,), polarity == wanted)
                    break
        return factors, obligation

    def _drop_redundant(self, literals: Collection[tuple[int, bool]], absorbing: int) -> list[tuple[int, bool]]:
        """Return the literals without those that are redundant beside another literal.

        The literals are operands of an ``and`` if ``absorbing`` is FALSE, of an ``or`` if it is
        TRUE. For example, ``F b`` is redundant in ``F(a & X F b) & F b``.
        """
        successors = self._successors
        variables = {variable for variable, _ in literals}
        redundant: set[int] = set()
        for variable, polarity in literals:
            formula = successors.formulas[variable]
            if polarity and formula is not None and formula.is_temporal:
                whole = successors.obligation(formula)
                redundant.update(
                    other
                    for other in variables.intersection(self.support(whole))
                    if other != variable and self.restrict(whole, (other,), absorbing == TRUE) == absorbing
                )
        return [(variable, polarity) for variable, polarity in literals if not (polarity and variable in redundant)]

    def _terms(self, obligation: int) -> list[_Term] | None:
        """Return the obligation as a disjunction of terms, which are conjunctions of literals.

        Returns None if there are more than :data:`_TERM_LIMIT` terms.
        """
        if obligation in self._sums:
            return self._sums[obligation]
        obligations = self._successors.diagrams.obligations
        variable = obligations.variable[obligation]
        absent, present = obligations.low[obligation], obligations.high[obligation]
        shared = obligations.both(absent, present)
        common, alone = self._terms(shared), self._terms(present)
        # If the variable is temporal, the obligation is monotone in it: `shared` is `absent`, and no term negates it.
        without = common if shared == absent else self._terms(absent)
        terms: list[_Term] | None = None
        if common is not None and alone is not None and without is not None:
            terms = [
                *(term | {(variable, True)} for term in alone if not any(other <= term for other in common)),
                *(term | {(variable, False)} for term in without if not any(other <= term for other in common)),
                *common,
            ]
            if len(terms) > _TERM_LIMIT:
                terms = None
        self._sums[obligation] = terms
        return terms

    def _literal(self, variable: int, polarity: bool) -> _Positioned:
        formula = self._successors.formulas[variable]
        if formula is None:
            return self._with_position(self._successors.stands_for[variable])
        place = self._position.get(formula, len(self._position) + variable)
        return place, formula if polarity else build.not_(formula)


def _is_long_bound(formula: Formula) -> bool:
    operator = bounded_operator(formula)
    return operator is not None and operator.steps > _MOST_FACTORED


def _join(join: Callable[..., Formula], operands: list[_Positioned]) -> _Positioned:
    operands.sort(key=lambda operand: operand[0])
    return operands[0][0] if operands else 0, join(*(formula for _, formula in operands))
