"""The sentence about a retraining that started from the policy of a case."""

from __future__ import annotations

from typing import Any

import pytest

from tests.runtime.regression.handmade import summaries
from tltl_runtime.evaluation.figures import figures_of
from tltl_runtime.regression.report.retraining_result import (
    BestFailedEpisode,
    FinishedRetraining,
    Outcome,
    RetrainingResult,
    outcome_of,
    sentence,
)
from tltl_runtime.regression.suite.suite import Thresholds
from tltl_runtime.regression.verdict.confidence import rate_interval
from tltl_runtime.support.record_json import from_json, to_json
from tltlc.core.record import replace

TRAINED = FinishedRetraining(
    end="minutes", steps=212_992, seconds=303.0, searched=200_000, complete=True, shortest=None
)
BEST = BestFailedEpisode(0.5, "reach near(exit)")


def sentence_of(outcome: Outcome, passed: int, failed: int, **changed: Any) -> str:
    best = BEST if failed else None
    figures = figures_of(summaries(passed, failed))
    interval = rate_interval(passed, failed, 0.05)
    return sentence(outcome, replace(TRAINED, **changed), figures, interval, Thresholds(), best)


@pytest.mark.parametrize(
    ("low", "met", "shortest", "outcome"),
    [
        (0.85, 40, 100, "learned"),
        (0.84, 40, 100, "feasible"),
        (0.0, 1, None, "feasible"),
        (0.0, 0, 100, "feasible"),
        (0.0, 0, None, "no_way"),
    ],
)
def test_the_outcome_depends_on_successes_and_demonstrations(
    low: float, met: int, shortest: int | None, outcome: str
) -> None:
    assert outcome_of(replace(TRAINED, shortest=shortest), low, Thresholds(), met) == outcome


def test_the_sentence_for_a_learned_level() -> None:
    assert sentence_of("learned", 43, 0, shortest=97) == (
        "feasible: after 5 min 3 s of search and training (200,000 and 212,992 steps) the policy meets the spec in 43 "
        "of 43 fresh episodes (89% to 100% for certain)"
    )
    assert "after 5 min 3 s of training (212,992 steps) the policy" in sentence_of("learned", 43, 0, searched=0)
    assert "reached progress" not in sentence_of("learned", 43, 1)


def test_the_sentence_for_a_feasible_level_that_was_not_learned() -> None:
    assert sentence_of("feasible", 5, 20, shortest=1_213) == (
        "feasible, but not learned; there are ways, and the shortest known one takes 1,213 steps; after 5 min 3 s of "
        "search and training (200,000 and 212,992 steps) the policy meets the spec in 5 of 25 fresh episodes "
        "(3% to 51% for certain), but 85% or more is required; the best of the failed ones "
        "reached progress 0.50, where this remained: reach near(exit)"
    )
    assert "there are ways" not in sentence_of("feasible", 0, 25)


def test_the_sentence_for_a_likely_infeasible_level() -> None:
    assert sentence_of("no_way", 0, 25) == (
        "no way found: neither a search of 200,000 steps nor a training of 212,992 steps, 5 min 3 s in all, met the "
        "spec once; the level is likely infeasible; the best of its episodes reached progress 0.50, where this "
        "remained: reach near(exit)"
    )
    assert "a search of 9 steps, which the limit stopped, nor" in sentence_of(
        "no_way", 0, 25, searched=9, complete=False
    )


def test_a_training_without_a_search_proves_little() -> None:
    assert sentence_of("no_way", 0, 25, searched=0) == (
        "no way found: a training of 212,992 steps, 5 min 3 s in all, did not meet the spec once; that says little, "
        "because there was no search: let it train longer; the best of its episodes reached progress 0.50, where this "
        "remained: reach near(exit)"
    )


def test_a_retraining_survives_json() -> None:
    retrained = RetrainingResult(
        "no_way", "no", TRAINED, figures_of(summaries(0, 2)), (0.0, 0.5), BEST, "retrained/a/p", None
    )
    assert from_json(RetrainingResult, to_json(retrained), "retrained") == retrained
