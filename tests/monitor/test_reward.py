"""Algorithm 1: the numbers that the paper works out, the totals of episodes, and both rules of termination."""

from __future__ import annotations

import random
from collections.abc import Sequence
from typing import Any, Literal

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.fixtures import cover_and_hide
from tests.monitor.strategies import atom_traces, automata
from tltlc.automaton.finite.build import build, spec_from_formula
from tltlc.automaton.fspa import Fspa
from tltlc.core.record import replace
from tltlc.logic import formula as f
from tltlc.monitor import Monitor, RewardOptions, Step
from tltlc.monitor.progress_and_reward import MODES, reward_step
from tltlc.monitor.tables import tables

A, P = f.atom("a"), f.atom("p")
FAR = {"distance(s1)": 20.0, "distance(s2)": 20.0, "distance(exit)": 20.0, "health": 1.0}


def automaton(formula: f.Formula, limit: int | None, judge: Literal["goal", "limit"] | None = None) -> Fspa:
    fspa = build(spec_from_formula(formula))
    return replace(fspa, limit_steps=limit, judge=judge or fspa.judge)


def episode(monitor: Monitor, trace: Sequence[tuple[float, ...]]) -> list[Step]:
    """Return the steps up to the end of the episode."""
    steps: list[Step] = []
    for values in trace:
        steps.append(monitor.step_atoms(values))
        if steps[-1].done:
            break
    return steps


def test_progress_halfway_to_the_exit_is_that_of_the_paper() -> None:
    """In `F near(e) & G alive`, at distance (b + B) / 2 and full health: 2/3 + 0.25/3 = 0.75."""
    fspa = cover_and_hide()
    outcome = reward_step(tables(fspa), 3, 3, (-1.0, -1.0, -0.75, 1.0), 2 / 3, 10)
    assert outcome.progress == pytest.approx(0.75)
    assert outcome.reward == pytest.approx(0.75 - 2 / 3 - 1 / 400)
    assert not outcome.done


def test_an_episode_of_cover_and_hide_has_the_progress_computed_by_hand() -> None:
    monitor = Monitor(cover_and_hide())
    changes: list[dict[str, float]] = [
        {},
        {"distance(s1)": 10.5},
        {"distance(s1)": 15.0},
        {"distance(s1)": 0.5},
        {"distance(s2)": 0.5},
        {"distance(exit)": 10.5},
        {"distance(exit)": 0.0},
    ]
    steps = [monitor.step({**FAR, **change}) for change in changes]
    assert [step.state for step in steps] == [0, 0, 0, 1, 3, 3, 4]
    assert [step.progress for step in steps] == pytest.approx([0, 0.25 / 3, 0.25 / 3, 1 / 3, 2 / 3, 0.75, 1])
    assert [step.done for step in steps] == [False] * 6 + [True]
    assert sum(step.reward for step in steps) == pytest.approx(1 - 7 / 400)
    after = monitor.step({**FAR, "health": 0.0})
    assert (after.verdict, after.done, after.progress, after.reward) == ("violated", True, 1.0, 0.0)


def test_a_violation_costs_the_remaining_steps() -> None:
    monitor = Monitor(cover_and_hide())
    steps = [monitor.step({**FAR, "distance(s1)": 0.0}), monitor.step({**FAR, "health": 0.0})]
    assert steps[1].reward == pytest.approx(-1 / 400 - 398 / 400)
    assert sum(step.reward for step in steps) == pytest.approx(1 / 3 - 1)


@given(st.data(), automata())
def test_every_failed_episode_totals_progress_minus_one(data: st.DataObject, fspa: Fspa) -> None:
    fspa = replace(fspa, judge="goal", limit_steps=5)
    trace = data.draw(atom_traces(fspa, max_size=5))
    steps = episode(Monitor(fspa), trace + [trace[-1]] * (5 - len(trace)))
    assert steps[-1].done
    total = sum(step.reward for step in steps)
    if steps[-1].accepting:
        assert steps[-1].progress == 1.0
        assert total == pytest.approx(1 - len(steps) / 5)
    else:
        assert total == pytest.approx(steps[-1].progress - 1)


