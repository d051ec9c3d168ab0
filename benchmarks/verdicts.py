"""Measure how often the verdicts of ``tltlc regress`` are wrong, on simulated episodes.

The episodes are like those of the shipped policies: successes with a reward around 0.79, failures
with a reward around -0.3 at some stage of the spec. Each case is simulated many times, and judged as
in suites of 1, 9 and 30 cases. The cases of a suite are independent, so the probabilities for whole
suites follow.
"""

from __future__ import annotations

import zlib
from collections import Counter
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from importlib.util import find_spec
from math import exp, fsum, lgamma, log, log1p
from typing import TYPE_CHECKING, Final, Literal

from benchmarks.store import Record, Store, measure_missing, source_digest

if TYPE_CHECKING:
    import numpy as np

    from tltl_runtime.regression.verdict.verdict import Judgement
    from tltl_runtime.spec.episode_summary import EpisodeSummary

SECTION = "verdicts"

Pairing = Literal["identical", "half", "independent"]
"""Which episodes are the same as in the baseline: all of them, half of them by chance, or none."""

ERROR: Final = 0.05
"""The default error probability of a suite."""

LATEST: Final = (25, 50, 100)
"""Numbers of episodes; the report counts the verdicts that came by then."""

_RARE: Final = 0.97
"""From this pass rate on, false alarms are rare."""

JUST_BELOW: Final = 0.849
"""A pass rate just below the threshold, which is hardest to tell from a rate above it."""

THRESHOLD: Final = 0.05
"""The default threshold for changes of progress and reward."""

_STAGES: Final = (0.25, 0.5, 0.75)
"""The values of the progress of failures; all are equally likely."""
_FAILED: Final = (-0.3, 0.2)
"""Mean and standard deviation of the reward of failures."""


@dataclass(frozen=True, slots=True)
class Play:
    """How a policy plays: its pass rate, and the mean and standard deviation of the reward of successes."""

    rate: float
    reward: float = 0.79
    spread: float = 0.05


@dataclass(frozen=True, slots=True)
class Scenario:
    """How a policy plays ``now``, and how it played ``before``, when the baseline was recorded."""

    now: Play
    before: Play
    pairing: Pairing = "independent"

    @property
    def is_slight(self) -> bool:
        """Whether the reward has changed by less than its threshold, and nothing else has changed."""
        now, before = self.now, self.before
        return now != before and now.rate == before.rate and abs(now.reward - before.reward) < THRESHOLD

    @property
    def is_rare(self) -> bool:
        """Whether wrong verdicts are rare, so that many trials are needed."""
        is_same = self.now == self.before
        return self.is_slight or (is_same and (self.now.rate >= _RARE or self.now.rate == JUST_BELOW))

    @property
    def name(self) -> str:
        """The name of the scenario in the results."""
        now, before = self.now, self.before
        if now == before:
            return f"{now.rate:g} {self.pairing}"
        parts = [
            f"{figure} {old:g} to {new:g}"
            for figure, old, new in (("rate", before.rate, now.rate), ("reward", before.reward, now.reward))
            if old != new
        ]
        return f"{', '.join(parts)}, ± {now.spread:g}"


def _unchanged_scenarios() -> Iterator[Scenario]:
    for rate in (1.0, 0.99, 0.98, 0.97, 0.95):
        for pairing in ("identical", "half", "independent"):
            yield Scenario(Play(rate), Play(rate), pairing)
    for rate in (0.92, 0.9, 0.85, JUST_BELOW, 0.8, 0.7, 0.6, 0.499, 0.4, 0.3, 0.0):
        yield Scenario(Play(rate), Play(rate), "identical")


def _changed_scenarios() -> Iterator[Scenario]:
    for reward, spread in ((0.75, 0.05), (0.745, 0.15)):
        yield Scenario(Play(0.98, reward, spread), Play(0.98, 0.79, spread))
    for reward, spread in ((0.65, 0.05), (0.65, 0.15), (0.69, 0.05), (0.69, 0.15)):
        yield Scenario(Play(0.98, reward, spread), Play(0.98, 0.74, spread))
    for before, now in ((1.0, 0.9), (0.98, 0.9), (0.97, 0.88), (0.98, 0.8), (0.98, 0.6), (0.98, 0.3)):
        yield Scenario(Play(now), Play(before))


@dataclass(frozen=True, slots=True)
class Plan:
    """The size of the measurement: each scenario, with ``trials`` of a case, in suites of ``sizes`` cases.

    If verdicts come late, or errors are frequent, only ``few`` trials are made.
    """

    scenarios: Sequence[Scenario] = field(default_factory=lambda: (*_unchanged_scenarios(), *_changed_scenarios()))
    trials: int = 4000
    few: int = 500
    sizes: Sequence[int] = (1, 9, 30)


def measure(store: Store, _: float, say: Callable[[str], None], plan: Plan | None = None) -> None:
    """Simulate each scenario for which the store has no record of the present :func:`rule`."""
    if find_spec("numpy") is None:
        say(f"{SECTION} left out: numpy is not installed (the extra `rl`, Python 3.10 or 3.11)")
        return
    chosen_plan = plan or Plan()
    scenarios = {scenario.name: scenario for scenario in chosen_plan.scenarios}

    def record(name: str) -> Record:
        scenario = scenarios[name]
        return measure_scenario(
            scenario, chosen_plan.trials if scenario.is_rare else chosen_plan.few, chosen_plan.sizes
        )

    measure_missing(store, SECTION, scenarios, record, say, field="suites", current={"rule": rule()})


