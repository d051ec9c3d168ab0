"""Group failed episodes by how they end, with a text for each group."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Collection, Iterator, Mapping, Sequence
from typing import Final, TypeVar

from tltl_runtime.game.episode import Kind
from tltl_runtime.game.level import Level
from tltl_runtime.regression.explain.account import Account
from tltl_runtime.regression.explain.nearest_miss import approach, remained
from tltl_runtime.regression.explain.places import in_the_way, place_name
from tltl_runtime.regression.explain.stages import Subgoal, subgoal
from tltlc.api import Fspa, record, replace

_T = TypeVar("_T")
_What = tuple[Kind, tuple[str, ...]]

_FEW: Final = 3
"""Both the most kinds of ends that get texts of their own, and the least number of episodes of such a kind.

One tenth of all episodes is enough, too.
"""


@record
class FailureEnd:
    """How and where an episode failed, and what it had to do next."""

    cause: Kind
    by: tuple[str, ...]
    where: str
    undone: Subgoal

    @property
    def what(self) -> _What:
        """The cause and the names in ``by``, without place and stage."""
        return self.cause, self.by


@record
class Failures:
    """Episodes that fail alike.

    ``text`` describes the failures and ``more`` adds details.  ``alike`` tells whether an end belongs to
    the group, provided that it belongs to no earlier group.
    """

    text: str
    accounts: tuple[Account, ...]
    alike: Callable[[FailureEnd], bool]
    more: str = ""


def end_of(level: Level, fspa: Fspa, account: Account) -> FailureEnd:
    """Return how a failed episode ended."""
    by = tuple(sorted(account.by))
    return FailureEnd(account.cause, by, place_name(level, account.place), subgoal(fspa, account.summary.unmet))


def failures(level: Level, fspa: Fspa, accounts: Sequence[Account]) -> Iterator[Failures]:
    """Group the failed episodes, most frequent ends first.  All texts are distinct."""
    groups: dict[FailureEnd, list[Account]] = {}
    for account in accounts:
        if not account.summary.success:
            groups.setdefault(end_of(level, fspa, account), []).append(account)
    frequent = _often(groups, len(accounts))
    stages = Counter(replace(end, undone=Subgoal()) for end in groups)
    for end in frequent:
        # If the same end occurs in several stages, the texts must differ.
        stage = f" before it {end.undone.text}" if stages[replace(end, undone=Subgoal())] > 1 else ""
        group = groups[end]
        details = f"{approach(level, fspa, end.undone, group)}; {remained(fspa, group)}"
        yield Failures(_end_text(level, end, group) + stage, tuple(group), end.__eq__, details)
    few = {end: group for end, group in groups.items() if end not in frequent}
    yield from _few(level, few, frequent, len(accounts))


def _often(groups: Mapping[_T, Sequence[Account]], episodes: int) -> list[_T]:
    """The keys of the most frequent groups that are large enough."""
    largest = sorted(groups, key=lambda key: -len(groups[key]))[:_FEW]
    return [key for key in largest if len(groups[key]) >= _FEW or 10 * len(groups[key]) >= episodes]


def _few(
    level: Level, groups: Mapping[FailureEnd, Sequence[Account]], frequent: Collection[FailureEnd], episodes: int
) -> Iterator[Failures]:
    """Group the remaining ends: by cause if frequent, then all others together."""
    causes: dict[_What, list[Account]] = {}
    for end, accounts in groups.items():
        causes.setdefault(end.what, []).extend(accounts)
    frequent_causes = _often(causes, episodes)
    rare_causes = [cause for cause in causes if cause not in frequent_causes]
    if len(rare_causes) == 1:
        frequent_causes += rare_causes
        rare_causes = []
    for cause in frequent_causes:
        same_cause = [end for end in groups if end.what == cause]
        text, alike = _one_cause(level, same_cause, causes[cause], frequent)
        yield Failures(text, tuple(causes[cause]), alike)
    if rare_causes:
        otherwise = " otherwise" if frequent or frequent_causes else ""
        yield Failures(
            f"fails{otherwise}", tuple(account for cause in rare_causes for account in causes[cause]), lambda _: True
        )


def _one_cause(
    level: Level, ends: Sequence[FailureEnd], accounts: Sequence[Account], frequent: Collection[FailureEnd]
) -> tuple[str, Callable[[FailureEnd], bool]]:
    """A text for these ends of one cause, and a predicate for further ends that it covers.

    The ends in ``frequent`` have texts of their own.
    """
    cause, places, stages = ends[0].what, {end.where for end in ends}, {end.undone for end in ends}
    apart = {end.where for end in frequent if end.what == cause}
    if len(places) == 1:
        (where,) = places
    else:
        where = "elsewhere" if apart and apart.isdisjoint(places) else "in different places"
    stage = ""
    is_one_stage = len(stages) == 1 and len({end.undone for end in (*frequent, *ends)}) > 1
    if is_one_stage:
        stage = f" before it {ends[0].undone.text}"
    elif places <= apart:
        stage = " at other stages"

    def alike(end: FailureEnd) -> bool:
        same_place = end.where in places if len(places) == 1 else where != "elsewhere" or end.where not in apart
        return end.what == cause and same_place and (not is_one_stage or end.undone in stages)

    return _end_text(level, replace(ends[0], where=where), accounts) + stage, alike


def _end_text(level: Level, end: FailureEnd, accounts: Sequence[Account]) -> str:
    """Describe the end of these episodes.  Asides end with a comma, since the number of episodes follows."""
    by = f" by {_names(end.by)}" if end.by else ""
    broke = _mostly("breaking", [account.broke for account in accounts])
    saw = _mostly("seen by", [[name for name in account.seen_by if name not in end.by] for account in accounts])
    if end.cause == "killed":
        return f"dies {end.where}{by}{broke}{saw}" + "," * bool(broke or saw)
    if end.cause == "violated":
        return f"breaks the spec {end.where} ({_names(end.by)}){saw}" + "," * bool(saw)
    ends = [(account.place, account.shut) for account in accounts]
    stopped = in_the_way(level, ends)
    mostly = "" if all(set(stopped) <= set(in_the_way(level, [account])) for account in ends) else "mostly "
    return f"runs out of time {end.where}" + (f", {mostly}at {_names(stopped)}," if stopped else "")


def _mostly(verb: str, named: Sequence[Sequence[str]]) -> str:
    """A clause, starting with a comma, with the names that more than half of the episodes have; empty without any."""
    counts = Counter(name for names in named for name in names)
    often = [name for name, count in counts.items() if 2 * count > len(named)]
    if not often:
        return ""
    rarely = any(counts[name] < len(named) for name in often)
    return f", {'mostly ' if rarely else ''}{verb} {_names(often)}"


def _names(names: Sequence[str]) -> str:
    *before, last = (f"`{name}`" for name in names)
    return f"{', '.join(before)} and {last}" if before else last
