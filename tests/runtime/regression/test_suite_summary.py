"""The result of a suite in one sentence, and the order of its cases."""

from __future__ import annotations

import pytest

from tests.runtime.regression.handmade import case, suite, summaries
from tltl_runtime.evaluation.figures import figures_of
from tltl_runtime.regression.explain.explain import Finding
from tltl_runtime.regression.report.case_report import CaseReport, CaseStatus, CaseTraces, TraceNames
from tltl_runtime.regression.report.report_json import document
from tltl_runtime.regression.report.suite_summary import suite_summary, worst_first
from tltlc.core.record import replace

FIGURES = figures_of(summaries(43))
GOOD = CaseReport("a", "room", "v0", "pass", (), figures=FIGURES, baseline=FIGURES)
NEW = replace(GOOD, new_failures=(Finding("dies in 1 of 43 episodes; before: in 0 of 200", (3,)),))
CHANGED = replace(GOOD, verdict="review")
UNCERTAIN = replace(CHANGED, certain=False)
FAILED = replace(GOOD, verdict="fail", rate_interval=(0.0, 0.2))
IMPOSSIBLE = replace(FAILED, is_impossible=True)
FAILED_BEFORE = replace(FAILED, baseline=figures_of(summaries(1, 9)))
BROKEN = CaseReport("a", "room", "v0", "fail", ("it cannot be played",))
TRACES = CaseTraces("s", TraceNames("now", ()), TraceNames("before", ()))


@pytest.mark.parametrize(
    ("report", "status"),
    [
        (GOOD, "as_before"),
        (NEW, "as_before"),
        (CHANGED, "changed"),
        (UNCERTAIN, "uncertain"),
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
    assert suite_summary(reports, not_judged).sentence == sentence


def test_recorded_traces_have_their_own_words() -> None:
    traces = [replace(report, traces=TRACES) for report in (FAILED, BROKEN, CHANGED, NEW)]
    assert suite_summary(traces).sentence == (
        "1 of 4 sets of traces no longer meets its spec; 1 cannot be judged; 1 changed; "
        "1 is as before, with a new failure"
    )
    assert suite_summary(traces[:1]).sentence == "The set of traces no longer meets its spec"
    assert suite_summary([traces[0], GOOD, FAILED]).sentence == (
        "2 of 3 cases no longer meet their specs; 1 is as before"
    )


def test_a_new_failure_counts_only_in_a_pass() -> None:
    summary = suite_summary([NEW, replace(NEW, verdict="fail"), replace(NEW, verdict="review"), GOOD])
    assert summary.new_failures == 1


def test_the_json_has_the_sentence_and_its_counts() -> None:
    data = document(suite(case("a")), [NEW, FAILED, GOOD], complete=True, left_out=["b"], missing=["c"])
    assert data["summary"] == {
        "sentence": "1 of 3 levels can no longer be finished by its agent; 2 play as before, one of them with a new "
        "failure; 2 were not judged",
        "noun": "level",
        "judged": 3,
        "unfinished": 1,
        "impossible": 0,
        "unplayable": 0,
        "unfinished_before": 0,
        "changed": 0,
        "uncertain": 0,
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
