"""Sentences that say what a policy does differently from the baseline, with example episodes.

A *stage* is a part of the spec: the automaton's states at one distance from acceptance, with the
subgoal that leads from them towards acceptance.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Sequence
from statistics import fmean
from typing import Final, Literal

from tltl_runtime.game.geometry import Region
from tltl_runtime.game.level import Level
from tltl_runtime.game.mentions import NO_MENTIONS, Mentions, region_text
from tltl_runtime.regression.explain.explained_episode import ExplainedEpisode
from tltl_runtime.regression.explain.failures import end_of, failures
from tltl_runtime.regression.explain.open_goals import open_goals, subgoal_of_all
from tltl_runtime.regression.explain.path_points import positions_along
from tltl_runtime.regression.explain.phrase import Phrase, phrase, quoted_names
from tltl_runtime.regression.explain.stages import MEETS, Subgoal, subgoals_phrase
from tltl_runtime.support.number_text import count_text, percent, significant
from tltlc.api import Fspa, Notation, label_text, record

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

_NOTATIONS: Final[tuple[Notation, Notation]] = ("english", "unicode")
"""The notations of formulas in sentences: in words, and in symbols."""

_MIN_SUCCESSES: Final = 3
"""Lengths and regions are compared only if at least this many episodes succeed, both now and before."""


FindingKind = Literal["unreached", "end", "stage", "length", "region", "remaining", "unchanged"]
"""What a finding is about.

- ``unreached``: a stage that episodes completed before, and none completes now;
- ``end``: how episodes fail;
- ``stage``: another stage that more or fewer episodes complete than before;
- ``length``: whether successful episodes are longer or shorter;
- ``region``: a region through which more or fewer successful episodes pass;
- ``remaining``: what remained to be done in failed episodes;
- ``unchanged``: the stages that most episodes complete, now as before.
"""


@record
class Finding:
    """A sentence about the episodes played now, and the indices of examples among them.

    ``text`` is the sentence. ``episodes`` are the indices of the episodes that do what it says or, if
    ``others`` is true, of the episodes that do not. ``mentions`` names the things and regions of the
    level that the sentence mentions. ``short`` is the sentence without details; empty if it has none.
    ``symbols`` is the sentence with its formula in symbols instead of words; empty if it has no formula.
    """

    text: str
    episodes: tuple[int, ...]
    others: bool = False
    mentions: Mentions = NO_MENTIONS
    kind: FindingKind = "end"
    short: str = ""
    symbols: str = ""


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
        *_ends(level, fspa, now, before),
        *_remaining(fspa, now),
        *_lengths(_step_s(level, fspa), now, before),
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
    none, or if the only stage is to meet the spec, there is no finding. ``noun`` is the word for the
    episodes: ``episodes`` or ``traces``.
    """
    unchanged_stages: list[Subgoal] = []
    for distance, states in _visited_states(fspa, (*now, *before)):
        passed_now, passed_before = (_episodes_past(fspa, episodes, distance) for episodes in (now, before))
        stage = subgoal_of_all(fspa, states, distance)
        if abs(len(passed_now) / len(now) - len(passed_before) / len(before)) < _STAGE_TOLERANCE:
            if len(passed_now) / len(now) > _COMMON_SHARE:
                unchanged_stages.append(stage)
            continue
        if stage == MEETS and not unchanged_stages:
            # The pass rate says the same.
            return
        failed = tuple(episode.summary.index for episode in now if episode not in passed_now)
        counts = [
            count_text(len(passed), len(episodes), noun, is_compared=len(now) != len(before))
            for passed, episodes in ((passed_now, now), (passed_before, before))
        ]
        yield _stage(stage, unchanged_stages, counts, failed, is_unreached=not passed_now)
        return
    if unchanged_stages:
        sentence = phrase(subgoals_phrase(unchanged_stages), " as before")
        yield Finding(sentence.text, (), mentions=sentence.mentions, kind="unchanged")


def _stage(
    stage: Subgoal, unchanged: Sequence[Subgoal], counts: Sequence[str], failed: tuple[int, ...], *, is_unreached: bool
) -> Finding:
    """Return the finding about the first changed stage.

    ``unchanged`` are the earlier stages. ``counts`` say how many episodes complete the stage now and
    before, and ``failed`` are the indices of those that do not. ``is_unreached`` says that none does.
    """
    goal = subgoals_phrase([stage])
    earlier = phrase(subgoals_phrase(unchanged), " as before") if unchanged else Phrase("")
    if is_unreached:
        short = phrase("no longer ", goal, f": in {counts[0]}")
        sentence = phrase(short, f"; before: in {counts[1]}", "; " if unchanged else "", earlier)
    else:
        short = phrase(earlier, ", then " if unchanged else "", goal, f" in {counts[0]}")
        sentence = phrase(short, f"; before: in {counts[1]}")
    kind: FindingKind = "unreached" if is_unreached else "stage"
    return Finding(sentence.text, failed, others=True, mentions=sentence.mentions, kind=kind, short=short.text)


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