@given(st.data(), automata())
def test_progress_is_the_best_so_far_and_rewards_are_its_increase(data: st.DataObject, fspa: Fspa) -> None:
    monitor = Monitor(replace(fspa, limit_steps=None))
    best, over = 0.0, False
    for values in data.draw(atom_traces(fspa)):
        step = monitor.step_atoms(values)
        assert 0.0 <= best <= step.progress <= 1.0
        assert step.reward == (0.0 if over else step.progress - best)
        best, over = step.progress, step.done


def test_a_spec_judged_at_its_limit_is_rewarded_for_survival() -> None:
    fspa = automaton(f.always(P), 4)
    assert (fspa.judge, fspa.spec_size) == ("limit", 0)
    alive = episode(Monitor(fspa), [(1.0,)] * 9)
    assert [(step.progress, step.done) for step in alive] == [(0.25, False), (0.5, False), (0.75, False), (1.0, True)]
    dead = episode(Monitor(fspa), [(1.0,), (1.0,), (-1.0,)])
    assert (dead[-1].progress, dead[-1].done) == (0.5, True)
    assert sum(step.reward for step in dead) == pytest.approx(0.5 - 1)


def test_a_spec_judged_at_its_limit_ends_early_when_satisfied() -> None:
    fspa = automaton(f.eventually(A), 4, "limit")
    steps = episode(Monitor(fspa), [(-1.0,), (1.0,), (1.0,)])
    assert [(step.progress, step.done) for step in steps] == [(0.25, False), (1.0, True)]


def test_without_a_limit_survival_gives_no_progress_and_steps_are_free() -> None:
    steps = episode(Monitor(automaton(f.always(P), None)), [(1.0,), (1.0,), (-1.0,), (1.0,)])
    assert [(step.progress, step.reward, step.done) for step in steps] == [(0, 0, False), (0, 0, False), (0, 0, True)]


def test_a_spec_of_size_zero_does_not_divide_by_zero() -> None:
    goal = episode(Monitor(automaton(f.always(P), 4, "goal")), [(1.0,)])
    assert (goal[0].progress, goal[0].done, goal[0].reward) == (1.0, True, 1 - 1 / 4)
    never = episode(Monitor(automaton(f.FALSE, 4, "goal")), [()])
    assert (never[0].progress, never[0].done, never[0].reward) == (0.0, True, -1.0)


def test_the_printed_algorithm_ends_one_step_later() -> None:
    """With `termination="paper"`, a success can still turn into a failure."""
    fspa = automaton(f.and_(f.eventually(A), f.always(P)), 10, "goal")
    literal = RewardOptions(termination="paper")
    reached, dead = (1.0, 1.0), (1.0, -1.0)
    assert [step.done for step in episode(Monitor(fspa), [reached, dead])] == [True]
    steps = episode(Monitor(fspa, reward=literal), [reached, reached])
    assert [(step.done, step.accepting) for step in steps] == [(False, True), (True, True)]
    assert sum(step.reward for step in steps) == pytest.approx(1 - 2 / 10)
    steps = episode(Monitor(fspa, reward=literal), [reached, dead, dead])
    assert [(step.done, step.verdict) for step in steps] == [
        (False, "holding"),
        (False, "violated"),
        (True, "violated"),
    ]
    assert sum(step.reward for step in steps) == pytest.approx(1 - 1)


def test_the_discounted_terminal_penalty_sums_discounted_steps() -> None:
    fspa = automaton(f.and_(f.eventually(A), f.always(P)), 10, "goal")
    trace = [(-1.0, 1.0), (-1.0, 1.0), (-1.0, -1.0)]
    gamma = 0.9
    options = RewardOptions(terminal_penalty="discounted", gamma=gamma)
    last = episode(Monitor(fspa, reward=options), trace)[-1]
    # The cost of the seven remaining steps, discounted to the step of the violation.
    assert last.reward == pytest.approx(-1 / 10 - sum(gamma**step / 10 for step in range(7)))
    same = episode(Monitor(fspa, reward=replace(options, gamma=1.0)), trace)[-1]
    assert same.reward == episode(Monitor(fspa), trace)[-1].reward


def test_the_nearest_improving_edge_counts() -> None:
    """Line 14 takes the most robust of several improving edges."""
    fspa = automaton(f.or_(f.eventually(f.and_(A, P)), f.eventually(f.atom("c"))), None)
    step = Monitor(fspa).step_atoms((-0.25, 0.5, -0.75))
    assert (step.progress, step.limiting) == (0.75, "a")
    step = Monitor(fspa).step_atoms((-0.75, -0.5, -0.625))
    assert (step.progress, step.limiting) == (0.375, "c")


