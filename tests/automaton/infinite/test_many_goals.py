"""Goals in any order: the construction stops before it lists every set of remaining goals."""

from __future__ import annotations

import pytest

from tltlc.automaton.diagrams import Diagrams
from tltlc.automaton.infinite.after_automaton import STEPS_PER_OBLIGATION, ObligationAutomaton
from tltlc.automaton.infinite.normal_form import infinite_form
from tltlc.automaton.work import OutOfWork, Work
from tltlc.logic import formula as build


def test_successors_are_limited_by_the_remaining_work() -> None:
    goals = [build.eventually(build.atom(f"a{number}")) for number in range(40)]
    formula = infinite_form(build.and_(*goals))
    most = 1_000
    work = Work(most * STEPS_PER_OBLIGATION)
    after = ObligationAutomaton(formula.atoms(), Diagrams(work))
    with pytest.raises(OutOfWork):
        after.after(after.obligation(formula))
    assert len(after.letters.variable) < 10 * most
