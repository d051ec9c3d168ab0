"""How many episodes came to which states."""

from __future__ import annotations

from tests.runtime.regression.page import samples
from tltl_runtime.regression.report.page.traffic import traffic


def test_every_episode_is_counted_where_it_was() -> None:
    episodes = samples.cover_and_hide_failed()
    found = traffic([samples.account_of(index, each) for index, each in enumerate(episodes)])
    assert found.episodes == len(episodes) and found.visited[0] == len(episodes)
    for state, count in found.visited.items():
        assert count == sum(state in each.states.tolist() for each in episodes)
    assert sum(found.failed.values()) == sum(not each.success for each in episodes) > 0
    edges = {(edge.source, edge.target) for edge in episodes[0].fspa.edges}
    took = frozenset[tuple[int, int]]().union(*found.took)
    assert took and took <= edges
    assert all(source != target for source, target in took)


def test_an_episode_that_breaks_the_spec_fails_in_the_state_before() -> None:
    (episode,) = samples.cover_and_hide_failed()[:1]
    assert episode.end == "violation"
    found = traffic([samples.account_of(0, episode)])
    assert found.failed == {int(episode.states[-2]): 1}
    (took,) = found.took
    assert (int(episode.states[-2]), int(episode.states[-1])) in took


def test_nothing_comes_of_no_episodes() -> None:
    found = traffic([])
    assert (found.episodes, dict(found.visited), dict(found.failed), found.took) == (0, {}, {}, ())
