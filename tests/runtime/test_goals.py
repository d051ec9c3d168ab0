"""The next goals of the player are read from the automaton of the spec."""

from __future__ import annotations

import pytest

from tltl_runtime.spec.goals import next_goals
from tltl_runtime.spec.task import load_task

BRANCHING = "examples/branching.tltl:branching"
SAMPLE = {"health": 1.0, "open_left": 0.0, "open_right": 0.0} | {
    f"distance({name})": 5.0 for name in ("s1", "s2", "s3", "e_left", "e_right")
}
PLACES = ("s1", "s2", "s3", "e_left", "e_right")


@pytest.mark.parametrize(
    ("state", "opened", "goals"),
    [(0, None, ("s1",)), (1, None, ("s2",)), (4, "left", ("e_left",)), (4, "right", ("e_right",)), (4, None, ())],
)
def test_the_goals_of_branching_follow_its_state_and_the_open_branch(
    state: int, opened: str | None, goals: tuple[str, ...]
) -> None:
    task = load_task(BRANCHING)
    sample = SAMPLE | ({f"open_{opened}": 1.0} if opened else {})
    assert next_goals(task.fspa, state, sample, task.params, PLACES) == goals


def test_an_accepting_state_has_no_goals() -> None:
    task = load_task(BRANCHING)
    (accepting,) = (state.id for state in task.fspa.states if state.accepting)
    assert next_goals(task.fspa, accepting, SAMPLE, task.params, PLACES) == ()


def test_the_goal_closest_to_acceptance_comes_first() -> None:
    task = load_task("import spatial\nentity a, b\nspec either = (F (near(a) & X F near(b))) | F near(b)")
    sample = {"distance(a)": 9.0, "distance(b)": 9.0}
    assert next_goals(task.fspa, 0, sample, {"level_size": 20.0}, ("a", "b"))[0] == "b"


def test_a_goal_that_needs_a_remembered_atom_does_not_count() -> None:
    task = load_task(
        "import spatial\nentity a, b\nsignal seen: bool\nspec s = F (near(a) & times(seen) > 1) | F near(b)"
    )
    sample = {"distance(a)": 9.0, "distance(b)": 9.0, "seen": 0.0}
    assert next_goals(task.fspa, 0, sample, {"level_size": 20.0}, ("a", "b")) == ("b",)