def _ends(
    level: Level | None, fspa: Fspa, now: Sequence[ExplainedEpisode], before: Sequence[ExplainedEpisode]
) -> Iterator[Finding]:
    """Yield a finding for each way in which episodes ``now`` fail.

    Its short text says how many episodes fail in this way. The sentence adds how many episodes ``before``
    did so, and details. The order is that of
    :func:`~tltl_runtime.regression.explain.failures.failures`. All texts are distinct.
    """
    noun, is_compared = _noun(level), len(now) != len(before)
    ends_before = [end_of(level, fspa, episode) for episode in before if not episode.summary.success]
    for group in failures(level, fspa, now, ends_before):
        matches = [group.matches(end) for end in ends_before]
        ends_before = [end for end, is_match in zip(ends_before, matches, strict=True) if not is_match]
        short = phrase(group.text, f" in {count_text(len(group.episodes), len(now), noun, is_compared=is_compared)}")
        counted_before = count_text(sum(matches), len(before), noun, is_compared=is_compared)
        sentence = phrase(short, f"; before: in {counted_before}", group.more)
        indices = tuple(sorted(episode.summary.index for episode in group.episodes))
        yield Finding(sentence.text, indices, mentions=sentence.mentions, short=short.text)


def new_failures(
    level: Level | None, fspa: Fspa, now: Sequence[ExplainedEpisode], before: Sequence[ExplainedEpisode]
) -> tuple[Finding, ...]:
    """Return a finding for each way in which episodes ``now`` fail, but no episode ``before``.

    Ways to fail differ in their cause and in what caused it; if the spec was not broken, also in the
    subgoal that was not reached. The place does not count. The texts are as in :func:`findings`.
    """
    known = {end_of(level, fspa, episode).mode for episode in before if not episode.summary.success}
    new = [episode for episode in now if not episode.summary.success and end_of(level, fspa, episode).mode not in known]
    results = []
    for group in failures(level, fspa, new):
        # The text is that of `findings`, so that a page can tell it once.
        counted = count_text(len(group.episodes), len(now), _noun(level), is_compared=len(now) != len(before))
        short = phrase(group.text, f" in {counted}")
        sentence = phrase(short, f"; before: in 0 of {len(before)}")
        indices = tuple(sorted(episode.summary.index for episode in group.episodes))
        results.append(Finding(sentence.text, indices, mentions=sentence.mentions, short=short.text))
    return tuple(results)


def _remaining(fspa: Fspa, now: Sequence[ExplainedEpisode]) -> Iterator[Finding]:
    """Yield a finding for each of the states in which episodes failed most often: what remained to be done there."""
    failed = [episode for episode in now if not episode.summary.success]
    for state, count in Counter(episode.summary.unmet for episode in failed).most_common(_MOST_STATES):
        counted = count_text(count, len(failed), f"failure{'s' * (len(failed) != 1)}")
        words, symbols = (
            f"in {counted}, {_remaining_text(fspa, state, notation)} (state {state})" for notation in _NOTATIONS
        )
        indices = tuple(sorted(episode.summary.index for episode in failed if episode.summary.unmet == state))
        yield Finding(words, indices, kind="remaining", symbols="" if symbols == words else symbols)


def _remaining_text(fspa: Fspa, state: int, notation: Notation) -> str:
    """Say what remains in a state: ``2 of 3 goals were reached: `a` and `b`; `c` was missed``.

    If goals in any order are not all that remains, the text is that of the state: ``this remained: Reach c``.
    """
    goals = open_goals(fspa, state)
    if goals is None or not goals.open:
        return f"this remained: {label_text(fspa, state, notation).rstrip('.')}"
    count = len(goals.reached)
    reached = f": {quoted_names(goals.reached)}" if count else ""
    were, missed = ("was" if number == 1 else "were" for number in (count, len(goals.open)))
    total = count + len(goals.open)
    return f"{count} of {total} goals {were} reached{reached}; {quoted_names(goals.open)} {missed} missed"


def _step_s(level: Level | None, fspa: Fspa) -> float | None:
    """Return how long a step takes, in seconds; None if neither the spec nor the level's game has a fixed clock."""
    if fspa.clock_varies:
        return None
    if fspa.clock_s is None and level is not None:
        return level.game.clock_s(level)
    return fspa.clock_s


def _lengths(
    step_s: float | None, now: Sequence[ExplainedEpisode], before: Sequence[ExplainedEpisode]
) -> Iterator[Finding]:
    """Yield a finding if successful episodes take clearly more or fewer steps than before.

    ``step_s`` is how long a step takes, in seconds, or None.
    """
    new, old = (
        [episode.summary.steps for episode in episodes if episode.summary.success] for episodes in (now, before)
    )
    if min(len(new), len(old)) < _MIN_SUCCESSES or 1 / _LENGTH_RATIO < fmean(new) / fmean(old) < _LENGTH_RATIO:
        return
    # Subtract the rounded means, so that the difference is that of the numbers in the sentence.
    mean, mean_before = round(fmean(new)), round(fmean(old))
    count = abs(mean - mean_before)
    steps = f"{count:,} {'more' if mean > mean_before else 'fewer'} step{'s' * (count != 1)}"
    time = f" ({significant(count * step_s)} s)" if step_s is not None else ""
    short = f"takes {steps}{time} to meet the spec"
    indices = tuple(episode.summary.index for episode in now if episode.summary.success)
    yield Finding(f"{short}: {mean:,} on average; before: {mean_before:,}", indices, kind="length", short=short)


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
                kind="region",
            )


def _visits(episode: ExplainedEpisode, region: Region) -> bool:
    (x0, y0, _), (x1, y1, _) = region.box.low, region.box.high
    end = [] if episode.place is None else [episode.place[:2]]
    return any(x0 <= x <= x1 and y0 <= y <= y1 for x, y in (*positions_along(episode.way), *end))
