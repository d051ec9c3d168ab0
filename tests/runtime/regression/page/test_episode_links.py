"""Links to episodes: which episodes they play, and from which step."""

from __future__ import annotations

import re

import pytest

from tests.runtime.regression.page import samples
from tltl_runtime.regression.explain.explain import Finding
from tltl_runtime.regression.report.page.episode_links import episode_links, trace_links
from tltl_runtime.regression.report.trace_curves import TraceCurves
from tltl_runtime.stealth.recordings.episode import Episode


def failed() -> dict[int, Episode]:
    return dict(enumerate(samples.cover_and_hide_failed()))


def met() -> dict[int, Episode]:
    return dict(enumerate(samples.cover_and_hide_met()))


@pytest.mark.parametrize(
    ("text", "episodes", "words"),
    [
        ("dies by `guard` in 3 of 25 episodes; before: in 0 of 25", (0, 1, 2), "play the end of episodes: 0 1 2"),
        ("dies by `guard` in 1 of 25 episodes; before: in 24 of 25", (1,), "play the end of episode: 1"),
        ("reaches `exit` in 22 of 25 episodes (88%)", (0, 1, 2), "play the end of episodes that do not: 0 1 2"),
        ("reaches `exit` in 24 of 25 episodes", (2,), "play the end of an episode that does not: 2"),
        ("reaches `exit` in 3 of 6 episodes", (0, 1, 2), "play the end of episodes that do not: 0 1 2"),
        ("dies by `guard` in 3 of 6 episodes", (0, 1, 2), "play the end of episodes: 0 1 2"),
        ("fails otherwise", (0, 9), "play the end of episode: 0"),
    ],
)
def test_links_play_the_episodes_of_a_finding(text: str, episodes: tuple[int, ...], words: str) -> None:
    finding = Finding(text, episodes, others=text.startswith("reaches"))
    links = episode_links(finding, failed(), "a")
    assert links is not None and re.sub(r"<.*?>", "", links).strip() == words
    for index in re.findall(r"\d", words.partition(":")[2]):
        assert f'title="play the end of episode {index}"' in links


def test_links_play_successes_from_the_start() -> None:
    links = episode_links(Finding("successes are longer", (0, 1)), met(), "a")
    assert links is not None and re.sub(r"<.*?>", "", links).strip() == "play episodes: 0 1"
    assert re.findall(r'href="#(.*?)"', links) == ["a/0/0", "a/1/0"]
    assert 'title="play episode 1"' in links


def test_a_finding_without_recordings_has_no_links() -> None:
    assert episode_links(Finding("fails", (7,)), failed(), "a") is None


def test_a_link_begins_at_the_step_nearest_to_four_seconds_before_the_end() -> None:
    episode = failed()[0]
    links = episode_links(Finding("fails", (0,)), {0: episode}, "a")
    before_end = round(4.0 / 0.15)
    assert links is not None and f'href="#a/0/{len(episode.actions) - before_end}"' in links


@pytest.mark.parametrize(
    ("episodes", "others", "words"),
    [
        (tuple(range(20)), False, "show 3 of 20 traces: 0.csv 1.csv 2.csv"),
        (tuple(range(20)), True, "show 3 of 20 traces that do not: 0.csv 1.csv 2.csv"),
        ((0, 1), False, "show traces: 0.csv 1.csv"),
        ((1,), False, "show trace: 1.csv"),
        ((1,), True, "show a trace that does not: 1.csv"),
    ],
)
def test_links_to_traces_say_how_many_of_them_are_drawn(episodes: tuple[int, ...], others: bool, words: str) -> None:
    drawn = {index: TraceCurves(f"{index}.csv", "", ((0.5,),), ()) for index in range(3)}
    links = trace_links(Finding("fails", episodes, others=others), drawn, "a")
    assert links is not None and re.sub(r"<.*?>", "", links).strip() == words
