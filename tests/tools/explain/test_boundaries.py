"""What explanations say of the steps at the edges of goals, times and events."""

from __future__ import annotations

import pytest

from tltlc.automaton.fspa import Fspa
from tltlc.monitor import Monitor
from tltlc.pipeline import compile_text
from tltlc.tools.explain.boundaries import boundaries

SIGNALS = "clock 2 Hz\nsignal a: bool\nsignal b: bool\nsignal x: int in [0, 9]\n"


def _spec(clause: str) -> Fspa:
    return compile_text(f"{SIGNALS}spec s {{\n    {clause}\n}}\n")[0]


def _verdict(fspa: Fspa, *steps: str) -> str:
    """Return the verdict after these steps: each has the names of the bools that hold."""
    monitor = Monitor(fspa)
    return [monitor.step({"a": "a" in names, "b": "b" in names, "x": 0}).verdict for names in steps][-1]


def test_a_later_goal_may_have_begun_before() -> None:
    fspa = _spec("reach a then b")
    assert boundaries(fspa) == (
        "then b: any later step counts, also if it began before; `begins` asks for a beginning",
        "before its turn, a goal does not count, and breaks nothing",
    )
    assert _verdict(fspa, "b", "ab") == "pending" and _verdict(fspa, "b", "ab", "b") == "satisfied"


def test_a_goal_that_begins_is_told_of_the_first_step_alone() -> None:
    fspa = _spec("reach begins a")
    assert boundaries(fspa) == (
        "a begins: at the first of its steps in a row; also at the first step of play, if it holds there",
    )
    assert _verdict(fspa, "a") == "satisfied"
    assert not any(text.startswith("then") for text in boundaries(_spec("reach b then begins a")))


@pytest.mark.parametrize("time", ["", "within 300 s "])
def test_a_goal_after_an_earlier_one_is_told_as_one_behind_then(time: str) -> None:
    fspa = _spec(f"require eventually {time}(b and previously once a)")
    assert boundaries(fspa)[0] == (
        "then b: any later step counts, also if it began before; `begins` asks for a beginning"
    )
    assert _verdict(fspa, "ab", "b") == "satisfied"


def test_an_answer_may_come_at_the_last_step_and_counts_as_missed_where_play_ends() -> None:
    fspa = _spec("keep a implies eventually within 1 s b")
    assert boundaries(fspa) == (
        "within 1 s: up to and including the step 1 s later",
        "where play ends before that, what has not come counts as missed",
    )
    assert _verdict(fspa, "a", "", "b") == "holding" and _verdict(fspa, "a", "", "") == "violated"
    assert _verdict(fspa, "a", "") == "pending"


def test_a_time_after_which_something_is_forbidden_includes_its_last_step() -> None:
    fspa = _spec("avoid a then within 1 s a")
    assert boundaries(fspa)[-2:] == (
        "for the next 1 s: up to and including the step 1 s later",
        "where play ends during such a time, nothing more is asked for",
    )
    assert _verdict(fspa, "a", "", "a") == "violated" and _verdict(fspa, "a", "", "", "a") == "holding"
    assert _verdict(fspa, "a") == "holding"


def test_a_time_ends_before_the_step_that_much_later() -> None:
    fspa = _spec("keep a implies always for 2 s b")
    assert boundaries(fspa) == (
        "for 2 s: from that step on, but no longer at the step 2 s later",
        "where play ends during such a time, nothing more is asked for",
    )
    assert _verdict(fspa, "ab", "b", "b", "b", "") == "holding" and _verdict(fspa, "ab", "b", "b", "") == "violated"
    assert _verdict(fspa, "ab", "b") == "holding"


@pytest.mark.parametrize(
    ("clause", "text", "number"),
    [
        ("avoid time_holding(a) > 1 s", "a for more than 1 s: from the 4th step in a row with a", 4),
        ("avoid time_holding(a) >= 1 s", "a for at least 1 s: from the 3rd step in a row with a", 3),
        ("keep time_holding(a) <= 5 s", "a for more than 5 s: from the 12th step in a row with a", 12),
        ("keep time_holding(not a) < 0.5 s", "not a for at least 0.5 s: from the 2nd step in a row with not a", 2),
    ],
)
def test_a_time_in_a_row_is_told_in_steps(clause: str, text: str, number: int) -> None:
    fspa = _spec(clause)
    assert boundaries(fspa) == (text,)
    held = "" if "not a" in clause else "a"
    assert _verdict(fspa, *[held] * (number - 1)) == "holding" and _verdict(fspa, *[held] * number) == "violated"


def test_what_lasts_from_an_answer_on_may_have_ended_before() -> None:
    fspa = _spec("keep a implies eventually within 2 s always b")
    assert "what must hold from then on may also hold and end again before that step" in boundaries(fspa)
    assert _verdict(fspa, "ab", "", "b") == "holding"


def test_a_value_at_an_event_is_new_at_its_step() -> None:
    fspa = _spec("keep ends a implies x == value_at(x, begins b)")
    assert "the x when b last began: at the start of b itself, the one of that step" in boundaries(fspa)


