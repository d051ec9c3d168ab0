"""A monitor for each member of a group: monitors of one automaton that share its tables and nothing else."""

from __future__ import annotations

import pytest

from tests.calls import calls
from tltlc import compile_text
from tltlc.monitor import Monitor, MonitorError, RewardOptions

TEXT = """
entity guard
signal distance(g: entity): length in [0 m, 50 m]
signal mode(g: entity): (idle, alert)
param far: length in [1 m, 49 m] = 30 m
exclusive distance(guard) > far, distance(guard) < 3 m
spec rules {
    avoid distance(guard) > far and mode(guard) is alert
    reach distance(guard) < 3 m then mode(guard) is alert
}
"""
(FSPA,) = compile_text(TEXT)


def sample(distance: float, mode: str = "idle") -> dict[str, float | str]:
    return {"distance(guard)": distance, "mode(guard)": mode}


def test_another_monitor_begins_before_its_first_sample() -> None:
    first = Monitor(FSPA)
    first.step(sample(1.0))
    second = first.another()
    assert (second.state, second.steps, second.progress, second.done, second.values) == (0, 0, 0.0, False, ())
    assert second.step(sample(1.0)) == Monitor(FSPA).step(sample(1.0))


def test_steps_of_one_monitor_leave_the_others_where_they_are() -> None:
    first = Monitor(FSPA)
    second = first.another()
    second.step(sample(40.0, "alert"))
    assert second.done
    assert (first.state, first.steps, first.done) == (0, 0, False)
    third = second.another()
    assert not third.done
    assert [third.step(sample(1.0)).verdict, third.step(sample(9.0, "alert")).verdict] == ["pending", "holding"]


def test_each_monitor_has_its_own_notices() -> None:
    first = Monitor(FSPA)
    first.step(sample(60.0))
    second = first.another()
    assert (len(first.notices), second.notices) == (1, [])
    second.step(sample(70.0))
    assert [len(monitor.notices) for monitor in (first, second)] == [1, 1]
    assert "70" in second.notices[0].title


def test_params_and_reward_are_those_of_the_first() -> None:
    options = RewardOptions(mode="sparse")
    first = Monitor(FSPA, {"far": 5.0}, options)
    second = first.another()
    assert second.step(sample(9.0, "alert")) == first.step(sample(9.0, "alert"))
    assert second.done


def test_a_refused_sample_is_refused_by_every_monitor() -> None:
    with pytest.raises(MonitorError, match="no value for"):
        Monitor(FSPA).another().step({})


def test_making_another_monitor_compiles_nothing() -> None:
    first = Monitor(FSPA)
    # Measured: 8 calls, and 613 for a first monitor.
    assert calls(first.another) < 100
