"""The result of retraining a case's policy on the changed level: whether the level is feasible.

A level is feasible if a player can meet the spec there.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Final, Literal

from tltl_runtime.evaluation.figures import Figures
from tltl_runtime.regression.suite.thresholds import Thresholds
from tltl_runtime.support.number_text import duration, interval_text, number, percent_exactly
from tltlc.api import record

Outcome = Literal["learned", "feasible", "no_way"]

OUTCOMES: Final[Mapping[Outcome, str]] = {"learned": "learned", "feasible": "feasible", "no_way": "no way found"}
"""The name of each outcome as reports show it."""


@record
class FinishedRetraining:
    """A finished training that started from a case's policy.

    ``end`` says why it ended: it ``met`` its goal, or it reached its limit of ``steps`` or
    ``minutes``. ``steps`` is the number of decisions of the agent. ``seconds`` is the duration,
    including that of the search for successful episodes before the training. ``searched`` is the
    number of decisions of the search; 0 if there was none, because the game does not say where the
    player is. ``complete`` is False if a limit stopped the search. ``shortest`` is the number of
    steps of the shortest episode, of the search or the agent, that met the spec; None if none did.
    """

    end: Literal["met", "steps", "minutes"]
    steps: int
    seconds: float
    searched: int
    complete: bool
    shortest: int | None


@record
class BestFailedEpisode:
    """The failed episode with the greatest ``progress``, in [0, 1].

    ``remained`` says in English what remained to be done when the episode failed.
    """

    progress: float
    remained: str


@record
class RetrainingResult:
    """Whether a changed level is feasible, according to a retraining.

    ``outcome`` is the first of these that applies:

    - ``learned``: the retrained policy's pass rate is certainly at least the case's ``pass_rate``.
    - ``feasible``: the spec was met at least once, by the search before the training, by the agent,
      or by the old or the new policy.
    - ``no_way``: nobody met the spec.

    ``text`` describes the outcome in a sentence. The retrained policy then played fresh episodes:
    ``figures`` are their statistics, and ``rate_interval`` is the confidence interval of their pass
    rate. ``best`` is the failed episode with the greatest progress, or None if no episode failed.
    ``policy`` is the path of the retrained policy, and ``episode`` that of the recording of a fresh
    episode that met the spec, or None if none did. Both are relative to the folder of the run.
    """

    outcome: Outcome
    text: str
    trained: FinishedRetraining
    figures: Figures
    rate_interval: tuple[float, float]
    best: BestFailedEpisode | None
    policy: str
    episode: str | None


def outcome_of(trained: FinishedRetraining, low: float, thresholds: Thresholds, met: int) -> Outcome:
    """Return the outcome of a retraining, as in :class:`RetrainingResult`.

    ``low`` is the lower end of the confidence interval of the retrained policy's pass rate. ``met``
    counts the episodes that met the spec, among those of the retrained policy and those of the old
    policy by which the case was judged.
    """
    if low >= thresholds.pass_rate:
        return "learned"
    return "feasible" if met or trained.shortest is not None else "no_way"


def sentence(
    outcome: Outcome,
    trained: FinishedRetraining,
    figures: Figures,
    rate_interval: tuple[float, float],
    thresholds: Thresholds,
    best: BestFailedEpisode | None,
) -> str:
    """Describe the outcome of a retraining in a sentence. The arguments are as in :class:`RetrainingResult`."""
    effort = f"{duration(trained.seconds)} of training ({trained.steps:,} steps)"
    if trained.searched:
        counts = f"{trained.searched:,} and {trained.steps:,} steps"
        effort = f"{duration(trained.seconds)} of search and training ({counts})"
    count, passed = figures.episodes, round(figures.pass_rate * figures.episodes)
    fresh_result = (
        f"the policy meets the spec in {passed} of {count} fresh episodes ({interval_text(rate_interval)} for certain)"
    )
    if outcome == "learned":
        return f"feasible: after {effort} {fresh_result}"
    if outcome == "feasible":
        clauses = ["feasible, but not learned"]
        if trained.shortest is not None:
            clauses.append(f"there are ways, and the shortest known one takes {trained.shortest:,} steps")
        clauses.append(
            f"after {effort} {fresh_result}, but {percent_exactly(thresholds.pass_rate)} or more is required"
        )
    else:
        clauses = _no_way_clauses(trained)
    if best is not None:
        best_of = "the best of the failed ones" if passed else "the best of its episodes"
        clauses.append(f"{best_of} reached progress {number(best.progress, 2)}, where this remained: {best.remained}")
    return "; ".join(clauses)


def _no_way_clauses(trained: FinishedRetraining) -> list[str]:
    """Return two clauses for the outcome ``no_way``: how much was tried in vain, and what follows."""
    training, in_all = f"a training of {trained.steps:,} steps", f"{duration(trained.seconds)} in all"
    if not trained.searched:
        return [
            f"no way found: {training}, {in_all}, did not meet the spec once",
            "that says little, because there was no search: let it train longer",
        ]
    broken = "" if trained.complete else ", which the limit stopped,"
    search = f"a search of {trained.searched:,} steps{broken}"
    return [
        f"no way found: neither {search} nor {training}, {in_all}, met the spec once",
        "the level is likely infeasible" if trained.complete else "that says little: let it train longer",
    ]
