"""The progress lines of a training."""

from __future__ import annotations

import pytest

from tests.runtime.training.reports import a_report
from tltl_runtime.cli.support.training_text import (
    confirmation_line,
    duration,
    environments_line,
    limits_line,
    measuring_line,
    minutes,
    report_line,
    search_advice,
    search_end,
    search_line,
    search_result_line,
    seconds_left,
)
from tltl_runtime.training.exploration.search import SearchProgress
from tltl_runtime.training.exploration.search_plan import SearchPlan
from tltl_runtime.training.files.report import Confirmation
from tltl_runtime.training.files.settings import Stop, read_settings
from tltlc import compile_text
from tltlc.core.record import replace

(SPEC,) = compile_text("signal key: bool  signal door: bool  spec leave { reach key then door }")


def test_the_lines_before_a_training() -> None:
    settings = read_settings()
    stop, rollout = replace(settings.stop, steps=4_000_000), replace(settings.rollout, envs=16, workers=2)
    assert limits_line(stop) == "it ends when the spec is met, at the latest after 4,000,000 steps"
    assert limits_line(replace(stop, minutes=1.0)).endswith("after 4,000,000 steps or 1 minute, whichever comes first")
    assert environments_line(replace(settings, rollout=rollout)) == "starting 16 environments in 2 processes"
    one = replace(settings, rollout=replace(rollout, envs=1))
    assert environments_line(one) == "starting 1 environment in 1 process"
    assert measuring_line(searches=True).endswith(", and playing it twice for 200 steps, to see whether it repeats")


@pytest.fixture(scope="module")
def stop() -> Stop:
    return read_settings().stop


def test_the_line_of_an_iteration(stop: Stop) -> None:
    early, late = a_report(count=0, successes=0), a_report(100)
    assert report_line(early, stop) == "iteration 1: 4,096 steps in 2 s, 2,048 steps/s, at most 32 min 31 s left"
    assert report_line(late, stop) == (
        "iteration 100: 409,600 steps in 3 min 20 s, met in 40 of the last 50 episodes, progress 0.90, "
        "reward 0.65, 2,048 steps/s, at most 29 min 13 s left"
    )
    assert report_line(replace(late, stop="met"), stop).endswith("2,048 steps/s")
    without_times = replace(late, stop="met", iteration=replace(late.iteration, steps=0, collect_s=0.0, learn_s=0.0))
    assert report_line(without_times, stop).endswith("reward 0.65")


@pytest.mark.parametrize(
    ("lengths", "ways"),
    [
        ((), "no way to meet the spec yet"),
        ((80,), "1 of 10 ways to meet the spec, the shortest of 80 steps"),
        ((80, 90), "2 of 10 ways to meet the spec, the shortest of 80 steps"),
    ],
)
def test_the_line_of_the_search(lengths: tuple[int, ...], ways: str) -> None:
    searched = SearchProgress(steps=6400, replayed=3200, seconds=61.0, places=1200, lengths=lengths, complete=False)
    settings = read_settings()
    settings = replace(settings, exploration=replace(settings.exploration, ways=10, steps=64_000))
    line = f"searching: 6,400 steps in 1 min 1 s, 1,200 places, {ways}"
    assert search_line(searched, settings, SPEC) == f"{line}, at most 9 min 9 s left"
    assert search_line(replace(searched, complete=True), settings, SPEC) == line
    limited = replace(settings, stop=replace(settings.stop, minutes=3.0))
    assert search_line(searched, limited, SPEC) == f"{line}, at most 1 min 59 s left"
    assert "1 place, " in search_line(replace(searched, places=1), settings, SPEC)


def test_the_line_of_a_search_without_a_way_says_what_remains() -> None:
    searched = SearchProgress(6400, 3200, 61.0, 1200, (), complete=True, state=SPEC.edges_from(0)[-1].target)
    line = "searching: 6,400 steps in 1 min 1 s, 1,200 places, no way to meet the spec yet; at best this remained: "
    assert search_line(searched, read_settings(), SPEC) == f"{line}Reach door"
    assert "remained" not in search_line(replace(searched, lengths=(80,)), read_settings(), SPEC)


def test_the_line_of_the_search_counts_lost_episodes() -> None:
    searched = SearchProgress(6400, 3200, 61.0, 1200, (80,), complete=True, lost=1, loss="the game ended")
    assert search_line(searched, read_settings(), SPEC).endswith("; 1 episode was lost: the game ended")
    assert "; 1,200 episodes were lost: the" in search_line(replace(searched, lost=1200), read_settings(), SPEC)


def test_the_line_at_the_end_of_the_search() -> None:
    searched = SearchProgress(steps=6400, replayed=3200, seconds=61.0, places=1200, lengths=(90, 80), complete=True)
    assert search_result_line(searched) == "search: 2 ways found in 1 min 1 s, the shortest of 80 steps"


@pytest.mark.parametrize(("ways", "ways_text"), [(1, "1 way is"), (2, "2 ways are")])
def test_the_end_of_the_search(ways: int, ways_text: str) -> None:
    settings = replace(read_settings().exploration, ways=ways, steps=640)
    assert search_end(settings) == f"The search ends when {ways_text} found, at the latest after 640 steps."


def test_the_nearer_limit_determines_the_remaining_time(stop: Stop) -> None:
    report = a_report(10)
    assert seconds_left(report, replace(stop, steps=2 * report.steps)) == pytest.approx(report.seconds)
    assert seconds_left(report, replace(stop, minutes=1.0)) == pytest.approx(40.0)
    assert seconds_left(report, replace(stop, steps=1, minutes=9.0)) == 0.0


def test_the_remaining_time_excludes_the_search(stop: Stop) -> None:
    report, searched = a_report(10), SearchProgress(6400, 3200, 600.0, 1200, (80,), complete=True)
    after = replace(report, seconds=report.seconds + 600.0, searched=searched)
    assert seconds_left(after, stop) == pytest.approx(seconds_left(report, stop))
    # The seconds of the search count towards the limit of minutes.
    assert seconds_left(after, replace(stop, minutes=11.0)) == pytest.approx(40.0)


def test_the_line_of_a_confirmation(stop: Stop) -> None:
    assert confirmation_line(92, Confirmation(100, 100)) == "confirmed: the policy met it in 100 fresh episodes, too"
    refused = a_report(92, confirmation=Confirmation(12, 100))
    assert ", not confirmed after iteration 92: fresh episode 13 of 100 failed, 2,048" in report_line(refused, stop)


@pytest.mark.parametrize(
    ("seconds", "text"),
    [(0.2, "0 s"), (59.4, "59 s"), (59.6, "1 min 0 s"), (754, "12 min 34 s"), (12000, "3 h 20 min")],
)
def test_durations_have_fitting_units(seconds: float, text: str) -> None:
    assert duration(seconds) == text


def test_a_limit_in_minutes_is_in_words() -> None:
    assert [minutes(limit) for limit in (0.5, 1.0, 30.0)] == ["0.5 minutes", "1 minute", "30 minutes"]


def test_a_search_without_success_is_told_to_name_what_matters() -> None:
    none = SearchProgress(640, 20, 1.5, 12, (), complete=True)
    advice = search_advice(SearchPlan("positions"), none)
    assert advice is not None
    assert advice.startswith(
        "its places were where the player stands, and the state of the spec: if the way needs more"
    )
    assert "values of signals" in str(search_advice(SearchPlan("signals"), none))
    assert search_advice(SearchPlan("own"), none) is None and search_advice(None, none) is None
    assert search_advice(SearchPlan("positions"), replace(none, lengths=(9,))) is None
