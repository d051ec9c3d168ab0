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
