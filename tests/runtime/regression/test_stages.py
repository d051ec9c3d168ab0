"""The description of the stage of a spec in a state of its automaton."""

from __future__ import annotations

import pytest

from tltl_runtime.regression.explain.open_goals import OpenGoals, open_goals, subgoal_of_all
from tltl_runtime.regression.explain.stages import (
    Subgoal,
    is_opposite_asked,
    near_enough,
    subgoal,
    subgoals_phrase,
    target_of,
)
from tltlc import compile_text
from tltlc.automaton.fspa import Fspa


def spec(body: str, declared: str = "entity s1, s2, exit\nexclusive near(s1), near(s2), near(exit)\n") -> Fspa:
    (fspa,) = compile_text(f"import stealth\nimport spatial\n{declared}spec s {{\n limit 100 steps\n {body}\n}}\n")
    return fspa


def subgoals(fspa: Fspa) -> list[str]:
    """The descriptions of the states that are not traps, by decreasing distance."""
    states = [state for state in fspa.states if state.distance is not None]
    return [subgoal(fspa, state.id).text for state in sorted(states, key=lambda state: -(state.distance or 0))]


def test_a_sequence_has_one_stage_per_state() -> None:
    fspa = spec("reach near(s1) then near(s2) then near(exit)\n keep alive")
    assert subgoals(fspa) == ["reaches `s1`", "reaches `s2`", "reaches `exit`", "meets the spec"]


def test_goals_in_any_order_are_alternatives() -> None:
    fspa = spec("reach near(s1)\n reach near(s2)")
    assert subgoal(fspa, 0).text in ("reaches `s1` or `s2`", "reaches `s2` or `s1`")


def test_states_with_one_stage_share_its_description() -> None:
    fspa = spec("reach near(s1)\n reach near(s2)\n reach near(exit)")
    two, one = ([state.id for state in fspa.states if state.distance == distance] for distance in (2, 1))
    assert subgoal_of_all(fspa, one[:1], 1).text == subgoal(fspa, one[0]).text
    assert subgoal_of_all(fspa, two, 2).text == "reaches 2 of the 3 goals `s1`, `s2` and `exit`"
    assert subgoal_of_all(fspa, one, 1).text == "meets the spec"


def test_stages_without_plain_goals_are_counted_as_steps() -> None:
    fspa = spec(
        "require eventually (near(s1) and next eventually near(exit))\n"
        "require eventually (near(s2) and next eventually near(exit))"
    )
    states = {distance: [state.id for state in fspa.states if state.distance == distance] for distance in (2, 3)}
    assert subgoal_of_all(fspa, states[2], 2).text == "comes to the last step of the spec"
    assert subgoal_of_all(fspa, states[2] + states[3], 3).text == "comes to the last 2 steps of the spec"


def test_goals_in_any_order_are_reached_or_open() -> None:
    declared = "entity s1\nsignal open_door: bool\nsignal x: length in [0 m, 9 m]\n"
    fspa = spec("reach near(s1)\n reach open_door\n reach x >= 7 m\n keep alive", declared)
    goals = {(its.reached, its.open) for state in fspa.states if (its := open_goals(fspa, state.id))}
    assert (("s1", "x >= 7"), ("open_door",)) in goals
    assert (("s1", "open_door", "x >= 7"), ()) in goals
    assert open_goals(fspa, 0) == OpenGoals((), ("s1", "open_door", "x >= 7"))


@pytest.mark.parametrize("body", ["reach near(s1) then near(s2)", "reach near(s1)", "reach near(s1) reach not alive"])
def test_other_specs_have_no_goals_in_any_order(body: str) -> None:
    assert open_goals(spec(body), 0) is None


def test_alternatives_of_several_atoms_share_the_verb() -> None:
    fspa = spec("reach (b and c) or d", "".join(f"signal {name}: bool\n" for name in "bcd"))
    assert subgoal(fspa, 0).text == "makes `d`, or both `b` and `c`, true"


@pytest.mark.parametrize(
    ("body", "text"),
    [
        ("reach (a and b) or (b and c) or (c and d)", "meets the spec"),
        ("reach a or b or c or d", "makes `a`, `b`, `c` or `d` true"),
        ("reach (a and b) or (b and c) or (c and d) then a", "comes to the last step of the spec"),
    ],
)
def test_many_alternatives_of_several_atoms_are_not_listed(body: str, text: str) -> None:
    fspa = spec(body, "".join(f"signal {name}: bool\n" for name in "abcd"))
    assert subgoal(fspa, 0).text == text