def test_the_robustness_of_an_edge_that_is_not_taken_is_capped_at_zero() -> None:
    """In `F near(e) & G alive`, the robustness 0.5 of the edge is capped at 0."""
    outcome = reward_step(tables(cover_and_hide()), 3, 3, (-1.0, -1.0, 0.5, 1.0), 0.0, 10)
    assert outcome.progress == 2 / 3 + 1 / 3


def test_a_trap_adds_no_progress() -> None:
    """Whatever the values of the atoms, the progress so far stays as it is."""
    fspa = cover_and_hide()
    assert (fspa.states[2].verdict, fspa.states[2].distance) == ("violated", None)
    for best in (0.0, 2 / 3):
        for source in (0, 2, 3):
            assert reward_step(tables(fspa), source, 2, (1.0, 1.0, 1.0, 1.0), best, 10).progress == best


def test_the_order_of_operations_is_fixed() -> None:
    """All monitors must agree to the last bit."""
    fspa = cover_and_hide()
    rng = random.Random(1)
    for _ in range(200):
        values = (-rng.random(), -rng.random(), -rng.random(), rng.random())
        best, step = rng.random() / 2, rng.randrange(1, 399)
        outcome = reward_step(tables(fspa), 1, 1, values, best, step)
        progress = (3 - 2) / 3 + (1.0 + min(values[1], values[3])) / 3
        assert outcome.progress == max(best, progress)
        assert outcome.reward == (max(best, progress) - best) - 1 / 400


def test_a_truncated_episode_succeeds_only_at_its_goal() -> None:
    """`last` ends the episode; a failure costs the remaining steps, and a success has full progress."""
    fspa = automaton(f.eventually(A), 10)
    monitor = Monitor(fspa)
    monitor.step_atoms((-0.5,))
    step = monitor.step_atoms((-0.5,), last=True)
    assert (step.done, step.verdict, monitor.success) == (True, "pending", False)
    assert step.reward == pytest.approx(-1 / 10 - 8 / 10)
    assert monitor.step_atoms((1.0,)).reward == 0.0
    assert not monitor.success

    survive = Monitor(automaton(f.always(P), None))
    assert (survive.step_atoms((1.0,), last=True).reward, survive.success, survive.progress) == (1.0, True, 1.0)
    limited = Monitor(automaton(f.always(P), 4))
    step = limited.step_atoms((1.0,), last=True)
    assert (limited.success, step.progress) == (False, 0.25)
    assert step.reward == pytest.approx(0.25 - 1)
    literal = Monitor(automaton(f.eventually(A), 4), reward=RewardOptions(termination="paper"))
    assert (literal.step_atoms((1.0,), last=True).done, literal.success) == (True, True)


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"mode": "Sparse"}, f"mode must be one of {', '.join(map(repr, MODES))}, not 'Sparse'"),
        ({"mode": ""}, "mode must be one of"),
        ({"mode": "os"}, "mode must be one of"),
        ({"mode": None}, "mode must be one of"),
        ({"termination": "zzz"}, "termination must be one of 'entry', 'paper', not 'zzz'"),
        ({"terminal_penalty": "zzz"}, "terminal_penalty must be one of 'undiscounted', 'discounted', not 'zzz'"),
        ({"gamma": 2}, "gamma must be a number above 0 and at most 1, not 2"),
        ({"gamma": 0.0}, "gamma must be a number"),
        ({"gamma": float("nan")}, "gamma must be a number"),
        ({"gamma": "1"}, "gamma must be a number"),
    ],
)
def test_invalid_options_are_rejected(options: dict[str, Any], message: str) -> None:
    with pytest.raises(ValueError, match=message):
        RewardOptions(**options)


def test_a_monitor_rejects_other_types() -> None:
    fspa = cover_and_hide()
    with pytest.raises(TypeError, match=r"RewardOptions\(mode=\"sparse\"\), not 'sparse'"):
        Monitor(fspa, reward="sparse")  # type: ignore[arg-type]
    with pytest.raises(TypeError, match=r"an automaton is needed, not 'plan\.tltl'"):
        Monitor("plan.tltl")  # type: ignore[arg-type]
