"""Reports on real episodes of real levels, without a trained policy: the expert played them."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from functools import cache

from tests.runtime.stealth.expert_episodes import played
from tltl_runtime.evaluation.figures import figures_of
from tltl_runtime.game.episode import RecordedEpisode
from tltl_runtime.game.episode_summary import summary_of
from tltl_runtime.regression.explain.explain import findings
from tltl_runtime.regression.explain.explained_episode import ExplainedEpisode, explain_episode, summaries_of
from tltl_runtime.regression.report.case_report import CaseReport
from tltl_runtime.regression.report.page.contents import ReportedCase, SuiteReport
from tltl_runtime.regression.verdict.verdict import CaseVerdict
from tltl_runtime.stealth.env import make_env
from tltl_runtime.stealth.episode_recorder import RecordEpisode
from tltl_runtime.stealth.recordings.episode import Episode


def navigation() -> tuple[Episode, ...]:
    """Return two episodes on the level navigation that meet the spec."""
    return _played("navigation", 2)


def branching() -> tuple[Episode, ...]:
    """Return one episode on the level branching, which has two enemies, movers and a laser."""
    return _played("branching", 1)


def cover_and_hide_met() -> tuple[Episode, ...]:
    """Return two episodes on the level cover_and_hide that meet the spec."""
    return _played("cover_and_hide", 2)


def cover_and_hide_failed() -> tuple[Episode, ...]:
    """Return three episodes on the level cover_and_hide, of a player that does not hide."""
    return _played("cover_and_hide", 3, careful=False)


@cache
def _played(level: str, count: int, *, careful: bool = True) -> tuple[Episode, ...]:
    return tuple(played(level, seed=seed, careful=careful) for seed in range(count))


@cache
def branching_that_takes_its_time() -> Episode:
    """Return an episode of a player that walks in circles until the limit of the spec."""
    env = RecordEpisode(make_env("branching", "v0"), "nobody")
    try:
        env.reset(seed=0)
        done, step = False, 0
        while not done:
            _, _, terminated, truncated, _ = env.step([1 + step // 3 % 2, 1 + step // 5 % 2, 0, 0, 0])
            done, step = terminated or truncated, step + 1
        return env.episode
    finally:
        env.close()


def explained_of(index: int, episode: RecordedEpisode) -> ExplainedEpisode:
    """Return an episode with its explanation, as if a case had played it."""
    return explain_episode(summary_of(episode, index), episode)


def reported(
    name: str,
    verdict: CaseVerdict,
    now: Sequence[RecordedEpisode],
    before: Sequence[RecordedEpisode],
    recorded: Iterable[int] | None = None,
) -> ReportedCase:
    """Return a report on episodes of one level; the episodes ``before`` are the baseline.

    Of the episodes ``now``, those with the indices ``recorded`` have a recording, by default all.
    """
    level, fspa = now[0].level, now[0].fspa
    explained_episodes, baseline_episodes = (
        [explained_of(index, episode) for index, episode in enumerate(episodes)] for episodes in (now, before)
    )
    explanation = findings(level, fspa, explained_episodes, baseline_episodes)
    passed = sum(explained.summary.success for explained in explained_episodes)
    report = CaseReport(
        name=name,
        level=level.name,
        variant=level.variant,
        verdict=verdict,
        rate_interval=(0.0, 0.4) if verdict == "fail" else (0.9, 1.0),
        causes=(f"met in {passed} of {len(now)} episodes",),
        figures=figures_of(summaries_of(explained_episodes)),
        baseline=figures_of(summaries_of(baseline_episodes)),
        explanation=explanation,
        episodes=tuple(explained_episodes),
    )
    indices = range(len(now)) if recorded is None else recorded
    return ReportedCase(
        report, level, fspa, {index: now[index] for index in indices}, tuple(baseline_episodes), before[0].level
    )


@cache
def suite() -> SuiteReport:
    """Return a report on three cases: one passes, one with enemies fails, one cannot be played."""
    failed, met = cover_and_hide_failed(), cover_and_hide_met()
    broken = CaseReport("broken:v0", "broken", "v0", "fail", ("it cannot be played", "TLT0803: no `start`"))
    return SuiteReport(
        suite="sample",
        seed=7,
        error=0.05,
        versions={"tltlc": "0.1", "python": "3.11"},
        cases=(
            reported("navigation:v0", "pass", navigation(), navigation()),
            reported("cover_and_hide:v0", "fail", failed, met, recorded=(0, 1)),
            ReportedCase(broken),
        ),
    )
