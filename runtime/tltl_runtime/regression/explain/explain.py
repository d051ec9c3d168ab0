"""Explanations: what a policy does otherwise than in the baseline, in sentences that name episodes."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from statistics import fmean
from typing import Final

from tltl_runtime.regression.explain.account import Account
from tltl_runtime.regression.explain.failures import end_of, failures
from tltl_runtime.regression.explain.path_points import places_along
from tltl_runtime.regression.explain.stages import deed_of_all, together
from tltl_runtime.stealth.level import Level, Region
from tltl_runtime.support.number_text import counted, percent
from tltlc.automaton.fspa import Fspa
from tltlc.core.record import record

_ALIKE: Final = 0.05
"""Shares of episodes that come to a stage and differ by less are told of as alike."""

_USUAL: Final = 0.8
"""What more episodes do than this share is told of as what is done."""

_OTHERWISE: Final = 0.4
"""Shares of the successful episodes that go through a region are told of where they differ by so much."""

_SLOWER: Final = 1.15
"""Mean lengths of successes whose ratio is less are alike."""

_FEW: Final = 3
"""Of fewer successes nothing is told."""


@record
class Finding:
    """A sentence, and the indices of the episodes that it speaks of; ``others``: of all that do not do what it says."""

    text: str
    episodes: tuple[int, ...]
    others: bool = False


def findings(level: Level, fspa: Fspa, now: Sequence[Account], before: Sequence[Account]) -> tuple[Finding, ...]:
    """How the episodes go, stage by stage, and how those end that fail; against the baseline's.

    ``level`` is the one that was played now.
    """
    return (
        *_stages(fspa, now, before),
        *ends(level, fspa, now, before),
        *_lengths(now, before),
        *_regions(level, now, before),
    )


def _stages(fspa: Fspa, now: Sequence[Account], before: Sequence[Account]) -> Iterator[Finding]:
    """Up to which stage the episodes come; one sentence for all that is as before, one for the first that is not."""
    done: list[str] = []
    for distance, states in _visited(fspa, (*now, *before)):
        came, used = (_passed(fspa, accounts, distance) for accounts in (now, before))
        what = deed_of_all(fspa, states, distance)
        if abs(len(came) / len(now) - len(used) / len(before)) < _ALIKE:
            if len(came) / len(now) > _USUAL:
                done.append(what)
            continue
        first = f"{together(done)} as before, then " if done else ""
        failed = tuple(each.index for each in now if each not in came)
        counts = [counted(len(some), len(all_), "episodes") for some, all_ in ((came, now), (used, before))]
        text = f"{first}{what} in {counts[0]}; before: in {counts[1]}"
        yield Finding(text, failed, others=True)
        return
    if done:
        yield Finding(f"{together(done)} as before", ())


def _visited(fspa: Fspa, accounts: Sequence[Account]) -> list[tuple[int, set[int]]]:
    """The states that any of the episodes came to and that are not accepting, by their distance, the greatest first."""
    found: dict[int, set[int]] = {}
    for state in {arrival.state for each in accounts for arrival in each.arrivals}:
        if distance := fspa.states[state].distance:
            found.setdefault(distance, set()).add(state)
    return sorted(found.items(), reverse=True)


def _passed(fspa: Fspa, accounts: Sequence[Account], distance: int) -> list[Account]:
    """The episodes that came nearer to acceptance than ``distance``."""
    return [each for each in accounts if min(_distances(fspa, each)) < distance]


def _distances(fspa: Fspa, account: Account) -> list[int]:
    found = [fspa.states[arrival.state].distance for arrival in account.arrivals]
    return [distance for distance in found if distance is not None] or [fspa.spec_size]


def ends(level: Level, fspa: Fspa, now: Sequence[Account], before: Sequence[Account]) -> Iterator[Finding]:
    """How the failed episodes end, the most frequent first; no two sentences are equal."""
    left = [end_of(level, fspa, each) for each in before if not each.success]
    for group in failures(level, fspa, now):
        used = [group.alike(end) for end in left]
        left = [end for end, is_alike in zip(left, used, strict=True) if not is_alike]
        text = f"{group.text} in {_of(len(group.accounts), now)}; before: in {_of(sum(used), before)}{group.more}"
        yield Finding(text, tuple(sorted(each.index for each in group.accounts)))


def _lengths(now: Sequence[Account], before: Sequence[Account]) -> Iterator[Finding]:
    new, old = ([each.steps for each in accounts if each.success] for accounts in (now, before))
    if min(len(new), len(old)) >= _FEW:
        ratio = fmean(new) / fmean(old)
        if not 1 / _SLOWER < ratio < _SLOWER:
            how = "longer" if ratio > 1 else "shorter"
            text = f"successes are {how}: {fmean(new):.0f} steps on average; before: {fmean(old):.0f}"
            yield Finding(text, tuple(each.index for each in now if each.success))


def _regions(level: Level, now: Sequence[Account], before: Sequence[Account]) -> Iterator[Finding]:
    """The regions that more of the successful episodes pass through than before, or fewer."""
    new, old = ([each for each in accounts if each.success] for accounts in (now, before))
    if min(len(new), len(old)) < _FEW:
        return
    for region in level.regions:
        there, used_to = ([each for each in accounts if _visits(each, region)] for accounts in (new, old))
        share, used = len(there) / len(new), len(used_to) / len(old)
        if abs(share - used) >= _OTHERWISE:
            name = region.name.replace("_", " ")
            text = f"{percent(share)} of the successful episodes pass through the {name}; before: {percent(used)}"
            yield Finding(text, tuple(each.index for each in there))


def _visits(account: Account, region: Region) -> bool:
    (x0, y0, _), (x1, y1, _) = region.box.low, region.box.high
    return any(x0 <= x <= x1 and y0 <= y <= y1 for x, y in (*places_along(account.way), account.place[:2]))


def _of(count: int, accounts: Sequence[Account]) -> str:
    return f"{count} of {len(accounts)} episodes"
