"""The findings that say how and where episodes end."""

from __future__ import annotations

from collections.abc import Sequence

import pytest

from tests.runtime.regression.handmade import an_episode
from tests.runtime.regression.room_findings import (  # noqa: F401
    MIDDLE,
    NORTH,
    _fspa,
    _level,
    deaths,
    sentences,
    states_after,
    successes,
)
from tltl_runtime.regression.explain.explain import findings
from tltl_runtime.regression.explain.explained_episode import ExplainedEpisode
from tltl_runtime.stealth.level import Point, StealthLevel
from tltlc.automaton.fspa import Fspa
from tltlc.core.record import replace


def test_ends_are_grouped_by_kind_and_place_most_frequent_first(level: StealthLevel, fspa: Fspa) -> None:
    now = successes(fspa)
    for index in range(5):
        now[index] = an_episode(
            index, False, states=states_after(fspa, 0), cause="violated", by=("seen",), seen_by=("guard",)
        )
    for index in range(5, 12):
        now[index] = an_episode(index, False, states=states_after(fspa, 1), place=(8.5, 8.0, 0.0))
    texts = sentences(level, fspa, now)
    assert texts[1:3] == [
        "runs out of time near `exit` in 7 of 25 episodes; before: in 0 of 25 episodes",
        "breaks the spec in the middle (`seen`), seen by `guard`, in 5 of 25 episodes; before: in 0 of 25 episodes",
    ]


@pytest.mark.parametrize(
    ("saw", "words"),
    [
        (14, ", seen by `camera`,"),
        (9, ", mostly seen by `camera`,"),
        (7, ""),
        (1, ""),
    ],
)
def test_an_enemy_that_saw_the_player_in_most_episodes_is_named(
    level: StealthLevel, fspa: Fspa, saw: int, words: str
) -> None:
    now = deaths(fspa, 14, seen_by=("guard",))
    now[:saw] = [replace(explained, seen_by=("guard", "camera")) for explained in now[:saw]]
    assert sentences(level, fspa, now)[1].startswith(f"dies in the north hall by `guard`{words} in 14 of 25 episodes")


def test_a_death_names_the_broken_atom(level: StealthLevel, fspa: Fspa) -> None:
    now = deaths(fspa, 14, broke=("alive",), seen_by=("guard", "camera"))
    end = sentences(level, fspa, now)[1]
    assert end.startswith("dies in the north hall by `guard`, breaking `alive`, seen by `camera`, in 14 of 25")


def test_ends_in_two_stages_have_separate_sentences(level: StealthLevel, fspa: Fspa) -> None:
    now = [an_episode(index, False, states=states_after(fspa, 1 if index < 14 else 2)) for index in range(25)]
    ends = [finding for finding in findings(level, fspa, now, successes(fspa)) if "runs out of time" in finding.text]
    prefix = "runs out of time in the middle before it reaches"
    assert [(finding.text.partition(" of 25")[0], len(finding.episodes)) for finding in ends] == [
        (f"{prefix} `s2` in 14", 14),
        (f"{prefix} `exit` in 11", 11),
    ]


def timed_out(fspa: Fspa, index: int, stage: int, place: Point = MIDDLE) -> ExplainedEpisode:
    return an_episode(index, False, states=states_after(fspa, stage), place=place)


def died(fspa: Fspa, index: int, stage: int, place: Point = MIDDLE) -> ExplainedEpisode:
    return an_episode(index, False, states=states_after(fspa, stage), place=place, cause="killed", by=("guard",))


def last_sentence(
    level: StealthLevel, fspa: Fspa, now: Sequence[ExplainedEpisode], before: Sequence[ExplainedEpisode] = ()
) -> str:
    texts = sentences(level, fspa, now, before or successes(fspa, 40))
    return [text for text in texts if "this remained" not in text][-1]


def test_rare_ends_share_one_sentence(level: StealthLevel, fspa: Fspa) -> None:
    now = successes(fspa, 40)
    now[:3] = [timed_out(fspa, index, 1) for index in range(3)]
    assert last_sentence(level, fspa, now).startswith("runs out of time")
    now[0] = timed_out(fspa, 0, 0)
    (_, rest, *_) = findings(level, fspa, now, successes(fspa, 40))
    text = "runs out of time in the middle in 3 of 40 episodes (7%); before: in 0 of 40 episodes"
    assert (rest.text, rest.episodes) == (text, (0, 1, 2))
    now[1] = timed_out(fspa, 1, 1, NORTH)
    assert last_sentence(level, fspa, now) == text.replace("the middle", "different places")
    now[2] = died(fspa, 2, 1)
    assert last_sentence(level, fspa, now) == "fails in 3 of 40 episodes (7%); before: in 0 of 40 episodes"


def test_remaining_ends_with_a_known_cause_name_it(level: StealthLevel, fspa: Fspa) -> None:
    now = successes(fspa, 40)
    now[:4] = [died(fspa, index, 2, NORTH) for index in range(4)]
    now[4:7] = [died(fspa, index, 1, (2.0 + 4.0 * (index % 2), 5.0, 0.0)) for index in range(4, 7)]
    # The baseline counts episodes that died elsewhere in the same stage.
    before = successes(fspa, 40)
    before[:4] = [died(fspa, 0, 1), died(fspa, 1, 2), died(fspa, 2, 1, NORTH), timed_out(fspa, 3, 1)]
    text = "dies elsewhere by `guard` before it reaches `s2` in 3 of 40 episodes (7%); before: in 1 of 40 episodes (3%)"
    assert last_sentence(level, fspa, now, before) == text
    now[4] = died(fspa, 4, 0)
    assert last_sentence(level, fspa, now, before) == (
        "dies elsewhere by `guard` in 3 of 40 episodes (7%); before: in 2 of 40 episodes (5%)"
    )


def test_a_single_remaining_cause_is_named(level: StealthLevel, fspa: Fspa) -> None:
    now = successes(fspa, 40)
    now[0] = died(fspa, 0, 2, NORTH)
    assert last_sentence(level, fspa, now) == (
        "dies in the north hall by `guard` in 1 of 40 episodes (3%); before: in 0 of 40 episodes"
    )
    # If other episodes died in the same place, the sentence names the stage.
    now[1:5] = [died(fspa, index, 1, NORTH) for index in range(1, 5)]
    assert last_sentence(level, fspa, now).startswith(
        "dies in the north hall by `guard` before it reaches `exit` in 1 of 40"
    )
    now[5] = died(fspa, 5, 0, NORTH)
    assert last_sentence(level, fspa, now).startswith("dies in the north hall by `guard` at other stages in 2 of 40")


def test_rare_causes_share_one_sentence(level: StealthLevel, fspa: Fspa) -> None:
    now = successes(fspa, 40)
    now[:4] = [died(fspa, index, 2, NORTH) for index in range(4)]
    now[4:6] = [died(fspa, 4, 1), timed_out(fspa, 5, 1)]
    assert (
        last_sentence(level, fspa, now, now)
        == "fails otherwise in 2 of 40 episodes (5%); before: in 2 of 40 episodes (5%)"
    )


def test_ends_show_the_counts_of_the_baseline(level: StealthLevel, fspa: Fspa) -> None:
    now = [an_episode(index, index >= 10, states=states_after(fspa, 3 if index >= 10 else 2)) for index in range(25)]
    texts = sentences(level, fspa, now, now)
    assert texts[0] == "reaches `s1`, `s2` as before"
    assert texts[1].startswith("runs out of time in the middle in 10 of 25 episodes; before: in 10 of 25 episodes")
