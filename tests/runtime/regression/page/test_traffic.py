"""The counts of episodes per state and edge."""

from __future__ import annotations

from tests.runtime.regression.page import samples
from tltl_runtime.regression.report.page.traffic import traffic


def test_every_episode_is_counted_in_the_states_it_visited() -> None:
    episodes = samples.cover_and_hide_failed()
    counts = traffic([samples.explained_of(index, episode) for index, episode in enumerate(episodes)])
    assert counts.episodes == len(episodes) and counts.visited[0] == len(episodes)
    for state, count in counts.visited.items():
        assert count == sum(state in episode.states.tolist() for episode in episodes)
    assert sum(counts.failed.values()) == sum(not episode.success for episode in episodes) > 0
    edges = {(edge.source, edge.target) for edge in episodes[0].fspa.edges}
    took = frozenset[tuple[int, int]]().union(*counts.edges)
    assert took and took <= edges
    assert all(source != target for source, target in took)


def test_a_violation_counts_as_failed_in_the_state_before_the_trap() -> None:
    (episode,) = samples.cover_and_hide_failed()[:1]
    assert episode.end == "violation"
    counts = traffic([samples.explained_of(0, episode)])
    assert counts.failed == {int(episode.states[-2]): 1}
    (took,) = counts.edges
    assert (int(episode.states[-2]), int(episode.states[-1])) in took


def test_without_episodes_all_counts_are_empty() -> None:
    counts = traffic([])
    assert (counts.episodes, dict(counts.visited), dict(counts.failed), counts.edges) == (0, {}, {}, ())
