"""Explained episodes of real play, by the scripted expert and by a player that ignores enemies."""

from __future__ import annotations

from itertools import pairwise
from math import dist

import pytest

from tests.runtime.regression.page import samples
from tltl_runtime.game.episode_summary import summary_of
from tltl_runtime.regression.explain.explain import findings
from tltl_runtime.regression.explain.explained_episode import ExplainedEpisode, explain_episode
from tltl_runtime.stealth.recordings.episode import Episode
from tltl_runtime.support.record_json import from_json, to_json
from tltlc.core.record import replace
from tltlc.tools.judge.verdict import RejectionCause

EPISODES = ("navigation", "branching", "cover_and_hide_met", "cover_and_hide_failed")


@pytest.fixture(params=EPISODES, name="episode", scope="module")
def _episode(request: pytest.FixtureRequest) -> Episode:
    episodes: tuple[Episode, ...] = getattr(samples, request.param)()
    return episodes[0]


@pytest.fixture(name="explained", scope="module")
def _explained(episode: Episode) -> ExplainedEpisode:
    return samples.explained_of(0, episode)


def test_every_entered_state_has_an_arrival(episode: Episode, explained: ExplainedEpisode) -> None:
    states = [arrival.state for arrival in explained.arrivals]
    assert states[0] == 0 and all(one != other for one, other in pairwise(states))
    assert set(states) == set(episode.states.tolist())
    for arrival in explained.arrivals:
        assert episode.states[arrival.step] == arrival.state
        assert dist(arrival.place, episode.snapshots[arrival.step].player.position) < 0.01
    if explained.summary.success:
        assert episode.fspa.states[states[-1]].distance == 0


def test_a_success_has_no_cause_of_failure(explained: ExplainedEpisode) -> None:
    if explained.summary.success:
        assert (explained.nearest, explained.seen_by, explained.cause) == (None, (), "success")


def test_an_explained_episode_survives_json(explained: ExplainedEpisode) -> None:
    assert from_json(ExplainedEpisode, to_json(explained), "episode") == explained


def test_only_a_game_with_a_clock_has_seconds() -> None:
    episode = samples.cover_and_hide_failed()[0]
    cause = RejectionCause("broken", len(episode.times) - 1, ("keep alive",), ("alive",))
    summary = replace(summary_of(episode, 0), cause=cause)
    assert explain_episode(summary, episode).seconds == round(float(episode.times[-1]), 4)
    shots = tuple(replace(shot, time=float(step)) for step, shot in enumerate(episode.snapshots))
    numbered = replace(episode, snapshots=shots)
    assert explain_episode(summary, numbered).seconds is None


def test_a_death_has_its_killers_and_the_closest_approach() -> None:
    episode = samples.cover_and_hide_failed()[0]
    explained = samples.explained_of(0, episode)
    assert not explained.summary.success
    assert explained.cause in ("killed", "violated")
    assert explained.by
    assert explained.seen_by == ("guard",)
    assert explained.broke == ("alive",)
    nearest = explained.nearest
    assert nearest is not None and nearest.robustness <= 0.0
    if nearest.target is not None:
        column = [signal.name for signal in episode.fspa.signals].index(f"distance({nearest.target})")
        rows = rows_away(episode, explained)
        assert nearest.distance == pytest.approx(min(episode.signals[row + 1, column] for row in rows), abs=0.01)


def rows_away(episode: Episode, explained: ExplainedEpisode) -> list[int]:
    """The decisions in the state where the episode failed that left the limiting atom false."""
    assert explained.nearest is not None
    atom = [atom_record.name for atom_record in episode.fspa.atoms].index(explained.nearest.atom)
    steps = range(len(episode.actions))
    return [
        step for step in steps if episode.states[step] == explained.summary.unmet and episode.atoms[step, atom] <= 0.0
    ]


def test_the_closest_approach_is_the_least_distance_to_the_target() -> None:
    episode = samples.cover_and_hide_failed()[0]
    explained = samples.explained_of(0, episode)
    assert explained.nearest is not None and explained.nearest.target is not None
    column = [signal.name for signal in episode.fspa.signals].index(f"distance({explained.nearest.target})")
    rows = rows_away(episode, explained)
    signals = episode.signals.copy()
    signals[rows[0] + 1, column] = 0.25
    nearer = samples.explained_of(0, replace(episode, signals=signals)).nearest
    assert nearer == replace(explained.nearest, distance=0.25), "the guard was as near as before"


def test_findings_compare_failures_with_the_baseline() -> None:
    now, before = samples.cover_and_hide_failed(), samples.cover_and_hide_met()
    explained_episodes, baseline_episodes = (
        [samples.explained_of(index, episode) for index, episode in enumerate(episodes)] for episodes in (now, before)
    )
    stage, *ends, remaining = findings(now[0].level, now[0].fspa, explained_episodes, baseline_episodes)
    assert "before: in 2 of 2 episodes" in stage.text and stage.episodes
    assert ends and "this remained" in remaining.text
    assert all("`guard`" in end.text and "before: in 0 of 2 episodes" in end.text for end in ends)
    assert findings(before[0].level, before[0].fspa, baseline_episodes, baseline_episodes)[0].text.endswith("as before")
