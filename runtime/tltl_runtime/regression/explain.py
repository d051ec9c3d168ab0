"""Explanations: what a policy does otherwise than in the baseline, in sentences that name episodes."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Sequence
from statistics import fmean
from typing import Final

from tltl_runtime.regression.account import Account, Nearest
from tltl_runtime.regression.places import in_the_way, place_name
from tltl_runtime.regression.stages import REACHES, deed, deed_of_all, together
from tltl_runtime.regression.way import places_along
from tltl_runtime.stealth.episodes.cause import Kind
from tltl_runtime.stealth.level import Level, Region
from tltl_runtime.texts import number, percent
from tltlc.automaton.fspa import Fspa
from tltlc.record import record

_ALIKE: Final = 0.05
"""Shares of episodes that come to a stage and differ by less are told of as alike."""

_USUAL: Final = 0.8
"""What more episodes do than this share is told of as what is done."""

_OTHERWISE: Final = 0.4
"""Shares of the successful episodes that go through a region are told of where they differ by so much."""

_SLOWER: Final = 1.15
"""Mean lengths of successes whose ratio is less are alike."""

_FEW: Final = 3
"""Ends are told of that so many episodes have, or one in ten; of more kinds than that, the most frequent.  Of fewer
successes nothing is told."""


@record
class Finding:
    """A sentence, and the indices of the episodes that it speaks of."""

    text: str
    episodes: tuple[int, ...]


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
        text = f"{first}{what} in {_of(len(came), now)}; before: in {_of(len(used), before)}"
        yield Finding(text, failed)
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
    groups: dict[tuple[_End, str], list[Account]] = {}
    for each in now:
        if not each.success:
            groups.setdefault(_kind(level, fspa, each), []).append(each)
    often = sorted(groups.items(), key=lambda item: -len(item[1]))[:_FEW]
    frequent = {kind: each for kind, each in often if len(each) >= _FEW or 10 * len(each) >= len(now)}
    stages = Counter(end for end, _ in groups)
    failed_before = Counter(_kind(level, fspa, each) for each in before if not each.success)
    for (end, undone), accounts in frequent.items():
        used = failed_before.pop((end, undone), 0)
        # Where one end comes in several stages, the sentences must tell them apart.
        stage = f" before it {undone}" if stages[end] > 1 else ""
        text = f"{_told(level, end, accounts)}{stage} in {_of(len(accounts), now)}; before: in {_of(used, before)}"
        ended = f"{text}{_approach(undone, accounts)}; {_remained(fspa, accounts)}"
        yield Finding(ended, tuple(each.index for each in accounts))
    if rest := sorted(each.index for kind, accounts in groups.items() if kind not in frequent for each in accounts):
        otherwise = "otherwise " if frequent else ""
        used = sum(failed_before.values())
        yield Finding(f"fails {otherwise}in {_of(len(rest), now)}; before: in {_of(used, before)}", tuple(rest))


@record
class _End:
    """How and where an episode failed."""

    cause: Kind
    by: tuple[str, ...]
    where: str


def _kind(level: Level, fspa: Fspa, account: Account) -> tuple[_End, str]:
    """How an episode failed, and what it would have had to do next."""
    by = tuple(sorted(account.by))
    return _End(account.cause, by, place_name(level, account.place)), deed(fspa, account.unmet)


def _told(level: Level, end: _End, accounts: Sequence[Account]) -> str:
    """The end of these episodes, in words; behind asides there is a comma, since how many they are comes next."""
    by = f" by {_names(end.by)}" if end.by else ""
    broke = _mostly("breaking", [each.broke for each in accounts])
    saw = _mostly("seen by", [[name for name in each.seen_by if name not in end.by] for each in accounts])
    if end.cause == "killed":
        return f"dies {end.where}{by}{broke}{saw}" + "," * bool(broke or saw)
    if end.cause == "violated":
        return f"breaks the spec {end.where} ({_names(end.by)}){saw}" + "," * bool(saw)
    stopped = in_the_way(level, [(each.place, each.shut) for each in accounts])
    return f"is {end.where} when time is up" + (f", at {_names(stopped)}," if stopped else "")


def _mostly(what: str, named: Sequence[Sequence[str]]) -> str:
    """The names that more than half of the episodes have, behind a comma; empty where there is none."""
    counts = Counter(name for names in named for name in names)
    often = [name for name, count in counts.items() if 2 * count > len(named)]
    if not often:
        return ""
    rarely = any(counts[name] < len(named) for name in often)
    return f", {'mostly ' if rarely else ''}{what} {_names(often)}"


def _approach(undone: str, accounts: Sequence[Account]) -> str:
    """What most of the episodes lacked of what was to be done next, behind a semicolon; where they had come to it, and
    something else broke the spec then, that.
    """
    said = ""
    if arrived := sum(each.arrived for each in accounts):
        was = "was" if arrived == 1 else "were"
        there = f"{was} at {undone.removeprefix(REACHES)}" if undone.startswith(REACHES) else "lacked nothing else"
        said = f"; {arrived} of them {there} when it broke"
    near = [each.nearest for each in accounts if each.nearest and not each.arrived]
    return f"{said}; {_limit(near)}" if 2 * len(near) > len(accounts) else said


def _limit(near: Sequence[Nearest]) -> str:
    """What was the limit most often, and how near the episodes came then at best."""
    (((atom, wanted), count),) = Counter((each.atom, each.wanted) for each in near).most_common(1)
    limited = [each for each in near if (each.atom, each.wanted) == (atom, wanted)]
    often = "" if 2 * count > len(near) else "most often "
    if not wanted:
        return f"{often}the limit is that `{atom}` holds"
    if distances := [each.distance for each in limited if each.distance is not None]:
        return f"closest approach to `{limited[0].target}`: {min(distances):.1f} m ({often}`{atom}` is the limit)"
    best = max(each.robustness for each in limited)
    # Of what is either true or false there is no better or worse.
    return f"{often}the limit is `{atom}`" + (f", {number(best, 2)} at best" if best > -1.0 else "")


def _remained(fspa: Fspa, accounts: Sequence[Account]) -> str:
    """In which state of the automaton most of the episodes failed, and what remained to be done there."""
    ((state, count),) = Counter(each.unmet for each in accounts).most_common(1)
    often = "" if count == len(accounts) else "mostly " if 2 * count > len(accounts) else "most often "
    return f"{often}in state {state}, where this remained: {fspa.states[state].label.english}"


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


def _names(names: Sequence[str]) -> str:
    *before, last = (f"`{name}`" for name in names)
    return f"{', '.join(before)} and {last}" if before else last
