from __future__ import annotations

import pytest

from tltl_runtime.stealth.enemies import branches
from tltl_runtime.stealth.enemies.behaviour import (
    FAILURE,
    RUNNING,
    SUCCESS,
    TreeNode,
    action,
    condition,
    selector,
    sequence,
)


def leaf(status: int, ticks: list[int]) -> TreeNode:
    def tick(_: object) -> int:
        ticks.append(status)
        return status

    return tick


@pytest.mark.parametrize(
    ("statuses", "result", "ticked"),
    [
        ((FAILURE, FAILURE), FAILURE, 2),
        ((FAILURE, RUNNING, SUCCESS), RUNNING, 2),
        ((SUCCESS, RUNNING), SUCCESS, 1),
    ],
)
def test_a_selector_stops_at_the_first_child_that_does_not_fail(
    statuses: tuple[int, ...], result: int, ticked: int
) -> None:
    ticks: list[int] = []
    assert selector(*(leaf(status, ticks) for status in statuses))(None) == result
    assert len(ticks) == ticked


@pytest.mark.parametrize(
    ("statuses", "result", "ticked"),
    [
        ((SUCCESS, SUCCESS), SUCCESS, 2),
        ((SUCCESS, RUNNING, FAILURE), RUNNING, 2),
        ((FAILURE, SUCCESS), FAILURE, 1),
    ],
)
def test_a_sequence_continues_while_its_children_succeed(statuses: tuple[int, ...], result: int, ticked: int) -> None:
    ticks: list[int] = []
    assert sequence(*(leaf(status, ticks) for status in statuses))(None) == result
    assert len(ticks) == ticked


def test_conditions_and_actions_get_the_agent() -> None:
    assert condition(lambda number: number > 3)(4) == SUCCESS
    assert condition(lambda number: number > 3)(3) == FAILURE
    assert action(lambda number: number > 3)(4) == SUCCESS
    assert action(lambda number: number > 3)(3) == RUNNING


def test_check_gaps_is_the_only_optional_branch() -> None:
    assert branches.added_branches() == ("check_gaps",)
    with pytest.raises(ValueError, match="'fly' is not one of the optional branches: check_gaps"):
        branches.tree(("fly",))
    with pytest.raises(ValueError, match="'chase' is not one of the optional branches"):
        branches.tree(("chase",))


def test_a_decorated_function_adds_a_branch(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(branches, "_BRANCHES", dict(branches._BRANCHES))

    class Dancer:
        knows = False
        search_left = 0.0
        is_off_route = False
        danced = 0

    @branches.branch("dance", rank=45, added=True)
    def dance() -> TreeNode:
        def step(dancer: Dancer) -> bool:
            dancer.danced += 1
            return False

        return action(step)

    dancer = Dancer()
    assert branches.tree(("dance",))(dancer) == RUNNING
    assert dancer.danced == 1
    with pytest.raises(ValueError, match="the branch 'dance' already exists"):
        branches.branch("dance", rank=1)(dance)
