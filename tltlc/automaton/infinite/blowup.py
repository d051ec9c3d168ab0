"""Find the clauses of a spec over infinite traces that make its automaton too expensive."""

from __future__ import annotations

from typing import Final

from tltlc.automaton.diagrams import OutOfSteps
from tltlc.automaton.finite.blowup import ADVICE, ClauseSize, error_with_clauses, failure_text
from tltlc.automaton.guards import TooManyPrimes
from tltlc.automaton.infinite.construct import rabin
from tltlc.automaton.work import OutOfWork
from tltlc.diagnostics.diagnostic import TltlError
from tltlc.resolve.spec import Conjunct, Spec

_FOR_A_PART: Final = 500_000
"""Steps of work for the automaton of one clause alone: enough to compare the clauses, few enough to be quick."""
_FOR_ALL_PARTS: Final = 2_000_000
"""Steps of work for the automata of all clauses together."""


def budget_error(spec: Spec, reason: Exception) -> TltlError:
    """Return the error for a spec whose automaton is too expensive.

    ``reason`` is the exception that stopped the construction. The error is TLT0502 if there are too
    many edges or prime implicants, and TLT0501 otherwise.
    """
    too_large, advice = failure_text(reason), ADVICE
    if isinstance(reason, OutOfWork):
        too_large, advice = "takes too long to build", f"{ADVICE}; or allow more work with `--state-budget`"
    remaining = _FOR_ALL_PARTS

    def size(part: Conjunct, spec: Spec) -> ClauseSize | None:
        nonlocal remaining
        if remaining < _FOR_A_PART:
            # The budget for measuring is used up. The message names the three largest clauses, and more have been
            # measured by now. Size 0 puts this clause behind them.
            return ClauseSize(0, "")
        try:
            automaton = rabin(part.formula, [atom.name for atom in spec.atoms], spec.exclusive, _FOR_A_PART)
        except (OutOfWork, OutOfSteps, TooManyPrimes, RecursionError):
            remaining -= _FOR_A_PART
            return None
        remaining -= _FOR_A_PART - automaton.letters.work.left
        states, pairs = len(automaton.steps), automaton.pairs
        words = f"{states} state{'s' * (states != 1)} and {pairs} pair{'s' * (pairs != 1)}"
        return ClauseSize(states * max(pairs, 1), words)

    return error_with_clauses(spec, reason, too_large, size, advice)
