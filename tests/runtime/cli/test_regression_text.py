"""The text of a report on a suite."""

from __future__ import annotations

from click import unstyle

from tests.runtime.regression.handmade import summaries
from tltl_runtime.cli.support.regression_text import case_lines, report_lines, summary_line
from tltl_runtime.evaluation.figures import figures_of
from tltl_runtime.regression.explain.explain import Finding
from tltl_runtime.regression.report.case_report import CaseReport
from tltl_runtime.regression.report.retraining_result import FinishedRetraining, Outcome, RetrainingResult
from tltl_runtime.regression.suite_run import FinishedCase
from tltl_runtime.regression.verdict.verdict import CaseVerdict
from tltlc.core.record import replace

TRAINED = FinishedRetraining(end="minutes", steps=1, seconds=1.0, searched=0, complete=True, shortest=None)


def report(verdict: CaseVerdict, outcome: Outcome | None = None) -> CaseReport:
    figures, files = figures_of(summaries(25)), ("policy", None)
    retrained = outcome and RetrainingResult(outcome, "", TRAINED, figures, (0.0, 1.0), None, *files)
    return CaseReport("a", "room", "v0", verdict, (), retrained=retrained)


def test_a_mean_is_never_minus_zero() -> None:
    figures = figures_of([replace(summary, reward=-0.0004) for summary in summaries(25)])
    (line,) = case_lines(replace(report("pass"), figures=figures, baseline=figures), 1, is_cached=False)
    assert unstyle(line).endswith("progress   1.00 (  1.00)  reward   0.00 (  0.00)")


def test_the_sentence_comes_first_then_failures_then_reviews() -> None:
    reports = [report("pass"), report("review"), report("fail"), replace(report("review"), name="long name")]
    lines = [unstyle(line) for line in report_lines([FinishedCase(each, is_cached=False) for each in reports], 2)]
    assert lines == [
        "1 of 4 cases cannot be played; 2 may have changed; 1 plays as before; 2 were not judged",
        "a          fail",
        "a          review",
        "long name  review",
        "a          pass",
    ]
    assert list(report_lines([])) == []


def test_minor_reasons_are_last_and_dim() -> None:
    failed = replace(
        report("fail"), causes=("met in 0",), edits=("a changed",), version_changes=("old",), figure_changes=("reward",)
    )
    lines = list(case_lines(failed, 1, is_cached=False))[1:]
    assert [unstyle(line) for line in lines] == ["    a changed", "    met in 0", "    reward", "    old"]
    assert ["\x1b[2m" in line for line in lines] == [False, False, True, True]


def test_a_new_failure_in_a_pass_is_shown() -> None:
    new = replace(report("pass"), causes=("met in 42 of 43",), new_failures=(Finding("dies in 1 of 43", (3,)),))
    assert [unstyle(line) for line in case_lines(new, 1, is_cached=False)] == [
        "a  pass",
        "    new failure: dies in 1 of 43",
    ]


def test_verdicts_are_counted() -> None:
    assert summary_line([report("pass")]) == "1 case: 1 pass"
    assert summary_line([report("fail"), report("review"), report("fail")]) == "3 cases: 1 review, 2 fail"
    assert summary_line([], ["a"]) == "no case was judged"
    assert summary_line([]) == "there was no case to judge"


def test_outcomes_of_retraining_are_counted() -> None:
    reports = [report("pass"), report("review", "learned"), report("fail", "no_way"), report("fail", "feasible")]
    counted = "retrained: 1 learned, 1 feasible, 1 no way found"
    assert summary_line(reports) == f"4 cases: 1 pass, 1 review, 2 fail; {counted}"
    assert summary_line(reports[:2]) == "2 cases: 1 pass, 1 review; retrained: 1 learned"
