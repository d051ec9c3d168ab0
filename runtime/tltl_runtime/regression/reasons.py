"""Why a case has its verdict: sentences for people, the weightiest first."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from statistics import fmean

from tltl_runtime.regression.account import Account
from tltl_runtime.regression.baseline import Identity
from tltl_runtime.regression.suite import Thresholds
from tltl_runtime.regression.verdict import Judgement, beyond
from tltl_runtime.stealth.level import Level
from tltl_runtime.stealth.supply.feasible import reach_warnings
from tltl_runtime.texts import between, percent_exactly
from tltlc.automaton.fspa import Fspa


def reasons(
    judgement: Judgement, thresholds: Thresholds, now: Sequence[Account], before: Sequence[Account]
) -> Iterator[str]:
    """What the statistics say."""
    passed, used = (sum(each.success for each in accounts) for accounts in (now, before))
    good, bad = percent_exactly(thresholds.pass_rate), percent_exactly(thresholds.fail_rate)
    met = f"met in {passed} of {len(now)} episodes, before in {used} of {len(before)}"
    if judgement.verdict == "fail":
        yield f"{met}: certainly in less than {bad}"
    elif judgement.rate_interval[0] >= thresholds.pass_rate:
        yield f"{met}: certainly in {good} or more"
    elif judgement.certain and judgement.rate_interval[1] < thresholds.pass_rate:
        yield f"{met}: certainly in {bad} to {good}"
    else:
        yield f"{met}: {between(judgement.rate_interval)} can be said for certain, and {good} are asked for"
    for change in judgement.changes:
        yield _moved(change.figure, change.now, change.before)
    if judgement.verdict == "review" and not judgement.certain:
        certain = {change.figure for change in judgement.changes}
        for figure in (each for each in beyond(now, before, thresholds) if each not in certain):
            means = [fmean(getattr(each, figure) for each in accounts) for accounts in _of_equal_seeds(now, before)]
            yield f"{_moved(figure, *means)}; that is {getattr(thresholds, figure):g} or more, but not certain"


def _moved(figure: str, now: float, before: float) -> str:
    """That the mean of a figure is another one."""
    how = "lower" if now < before else "higher"
    return f"{figure} is {how}, {now:.2f} on average; before: {before:.2f}"


def _of_equal_seeds(now: Sequence[Account], before: Sequence[Account]) -> tuple[Sequence[Account], Sequence[Account]]:
    count = min(len(now), len(before))
    return now[:count], before[:count]


def obstacles(level: Level, fspa: Fspa) -> Iterator[str]:
    """What nobody can reach in the level, whoever plays."""
    for warning in reach_warnings(level, fspa):
        if warning.code == "TLT0814":
            yield f"{warning.title}: {warning.help}"


def edits(now: Identity, before: Identity, changes: Sequence[str]) -> Iterator[str]:
    """What is otherwise than in the baseline: files, what overlays say that they change (``changes``), and versions."""
    old, new = dict(before.files), dict(now.files)
    differ = [name for name in dict.fromkeys((*new, *old)) if old.get(name) != new.get(name)]
    # The baseline of another variant says nothing of overlays that are not this one's.
    aside = {name for name in differ if now.variant != before.variant and name.startswith("overlays/")}
    aside -= old.keys() & new.keys()
    if changed := [name for name in differ if name not in aside]:
        yield f"changed since the baseline: {', '.join(changed)}"
    if aside:
        yield f"differs from `{before.variant}` by {', '.join(name for name in differ if name in aside)}"
    yield from changes
    for name, version in before.versions.items():
        if (here := now.versions.get(name)) != version:
            yield f"the baseline was recorded with {name} {version}, and this is {here or 'without it'}"
