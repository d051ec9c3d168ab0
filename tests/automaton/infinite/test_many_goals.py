"""Goals in any order: their automaton is given up before all sets of goals that are left are listed."""

from __future__ import annotations

import pytest

from tltlc.automaton.infinite.after_automaton import STEPS_PER_OBLIGATION, After
from tltlc.automaton.infinite.infinite import infinite_form
from tltlc.automaton.infinite.letters import Letters
from tltlc.automaton.infinite.work import OutOfWork, Work
from tltlc.logic import formula as build


def test_what_letters_lead_to_is_limited_by_the_work_that_is_left() -> None:
    goals = [build.eventually(build.atom(f"a{number}")) for number in range(40)]
    formula = infinite_form(build.and_(*goals))
    most = 1_000
    work = Work(most * STEPS_PER_OBLIGATION)
    after = After(formula.atoms(), Letters(work))
    with pytest.raises(OutOfWork):
        after.after(after.obligation(formula))
    assert len(after.letters.atom) < 10 * most
