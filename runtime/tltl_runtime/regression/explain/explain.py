"""Sentences that say what a policy does differently from the baseline, with example episodes.

A *stage* is a part of the spec: the automaton's states at one distance from acceptance, with the
subgoal that leads from them towards acceptance.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Sequence
from statistics import fmean
from typing import Final

from tltl_runtime.game.geometry import Region
from tltl_runtime.game.level import Level
from tltl_runtime.game.mentions import NO_MENTIONS, Mentions, region_text
from tltl_runtime.regression.explain.explained_episode import ExplainedEpisode
from tltl_runtime.regression.explain.failures import end_of, failures
from tltl_runtime.regression.explain.open_goals import open_goals, subgoal_of_all
from tltl_runtime.regression.explain.path_points import positions_along
from tltl_runtime.regression.explain.phrase import phrase, quoted_names
from tltl_runtime.regression.explain.stages import Subgoal, subgoals_phrase
from tltl_runtime.support.number_text import count_text, percent
from tltlc.api import Fspa, label_text, record

_STAGE_TOLERANCE: Final = 0.05
"""The share of episodes that complete a stage has changed if it differs by at least this much."""

_COMMON_SHARE: Final = 0.8
"""A stage without change is mentioned only if more than this share of the episodes complete it."""

_REGION_DIFFERENCE: Final = 0.4
"""The share of successes that visit a region has changed if it differs by at least this much."""

_LENGTH_RATIO: Final = 1.15
"""Two mean lengths of episodes count as equal if the greater is less than this factor times the smaller."""

_MOST_STATES: Final = 3
"""What remained to be done is said for at most this many states: those in which most episodes failed."""

_MIN_SUCCESSES: Final = 3
"""Lengths and regions are compared only if at least this many episodes succeed, both now and before."""


@record
class Finding:
    """A sentence about the episodes played now, and the indices of examples among them.

    ``text`` is the sentence. ``episodes`` are the indices of the episodes that do what it says or, if
    ``others`` is true, of the episodes that do not. ``mentions`` names the things and regions of the
    level that the sentence mentions.
    """

    text: str
    episodes: tuple[int, ...]
    others: bool = False
    mentions: Mentions = NO_MENTIONS


def findings(
    level: Level | None, fspa: Fspa, now: Sequence[ExplainedEpisode], before: Sequence[ExplainedEpisode]
) -> tuple[Finding, ...]:
    """Return sentences that compare the episodes ``now`` with the episodes ``before``, of the baseline.

    They say which stages (parts of the spec) the episodes complete, how episodes fail, what remained to be
    done then, whether successful episodes are longer or shorter, and through which regions of the level they pass.
    ``level`` is the level that was played now, or None for recorded traces, which have no regions.
    """
    return (
        *_stages(fspa, now, before, _noun(level)),
        *(finding for _, finding in _ends(level, fspa, now, before)),
        *_remaining(fspa, now),
        *_lengths(now, before),
        *(_regions(level, now, before) if level is not None else ()),
    )


def _noun(level: Level | None) -> str:
    return "traces" if level is None else "episodes"


def _stages(
    fspa: Fspa, now: Sequence[ExplainedEpisode], before: Sequence[ExplainedEpisode], noun: str
) -> Iterator[Finding]:
    """Yield at most one finding about the stages that episodes complete.

    An episode completes a stage when it comes nearer to acceptance than the states of the stage. The
    finding is about the first stage that clearly more, or clearly fewer, episodes complete now than
    before. It also names the earlier stages that most episodes complete, now as before. If no stage
    has changed in this way, the finding names all stages that most episodes complete. If there are
    none, there is no finding. ``noun`` is the word for the episodes: ``episodes`` or ``traces``.
    """
    unchanged_stages: list[Subgoal] = []
    for distance, states in _visited_states(fspa, (*now, *before)):
        passed_now, passed_before = (_episodes_past(fspa, episodes, distance) for episodes in (now, before))
        stage = subgoal_of_all(fspa, states, distance)
        if abs(len(passed_now) / len(now) - len(passed_before) / len(before)) < _STAGE_TOLERANCE:
            if len(passed_now) / len(now) > _COMMON_SHARE:
                unchanged_stages.append(stage)
            continue
        prefix = phrase(subgoals_phrase(unchanged_stages), " as before, then ") if unchanged_stages else ""
        failed = tuple(episode.summary.index for episode in now if episode not in passed_now)
        counts = [
            count_text(len(passed), len(episodes), noun, is_compared=len(now) != len(before))
            for passed, episodes in ((passed_now, now), (passed_before, before))
        ]
        sentence = phrase(prefix, subgoals_phrase([stage]), f" in {counts[0]}; before: in {counts[1]}")
        yield Finding(sentence.text, failed, others=True, mentions=sentence.mentions)
        return
    if unchanged_stages:
        sentence = phrase(subgoals_phrase(unchanged_stages), " as before")
        yield Finding(sentence.text, (), mentions=sentence.mentions)


def _visited_states(fspa: Fspa, episodes: Sequence[ExplainedEpisode]) -> list[tuple[int, set[int]]]:
    """Return pairs of a distance from acceptance and the visited states at this distance.

    The greatest distance comes first. Accepting states and traps are left out.
    """
    states_by_distance: dict[int, set[int]] = {}
    for state in {arrival.state for episode in episodes for arrival in episode.arrivals}:
        if distance := fspa.states[state].distance:
            states_by_distance.setdefault(distance, set()).add(state)
    return sorted(states_by_distance.items(), reverse=True)


def _episodes_past(fspa: Fspa, episodes: Sequence[ExplainedEpisode], distance: int) -> list[ExplainedEpisode]:
    """Return the episodes that reached a state less than ``distance`` transitions from acceptance."""
    return [episode for episode in episodes if min(_distances(fspa, episode)) < distance]


def _distances(fspa: Fspa, episode: ExplainedEpisode) -> list[int]:
    distances = [fspa.states[arrival.state].distance for arrival in episode.arrivals]
    return [distance for distance in distances if distance is not None] or [fspa.spec_size]


def most_frequent_end(
    level: Level | None, fspa: Fspa, now: Sequence[ExplainedEpisode], before: Sequence[ExplainedEpisode]
) -> str | None:
    """Describe how the failed episodes ``now`` end most often: ``dies in the corridor in 7 of 25 episodes``.

    None if no episode failed. ``before`` are the episodes of the baseline. ``level`` is None for
    recorded traces.
    """
    return next((headline for headline, _ in _ends(level, fspa, now, before)), None)


def _ends(
    level: Level | None, fspa: Fspa, now: Sequence[ExplainedEpisode], before: Sequence[ExplainedEpisode]
) -> Iterator[tuple[str, Finding]]:
    """Yield a short text and a finding for each way in which episodes ``now`` fail.

    The text says how many episodes fail in this way. The finding adds how many episodes ``before``
    did so, and details. The order is that of
    :func:`~tltl_runtime.regression.explain.failures.failures`. All texts are distinct.
    """
    noun, is_compared = _noun(level), len(now) != len(before)
    ends_before = [end_of(level, fspa, episode) for episode in before if not episode.summary.success]
    for group in failures(level, fspa, now, ends_before):
        matches = [group.matches(end) for end in ends_before]
        ends_before = [end for end, is_match in zip(ends_before, matches, strict=True) if not is_match]
        headline = phrase(group.text, f" in {count_text(len(group.episodes), len(now), noun, is_compared=is_compared)}")
        counted_before = count_text(sum(matches), len(before), noun, is_compared=is_compared)
        sentence = phrase(headline, f"; before: in {counted_before}", group.more)
        indices = tuple(sorted(episode.summary.index for episode in group.episodes))
        yield headline.text, Finding(sentence.text, indices, mentions=sentence.mentions)


def _remaining(fspa: Fspa, now: Sequence[ExplainedEpisode]) -> Iterator[Finding]:
    """Yield a finding for each of the states in which episodes failed most often: what remained to be done there."""
    failed = [episode for episode in now if not episode.summary.success]
    for state, count in Counter(episode.summary.unmet for episode in failed).most_common(_MOST_STATES):
        counted = count_text(count, len(failed), f"failure{'s' * (len(failed) != 1)}")
        text = f"in {counted}, {_remaining_text(fspa, state)} (state {state})"
        indices = (episode.summary.index for episode in failed if episode.summary.unmet == state)
        yield Finding(text, tuple(sorted(indices)))


def _remaining_text(fspa: Fspa, state: int) -> str:
    """Say what remains in a state: ``2 of 3 goals were reached: `a` and `b`; `c` was missed``.

    If goals in any order are not all that remains, the text is that of the state: ``this remained: Reach c``.
    """
    goals = open_goals(fspa, state)
    if goals is None or not goals.open:
        return f"this remained: {label_text(fspa, state).rstrip('.')}"
    count = len(goals.reached)
    reached = f": {quoted_names(goals.reached)}" if count else ""
    were, missed = ("was" if number == 1 else "were" for number in (count, len(goals.open)))
    total = count + len(goals.open)
    return f"{count} of {total} goals {were} reached{reached}; {quoted_names(goals.open)} {missed} missed"


def _lengths(now: Sequence[ExplainedEpisode], before: Sequence[ExplainedEpisode]) -> Iterator[Finding]:
    new, old = (
        [episode.summary.steps for episode in episodes if episode.summary.success] for episodes in (now, before)
    )
    if min(len(new), len(old)) >= _MIN_SUCCESSES:
        ratio = fmean(new) / fmean(old)
        if not 1 / _LENGTH_RATIO < ratio < _LENGTH_RATIO:
            change = "longer" if ratio > 1 else "shorter"
            text = f"successes are {change}: {fmean(new):.0f} steps on average; before: {fmean(old):.0f}"
            yield Finding(text, tuple(episode.summary.index for episode in now if episode.summary.success))


def _regions(level: Level, now: Sequence[ExplainedEpisode], before: Sequence[ExplainedEpisode]) -> Iterator[Finding]:
    """Yield a finding for each region through which clearly more or fewer successful episodes pass than before."""
    new, old = (
        [episode for episode in episodes if episode.summary.success and episode.way] for episodes in (now, before)
    )
    if min(len(new), len(old)) < _MIN_SUCCESSES:
        return
    for region in level.regions:
        visits_now, visits_before = (
            [episode for episode in episodes if _visits(episode, region)] for episodes in (new, old)
        )
        share, share_before = len(visits_now) / len(new), len(visits_before) / len(old)
        if abs(share - share_before) >= _REGION_DIFFERENCE:
            pass_through = f"{percent(share)} of the successful episodes pass through the {region_text(region.name)}"
            yield Finding(
                f"{pass_through}; before: {percent(share_before)}",
                tuple(episode.summary.index for episode in visits_now),
                mentions=Mentions(regions=(region.name,)),
            )


def _visits(episode: ExplainedEpisode, region: Region) -> bool:
    (x0, y0, _), (x1, y1, _) = region.box.low, region.box.high
    end = [] if episode.place is None else [episode.place[:2]]
    return any(x0 <= x <= x1 and y0 <= y <= y1 for x, y in (*positions_along(episode.way), *end))
