"""English conditions in calls of functions get those of the language, and the rest of the clause its help."""

from __future__ import annotations

import pytest

from tests.grammar.phrases_as_typed import fix
from tests.grammar.sentences import HEAD
from tltlc import compile_text

CLAUSES = {
    "keep times_since(fire, lap goes up) <= 2": "keep times_since(fire, lap > previous(lap)) <= 2",
    "keep lap increases implies times_since(fire, lap increases) >= 1": (
        "keep begins lap > previous(lap) implies previously (times_since(fire, lap > previous(lap)) >= 1)"
    ),
    "keep times(health falls below 20) <= 3": "keep times(begins (health < 20)) <= 3",
    "keep fire implies time_since(health drops below 20) > 3 s": (
        "keep fire implies time_since(begins (health < 20)) > 3 s"
    ),
    "keep health >= value_at(health, phase becomes shift) - 20": (
        "keep health >= value_at(health, begins (phase is shift)) - 20"
    ),
    "keep total_time(health is below 20) <= 3 s": "keep total_time(health < 20) <= 3 s",
    "keep time_holding(health stays the same) <= 3 s": (
        "keep time_holding(health >= previous(health) and health <= previous(health)) <= 3 s"
    ),
    "keep value_at(health, fire ends) >= 20": "keep value_at(health, ends fire) >= 20",
    "keep times_since(fire, spray starts) <= 2": "keep times_since(fire, begins spray) <= 2",
    "every fire lasts at least 3 s and at most 8 s unless spray": (
        "keep begins fire implies ((always for 3 s fire) or (fire until spray)) avoid time_holding(fire) > 8 s"
    ),
    "every fire lasts at most 8 s": "avoid time_holding(fire) > 8 s",
}
"""Clauses as typed, and as the first fixes leave them."""


@pytest.mark.parametrize("typed", CLAUSES)
def test_the_first_fix_has_the_condition(typed: str) -> None:
    text, left = fix(f"{HEAD}spec s {{\n{typed}\n}}\n")
    assert not left
    assert " ".join(text.partition("spec s {\n")[2].rstrip("}\n").split()) == CLAUSES[typed]
    compile_text(text)


def test_a_time_from_the_first_of_several_beginnings_has_a_condition() -> None:
    _, left = fix(f"{HEAD}spec s {{\nreach fire then spray then boss_dead within 6 s of the first fire\n}}\n")
    help_ = "write `reach fire then spray then (boss_dead and once within 6 s begins fire)` if `fire` begins once"
    assert [error.help for error in left] == [help_]
