"""The result of a suite in one sentence, and the order of its cases."""

from __future__ import annotations

import pytest

from tests.runtime.regression.handmade import case, suite, summaries
from tltl_runtime.evaluation.figures import figures_of
from tltl_runtime.regression.explain.explain import Finding
from tltl_runtime.regression.report.case_report import CaseReport, CaseStatus, CaseTraces, TraceNames
from tltl_runtime.regression.report.report_json import document
from tltl_runtime.regression.report.suite_summary import suite_summary, worst_first
from tltl_runtime.regression.suite.thresholds import Thresholds
from tltl_runtime.regression.verdict.verdict import FigureChange, judge
from tltlc.core.record import replace

FIGURES = figures_of(summaries(43))
GOOD = CaseReport("a", "room", "v0", "pass", (), rate_interval=(0.86, 1.0), figures=FIGURES, baseline=FIGURES)
NEW = replace(GOOD, new_failures=(Finding("dies in 1 of 43 episodes; before: in 0 of 200", (3,)),))
CHANGED = replace(GOOD, verdict="review", changes=(FigureChange("reward", 0.7, 0.4, 0.001),))
UNCERTAIN = replace(GOOD, verdict="review", certain=False, figure_changes=("reward is lower; but not certain",))


def rates(now: tuple[int, int], before: tuple[int, int], interval: tuple[float, float]) -> CaseReport:
    """A case with these successes and failures, and this interval of the pass rate, which has no verdict yet."""
    return replace(
        GOOD, figures=figures_of(summaries(*now)), baseline=figures_of(summaries(*before)), rate_interval=interval
    )


LOW = replace(rates((140, 60), (140, 60), (0.58, 0.8)), verdict="review")
SELDOM = replace(rates((140, 60), (200, 0), (0.58, 0.8)), verdict="review")
FAILED = replace(rates((0, 25), (200, 0), (0.0, 0.2)), verdict="fail")
MUCH_LESS = replace(rates((60, 140), (200, 0), (0.2, 0.42)), verdict="fail")
IMPOSSIBLE = replace(FAILED, is_impossible=True)
FAILED_BEFORE = replace(rates((0, 25), (0, 50), (0.0, 0.2)), verdict="fail")
SELDOM_BEFORE = replace(rates((60, 140), (70, 130), (0.2, 0.42)), verdict="fail")
ONE_OF_THIRTY = replace(UNCERTAIN, figures=figures_of(summaries(29, 1)))
BROKEN = CaseReport("a", "room", "v0", "fail", ("it cannot be played",))
TRACES = CaseTraces("s", TraceNames("now", ()), TraceNames("before", ()))


def levels(*reports: CaseReport) -> list[CaseReport]:
    """The reports as those on different levels."""
    return [replace(report, level=f"room{number}") for number, report in enumerate(reports)]


@pytest.mark.parametrize(
    ("report", "status"),
    [
        (GOOD, "as_before"),
        (NEW, "as_before"),
        (CHANGED, "changed"),
        (UNCERTAIN, "uncertain"),
        (LOW, "low_rate"),
        (replace(LOW, certain=False), "low_rate"),
        (replace(LOW, main=("only 24 traces: a verdict needs 25",)), "uncertain"),
        (SELDOM, "less_often"),
        (replace(LOW, baseline=figures_of(summaries(20, 180))), "changed"),
        (MUCH_LESS, "much_less_often"),
        (replace(MUCH_LESS, is_impossible=True), "much_less_often"),
        (SELDOM_BEFORE, "too_seldom_before"),
        (replace(FAILED_BEFORE, baseline=figures_of(summaries(5, 95))), "too_seldom_before"),
        (replace(FAILED, is_outdated=True), "outdated"),
        (replace(SELDOM, is_outdated=True), "outdated"),
        (replace(GOOD, verdict="review", is_outdated=True), "outdated"),
        (replace(BROKEN, verdict="review"), "uncertain"),
        (FAILED, "unfinished"),
        (IMPOSSIBLE, "impossible"),
        (FAILED_BEFORE, "unfinished_before"),
        (replace(FAILED_BEFORE, is_impossible=True), "unfinished_before"),
        (BROKEN, "unplayable"),
    ],
)
def test_each_verdict_has_a_status(report: CaseReport, status: CaseStatus) -> None:
    assert report.status == status


