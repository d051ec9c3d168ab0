"""Why a case has its verdict: sentences for people, the weightiest first."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from statistics import fmean
from typing import Final

from tltl_runtime.regression.explain.account import Account
from tltl_runtime.regression.suite.changed_keys import changed_keys
from tltl_runtime.regression.suite.level_texts import Texts
from tltl_runtime.regression.suite.suite import Thresholds
from tltl_runtime.regression.verdict.baseline import Identity
from tltl_runtime.regression.verdict.verdict import Judgement, beyond
from tltl_runtime.stealth.capabilities.feasible import check_reach, reach_warnings
from tltl_runtime.stealth.capabilities.reach import reachable
from tltl_runtime.stealth.capabilities.spec_places import SpecPlaces
from tltl_runtime.stealth.level import Level
from tltl_runtime.support.number_text import between, counted, percent_exactly
from tltlc.automaton.fspa import Fspa
from tltlc.diagnostics.diagnostic import TltlError

_OVERLAYS: Final = "overlays/"
"""How the names of overlays among the files of a level begin."""


def reasons(
    judgement: Judgement, thresholds: Thresholds, now: Sequence[Account], before: Sequence[Account]
) -> Iterator[str]:
    """What the statistics say."""
    passed, used = (sum(each.success for each in accounts) for accounts in (now, before))
    good, bad = percent_exactly(thresholds.pass_rate), percent_exactly(thresholds.fail_rate)
    met = f"met in {counted(passed, len(now), 'episodes')}, before in {counted(used, len(before))}"
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
            yield f"{_apart(figure, now, before)}; that is {getattr(thresholds, figure):g} or more, but not certain"


def _moved(figure: str, now: float, before: float) -> str:
    """That the mean of a figure is another one."""
    how = "lower" if now < before else "higher"
    return f"{figure} is {how}, {now:.2f} on average; before: {before:.2f}"


def _apart(figure: str, now: Sequence[Account], before: Sequence[Account]) -> str:
    """That the mean of a figure is another one over the seeds that both have.

    The mean of all of the baseline's episodes, which stands beside it in reports, is told where it reads otherwise.
    """
    count = min(len(now), len(before))
    new, old, of_all = (fmean(getattr(each, figure) for each in some) for some in (now[:count], before[:count], before))
    if f"{old:.2f}" == f"{of_all:.2f}":
        return _moved(figure, new, old)
    how = "lower" if new < old else "higher"
    same = f"before, in the same {count} episodes: {old:.2f} (in all {len(before)}: {of_all:.2f})"
    return f"{figure} is {how}, {new:.2f} on average; {same}"


def obstacles(level: Level, fspa: Fspa) -> Iterator[str]:
    """What nobody can reach in the level, whoever plays; of what is shut off by the same, the first."""
    found = [each for each in reach_warnings(level, fspa) if each.code == "TLT0814"]
    yield from {each.help: f"{each.title}: {each.help}" for each in reversed(found)}.values()


def is_infeasible(level: Level, fspa: Fspa) -> bool:
    """Whether nobody can do what a spec asks, whoever plays; :func:`obstacles` say why.

    False of a level that is too large to be searched.
    """
    try:
        found = check_reach(level, reachable(level), fspa, SpecPlaces(None))
    except TltlError:
        return False
    return any(each.severity == "error" for each in found)


def edits(
    now: Identity, before: Identity, changes: Sequence[str], texts: Texts = (), texts_before: Texts = ()
) -> Iterator[str]:
    """What is otherwise than in the baseline: files, what overlays say that they change (``changes``), and versions.

    Of files whose text is there, now and before, it is told which keys have changed.
    """
    old, new = dict(before.files), dict(now.files)
    differ = [name for name in dict.fromkeys((*new, *old)) if old.get(name) != new.get(name)]
    # The baseline of another variant says nothing of overlays that are not this one's.
    aside = {name for name in differ if now.variant != before.variant and name.startswith(_OVERLAYS)}
    aside -= old.keys() & new.keys()
    if changed := [name for name in differ if name not in aside]:
        words = (f"{name}{_keys(dict(texts_before).get(name), dict(texts).get(name))}" for name in changed)
        yield f"changed since the baseline: {', '.join(words)}"
    if aside:
        yield f"differs from `{before.variant}` by {', '.join(name for name in differ if name in aside)}"
    yield from changes
    for name, version in before.versions.items():
        if (here := now.versions.get(name)) != version:
            yield f"the baseline was recorded with {name} {version}, and this is {here or 'without it'}"


def _keys(before: str | None, now: str | None) -> str:
    """The keys of a file that have changed, in brackets; nothing where they are not known."""
    keys = "" if before is None or now is None else changed_keys(before, now)
    return f" ({keys})" if keys else ""
