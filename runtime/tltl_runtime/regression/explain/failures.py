"""Group failed episodes by how they end, with a text for each group."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Collection, Iterator, Mapping, Sequence
from typing import Final, TypeVar

from tltl_runtime.game.episode import EndKind
from tltl_runtime.game.level import Level
from tltl_runtime.regression.explain.explained_episode import ExplainedEpisode
from tltl_runtime.regression.explain.nearest_miss import approach_phrase
from tltl_runtime.regression.explain.phrase import Phrase, phrase, quoted_names, things_phrase
from tltl_runtime.regression.explain.places import blocking_solids, place_phrase
from tltl_runtime.regression.explain.stages import Subgoal, subgoal
from tltl_runtime.regression.explain.trace_ends import trace_end_text
from tltlc.api import Fspa, record, replace

_T = TypeVar("_T")
_FailureKind = tuple[EndKind, tuple[str, ...]]

_FEW: Final = 3
"""At most this many groups of failures get a text of their own: the largest groups.

Such a group must also contain at least this many failed episodes, or at least a tenth of all
episodes.
"""

_NOTHING: Final = Phrase("")
_ELSEWHERE: Final = Phrase("elsewhere")
_IN_DIFFERENT_PLACES: Final = Phrase("in different places")


@record
class FailureEnd:
    """How and where an episode failed, and which subgoal it had not reached (``undone``).

    ``cause`` and ``by`` are as in
    :class:`~tltl_runtime.regression.explain.explained_episode.ExplainedEpisode`. ``where`` is a phrase,
    for example ``in the corridor``; it is empty if the place is not known.
    """

    cause: EndKind
    by: tuple[str, ...]
    where: Phrase
    undone: Subgoal

    @property
    def kind(self) -> _FailureKind:
        """The cause and the names in ``by``: how the episode failed, without place and subgoal."""
        return self.cause, self.by

    @property
    def mode(self) -> tuple[_FailureKind, Subgoal | None]:
        """How the episode failed, without the place: if nothing broke the spec, also what was not reached."""
        return self.kind, None if self.cause in ("killed", "violated") else self.undone


@record
class Failures:
    """A group of episodes that fail alike.

    ``text`` says how they fail, and ``more`` adds details. ``matches`` is a function that says whether
    an episode with a given :class:`FailureEnd` belongs to the group. It assumes that the episode
    belongs to no earlier group.
    """

    text: Phrase
    episodes: tuple[ExplainedEpisode, ...]
    matches: Callable[[FailureEnd], bool]
    more: Phrase = _NOTHING


def end_of(level: Level | None, fspa: Fspa, episode: ExplainedEpisode) -> FailureEnd:
    """Return how and where a failed episode ended. ``level`` is None for a recorded trace."""
    by = tuple(sorted(episode.by))
    where = _NOTHING if level is None or episode.place is None else place_phrase(level, episode.place)
    return FailureEnd(episode.cause, by, where, subgoal(fspa, episode.summary.unmet))


def failures(
    level: Level | None, fspa: Fspa, episodes: Sequence[ExplainedEpisode], ends_before: Collection[FailureEnd] = ()
) -> Iterator[Failures]:
    """Group the failed episodes by how they end, and yield the groups.

    First come the largest groups, each of episodes with equal ends. Next are groups of the other
    episodes by cause. The last group contains the rest.

    All texts are distinct. ``ends_before`` are ends of other episodes, such as those of the baseline,
    that the caller will match with the groups. The text of a large group names its subgoal if another
    end, of a group or in ``ends_before``, differs only in the subgoal.
    """
    groups: dict[FailureEnd, list[ExplainedEpisode]] = {}
    for episode in episodes:
        if not episode.summary.success:
            groups.setdefault(end_of(level, fspa, episode), []).append(episode)
    frequent = _frequent_groups(groups, len(episodes))
    stages = Counter(replace(end, undone=Subgoal()) for end in {*groups, *ends_before})
    names_atoms = _is_ambiguous(episodes)
    for end in frequent:
        # If ends differ only in their subgoals, name the subgoal, so that the texts differ.
        stage = _stage_phrase(level, end) if stages[replace(end, undone=Subgoal())] > 1 else _NOTHING
        group = groups[end]
        details = approach_phrase(level, fspa, end.undone, group)
        yield Failures(
            phrase(_end_phrase(level, fspa, end, group, names_atoms=names_atoms), stage),
            tuple(group),
            end.__eq__,
            details,
        )
    remaining = {end: group for end, group in groups.items() if end not in frequent}
    yield from _remaining_failures(level, fspa, remaining, frequent, len(episodes), names_atoms=names_atoms)


def _is_ambiguous(episodes: Sequence[ExplainedEpisode]) -> bool:
    """Whether episodes broke the same clauses by different atoms."""
    broken = {(episode.clauses, tuple(sorted(episode.by))) for episode in episodes if episode.cause == "violated"}
    return len({clauses for clauses, _ in broken}) < len(broken)


def _frequent_groups(groups: Mapping[_T, Sequence[ExplainedEpisode]], episode_count: int) -> list[_T]:
    """Return the keys of the largest groups that get texts of their own, largest group first.

    ``_FEW`` says which groups these are. ``episode_count`` is the number of all episodes, successes
    included.
    """
    largest = sorted(groups, key=lambda key: -len(groups[key]))[:_FEW]
    return [key for key in largest if len(groups[key]) >= _FEW or 10 * len(groups[key]) >= episode_count]


def _remaining_failures(
    level: Level | None,
    fspa: Fspa,
    groups: Mapping[FailureEnd, Sequence[ExplainedEpisode]],
    frequent: Collection[FailureEnd],
    episode_count: int,
    *,
    names_atoms: bool,
) -> Iterator[Failures]:
    """Yield a group for each frequent cause of the ends in ``groups``, and one for all rare causes.

    ``groups`` has the episodes with each end. It does not contain the ends in ``frequent``, which
    already have texts of their own.
    """
    causes: dict[_FailureKind, list[ExplainedEpisode]] = {}
    for end, episodes in groups.items():
        causes.setdefault(end.kind, []).extend(episodes)
    frequent_causes = _frequent_groups(causes, episode_count)
    rare_causes = [cause for cause in causes if cause not in frequent_causes]
    if len(rare_causes) == 1:
        frequent_causes += rare_causes
        rare_causes = []
    for cause in frequent_causes:
        same_cause = [end for end in groups if end.kind == cause]
        text, matches = _phrase_for_cause(level, fspa, same_cause, causes[cause], frequent, names_atoms=names_atoms)
        yield Failures(text, tuple(causes[cause]), matches)
    if rare_causes:
        otherwise = " otherwise" if frequent or frequent_causes else ""
        rest = tuple(episode for cause in rare_causes for episode in causes[cause])
        yield Failures(Phrase(f"fails{otherwise}"), rest, lambda _: True)


def _phrase_for_cause(
    level: Level | None,
    fspa: Fspa,
    ends: Sequence[FailureEnd],
    episodes: Sequence[ExplainedEpisode],
    frequent: Collection[FailureEnd],
    *,
    names_atoms: bool,
) -> tuple[Phrase, Callable[[FailureEnd], bool]]:
    """Return a text that describes all of ``ends``, and a function that says whether it describes an end.

    The ends have the same cause. ``episodes`` are the episodes with these ends. The text differs
    from those of the ends in ``frequent``, which have texts of their own.
    """
    cause, places, stages = ends[0].kind, {end.where for end in ends}, {end.undone for end in ends}
    frequent_places = {end.where for end in frequent if end.kind == cause}
    if len(places) == 1:
        (where,) = places
    else:
        where = _ELSEWHERE if frequent_places and frequent_places.isdisjoint(places) else _IN_DIFFERENT_PLACES
    stage = _NOTHING
    is_one_stage = len(stages) == 1 and len({end.undone for end in (*frequent, *ends)}) > 1
    if is_one_stage:
        stage = _stage_phrase(level, ends[0])
    elif places <= frequent_places:
        stage = Phrase(" at other stages")

    def matches(end: FailureEnd) -> bool:
        same_place = (
            end.where in places if len(places) == 1 else where != _ELSEWHERE or end.where not in frequent_places
        )
        return end.kind == cause and same_place and (not is_one_stage or end.undone in stages)

    text = _end_phrase(level, fspa, replace(ends[0], where=where), episodes, names_atoms=names_atoms)
    return phrase(text, stage), matches


def _stage_phrase(level: Level | None, end: FailureEnd) -> Phrase:
    """Return a clause that names the subgoal that was not reached: `` before it reaches `exit```."""
    # The text before this clause says already that the trace ends before something.
    also = " and" if level is None and end.cause in ("limit", "stopped") else ""
    return Phrase(f"{also} before it {end.undone.text}", end.undone.mentions)


def _end_phrase(
    level: Level | None, fspa: Fspa, end: FailureEnd, episodes: Sequence[ExplainedEpisode], *, names_atoms: bool
) -> Phrase:
    """Describe how ``episodes`` failed, which all have the same ``end``: ``dies in the corridor``.

    With ``names_atoms``, the text names the atoms that broke the spec beside the clauses.

    The caller appends the number of episodes. So if the text ends with a clause that is set off by
    a comma, a comma also follows the clause: ``dies, mostly seen by `guard`,``.
    """
    if level is None:
        return Phrase(trace_end_text(fspa, end.cause, end.by, episodes))
    place = phrase(" ", end.where) if end.where.text else _NOTHING
    observers, adverb = _majority([[name for name in episode.seen_by if name not in end.by] for episode in episodes])
    saw = phrase(f", {adverb}seen by ", things_phrase(observers)) if observers else _NOTHING
    if end.cause == "killed":
        # In a region that kills, the place says who did it: "dies in the chasm".
        killers = [name for name in end.by if name not in end.where.mentions.regions]
        by = phrase(" by ", things_phrase(killers)) if killers else _NOTHING
        broken, adverb = _majority([episode.clauses or episode.broke for episode in episodes])
        broke = f", {adverb}breaking {quoted_names(broken)}" if broken else ""
        return phrase("dies", place, by, broke, saw, "," if broken or observers else "")
    if end.cause == "violated":
        clauses, adverb = _majority([episode.clauses for episode in episodes])
        broken_text = f"{adverb}{quoted_names(clauses)}" if clauses else "the spec"
        # Several atoms may break one clause, or one atom several of them. Each needs a text of its own.
        atoms = f" ({quoted_names(end.by)})" if end.by and (names_atoms or not clauses) else ""
        return phrase(f"breaks {broken_text}", place, atoms, saw, "," if observers else "")
    positions = [(episode.place, episode.shut) for episode in episodes if episode.place is not None]
    obstacles = blocking_solids(level, positions)
    mostly = (
        "" if all(set(obstacles) <= set(blocking_solids(level, [position])) for position in positions) else "mostly "
    )
    blocked = phrase(f", {mostly}at ", things_phrase(obstacles), ",") if obstacles else _NOTHING
    return phrase("runs out of time", place, blocked)


def _majority(names_by_episode: Sequence[Sequence[str]]) -> tuple[list[str], str]:
    """Return the names that more than half of the episodes have, and an adverb to put before them.

    ``names_by_episode`` has a list of names for each episode. The adverb is ``mostly`` and a space if
    an episode lacks one of the returned names, else empty.
    """
    counts = Counter(name for names in names_by_episode for name in names)
    frequent = [name for name, count in counts.items() if 2 * count > len(names_by_episode)]
    is_partial = any(counts[name] < len(names_by_episode) for name in frequent)
    return frequent, "mostly " if is_partial else ""