@pytest.mark.parametrize(
    ("reports", "not_judged", "sentence"),
    [
        (
            [GOOD, FAILED, CHANGED, GOOD, FAILED, CHANGED, GOOD, GOOD, GOOD],
            0,
            "2 of 9 levels can no longer be finished by their agents; 2 changed; 5 play as before",
        ),
        ([IMPOSSIBLE, IMPOSSIBLE, GOOD], 0, "2 of 3 levels can no longer be finished; 1 plays as before"),
        (
            [FAILED, IMPOSSIBLE, GOOD],
            0,
            "2 of 3 levels can no longer be finished by their agents, one of them not by any player; 1 plays as before",
        ),
        ([BROKEN, GOOD], 0, "1 of 2 levels cannot be played; 1 plays as before"),
        (
            [FAILED_BEFORE, UNCERTAIN],
            0,
            "1 of 2 levels is not finished by its agent, as before; 1 may have changed",
        ),
        (
            [MUCH_LESS, GOOD],
            0,
            "1 of 2 levels is finished much less often by its agent (in 30% of episodes, before in 100%); "
            "1 plays as before",
        ),
        (
            [MUCH_LESS, replace(MUCH_LESS, figures=figures_of(summaries(1, 24)))],
            0,
            "2 of 2 levels are finished much less often by their agents (in 4% to 30%, before in 100%)",
        ),
        (
            [FAILED, MUCH_LESS],
            0,
            "1 of 2 levels can no longer be finished by its agent; "
            "1 is finished much less often by its agent (in 30% of episodes, before in 100%)",
        ),
        ([SELDOM], 0, "The level is finished less often by its agent (in 70% of episodes, before in 100%)"),
        (
            [LOW],
            0,
            "The level plays as before, but is not certainly finished often enough (in 70% of episodes, before in 70%)",
        ),
        (
            [LOW, replace(LOW, verdict="fail", is_outdated=True)],
            0,
            "1 of 2 levels has another spec than its agent was trained for; 1 plays as before, but is not certainly "
            "finished often enough (in 70% of episodes, before in 70%)",
        ),
        (
            [SELDOM_BEFORE],
            0,
            "The level is still finished too seldom by its agent (in 30% of episodes, before in 35%)",
        ),
        ([GOOD, NEW, GOOD], 0, "All 3 levels play as before, one of them with a new failure"),
        ([NEW, NEW, GOOD], 0, "All 3 levels play as before, 2 of them with new failures"),
        ([GOOD, GOOD], 0, "All 2 levels play as before"),
        ([CHANGED, CHANGED], 0, "2 of 2 levels changed"),
        ([GOOD], 0, "The level plays as before"),
        ([NEW], 0, "The level plays as before, with a new failure"),
        ([FAILED], 0, "The level can no longer be finished by its agent"),
        ([IMPOSSIBLE], 0, "The level can no longer be finished"),
        ([GOOD, GOOD], 1, "All 2 levels play as before; 1 was not judged"),
        (
            [FAILED, GOOD],
            7,
            "1 of 2 levels can no longer be finished by its agent; 1 plays as before; 7 were not judged",
        ),
        ([], 0, "No level was judged"),
        ([], 3, "No level was judged"),
    ],
)
def test_the_sentence_says_what_has_become_of_the_cases(
    reports: list[CaseReport], not_judged: int, sentence: str
) -> None:
    assert suite_summary(levels(*reports), not_judged).sentence == sentence


