"""Decide whether clauses of a spec over infinite traces contradict each other."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

from tltlc.automaton.diagrams import OutOfSteps
from tltlc.automaton.finite.blowup import recursion_room
from tltlc.automaton.guards import TooManyPrimes
from tltlc.automaton.infinite.analysis import analysis_of_rabin
from tltlc.automaton.infinite.construct import rabin
from tltlc.automaton.work import OutOfWork, Work
from tltlc.logic.formula import and_
from tltlc.resolve.spec import Conjunct, Spec

_WORK: Final = 100_000
"""Steps of work after which the search gives up: a warning must not take longer than the compilation."""


def unsatisfiable(parts: Sequence[Conjunct], spec: Spec) -> bool:
    """Whether it is certain that no infinite trace satisfies all of ``parts``, which are clauses of ``spec``.

    Returns False if some trace does, or if the decision takes too much work.
    """
    whole = and_(*(part.formula for part in parts))
    names = [atom.name for atom in spec.atoms]
    try:
        with recursion_room():
            automaton = rabin(whole, names, spec.exclusive, _WORK)
            return analysis_of_rabin(automaton, Work(_WORK)).verdict(0) == "violated"
    except (OutOfWork, OutOfSteps, TooManyPrimes, RecursionError):
        return False
