"""The figures of episodes and the text report, against values computed by hand."""

from __future__ import annotations

import pytest

from tltl_runtime.evaluation.figures import FailureGroup, evaluation_of, figures_of
from tltl_runtime.evaluation.text import report_text
from tltl_runtime.spec.episode_summary import End, EpisodeSummary
from tltlc.core.record import replace
from tltlc.tools.judge.verdict import RejectionCause

PASSED = EpisodeSummary(0, 7, True, "success", 1.0, 0.75, 100, 4, "satisfied", 15.0, 4, "Keep alive throughout.")


def failed(index: int, state: int, end: End, progress: float) -> EpisodeSummary:
    verdict = "violated" if end == "violation" else "pending"
    trap = 2 if end == "violation" else state
    return EpisodeSummary(
        index, 7, False, end, progress, progress - 1.0, 40, state, verdict, 6.0, trap, f"Reach {state}."
    )


EPISODES = [
    PASSED,
    failed(1, 1, "limit", 0.5),
    failed(2, 0, "violation", 0.2),
    failed(3, 0, "limit", 0.25),
    failed(4, 0, "violation", 0.3),
    *(replace(PASSED, index=index) for index in range(5, 10)),
]


def test_figures_equal_values_computed_by_hand() -> None:
    figures = figures_of(EPISODES)
    assert figures.pass_rate == pytest.approx(0.6)
    assert figures.pass_interval == pytest.approx((0.3127, 0.8318), abs=1e-4)
    assert figures.progress.mean == pytest.approx(0.725)
    assert figures.reward.mean == pytest.approx((6 * 0.75 + 1.25 - 4) / 10)
    assert figures.steps.mean == pytest.approx(76.0)
    assert figures.steps.std == pytest.approx((960 * 9) ** 0.5 / 3)
    assert figures.episodes == 10


def test_failed_episodes_are_grouped_by_state_and_end() -> None:
    evaluation = evaluation_of(EPISODES)
    assert evaluation.figures == figures_of(EPISODES)
    assert evaluation.ended == (
        FailureGroup(0, "Reach 0.", "violation", 2, 0.2, (2, 4)),
        FailureGroup(0, "Reach 0.", "limit", 1, 0.1, (3,)),
        FailureGroup(1, "Reach 1.", "limit", 1, 0.1, (1,)),
    )
    assert evaluation.episodes == tuple(EPISODES)


def test_figures_of_no_episodes_are_an_error() -> None:
    with pytest.raises(ValueError, match="0 of 0 is not a share"):
        figures_of([])


def test_the_text_report_has_a_column_for_each_evaluation() -> None:
    text = report_text({"sampled": evaluation_of(EPISODES), "arg-max": evaluation_of([PASSED])})
    assert (
        text
        == """\
                  sampled                 arg-max
episodes          10                      1
pass rate (95 %)  0.60 (0.31 to 0.83)     1.00 (0.21 to 1.00)
progress          0.72 ± 0.36             1.00 ± -
reward            0.17 ± 0.75             0.75 ± -
steps             76 ± 31                 100 ± -

sampled: 4 of 10 failed
  2 violated in state 0, remaining: Reach 0.
    episodes 2, 4
  1 out of time in state 0, remaining: Reach 0.
    episode 3
  1 out of time in state 1, remaining: Reach 1.
    episode 1
"""
    )


def test_the_text_report_names_the_clauses_that_episodes_break() -> None:
    broken = RejectionCause("broken", 40, ("avoid fell",))
    episodes = [replace(episode, cause=None if episode.success else broken) for episode in EPISODES]
    lines = report_text({"sampled": evaluation_of(episodes)}).splitlines()
    assert lines[7:9] == [
        "sampled: 4 of 10 failed",
        "  4 of 10 break `avoid fell`, at step 40",
    ]


def test_long_lists_of_episodes_are_truncated() -> None:
    text = report_text({"sampled": evaluation_of([failed(index, 0, "limit", 0.1) for index in range(20)])})
    assert "    episodes 0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, …\n" in text
