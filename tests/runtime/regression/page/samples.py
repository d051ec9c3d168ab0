"""Reports on cases that the scripted expert has played: real episodes, real levels, nothing trained."""

from __future__ import annotations

from collections.abc import Sequence
from functools import cache

from tltl_runtime.evaluation.play import Played
from tltl_runtime.regression.account import Account, account
from tltl_runtime.regression.case_report import CaseReport, figures
from tltl_runtime.regression.explain import findings
from tltl_runtime.regression.page.page import ReportedCase, SuiteReport
from tltl_runtime.regression.verdict import Verdict
from tltl_runtime.stealth.env import make_env
from tltl_runtime.stealth.episodes.episode import Episode
from tltl_runtime.stealth.expert.expert import Expert, play_episode
from tltl_runtime.stealth.levels.file import load_level
from tltl_runtime.stealth.recording import RecordEpisode


@cache
def played(level: str, variant: str, seeds: tuple[int, ...], *, careful: bool = True) -> tuple[Episode, ...]:
    """An episode of the expert for each seed."""
    env = RecordEpisode(make_env(level, variant), "expert")
    try:
        expert = Expert(env, careful=careful)
        found = []
        for seed in seeds:
            play_episode(env, expert, seed)
            found.append(env.episode)
        return tuple(found)
    finally:
        env.close()


def account_of(index: int, episode: Episode) -> Account:
    states = episode.states.tolist()
    state = states[-1]
    unmet = states[-2] if episode.verdict == "violated" else state
    label = episode.fspa.states[unmet].label.english
    return account(
        Played(
            index=index,
            seed=episode.seed,
            success=episode.success,
            verdict=episode.verdict,
            end=episode.end,
            progress=float(episode.progress[-1]),
            reward=float(episode.rewards.sum()),
            steps=len(episode.actions),
            seconds=episode.snapshots[-1].time,
            state=state,
            unmet=unmet,
            label=label,
        ),
        episode,
    )


def reported(
    name: str,
    verdict: Verdict,
    now: Sequence[Episode],
    before: Sequence[Episode],
    recorded: Sequence[int] | None = None,
) -> ReportedCase:
    """The report on episodes of one level, of which those of the indices ``recorded`` have a recording (all)."""
    level, fspa = now[0].level, now[0].fspa
    accounts, used = ([account_of(index, each) for index, each in enumerate(episodes)] for episodes in (now, before))
    told = findings(level, fspa, accounts, used)
    passed = sum(each.success for each in accounts)
    report = CaseReport(
        name=name,
        level=level.name,
        variant=level.variant,
        verdict=verdict,
        reasons=(f"met in {passed} of {len(now)} episodes", *(finding.text for finding in told)),
        figures=figures(accounts),
        baseline=figures(used),
        explanation=told,
        accounts=tuple(accounts),
    )
    indices = range(len(now)) if recorded is None else recorded
    return ReportedCase(report, level, fspa, {index: now[index] for index in indices}, tuple(used))


@cache
def suite() -> SuiteReport:
    """A case that passes, one with enemies that fails, and one that cannot be played any more."""
    good = played("navigation", "v0", (1, 2))
    careful, careless = (
        played("cover_and_hide", variant, (1, 2, 3), careful=is_careful)
        for variant, is_careful in (("v0", True), ("v2", False))
    )
    broken = CaseReport("broken:v0", "broken", "v0", "fail", ("it cannot be played any more", "TLT0803: no `start`"))
    return SuiteReport(
        suite="sample",
        seed=7,
        error=0.05,
        versions={"tltlc": "0.1", "python": "3.11"},
        cases=(
            reported("navigation:v0", "pass", good, good),
            reported("cover_and_hide:v2", "fail", careless, careful, recorded=(0, 1)),
            ReportedCase(broken),
        ),
    )


__all__ = ["account_of", "load_level", "played", "reported", "suite"]
