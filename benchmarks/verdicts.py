"""How good the verdicts of ``tltlc regress`` are: the rule itself, on episodes that are drawn at random.

Episodes are like those of the shipped policies: successes with a reward around 0.79, failures below 0 at some stage of
the spec.  A case is drawn many times and judged in suites of 1, 9 and 30 cases; how often a whole suite has a verdict
follows, since its cases are independent.
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
"""Of equal seeds, the same episodes as in the baseline: all of them, half of them by chance, or none."""

ERROR: Final = 0.05
"""Of a suite, as it is where a suite says nothing else."""

LATEST: Final = (25, 50, 100)
"""Numbers of episodes by which a verdict is counted, beside all."""

_RARE: Final = 0.97
"""From this pass rate on false alarms are rare."""

JUST_BELOW: Final = 0.849
"""A pass rate that no other one below the threshold is as hard to tell from."""

THRESHOLD: Final = 0.05
"""Of progress and reward, as it is where a suite says nothing else."""

_STAGES: Final = (0.25, 0.5, 0.75)
"""The progress of failures, as likely one as the other."""
_FAILED: Final = (-0.3, 0.2)
"""Mean and standard deviation of their reward."""


@dataclass(frozen=True, slots=True)
class Play:
    """How a policy plays: its pass rate, and mean and standard deviation of the reward of successes."""

    rate: float
    reward: float = 0.79
    spread: float = 0.05


@dataclass(frozen=True, slots=True)
class Scenario:
    """What a policy does now, and what it did when the baseline was recorded."""

    now: Play
    before: Play
    pairing: Pairing = "independent"

    @property
    def is_slight(self) -> bool:
        """Whether something has changed, and by less than its threshold."""
        now, before = self.now, self.before
        return now != before and now.rate == before.rate and abs(now.reward - before.reward) < THRESHOLD

    @property
    def is_rare(self) -> bool:
        """Whether what a verdict may do wrong is rare, so that many trials are needed to see it."""
        same = self.now == self.before
        return self.is_slight or (same and (self.now.rate >= _RARE or self.now.rate == JUST_BELOW))

    @property
    def name(self) -> str:
        """As it stands in the results."""
        now, before = self.now, self.before
        if now == before:
            return f"{now.rate:g} {self.pairing}"
        parts = [
            f"{what} {old:g} to {new:g}"
            for what, old, new in (("rate", before.rate, now.rate), ("reward", before.reward, now.reward))
            if old != new
        ]
        return f"{', '.join(parts)}, ± {now.spread:g}"


def _unchanged() -> Iterator[Scenario]:
    for rate in (1.0, 0.99, 0.98, 0.97, 0.95):
        for pairing in ("identical", "half", "independent"):
            yield Scenario(Play(rate), Play(rate), pairing)
    for rate in (0.92, 0.9, 0.85, JUST_BELOW, 0.8, 0.7, 0.6, 0.499, 0.4, 0.3, 0.0):
        yield Scenario(Play(rate), Play(rate), "identical")


def _changed() -> Iterator[Scenario]:
    for reward, spread in ((0.75, 0.05), (0.745, 0.15)):
        yield Scenario(Play(0.98, reward, spread), Play(0.98, 0.79, spread))
    for reward, spread in ((0.65, 0.05), (0.65, 0.15), (0.69, 0.05), (0.69, 0.15)):
        yield Scenario(Play(0.98, reward, spread), Play(0.98, 0.74, spread))
    for before, now in ((1.0, 0.9), (0.98, 0.9), (0.97, 0.88), (0.98, 0.8), (0.98, 0.6), (0.98, 0.3)):
        yield Scenario(Play(now), Play(before))


@dataclass(frozen=True, slots=True)
class Plan:
    """What is measured: each scenario, so many ``trials`` of a case, in suites of ``sizes`` cases.

    Where verdicts come late, or errors are frequent, ``few`` trials have to do.
    """

    scenarios: Sequence[Scenario] = field(default_factory=lambda: (*_unchanged(), *_changed()))
    trials: int = 4000
    few: int = 500
    sizes: Sequence[int] = (1, 9, 30)


def measure(store: Store, _: float, say: Callable[[str], None], plan: Plan | None = None) -> None:
    """Draw what the store does not have yet."""
    if find_spec("numpy") is None:
        say(f"{SECTION} left out: numpy is not installed (the extra `rl`, Python 3.10 or 3.11)")
        return
    made = plan or Plan()
    scenarios = {scenario.name: scenario for scenario in made.scenarios}

    def record(name: str) -> Record:
        scenario = scenarios[name]
        return measured(scenario, made.trials if scenario.is_rare else made.few, made.sizes)

    measure_missing(store, SECTION, scenarios, record, say, done="suites", like={"rule": rule()})


def rule() -> str:
    """Twelve hexadecimal digits that stand for the rule: figures of another one are measured again."""
    return source_digest(*(f"runtime/tltl_runtime/regression/verdict/{name}.py" for name in ("verdict", "confidence")))


def measured(scenario: Scenario, trials: int, sizes: Sequence[int]) -> Record:
    """How a case is judged, by the number of cases of its suite; equal arguments give equal figures."""
    import numpy as np

    generator = np.random.default_rng(zlib.crc32(scenario.name.encode()))
    found: dict[int, list[tuple[Judgement, int]]] = {size: [] for size in sizes}
    for _ in range(trials):
        now, before = drawn(scenario, generator)
        for size in sizes:
            found[size].append(judged(now, before, ERROR / size))
    return {
        "trials": trials,
        "rule": rule(),
        "rates": [scenario.before.rate, scenario.now.rate],
        "pairing": scenario.pairing,
        "changed": scenario.now != scenario.before,
        "slight": scenario.is_slight,
        "suites": {str(size): _shares(judgements) for size, judgements in found.items()},
    }


def drawn(scenario: Scenario, generator: np.random.Generator) -> tuple[list[EpisodeSummary], list[EpisodeSummary]]:
    """The episodes of a case and of its baseline, as many as are played at the most."""
    before, now = (_episodes(play, generator) for play in (scenario.before, scenario.now))
    same = {"identical": 1.0, "half": 0.5, "independent": 0.0}[scenario.pairing]
    kept = generator.random(len(now)) < same
    return [old if keep else new for old, new, keep in zip(before, now, kept, strict=True)], before


def judged(now: Sequence[EpisodeSummary], before: Sequence[EpisodeSummary], error: float) -> tuple[Judgement, int]:
    """The verdict, and after how many episodes it came."""
    from tltl_runtime.regression.suite.suite import LEAST_EPISODES, Thresholds
    from tltl_runtime.regression.verdict.verdict import judge

    thresholds = Thresholds()
    for count in range(LEAST_EPISODES, len(now) + 1):
        judgement = judge(now[:count], before, len(now), thresholds, error)
        if judgement:
            return judgement, count
    raise AssertionError("the last episode settles every verdict")


def in_suite(share: float, size: int) -> float:
    """How likely it is that something happens in at least one of so many independent cases."""
    return float(1.0 - (1.0 - share) ** size)


def at_most(share: float, trials: int) -> float:
    """The upper limit of 95 % for what happened in a share of the trials.

    The greatest probability with which it happens that seldom in at least 1 of 20 simulations (C. Clopper, E. Pearson,
    Biometrika 26 (1934), 404-413).
    """
    count = round(share * trials)
    low, high = share, 1.0
    for _ in range(50 if count < trials else 0):
        middle = (low + high) / 2
        low, high = (middle, high) if _seldom(count, trials, middle) >= 0.05 else (low, middle)
    return high


def _seldom(count: int, trials: int, probability: float) -> float:
    """How likely at most ``count`` of the trials are."""
    logs = log(probability), log1p(-probability)
    each = (
        lgamma(trials + 1) - lgamma(done + 1) - lgamma(trials - done + 1) + done * logs[0] + (trials - done) * logs[1]
        for done in range(count + 1)
    )
    return fsum(map(exp, each))


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
    """The summary of an episode; a verdict does not look at its steps and its last state."""
    from tltl_runtime.spec.episode_summary import EpisodeSummary

    return EpisodeSummary(index, None, success, "success" if success else "limit", progress, reward, 1, 0)


def _shares(judgements: Sequence[tuple[Judgement, int]]) -> Mapping[str, float]:
    """Shares of the verdicts, of those that are not certain, of figures that are said to have certainly changed, and of
    changes that were found early; mean episodes.
    """
    counts = Counter(judgement.verdict for judgement, _ in judgements)
    early = {f"changed_by_{latest}": _found_by(judgements, latest) for latest in LATEST}
    figures = {
        **{verdict: counts[verdict] for verdict in ("pass", "review", "fail")},
        "uncertain": sum(not judgement.certain for judgement, _ in judgements),
        "certain_change": sum(bool(judgement.changes) for judgement, _ in judgements),
        **early,
    }
    total = len(judgements)
    shares = {name: round(count / total, 5) for name, count in figures.items()}
    return {**shares, "episodes": round(sum(count for _, count in judgements) / total, 1)}


def _found_by(judgements: Sequence[tuple[Judgement, int]], latest: int) -> int:
    return sum(count <= latest and judgement.verdict != "pass" for judgement, count in judgements)