def test_a_low_rate_that_the_baseline_has_too_is_no_change() -> None:
    """The verdict is that of the statistics: 140 successes of 200, now and in the baseline."""
    episodes = summaries(140, 60)
    judgement = judge(episodes, episodes, 200, Thresholds(), 0.05)
    assert judgement is not None and (judgement.verdict, judgement.changes) == ("review", ())
    report = replace(LOW, certain=judgement.certain, rate_interval=judgement.rate_interval)
    assert report.status == "low_rate"
    assert "changed" not in suite_summary([report]).sentence


def test_variants_of_one_level_are_cases() -> None:
    reports = [replace(report, variant=f"v{number}") for number, report in enumerate((FAILED, GOOD, GOOD))]
    summary = suite_summary(reports)
    assert summary.noun == "case"
    assert summary.sentence == "1 of 3 cases can no longer be finished by its agent; 2 play as before"


def test_recorded_traces_have_their_own_words() -> None:
    traces = [replace(report, traces=TRACES) for report in (FAILED, BROKEN, CHANGED, NEW, MUCH_LESS)]
    assert suite_summary(traces).sentence == (
        "1 of 5 sets of traces no longer meets its spec; "
        "1 meets its spec much less often (in 30% of traces, before in 100%); 1 cannot be judged; 1 changed; "
        "1 is as before, with a new failure"
    )
    assert suite_summary([traces[0], GOOD, FAILED]).sentence == (
        "2 of 3 cases no longer meet their specs; 1 is as before"
    )


@pytest.mark.parametrize(
    ("report", "sentence"),
    [
        (FAILED, "25 of 25 traces do not meet the spec; before: none"),
        (ONE_OF_THIRTY, "1 of 30 traces does not meet the spec; before: none"),
        (replace(UNCERTAIN, figures=figures_of(summaries(24))), "All 24 traces meet the spec; before: all"),
        (SELDOM_BEFORE, "140 of 200 traces do not meet the spec; before: 130 of 200"),
        (CHANGED, "The set of traces changed"),
        (GOOD, "The set of traces is as before"),
    ],
)
def test_traces_of_a_single_set_are_counted(report: CaseReport, sentence: str) -> None:
    assert suite_summary([replace(report, traces=TRACES)]).sentence == sentence


def test_a_new_failure_counts_only_in_a_pass() -> None:
    summary = suite_summary([NEW, replace(NEW, verdict="fail"), replace(NEW, verdict="review"), GOOD])
    assert summary.counts["new_failures"] == 1


def test_the_json_has_the_sentence_and_its_counts() -> None:
    data = document(suite(case("a")), levels(NEW, FAILED, GOOD), complete=True, left_out=["b"], missing=["c"])
    assert data["summary"] == {
        "sentence": "1 of 3 levels can no longer be finished by its agent; 2 play as before, one of them with a new "
        "failure; 2 were not judged",
        "noun": "level",
        "judged": 3,
        "unfinished": 1,
        "impossible": 0,
        "much_less_often": 0,
        "unplayable": 0,
        "unfinished_before": 0,
        "too_seldom_before": 0,
        "outdated": 0,
        "less_often": 0,
        "changed": 0,
        "uncertain": 0,
        "low_rate": 0,
        "as_before": 2,
        "new_failures": 1,
        "not_judged": 2,
    }
    assert [entry["status"] for entry in data["cases"]] == ["as_before", "unfinished", "as_before"]
    assert [len(entry["new_failures"]) for entry in data["cases"]] == [1, 0, 0]


def test_failures_come_first_and_the_order_of_equal_verdicts_stays() -> None:
    names = ["p1", "f1", "r1", "p2", "r2", "f2"]
    verdicts = {"p": "pass", "f": "fail", "r": "review"}
    reports = [(replace(GOOD, name=name, verdict=verdicts[name[0]]), name) for name in names]
    assert [name for _, name in worst_first(reports)] == ["f1", "f2", "r1", "r2", "p1", "p2"]
