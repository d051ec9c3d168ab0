"""What has to be done in a state of an automaton, in words."""

from __future__ import annotations

import pytest

from tltl_runtime.regression.stages import chain, deed, target_of, together
from tltlc import compile_text
from tltlc.automaton.fspa import Fspa


def spec(body: str, declared: str = "entity s1, s2, exit\nexclusive near(s1), near(s2), near(exit)\n") -> Fspa:
    (fspa,) = compile_text(f"import stealth\nimport spatial\n{declared}spec s {{\n limit 100 steps\n {body}\n}}\n")
    return fspa


def deeds(fspa: Fspa) -> list[str]:
    return [deed(fspa, state) for state in chain(fspa)]


def test_a_sequence_is_told_step_by_step() -> None:
    fspa = spec("reach near(s1) then near(s2) then near(exit)\n keep alive")
    assert deeds(fspa) == ["reaches `s1`", "reaches `s2`", "reaches `exit`", "meets the spec"]
    distances = [fspa.states[state].distance or 0 for state in chain(fspa)]
    assert distances == sorted(distances, reverse=True) and distances[-1] == 0


def test_what_is_reached_in_any_order() -> None:
    fspa = spec("reach near(s1)\n reach near(s2)")
    assert deed(fspa, 0) in ("reaches `s1` or `s2`", "reaches `s2` or `s1`")


def test_whichever_way_is_open_is_told() -> None:
    fspa = spec(
        "reach (open_a and near(s1)) or (open_b and near(s2))",
        "entity s1, s2\nsignal open_a: bool\nsignal open_b: bool\n",
    )
    assert deed(fspa, 0) in ("reaches `s1` or `s2`", "reaches `s2` or `s1`")


def test_deeds_together_say_once_that_they_are_reached() -> None:
    assert together(["reaches `s1`", "reaches `s2` or `s3`"]) == "reaches `s1`, then `s2` or `s3`"
    assert together(["reaches `s1`", "makes `open` true"]) == "reaches `s1`, makes `open` true"


def test_what_is_no_place_is_made_true() -> None:
    fspa = spec("reach open_door\n keep alive", "signal open_door: bool\n")
    assert deeds(fspa) == ["makes `open_door` true", "meets the spec"]


def test_what_is_not_to_hold_is_made_false() -> None:
    fspa = spec("reach not loud\n keep alive\n keep not seen", "signal loud: bool\n")
    assert deeds(fspa) == ["makes `loud` false", "meets the spec"]


def test_what_is_kept_all_the_time_is_no_deed() -> None:
    fspa = spec("reach near(s1)\n keep alive\n keep not seen", "entity s1\n")
    assert deeds(fspa)[0] == "reaches `s1`"


@pytest.mark.parametrize(("atom", "target"), [("near(s1)", "s1"), ("alive", None)])
def test_what_an_atom_measures_the_distance_to(atom: str, target: str | None) -> None:
    fspa = spec(f"reach {atom}", "entity s1\n")
    assert [target_of(each) for each in fspa.atoms] == [target]
