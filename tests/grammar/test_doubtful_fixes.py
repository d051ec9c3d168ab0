"""A clause that takes one of several readings of a sentence is no fix of it."""

from __future__ import annotations

import pytest

from tltlc import compile_text
from tltlc.diagnostics.diagnostic import Diagnostic, TltlError

HEAD = """\
clock 10 Hz
signal fire: bool
signal spray: bool
signal boss_dead: bool
signal lap: int in [0, 9]
signal health in [0, 100]
signal phase: (menu, shift, results)
"""


def error_of(clause: str) -> Diagnostic:
    with pytest.raises(TltlError) as failure:
        compile_text(f"{HEAD}spec s {{\n  {clause}\n}}\n")
    return failure.value.diagnostics[0]


@pytest.mark.parametrize(
    ("typed", "offered"),
    [
        ("after fire, no fire until spray", "`keep fire implies weak_next (not fire weak_until spray)`"),
        ("once fire, no fire before spray", "`keep fire implies weak_next (not fire weak_until spray)`"),
        (
            "when fire for 3 s, spray within 2 s",
            "`keep begins (time_holding(fire) >= 3 s) implies eventually within 2 s spray`",
        ),
        ("fire implies spray before boss_dead", "`keep fire implies (not boss_dead until (spray and not boss_dead))`"),
        ("reach fire before spray", "`require not spray until (fire and not spray)`"),
        ("while fire, health never falls", "`keep fire and previously fire implies health >= previous(health)`"),
        ("in fire, health stays the same", "`keep fire and previously fire implies "),
    ],
)
def test_a_help_names_the_readings_of_a_sentence(typed: str, offered: str) -> None:
    error = error_of(typed)
    assert not error.fixes
    assert offered in (error.help or "")


def test_no_form_is_for_the_opposite_of_what_no_second_forbids() -> None:
    assert "(boss_dead weak_until" not in (error_of("after fire, no second boss_dead until spray").help or "")


def test_a_help_with_readings_says_how_many_steps_a_time_takes() -> None:
    assert "`time_holding(fire) >= 3 s` needs 31 steps" in (error_of("when fire for 3 s, spray within 2 s").help or "")


@pytest.mark.parametrize(
    ("typed", "clause"),
    [
        (
            "keep health <= value_at(health, phase changes) + 3",
            "keep health <= value_at(health, ends (phase is menu) or ends (phase is shift) or ends (phase is results))"
            " + 3",
        ),
        (
            "keep begins (health <= 0) implies fire until (spray or 5 s)",
            "keep begins (health <= 0) implies (always for 5 s fire) or (fire weak_until spray)",
        ),
        ("keep fire until spray or for 5 s", "require (always for 5 s fire) or (fire weak_until spray)"),
    ],
)
def test_a_fix_is_the_clause_of_the_only_reading(typed: str, clause: str) -> None:
    assert [edit.text for edit in error_of(typed).fixes[0].edits] == [clause]
