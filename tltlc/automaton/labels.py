"""What remains to be done in a state, as a formula as short as can be proved.

An obligation is written back as a formula (common factors first, operands in source order), the
named rewrites shorten it, and then every operand of an ``and`` or ``or`` is tried: it goes where
the automaton itself proves that the language stays the same without it.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator

from tltlc.automaton.diagrams import ACCEPT, FALSE, TRUE, OutOfSteps
from tltlc.automaton.machine import Machine, equivalent
from tltlc.automaton.successors import Successors
from tltlc.logic import formula as build
from tltlc.logic.formula import Formula
from tltlc.logic.rewrite import simplify

_TERM_LIMIT = 64
"""Sums of products with more terms are written as nested case distinctions instead."""

_MEMBERS = 6
_CANDIDATES = 3
"""Of the smallest obligations that a state stands for, as many are written out, and of these as many shortened."""

_MOST_FACTORED = 40
"""Obligations over more variables are written out as they are built, without a search for common factors."""

_LONGEST_SIMPLIFIED = 200
_LONGEST_PROVED = 60
"""Labels with more nodes than that are not rewritten, or not tried operand by operand: nobody reads them."""

_PROOF_STEPS = 2_000
_PROOF_PAIRS = 100
_COST_OF_GIVING_UP = 30
"""A proof is given up after so many steps or pairs of states, and then counts as so many more."""

_Term = frozenset[tuple[int, bool]]


class Labels:
    """The labels of one machine's states.

    ``work`` bounds the proofs tried for all labels together; when it is spent, labels stay as they
    are.  A count and not a clock, so that equal input gives equal output.
    """

    __slots__ = ("_allowed", "_machine", "_members", "_position", "_sizes", "_successors", "_sums", "_work", "_written")

    def __init__(
        self, successors: Successors, machine: Machine, source: Formula, allowed: int = ACCEPT, work: int = 3_000
    ) -> None:
        self._successors = successors
        self._machine = machine
        self._allowed = allowed
        self._work = work
        self._position = {part: index for index, part in enumerate(source.walk())}
        self._sizes: dict[Formula, int] = {}
        self._written: dict[int, tuple[int, Formula]] = {}
        self._sums: dict[int, list[_Term] | None] = {FALSE: [], TRUE: [frozenset()]}
        self._members: dict[int, list[int]] = {}
        for obligation, state in machine.representative.items():
            self._members.setdefault(state, []).append(obligation)

    def label(self, state: int) -> Formula:
        """The shortest label found for a state of the machine, in negation normal form."""
        members = self._members[state]
        if len(members) > 1:
            members = sorted(members, key=lambda obligation: len(self._support(obligation)))
        written = sorted((self.written(obligation) for obligation in members[:_MEMBERS]), key=self.size)
        return min((self._shortened(formula, state) for formula in written[:_CANDIDATES]), key=self.size)

    def size(self, formula: Formula) -> int:
        """The number of nodes of the formula as it is written; remembered, since labels share their parts."""
        for node in formula.bottom_up(known=self._sizes):
            self._sizes[node] = 1 + sum(self._sizes[argument] for argument in node.args)
        return self._sizes[formula]

    def written(self, obligation: int) -> Formula:
        """The formula of an obligation, common factors first, operands in source order."""
        return self._ordered(obligation)[1]

    # --- writing an obligation out ------------------------------------------------------------

    def _ordered(self, obligation: int) -> tuple[int, Formula]:
        """The place of the formula's first part in the source, and the formula of the obligation."""
        known = self._written.get(obligation)
        if known is None:
            known = self._written[obligation] = self._write(obligation)
        return known

    def _write(self, obligation: int) -> tuple[int, Formula]:
        if obligation == FALSE:
            return 0, build.FALSE
        if obligation == TRUE:
            return 0, build.TRUE
        for absorbing, join in ((FALSE, build.and_), (TRUE, build.or_)):
            factors, rest = self._factors(obligation, absorbing)
            if factors:
                operands = [self._literal(*factor) for factor in factors]
                if rest not in (FALSE, TRUE):
                    operands.append(self._ordered(rest))
                return _joined(join, operands)
        terms = self._terms(obligation)
        if terms is not None:
            return _joined(
                build.or_, [_joined(build.and_, [self._literal(*literal) for literal in term]) for term in terms]
            )
        diagrams = self._successors.diagrams
        test = self._literal(diagrams.variable[obligation], True)
        present = _joined(build.and_, [test, self._ordered(diagrams.present[obligation])])
        return _joined(build.or_, [present, self._ordered(diagrams.absent[obligation])])

    def _factors(self, obligation: int, absorbing: int) -> tuple[list[tuple[int, bool]], int]:
        """The literals without (for TRUE: with) which the obligation is ``absorbing``, and what is left of it."""
        factors: list[tuple[int, bool]] = []
        wanted = absorbing == FALSE
        support = self._support(obligation)
        for variable in support if len(support) <= _MOST_FACTORED else support[:1]:
            for polarity in (True, False):
                if self._restricted(obligation, variable, polarity != wanted) == absorbing:
                    factors.append((variable, polarity))
                    obligation = self._restricted(obligation, variable, polarity == wanted)
                    break
        return factors, obligation

    def _support(self, obligation: int) -> list[int]:
        diagrams = self._successors.diagrams
        seen, stack = {FALSE, TRUE, obligation}, [obligation]
        variables: set[int] = set()
        while stack:
            node = stack.pop()
            if node in (FALSE, TRUE):
                continue
            variables.add(diagrams.variable[node])
            for child in (diagrams.absent[node], diagrams.present[node]):
                if child not in seen:
                    seen.add(child)
                    stack.append(child)
        return sorted(variables)

    def _restricted(self, obligation: int, variable: int, value: bool) -> int:
        """The obligation where a variable is known to hold or not."""
        diagrams = self._successors.diagrams
        memo: dict[int, int] = {}

        def restrict(node: int) -> int:
            tested = diagrams.variable[node]
            if tested > variable:
                return node
            if tested == variable:
                return diagrams.present[node] if value else diagrams.absent[node]
            result = memo.get(node)
            if result is None:
                absent, present = restrict(diagrams.absent[node]), restrict(diagrams.present[node])
                result = memo[node] = diagrams.obligation(tested, absent, present)
            return result

        return restrict(obligation)

    def _terms(self, obligation: int) -> list[_Term] | None:
        """A sum of products of the obligation, or None where it has too many terms."""
        if obligation in self._sums:
            return self._sums[obligation]
        diagrams = self._successors.diagrams
        variable = diagrams.variable[obligation]
        absent, present = diagrams.absent[obligation], diagrams.present[obligation]
        shared = diagrams.both(absent, present)
        common, alone = self._terms(shared), self._terms(present)
        # A temporal variable only ever helps: then `shared` is `absent`, and no term asks for its absence.
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

    def _literal(self, variable: int, polarity: bool) -> tuple[int, Formula]:
        formula = self._successors.formulas[variable]
        if formula is None:
            return self._ordered(self._successors.stands_for[variable])
        place = self._position.get(formula, len(self._position) + variable)
        return place, formula if polarity else build.not_(formula)

    # --- shortening ---------------------------------------------------------------------------

    def simplified(self, formula: Formula) -> Formula:
        """The formula after the named rewrites, unless it is too long for anybody to read."""
        return formula if self.size(formula) > _LONGEST_SIMPLIFIED else simplify(formula)

    def _shortened(self, formula: Formula, state: int) -> Formula:
        formula = self.simplified(formula)
        tried: set[Formula] = set()
        progress = self.size(formula) <= _LONGEST_PROVED
        while progress and self._work > 0:
            progress = False
            for shorter in sorted({simplify(f): None for f in _with_one_operand_less(formula)}, key=self.size):
                if shorter in tried or self.size(shorter) >= self.size(formula):
                    continue
                tried.add(shorter)
                if self._proved(shorter, state):
                    formula, progress = shorter, True
                    break
        return formula

    def _proved(self, formula: Formula, state: int) -> bool:
        self._work -= 1
        try:
            with self._successors.diagrams.at_most(_PROOF_STEPS):
                obligation = self._successors.obligation(formula)
                return equivalent(self._successors, self._machine, obligation, state, _PROOF_PAIRS, self._allowed)
        except OutOfSteps:
            self._work -= _COST_OF_GIVING_UP
            return False


def _joined(join: Callable[..., Formula], operands: list[tuple[int, Formula]]) -> tuple[int, Formula]:
    operands.sort(key=lambda operand: operand[0])
    return operands[0][0] if operands else 0, join(*(formula for _, formula in operands))


def _with_one_operand_less(formula: Formula) -> Iterator[Formula]:
    """The formula with one operand of one ``and`` or ``or`` in it left out, for each such operand."""
    args = formula.args
    if formula.op in ("and", "or"):
        for index in range(len(args)):
            yield build.rebuild(formula, args[:index] + args[index + 1 :])
    for index, argument in enumerate(args):
        if argument.op != "atom":
            for smaller in _with_one_operand_less(argument):
                yield build.rebuild(formula, (*args[:index], smaller, *args[index + 1 :]))