def test_atoms_that_hold_together_are_listed() -> None:
    fspa = spec("reach a reach b reach c", "".join(f"signal {name}: bool\n" for name in "abc"))
    assert subgoal(fspa, 0).text == "makes `a`, `b` and `c` true"


def test_alternative_goals_are_all_named() -> None:
    fspa = spec(
        "reach (open_a and near(s1)) or (open_b and near(s2))",
        "entity s1, s2\nsignal open_a: bool\nsignal open_b: bool\n",
    )
    assert subgoal(fspa, 0).text in ("reaches `s1` or `s2`", "reaches `s2` or `s1`")


def test_joined_stages_share_the_verb() -> None:
    assert (
        subgoals_phrase([Subgoal((("s1",),)), Subgoal((("s2",), ("s3",)), is_choice=True)]).text
        == "reaches `s1`, then `s2` or `s3`"
    )
    assert (
        subgoals_phrase([Subgoal((("s1",),)), Subgoal(other="makes `open` true")]).text
        == "reaches `s1`, makes `open` true"
    )


def test_an_atom_without_a_target_is_made_true() -> None:
    fspa = spec("reach open_door\n keep alive", "signal open_door: bool\n")
    assert subgoals(fspa) == ["makes `open_door` true", "meets the spec"]


def test_a_negated_goal_is_made_false() -> None:
    fspa = spec("reach not loud\n keep alive\n keep not seen", "signal loud: bool\n")
    assert subgoals(fspa) == ["makes `loud` false", "meets the spec"]


COMPARED = "signal x: length in [0 m, 9 m]\nsignal v: speed in [0 m/s, 9 m/s]\n"


def test_a_goal_with_an_inclusive_comparison_is_said_as_it_is_written() -> None:
    fspa = spec("reach x >= 7 m and v > 1 m/s then x <= 1 m\n keep v <= 8 m/s", COMPARED)
    assert subgoals(fspa) == ["makes `x >= 7` and `v > 1` true", "makes `x <= 1` true", "meets the spec"]
    asked = [atom.opposite for row, atom in enumerate(fspa.atoms) if is_opposite_asked(fspa, row)]
    assert asked == ["x >= 7", "x <= 1"]
    assert subgoals(spec("reach x >= 7 m", COMPARED)) == ["makes `x >= 7` true", "meets the spec"]


def test_an_invariant_is_no_stage() -> None:
    fspa = spec("reach near(s1)\n keep alive\n keep not seen", "entity s1\n")
    assert subgoals(fspa)[0] == "reaches `s1`"


def test_staying_near_an_entity_is_no_stage() -> None:
    fspa = spec("reach near(s1) then open_door\n keep near(s2, 9 m)", "entity s1, s2\nsignal open_door: bool\n")
    assert subgoals(fspa)[:2] == ["reaches `s1`", "makes `open_door` true"]


AWAY = "entity s1\npredicate away(x: entity) = clamp(distance(x) / 5 m - 1, -1, 1)\n"
BESIDE = "entity s1\npredicate beside(x: entity) = clamp(1 - abs(distance(x) - 3 m) / 1 m, -1, 1)\n"


def test_moving_away_is_not_reaching() -> None:
    assert subgoals(spec("reach near(s1) then away(s1)", AWAY))[:2] == ["reaches `s1`", "makes `away(s1)` true"]


@pytest.mark.parametrize(
    ("atom", "declared", "target"),
    [
        ("near(s1)", "entity s1\n", "s1"),
        ("alive", "", None),
        ("away(s1)", AWAY, None),
        ("beside(s1)", BESIDE, None),
    ],
)
def test_the_target_of_an_atom(atom: str, declared: str, target: str | None) -> None:
    fspa = spec(f"reach {atom}", declared)
    assert [target_of(fspa, index) for index in range(len(fspa.atoms))] == [target]


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
def test_the_distance_below_which_an_atom_holds(goal: str, metres: float | None) -> None:
    fspa = spec(f"reach {goal}", "entity s1\nparam arm: length = 2 m\n")
    assert near_enough(fspa, 0, {"level_size": 30.0}) == (None if metres is None else pytest.approx(metres, abs=1e-3))
