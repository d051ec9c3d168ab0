"""What has to be done in a state of an automaton, in words."""

from __future__ import annotations

import pytest

from tltl_runtime.regression.explain.stages import deed, deed_of_all, near_enough, target_of, together
from tltlc import compile_text
from tltlc.automaton.fspa import Fspa


def spec(body: str, declared: str = "entity s1, s2, exit\nexclusive near(s1), near(s2), near(exit)\n") -> Fspa:
    (fspa,) = compile_text(f"import stealth\nimport spatial\n{declared}spec s {{\n limit 100 steps\n {body}\n}}\n")
    return fspa


def deeds(fspa: Fspa) -> list[str]:
    """Of the states that are not traps, the farthest first."""
    states = [each for each in fspa.states if each.distance is not None]
    return [deed(fspa, each.id) for each in sorted(states, key=lambda each: -(each.distance or 0))]


def test_a_sequence_is_told_step_by_step() -> None:
    fspa = spec("reach near(s1) then near(s2) then near(exit)\n keep alive")
    assert deeds(fspa) == ["reaches `s1`", "reaches `s2`", "reaches `exit`", "meets the spec"]


def test_what_is_reached_in_any_order() -> None:
    fspa = spec("reach near(s1)\n reach near(s2)")
    assert deed(fspa, 0) in ("reaches `s1` or `s2`", "reaches `s2` or `s1`")


def test_the_deed_of_several_states_is_theirs_where_it_is_the_same() -> None:
    fspa = spec("reach near(s1)\n reach near(s2)\n reach near(exit)")
    two, one = ([each.id for each in fspa.states if each.distance == distance] for distance in (2, 1))
    assert deed_of_all(fspa, one[:1], 1) == deed(fspa, one[0])
    assert deed_of_all(fspa, two, 2) == "comes within 1 transition of acceptance"
    assert deed_of_all(fspa, one, 1) == "meets the spec"
    assert deed_of_all(fspa, (*two, *one), 3) == "comes within 2 transitions of acceptance"


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


def test_to_stay_near_something_is_no_deed() -> None:
    fspa = spec("reach near(s1) then open_door\n keep near(s2, 9 m)", "entity s1, s2\nsignal open_door: bool\n")
    assert deeds(fspa)[:2] == ["reaches `s1`", "makes `open_door` true"]


AWAY = "entity s1\npredicate away(x: entity) = clamp(distance(x) / 5 m - 1, -1, 1)\n"
BESIDE = "entity s1\npredicate beside(x: entity) = clamp(1 - abs(distance(x) - 3 m) / 1 m, -1, 1)\n"


def test_to_go_away_is_not_to_reach() -> None:
    assert deeds(spec("reach near(s1) then away(s1)", AWAY))[:2] == ["reaches `s1`", "makes `away(s1)` true"]


@pytest.mark.parametrize(
    ("atom", "declared", "target"),
    [
        ("near(s1)", "entity s1\n", "s1"),
        ("alive", "", None),
        ("away(s1)", AWAY, None),
        ("beside(s1)", BESIDE, None),
    ],
)
def test_what_an_atom_asks_to_come_near_to(atom: str, declared: str, target: str | None) -> None:
    fspa = spec(f"reach {atom}", declared)
    assert [target_of(fspa, each) for each in range(len(fspa.atoms))] == [target]


@pytest.mark.parametrize(
    ("goal", "metres"),
    [
        ("near(s1)", 1.0),
        ("near(s1, 2.5 m)", 2.5),
        ("inside_sphere(s1, 3 m)", 3.0),
        ("near(s1, arm)", None),
        ("facing(s1)", None),
    ],
)
def test_how_near_is_near_enough(goal: str, metres: float | None) -> None:
    fspa = spec(f"reach {goal}", "entity s1\nparam arm: length = 2 m\n")
    assert near_enough(fspa, 0, {"level_size": 30.0}) == (None if metres is None else pytest.approx(metres, abs=1e-3))
