"""Sentences whose first reading would mislead get the others, and no clause that no trace can meet."""

from __future__ import annotations

import pytest

from tests.grammar.phrases_as_typed import errors
from tests.grammar.test_english_sentences import HEAD
from tltlc.core.source import SourceFile

HELPS = {
    "keep begins fire and phase is menu implies not fire before phase is shift": (
        "write `keep begins fire and phase is menu implies (phase is not shift weak_until not fire)` "
        "if `not fire` must come before `phase is shift`, or with it, "
        "or `keep begins fire and phase is menu implies weak_next (not fire weak_until phase is shift)` "
        "if `fire` must not hold again before `phase is shift`"
    ),
    "keep times(fire) <= 2 between spray and spray": "write `keep times_since(fire, spray) <= 2`",
    "keep times(fire) <= 2 between spray and the next spray": "write `keep times_since(fire, spray) <= 2`",
    "keep times(fire) <= 2 between spray and boss_dead": (
        "write `keep (not boss_dead since begins spray) implies times_since(fire, begins spray) <= 2`"
    ),
    "keep fire implies spray and ends spray within 1 s": (
        "write `keep fire implies spray and eventually within 1 s ends spray`"
    ),
    "keep fire implies once in the last 60 s spray": "write `keep fire implies once within 60 s spray`",
    "health is never below 20 for more than 10 s": "write `avoid time_holding(health < 20) > 10 s`",
}


@pytest.mark.parametrize("typed", HELPS)
def test_the_help_has_the_readings(typed: str) -> None:
    left = errors(SourceFile("a.tltl", f"{HEAD}spec s {{\n{typed}\n}}\n"))
    assert [(error.help or "").splitlines()[0] for error in left] == [HELPS[typed]]
