"""What came of training a case's policy on the level as it is now: whether that is feasible after all."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Final, Literal

from tltl_runtime.evaluation.figures import Figures
from tltl_runtime.regression.suite.suite import Thresholds
from tltl_runtime.support.number_text import between, duration, number, percent_exactly
from tltlc.core.record import record

Outcome = Literal["learned", "feasible", "no_way"]

OUTCOMES: Final[Mapping[Outcome, str]] = {"learned": "learned", "feasible": "feasible", "no_way": "no way found"}
"""What outcomes are called."""


@record
class Trained:
    """A training that began with a case's policy, and its end.

    It took ``steps`` of the agent and ``seconds``, the search included, which took ``searched`` decisions and was
    ``complete`` unless a limit broke it off.  ``shortest`` is the length in steps of the shortest way to meet the spec
    that is known, of the search or of the agent; None where there is none.
    """

    end: Literal["met", "steps", "minutes"]
    steps: int
    seconds: float
    searched: int
    complete: bool
    shortest: int | None


@record
class Best:
    """The fresh episode that came farthest: its progress, in [0, 1], and in English what remained to be done then."""

    progress: float
    remained: str


@record
class Retrained:
    """Whether a changed level is feasible, as far as a training tells.

    ``outcome`` is ``learned`` where the retrained policy certainly meets the spec in at least the case's ``pass_rate``
    of episodes, ``feasible`` where the spec was met, by whomever, and ``no_way`` where it never was.  ``figures`` are
    those of the retrained policy in fresh episodes, ``rate_interval`` is what can be said of its pass rate for certain,
    and ``best`` is of the episodes that failed, None where all met the spec.  ``policy`` and ``episode``, a recording
    of one that met it, are files in the folder of the run.
    """

    outcome: Outcome
    text: str
    trained: Trained
    figures: Figures
    rate_interval: tuple[float, float]
    best: Best | None
    policy: str
    episode: str | None


def outcome_of(trained: Trained, low: float, thresholds: Thresholds, met: int) -> Outcome:
    """What a training shows; ``low`` is the lower end of the pass rate, ``met`` the episodes that met the spec, the
    case's own among them.
    """
    if low >= thresholds.pass_rate:
        return "learned"
    return "feasible" if met or trained.shortest is not None else "no_way"


def sentence(
    outcome: Outcome,
    trained: Trained,
    figures: Figures,
    rate_interval: tuple[float, float],
    thresholds: Thresholds,
    best: Best | None,
) -> str:
    """What is told of the outcome."""
    took = f"{duration(trained.seconds)} of training ({trained.steps:,} steps)"
    if trained.searched:
        both = f"{trained.searched:,} and {trained.steps:,} steps"
        took = f"{duration(trained.seconds)} of search and training ({both})"
    count, passed = figures.episodes, round(figures.pass_rate * figures.episodes)
    now = f"the policy meets the spec in {passed} of {count} fresh episodes ({between(rate_interval)} for certain)"
    if outcome == "learned":
        return f"feasible: after {took} {now}"
    if outcome == "feasible":
        said = ["feasible, but not learned"]
        if trained.shortest is not None:
            said.append(f"there are ways, the shortest that is known takes {trained.shortest:,} steps")
        said.append(f"after {took} {now}, and {percent_exactly(thresholds.pass_rate)} are asked for")
    else:
        broken = "" if trained.complete else ", which the limit broke off,"
        search, training = f"a search of {trained.searched:,} steps{broken}", f"a training of {trained.steps:,} steps"
        in_all = f"{duration(trained.seconds)} in all"
        said = [f"no way found: neither {search} nor {training}, {in_all}, met the spec once"]
        said.append("the level is likely infeasible" if trained.complete else "that says little: let it train longer")
    if best is not None:
        which = "the best of the failed ones" if passed else "the best of its episodes"
        said.append(f"{which} came to progress {number(best.progress, 2)}, where this remained: {best.remained}")
    return "; ".join(said)