def rule() -> str:
    """Return a hash of the code that decides verdicts; records of other code are measured again."""
    return source_digest(*(f"runtime/tltl_runtime/regression/verdict/{name}.py" for name in ("verdict", "confidence")))


def measure_scenario(scenario: Scenario, trials: int, sizes: Sequence[int]) -> Record:
    """Return how a case is judged, by the number of cases of its suite; equal arguments give equal figures."""
    import numpy as np

    generator = np.random.default_rng(zlib.crc32(scenario.name.encode()))
    judgements: dict[int, list[tuple[Judgement, int]]] = {size: [] for size in sizes}
    for _ in range(trials):
        now, before = draw_episodes(scenario, generator)
        for size in sizes:
            judgements[size].append(first_verdict(now, before, ERROR / size))
    return {
        "trials": trials,
        "rule": rule(),
        "rates": [scenario.before.rate, scenario.now.rate],
        "pairing": scenario.pairing,
        "changed": scenario.now != scenario.before,
        "slight": scenario.is_slight,
        "suites": {str(size): _shares(by_size) for size, by_size in judgements.items()},
    }


def draw_episodes(
    scenario: Scenario, generator: np.random.Generator
) -> tuple[list[EpisodeSummary], list[EpisodeSummary]]:
    """Draw the episodes of a case, as many as a case may play at most, and as many episodes of its baseline."""
    before, now = (_episodes(play, generator) for play in (scenario.before, scenario.now))
    same_share = {"identical": 1.0, "half": 0.5, "independent": 0.0}[scenario.pairing]
    is_same = generator.random(len(now)) < same_share
    return [old if is_kept else new for old, new, is_kept in zip(before, now, is_same, strict=True)], before


def first_verdict(
    now: Sequence[EpisodeSummary], before: Sequence[EpisodeSummary], error: float
) -> tuple[Judgement, int]:
    """Return the first verdict that is certain or final, and the number of episodes that it took."""
    from tltl_runtime.regression.suite.suite import LEAST_EPISODES
    from tltl_runtime.regression.suite.thresholds import Thresholds
    from tltl_runtime.regression.verdict.verdict import judge

    thresholds = Thresholds()
    for count in range(LEAST_EPISODES, len(now) + 1):
        judgement = judge(now[:count], before, len(now), thresholds, error)
        if judgement:
            return judgement, count
    raise AssertionError("the last episode settles every verdict")


def probability_in_suite(share: float, size: int) -> float:
    """Return the probability that an event of probability ``share`` happens in at least one of ``size`` cases."""
    return float(1.0 - (1.0 - share) ** size)


def upper_limit(share: float, trials: int) -> float:
    """Return the upper limit, at 95 %, of the probability of an event that happened in ``share`` of the trials.

    With any greater probability, the event would happen at most this often in less than 1 of 20 sets
    of trials (C. Clopper, E. Pearson, Biometrika 26 (1934), 404-413).
    """
    count = round(share * trials)
    low, high = share, 1.0
    for _ in range(50 if count < trials else 0):
        middle = (low + high) / 2
        low, high = (middle, high) if _probability_of_at_most(count, trials, middle) >= 0.05 else (low, middle)
    return high


def _probability_of_at_most(count: int, trials: int, probability: float) -> float:
    """Return the probability that an event happens in at most ``count`` of the trials."""
    logs = log(probability), log1p(-probability)
    terms = (
        lgamma(trials + 1) - lgamma(hits + 1) - lgamma(trials - hits + 1) + hits * logs[0] + (trials - hits) * logs[1]
        for hits in range(count + 1)
    )
    return fsum(map(exp, terms))


def _episodes(play: Play, generator: np.random.Generator) -> list[EpisodeSummary]:
    import numpy as np

    from tltl_runtime.regression.suite.suite import MOST_EPISODES

    count = MOST_EPISODES
    successes = generator.random(count) < play.rate
    progress = np.where(successes, 1.0, generator.choice(_STAGES, count))
    rewards = np.where(
        successes, generator.normal(play.reward, play.spread, count), generator.normal(*_FAILED, count)
    ).clip(-1.0, 1.0)
    draws = zip(successes.tolist(), progress.tolist(), rewards.tolist(), strict=True)
    return [_summary(index, *draw) for index, draw in enumerate(draws)]


def _summary(index: int, success: bool, progress: float, reward: float) -> EpisodeSummary:
    """Return the summary of an episode; verdicts do not use its steps and its last state."""
    from tltl_runtime.spec.episode_summary import EpisodeSummary

    return EpisodeSummary(index, None, success, "success" if success else "limit", progress, reward, 1, 0)


def _shares(judgements: Sequence[tuple[Judgement, int]]) -> Mapping[str, float]:
    """Return the shares of verdicts, uncertain verdicts, certain changes and early findings.

    ``episodes`` is the mean number of episodes that a verdict took.
    """
    counts = Counter(judgement.verdict for judgement, _ in judgements)
    early = {f"changed_by_{latest}": _count_found_by(judgements, latest) for latest in LATEST}
    figures = {
        **{verdict: counts[verdict] for verdict in ("pass", "review", "fail")},
        "uncertain": sum(not judgement.certain for judgement, _ in judgements),
        "certain_change": sum(bool(judgement.changes) for judgement, _ in judgements),
        **early,
    }
    total = len(judgements)
    shares = {name: round(count / total, 5) for name, count in figures.items()}
    return {**shares, "episodes": round(sum(count for _, count in judgements) / total, 1)}


def _count_found_by(judgements: Sequence[tuple[Judgement, int]], latest: int) -> int:
    return sum(count <= latest and judgement.verdict != "pass" for judgement, count in judgements)
