"""Label each state with a short formula that says what remains to be done there.

First, temporal subformulas are removed from the state's obligation, as long as its language stays
the same. The rest of the obligation is written as a formula, and the rules of
:mod:`tltlc.logic.rewrite` simplify it. Then operands of ``and`` and ``or`` are removed, as long as
the language stays the same. A comparison with the machine, called a proof here, decides whether the
language stays the same.
"""

from __future__ import annotations

from collections.abc import Iterator

from tltlc.automaton.diagrams import OutOfSteps
from tltlc.automaton.finite.machine import Machine, matches_state
from tltlc.automaton.finite.readback import ObligationWriter
from tltlc.automaton.finite.successors import Successors
from tltlc.automaton.transitions import ACCEPT, FALSE, TRUE
from tltlc.logic import formula as build
from tltlc.logic.formula import Formula
from tltlc.logic.rewrite import simplify

_MEMBERS = 6
"""The most obligations of one state that are written as formulas.

Several obligations can have the language of one state. The smallest ones are written.
"""
_CANDIDATES = 3
"""The most formulas of one state that are shortened. The smallest ones are chosen."""

LONGEST_SIMPLIFIED = 200
"""Labels with more operators and atoms are not simplified: they are too long to read."""
_LONGEST_PROVED = 60
"""Labels with more operators and atoms are not shortened operand by operand."""

_PROOF_STEPS = 2_000
"""A proof gives up after this many steps of the diagrams."""
_PROOF_PAIRS = 100
"""A proof gives up after it has compared this many obligations with a state."""
_COST_OF_GIVING_UP = 30
"""A proof that gives up counts as this many proofs."""


class LabelsTooLong(Exception):
    """Raised when all labels together have more operators and atoms than ``WORK["label nodes"]``."""


class Labels:
    """Computes the labels of the states of a machine: formulas that say what remains to be done.

    ``work`` is the largest number of proofs (comparisons of languages) for all labels together; a
    proof that gives up counts as several. After that, the remaining labels are not shortened. The
    limit is not a time, so that the same spec always gets the same labels.
    """

    __slots__ = (
        "_allowed",
        "_known",
        "_machine",
        "_members",
        "_refuted",
        "_simplified",
        "_sizes",
        "_successors",
        "_work",
        "_writer",
    )

    def __init__(
        self, successors: Successors, machine: Machine, source: Formula, allowed: int = ACCEPT, work: int = 3_000
    ) -> None:
        self._successors = successors
        self._machine = machine
        self._allowed = allowed
        self._work = work
        self._writer = ObligationWriter(successors, source)
        self._sizes: dict[Formula, int] = {}
        self._simplified: dict[Formula, Formula] = {}
        self._known = dict(machine.representative)
        self._refuted: set[tuple[int, int]] = set()
        self._members: dict[int, list[int]] = {}
        for obligation, state in machine.representative.items():
            self._members.setdefault(state, []).append(obligation)

    def label(self, state: int) -> Formula:
        """Return a short label for a state of the machine, in negation normal form."""
        members = self._members[state]
        if len(members) == 1 and (bound := self._writer.long_bound(members[0])) is not None:
            return self.simplify_label(bound)
        if len(members) > 1:
            members = sorted(members, key=lambda obligation: len(self._writer.support(obligation)))
        obligations = dict.fromkeys((self._drop_needless_variables(members[0], state), *members[:_MEMBERS]))
        written = sorted(map(self._writer.formula, obligations), key=self.size)
        return min((self._shorten(formula, state) for formula in written[:_CANDIDATES]), key=self.size)

    def size(self, formula: Formula) -> int:
        """Return the number of operators and atoms in the formula's text."""
        for node in formula.bottom_up(known=self._sizes):
            self._sizes[node] = 1 + sum(self._sizes[argument] for argument in node.args)
        return self._sizes[formula]

    def _drop_needless_variables(self, obligation: int, state: int) -> int:
        """Return the obligation without the variables that make no difference to its language.

        An obligation is a Boolean function, and most of its variables are temporal subformulas. The
        variables with the largest formulas are tried first. ``state`` is the state of the machine
        with the same language as the obligation.
        """
        if obligation in (FALSE, TRUE):
            return obligation
        obligation = self._writer.without_shorter_bounds(obligation)
        support = self._writer.support(obligation)
        for variable in sorted(support, key=self._size_of_variable, reverse=True) if len(support) > 1 else ():
            if self._work <= 0:
                break
            for value in (False, True):
                smaller = self._writer.restrict(obligation, (variable,), value)
                if smaller != obligation and self._prove(smaller, state):
                    obligation = smaller
                    break
        return obligation

    def _size_of_variable(self, variable: int) -> int:
        formula = self._successors.formulas[variable]
        return 0 if formula is None else self.size(formula)

    def simplify_label(self, formula: Formula) -> Formula:
        """Return the formula, simplified unless it is too long to read."""
        return formula if self.size(formula) > LONGEST_SIMPLIFIED else simplify(formula, self._simplified)

    def _shorten(self, formula: Formula, state: int) -> Formula:
        formula = self.simplify_label(formula)
        tried: set[Formula] = set()
        progress = self.size(formula) <= _LONGEST_PROVED
        while progress and self._work > 0:
            progress = False
            for shorter in sorted(dict.fromkeys(_with_one_operand_less(formula)), key=self.size):
                if shorter in tried:
                    continue
                tried.add(shorter)
                if self._prove(shorter, state):
                    formula, progress = simplify(shorter, self._simplified), True
                    break
        return formula

    def _prove(self, label: Formula | int, state: int) -> bool:
        """Whether a formula or obligation certainly has the same language as a state.

        Returns False if the languages differ, if the proof gives up, or if no work is left.
        """
        if self._work <= 0:
            return False
        successors = self._successors
        try:
            with successors.diagrams.limit.at_most(_PROOF_STEPS):
                obligation = label if isinstance(label, int) else successors.obligation(label)
                if (obligation, state) in self._refuted:
                    return False
                self._work -= 1
                proved = matches_state(
                    successors, self._machine, self._known, obligation, state, _PROOF_PAIRS, self._allowed
                )
        except OutOfSteps:
            self._work -= _COST_OF_GIVING_UP
            return False
        if not proved:
            self._refuted.add((obligation, state))
        return proved


def _with_one_operand_less(formula: Formula) -> Iterator[Formula]:
    """Yield, for each operand of an ``and`` or ``or`` anywhere in the formula, the formula without that operand."""
    args = formula.args
    if formula.op in ("and", "or"):
        for index in range(len(args)):
            yield build.rebuild(formula, args[:index] + args[index + 1 :])
    for index, argument in enumerate(args):
        if argument.op != "atom":
            for smaller in _with_one_operand_less(argument):
                yield build.rebuild(formula, (*args[:index], smaller, *args[index + 1 :]))
