"""Explanations: what a policy does differently from the baseline, in sentences that name episodes."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from statistics import fmean
from typing import Final

from tltl_runtime.game.geometry import Region
from tltl_runtime.game.level import Level
from tltl_runtime.regression.explain.account import Account
from tltl_runtime.regression.explain.failures import end_of, failures
from tltl_runtime.regression.explain.path_points import places_along
from tltl_runtime.regression.explain.stages import Subgoal, subgoal_of_all, subgoals_text
from tltl_runtime.support.number_text import counted, percent
from tltlc.api import Fspa, record

_ALIKE: Final = 0.05
"""Shares of episodes that complete a stage count as equal if they differ by less than this."""

_USUAL: Final = 0.8
"""A stage that more than this share of the episodes completes is named in the explanation."""

_OTHERWISE: Final = 0.4
"""Shares of successful episodes that pass through a region are reported if they differ by this much."""

_SLOWER: Final = 1.15
"""Mean lengths of successes count as equal if their ratio is less than this."""

_FEW: Final = 3
"""The least number of successes that are described."""


@record
class Finding:
    """A sentence and the indices of episodes that show it.

    If ``others`` is true, the indices are the episodes that do not do what the sentence says.
    """

    text: str
    episodes: tuple[int, ...]
    others: bool = False


def findings(level: Level, fspa: Fspa, now: Sequence[Account], before: Sequence[Account]) -> tuple[Finding, ...]:
    """Compare the episodes with the baseline: stages, ends of failures, lengths and regions.

    ``level`` is the level that was played now.
    """
    return (
        *_stages(fspa, now, before),
        *(finding for _, finding in _ends(level, fspa, now, before)),
        *_lengths(now, before),
        *_regions(level, now, before),
    )


def _stages(fspa: Fspa, now: Sequence[Account], before: Sequence[Account]) -> Iterator[Finding]:
    """Describe the completed stages in one sentence, up to the first stage whose share has changed."""
    done: list[Subgoal] = []
    for distance, states in _visited(fspa, (*now, *before)):
        passed_now, passed_before = (_passed(fspa, accounts, distance) for accounts in (now, before))
        stage = subgoal_of_all(fspa, states, distance)
        if abs(len(passed_now) / len(now) - len(passed_before) / len(before)) < _ALIKE:
            if len(passed_now) / len(now) > _USUAL:
                done.append(stage)
            continue
        first = f"{subgoals_text(done)} as before, then " if done else ""
        failed = tuple(account.summary.index for account in now if account not in passed_now)
        counts = [
            counted(len(passed), len(all_), "episodes") for passed, all_ in ((passed_now, now), (passed_before, before))
        ]
        text = f"{first}{stage.text} in {counts[0]}; before: in {counts[1]}"
        yield Finding(text, failed, others=True)
        return
    if done:
        yield Finding(f"{subgoals_text(done)} as before", ())


def _visited(fspa: Fspa, accounts: Sequence[Account]) -> list[tuple[int, set[int]]]:
    """The visited states that are neither accepting nor traps, grouped by distance, greatest first."""
    states_by_distance: dict[int, set[int]] = {}
    for state in {arrival.state for account in accounts for arrival in account.arrivals}:
        if distance := fspa.states[state].distance:
            states_by_distance.setdefault(distance, set()).add(state)
    return sorted(states_by_distance.items(), reverse=True)


def _passed(fspa: Fspa, accounts: Sequence[Account], distance: int) -> list[Account]:
    """The episodes that came nearer to acceptance than ``distance`` transitions."""
    return [account for account in accounts if min(_distances(fspa, account)) < distance]


def _distances(fspa: Fspa, account: Account) -> list[int]:
    distances = [fspa.states[arrival.state].distance for arrival in account.arrivals]
    return [distance for distance in distances if distance is not None] or [fspa.spec_size]


def most_frequent_end(level: Level, fspa: Fspa, now: Sequence[Account], before: Sequence[Account]) -> str | None:
    """Describe how most failed episodes end, without details; None if no episode failed."""
    return next((headline for headline, _ in _ends(level, fspa, now, before)), None)


def _ends(level: Level, fspa: Fspa, now: Sequence[Account], before: Sequence[Account]) -> Iterator[tuple[str, Finding]]:
    """Describe how failed episodes end, most frequent first, in short and in full.  All sentences are distinct."""
    ends_before = [end_of(level, fspa, account) for account in before if not account.summary.success]
    for group in failures(level, fspa, now):
        matches = [group.alike(end) for end in ends_before]
        ends_before = [end for end, is_alike in zip(ends_before, matches, strict=True) if not is_alike]
        headline = f"{group.text} in {_of(len(group.accounts), now)}"
        text = f"{headline}; before: in {_of(sum(matches), before)}{group.more}"
        yield headline, Finding(text, tuple(sorted(account.summary.index for account in group.accounts)))


def _lengths(now: Sequence[Account], before: Sequence[Account]) -> Iterator[Finding]:
    new, old = (
        [account.summary.steps for account in accounts if account.summary.success] for accounts in (now, before)
    )
    if min(len(new), len(old)) >= _FEW:
        ratio = fmean(new) / fmean(old)
        if not 1 / _SLOWER < ratio < _SLOWER:
            how = "longer" if ratio > 1 else "shorter"
            text = f"successes are {how}: {fmean(new):.0f} steps on average; before: {fmean(old):.0f}"
            yield Finding(text, tuple(account.summary.index for account in now if account.summary.success))


def _regions(level: Level, now: Sequence[Account], before: Sequence[Account]) -> Iterator[Finding]:
    """Describe regions that clearly more or fewer of the successful episodes pass through than before."""
    new, old = ([account for account in accounts if account.summary.success] for accounts in (now, before))
    if min(len(new), len(old)) < _FEW:
        return
    for region in level.regions:
        visits_now, visits_before = (
            [account for account in accounts if _visits(account, region)] for accounts in (new, old)
        )
        share, share_before = len(visits_now) / len(new), len(visits_before) / len(old)
        if abs(share - share_before) >= _OTHERWISE:
            name = region.name.replace("_", " ")
            text = (
                f"{percent(share)} of the successful episodes pass through the {name}; before: {percent(share_before)}"
            )
            yield Finding(text, tuple(account.summary.index for account in visits_now))


def _visits(account: Account, region: Region) -> bool:
    (x0, y0, _), (x1, y1, _) = region.box.low, region.box.high
    return any(x0 <= x <= x1 and y0 <= y <= y1 for x, y in (*places_along(account.way), account.place[:2]))


def _of(count: int, accounts: Sequence[Account]) -> str:
    return f"{count} of {len(accounts)} episodes"
