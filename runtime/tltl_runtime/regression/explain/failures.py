"""How failed episodes end, put together by what is alike: a text for each group of them."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Collection, Iterator, Mapping, Sequence
from typing import Final, TypeVar

from tltl_runtime.regression.explain.account import Account
from tltl_runtime.regression.explain.nearest_miss import approach, remained
from tltl_runtime.regression.explain.places import in_the_way, place_name
from tltl_runtime.regression.explain.stages import deed
from tltl_runtime.stealth.level import Level
from tltl_runtime.stealth.recordings.cause import Kind
from tltlc.automaton.fspa import Fspa
from tltlc.core.record import record, replace

_T = TypeVar("_T")
_What = tuple[Kind, tuple[str, ...]]

_FEW: Final = 3
"""Ends are told of that so many episodes have, or one in ten; of more kinds than that, the most frequent."""


@record
class End:
    """How and where an episode failed, and what it would have had to do next."""

    cause: Kind
    by: tuple[str, ...]
    where: str
    undone: str

    @property
    def what(self) -> _What:
        """What made it fail, wherever and whenever."""
        return self.cause, self.by


@record
class Failures:
    """Episodes that fail alike: in words, and in more words.  ``alike`` says whether others do that end so, of those
    that are alike to no earlier group.
    """

    text: str
    accounts: tuple[Account, ...]
    alike: Callable[[End], bool]
    more: str = ""


def end_of(level: Level, fspa: Fspa, account: Account) -> End:
    """How a failed episode ended."""
    by = tuple(sorted(account.by))
    return End(account.cause, by, place_name(level, account.place), deed(fspa, account.unmet))


def failures(level: Level, fspa: Fspa, accounts: Sequence[Account]) -> Iterator[Failures]:
    """The failed ones of some episodes, the most frequent ends first; no two texts are equal."""
    groups: dict[End, list[Account]] = {}
    for each in accounts:
        if not each.success:
            groups.setdefault(end_of(level, fspa, each), []).append(each)
    frequent = _often(groups, len(accounts))
    stages = Counter(replace(end, undone="") for end in groups)
    for end in frequent:
        # Where one end comes in several stages, the texts must tell them apart.
        stage = f" before it {end.undone}" if stages[replace(end, undone="")] > 1 else ""
        found = groups[end]
        more = f"{approach(level, fspa, end.undone, found)}; {remained(fspa, found)}"
        yield Failures(_told(level, end, found) + stage, tuple(found), end.__eq__, more)
    few = {end: found for end, found in groups.items() if end not in frequent}
    yield from _few(level, few, frequent, len(accounts))


def _often(groups: Mapping[_T, Sequence[Account]], episodes: int) -> list[_T]:
    """The keys of the most frequent groups, of those that are not small."""
    found = sorted(groups, key=lambda each: -len(groups[each]))[:_FEW]
    return [each for each in found if len(groups[each]) >= _FEW or 10 * len(groups[each]) >= episodes]


def _few(
    level: Level, groups: Mapping[End, Sequence[Account]], frequent: Collection[End], episodes: int
) -> Iterator[Failures]:
    """What is left of the ends: those of one cause together, and then all of causes that have few."""
    causes: dict[_What, list[Account]] = {}
    for end, found in groups.items():
        causes.setdefault(end.what, []).extend(found)
    often = _often(causes, episodes)
    left = [what for what in causes if what not in often]
    if len(left) == 1:
        often += left
        left = []
    for what in often:
        same = [end for end in groups if end.what == what]
        told, alike = _one_cause(level, same, causes[what], frequent)
        yield Failures(told, tuple(causes[what]), alike)
    if left:
        otherwise = " otherwise" if frequent or often else ""
        yield Failures(f"fails{otherwise}", tuple(each for what in left for each in causes[what]), lambda _: True)


def _one_cause(
    level: Level, ends: Sequence[End], accounts: Sequence[Account], frequent: Collection[End]
) -> tuple[str, Callable[[End], bool]]:
    """How these ends of one cause are told of together, and whether another end is meant by that, too.

    Those in ``frequent`` are told of apart.
    """
    what, places, stages = ends[0].what, {end.where for end in ends}, {end.undone for end in ends}
    apart = {end.where for end in frequent if end.what == what}
    if len(places) == 1:
        (where,) = places
    else:
        where = "elsewhere" if apart and apart.isdisjoint(places) else "in different places"
    stage = ""
    if len(stages) == 1 and len({end.undone for end in (*frequent, *ends)}) > 1:
        stage = f" before it {ends[0].undone}"
    elif places <= apart:
        stage = " at other stages"

    def alike(end: End) -> bool:
        there = end.where in places if len(places) == 1 else where != "elsewhere" or end.where not in apart
        return end.what == what and there and (not stage.startswith(" before") or end.undone in stages)

    return _told(level, replace(ends[0], where=where), accounts) + stage, alike


def _told(level: Level, end: End, accounts: Sequence[Account]) -> str:
    """The end of these episodes, in words; behind asides there is a comma, since how many they are comes next."""
    by = f" by {_names(end.by)}" if end.by else ""
    broke = _mostly("breaking", [each.broke for each in accounts])
    saw = _mostly("seen by", [[name for name in each.seen_by if name not in end.by] for each in accounts])
    if end.cause == "killed":
        return f"dies {end.where}{by}{broke}{saw}" + "," * bool(broke or saw)
    if end.cause == "violated":
        return f"breaks the spec {end.where} ({_names(end.by)}){saw}" + "," * bool(saw)
    ends = [(each.place, each.shut) for each in accounts]
    stopped = in_the_way(level, ends)
    mostly = "" if all(set(stopped) <= set(in_the_way(level, [each])) for each in ends) else "mostly "
    return f"runs out of time {end.where}" + (f", {mostly}at {_names(stopped)}," if stopped else "")


def _mostly(what: str, named: Sequence[Sequence[str]]) -> str:
    """The names that more than half of the episodes have, behind a comma; empty where there is none."""
    counts = Counter(name for names in named for name in names)
    often = [name for name, count in counts.items() if 2 * count > len(named)]
    if not often:
        return ""
    rarely = any(counts[name] < len(named) for name in often)
    return f", {'mostly ' if rarely else ''}{what} {_names(often)}"


def _names(names: Sequence[str]) -> str:
    *before, last = (f"`{name}`" for name in names)
    return f"{', '.join(before)} and {last}" if before else last