def test_bounds_in_one_goal_after_another_are_those_of_the_text() -> None:
    fspa = _spec("reach a then within 2 s b")
    assert "within 2 s: up to and including the step 2 s later" in boundaries(fspa)
    assert _verdict(fspa, "a", "", "", "", "b") == "satisfied"


def test_a_timer_is_told_as_the_bound_that_it_takes_the_place_of() -> None:
    texts = [
        boundaries(
            compile_text(f"clock {rate} Hz\nsignal a: bool\nsignal b: bool\nspec s {{ keep a implies {answer} }}")[0]
        )
        for rate in (2, 60)
        for answer in ("eventually within 3 s b", "always for 4 s b")
    ]
    assert texts[:2] == texts[2:]


def test_over_infinite_traces_there_are_none() -> None:
    (fspa,) = compile_text(f"{SIGNALS}spec s {{\n    semantics infinite\n    keep a implies eventually b\n}}\n")
    assert boundaries(fspa) == ()


def test_the_step_that_ends_an_until_is_free() -> None:
    fspa = _spec("require a weak_until b")
    assert boundaries(fspa) == ("until b: at that step itself, a is not asked for",)
    assert _verdict(fspa, "a", "b") == "satisfied"


@pytest.mark.parametrize("clause", ["keep times_within(a, 2 s) <= 1", "keep ends b implies once within 2 s begins a"])
def test_the_step_at_the_edge_of_the_last_seconds_counts(clause: str) -> None:
    assert "in the last 2 s: at this step, or at one up to and including the step 2 s before" in boundaries(
        _spec(clause)
    )


def test_the_edge_of_the_last_seconds_is_where_it_is_told() -> None:
    fspa = _spec("keep times_within(a, 2 s) <= 1")
    assert _verdict(fspa, "a", "", "", "", "a") == "violated"
    assert _verdict(fspa, "a", "", "", "", "", "a") == "holding"


def test_the_step_of_an_event_counts_since_it() -> None:
    fspa = _spec("keep b implies times_since(a, b) <= 0")
    assert boundaries(fspa) == ("a since b: what begins at that very step counts, what goes on from before does not",)
    assert _verdict(fspa, "", "ab") == "violated" and _verdict(fspa, "a", "ab") == "holding"


def test_a_time_in_all_does_not_count_the_first_step() -> None:
    fspa = _spec("keep total_time(a) <= 0.5 s")
    assert boundaries(fspa) == (
        "how long a has held in all: the first step of play adds nothing, since no time has passed",
    )
    assert _verdict(fspa, "a", "a") == "holding" and _verdict(fspa, "", "a", "a") == "violated"


def test_a_sum_of_fractions_may_miss_an_exact_limit_by_rounding() -> None:
    text = "results with fractions are rounded: an exact limit may be missed by the last digit"
    head = "signal vent in [0, 100]\nsignal n: int in [0, 9]\nspec s {{ keep {0} >= previous({0}) - 5 }}"
    (fractions,), (whole,) = (compile_text(head.format(name)) for name in ("vent", "n"))
    assert text in boundaries(fractions) and text not in boundaries(whole)
    monitor = Monitor(fractions)
    assert [monitor.step({"vent": vent}).verdict for vent in (10.3, 5.3)] == ["holding", "violated"]


@pytest.mark.parametrize(
    "clause",
    [
        "keep b implies time_since(a) < 2 s",
        "require a until (a and b)",
        "reach a then not a",
        "reach a then within 2 s b",
        "keep begins a implies time_holding(begins b) >= 2 s",
    ],
)
def test_nothing_is_told_that_is_not_so(clause: str) -> None:
    wrong = ("in the last", "until", "then ", "time_holding", "(b begins) for")
    assert not any(text.startswith(wrong) for text in boundaries(_spec(clause)))


@pytest.mark.parametrize("clause", ["avoid always for 2 s a", "keep b implies not always for 2 s a"])
def test_what_is_denied_is_told_as_its_opposite(clause: str) -> None:
    fspa = _spec(clause)
    assert boundaries(fspa) == (
        "within 1.5 s: up to and including the step 1.5 s later",
        "where play ends before that, what has not come counts as missed",
    )
    assert _verdict(fspa, "ab", "a") == "pending"


def test_a_window_that_is_no_multiple_of_a_step_is_told_in_steps() -> None:
    fspa = _spec("keep times_within(a, 2.3 s) <= 1")
    assert boundaries(fspa) == ("in the last 2.5 s: at this step, or at one up to and including the step 2.5 s before",)
    assert _verdict(fspa, "a", "", "", "", "", "a") == "violated"


@pytest.mark.parametrize("rate", [2, 60])
def test_the_beginning_that_a_timer_remembers_is_told(rate: int) -> None:
    head = f"clock {rate} Hz\nsignal a: bool\nsignal b: bool\nspec s {{ keep begins a implies "
    (fspa,) = compile_text(f"{head}eventually within 2 s b }}")
    assert boundaries(fspa)[0].startswith("a begins: at the first of its steps in a row")


def test_goals_that_exclude_each_other_have_not_begun_before() -> None:
    (fspa,) = compile_text(f"{SIGNALS}exclusive a, b\nspec s {{ reach a then b }}")
    assert boundaries(fspa) == ("before its turn, a goal does not count, and breaks nothing",)
