"""The findings that explain episodes in comparison with the baseline."""

from __future__ import annotations

from typing import Any

import pytest

from tests.runtime.regression.handmade import an_episode, changed
from tests.runtime.regression.room_findings import (  # noqa: F401
    MIDDLE,
    NORTH,
    SPEC,
    _fspa,
    _level,
    deaths,
    sentences,
    states_after,
    successes,
)
from tltl_runtime.game.geometry import Box, Region
from tltl_runtime.game.mentions import Mentions
from tltl_runtime.regression.explain.explain import findings
from tltl_runtime.regression.explain.explained_episode import NearestMiss
from tltl_runtime.regression.explain.nearest_miss import approach_phrase
from tltl_runtime.regression.explain.stages import Subgoal
from tltl_runtime.stealth.level import StealthLevel
from tltlc import compile_text
from tltlc.automaton.fspa import Fspa
from tltlc.automaton.text import label_text
from tltlc.core.record import replace
from tltlc.tools.judge.measures import Measure


def test_equal_episodes_are_as_before(level: StealthLevel, fspa: Fspa) -> None:
    (only,) = findings(level, fspa, successes(fspa), successes(fspa))
    assert only.text == "reaches `s1`, `s2`, `exit` as before"
    assert only.episodes == ()
    assert only.mentions == Mentions(("s1", "s2", "exit"))


@pytest.mark.parametrize(("fewer", "text"), [(1, "`s2`, `exit` as before"), (2, "then reaches `exit` in 38 of 40")])
def test_one_failure_in_twenty_is_not_as_before(level: StealthLevel, fspa: Fspa, fewer: int, text: str) -> None:
    now = successes(fspa, 40)
    for index in range(fewer):
        now[index] = an_episode(index, False, states=states_after(fspa, 2))
    assert text in sentences(level, fspa, now, successes(fspa, 40))[0]


def test_the_first_changed_stage_and_the_ends_in_it_are_described(level: StealthLevel, fspa: Fspa) -> None:
    near = NearestMiss("near(exit)", -0.2, NORTH, "exit", 3.2)
    died = {"cause": "killed", "by": ("guard",), "seen_by": ("guard",), "place": NORTH, "nearest": near}
    now = successes(fspa)
    for index in range(14):
        now[index] = an_episode(index, False, states=states_after(fspa, 2), **died)  # type: ignore[arg-type]
    # The episode with the best robustness was farther from its target.
    now[3] = replace(now[3], nearest=replace(near, robustness=-0.1, distance=6.0))
    stage, end, remaining = findings(level, fspa, now, successes(fspa))
    assert stage.text == (
        "reaches `s1`, `s2` as before, then reaches `exit` in 11 of 25 episodes; before: in 25 of 25 episodes"
    )
    assert stage.episodes == end.episodes == tuple(range(14))
    assert end.text == (
        "dies in the north hall by `guard` in 14 of 25 episodes; before: in 0 of 25 episodes; "
        "closest approach to `exit`: 3.2 m (`near(exit)` holds below 1.0 m)"
    )
    assert (
        remaining.text == "in 14 of 14 failures, this remained: Reach near(exit), and keep alive throughout (state 3)"
    )
    assert remaining.episodes == end.episodes
    assert stage.mentions == Mentions(("s1", "s2", "exit"))
    assert end.mentions == Mentions(("guard", "exit"), ("north_hall",))


def test_a_share_is_added_for_many_episodes(level: StealthLevel, fspa: Fspa) -> None:
    now = successes(fspa, 40)
    now[:14] = deaths(fspa, 14)[:14]
    (stage, *_) = sentences(level, fspa, now, successes(fspa, 40))
    assert stage.endswith("then reaches `exit` in 26 of 40 episodes (65%); before: in 40 of 40 episodes")


def test_the_state_of_failure_is_described_with_what_remained(level: StealthLevel, fspa: Fspa) -> None:
    first, other = states_after(fspa, 1)
    now = [
        an_episode(index, False, states=states_after(fspa, 0), unmet=first if index < 14 else other)
        for index in range(25)
    ]
    # It is said once for each state, however the episodes ended.
    assert [text for text in sentences(level, fspa, now) if "this remained" in text] == [
        f"in 14 of 25 failures, this remained: {label_text(fspa, first).rstrip('.')} (state {first})",
        f"in 11 of 25 failures, this remained: {label_text(fspa, other).rstrip('.')} (state {other})",
    ]


ANY_ORDER = SPEC.replace("near(s1) then near(s2) then near(exit)", "near(s1)  reach near(s2)  reach near(exit)")


def after(fspa: Fspa, *reached: str) -> list[int]:
    """The states of an episode that reaches these entities in this order."""
    states = [0]
    for name in reached:
        letter = [atom_record.name == f"near({name})" or atom_record.name == "alive" for atom_record in fspa.atoms]
        states.append(
            next(
                edge.target
                for edge in fspa.edges_from(states[-1])
                if any(all(letter[atom] == holds for atom, holds in prime) for prime in edge.guard.primes)
            )
        )
    return states


def test_stages_in_any_order_are_described_by_what_was_reached(level: StealthLevel) -> None:
    (fspa,) = compile_text(ANY_ORDER)
    ways = [("s1", "s2", "exit"), ("s1", "s2")]
    before = [an_episode(index, states=after(fspa, *ways[0])) for index in range(25)]
    now = [an_episode(index, index >= 15, states=after(fspa, *ways[index < 15])) for index in range(25)]
    stage = sentences(level, fspa, now, before)[0]
    assert stage.endswith("as before, then reaches `exit` in 10 of 25 episodes; before: in 25 of 25 episodes")


def test_stages_that_differ_between_episodes_are_described_by_the_count_of_goals(level: StealthLevel) -> None:
    (fspa,) = compile_text(ANY_ORDER)
    ways = [("s1", "s2", "exit"), ("exit", "s1", "s2")]
    before = [an_episode(index, states=after(fspa, *ways[index % 2])) for index in range(25)]
    now = [
        an_episode(index, index >= 15, states=after(fspa, *ways[index % 2][: 2 if index < 15 else 3]))
        for index in range(25)
    ]
    stage = sentences(level, fspa, now, before)[0]
    assert stage.endswith(
        ", then reaches 2 of the 3 goals `s1`, `s2` and `exit` as before, "
        "then meets the spec in 10 of 25 episodes; before: in 25 of 25 episodes"
    )


def test_goals_in_any_order_are_counted_in_what_remained(level: StealthLevel) -> None:
    (fspa,) = compile_text(ANY_ORDER)
    before = [an_episode(index, states=after(fspa, "s1", "s2", "exit")) for index in range(25)]
    now = [an_episode(index, False, states=after(fspa, *(("exit", "s1") if index < 15 else ()))) for index in range(25)]
    remained = [sentence for sentence in sentences(level, fspa, now, before) if "failures" in sentence]
    assert remained[0].startswith("in 15 of 25 failures, 2 of 3 goals were reached: `s1` and `exit`; `s2` was missed (")
    assert remained[1] == "in 10 of 25 failures, 0 of 3 goals were reached; `s1`, `s2` and `exit` were missed (state 0)"


def test_a_limit_of_less_than_half_is_called_most_often(level: StealthLevel, fspa: Fspa) -> None:
    near = [
        NearestMiss("alive", -0.5, MIDDLE),
        *(NearestMiss(f"near({name})", -0.4, MIDDLE, name, 2.5) for name in ("s1", "s2")),
    ]
    now = [an_episode(index, False, states=states_after(fspa, 0), nearest=near[index % 3]) for index in range(25)]
    assert "; most often, `alive` was not reached (-0.50 at best, it holds above 0)" in sentences(level, fspa, now)[1]


def test_a_limit_that_is_no_distance_names_the_atom(level: StealthLevel, fspa: Fspa) -> None:
    near = [NearestMiss("alive", value, MIDDLE) for value in (-0.75, -0.25, -0.5)]
    now = [an_episode(index, False, states=states_after(fspa, 0), nearest=near[index % 3]) for index in range(25)]
    assert sentences(level, fspa, now)[1].endswith("; `alive` was not reached (-0.25 at best, it holds above 0)")


def test_the_limit_of_most_episodes_is_named(level: StealthLevel, fspa: Fspa) -> None:
    best, most = NearestMiss("alive", 0.0, MIDDLE), NearestMiss("near(s1)", -0.4, MIDDLE, "s1", 2.5)
    now = [
        an_episode(index, False, states=states_after(fspa, 0), nearest=best if index == 7 else most)
        for index in range(25)
    ]
    assert "; closest approach to `s1`: 2.5 m (`near(s1)` holds below 1.0 m)" in sentences(level, fspa, now)[1]


@pytest.mark.parametrize(
    ("came", "approach"),
    [
        (1.06, "1.1 m (`near(s1)` holds below 1.0 m)"),
        (1.04, "1.04 m (`near(s1)` holds below 1.00 m)"),
        (1.0, "1.00 m (`near(s1)` holds below that)"),
    ],
)
def test_near_misses_have_enough_decimals(level: StealthLevel, fspa: Fspa, came: float, approach: str) -> None:
    near = NearestMiss("near(s1)", -0.01, MIDDLE, "s1", came)
    now = [an_episode(index, False, states=states_after(fspa, 0), nearest=near) for index in range(25)]
    assert f"; closest approach to `s1`: {approach}" in sentences(level, fspa, now)[1]


def test_a_distance_that_depends_on_a_param_has_no_threshold(level: StealthLevel) -> None:
    (fspa,) = compile_text(
        SPEC.replace("near(s1)", "near(s1, close=arm)").replace("spec", "param arm: length = 2 m\nspec")
    )
    near = NearestMiss("near(s1, close=arm)", -0.4, MIDDLE, "s1", 2.5)
    now = [an_episode(index, False, states=states_after(fspa, 0), nearest=near) for index in range(25)]
    assert (
        "; closest approach to `s1`: 2.5 m (`near(s1, close=arm)` was not reached)"
        in sentences(level, fspa, now, successes(fspa))[1]
    )


def test_episodes_at_the_target_when_the_spec_broke_are_counted(level: StealthLevel, fspa: Fspa) -> None:
    not_yet = NearestMiss("near(s1)", -0.4, MIDDLE, "s1", 2.5)
    episode_fields = {"cause": "killed", "broke": ("alive",), "nearest": not_yet}
    now = [
        an_episode(index, False, states=states_after(fspa, 0), arrived=index < 14, **episode_fields)
        for index in range(25)
    ]  # type: ignore[arg-type]
    end = sentences(level, fspa, now)[1]
    assert end.endswith("; 14 of them were at `s1` when it broke")
    few = [replace(explained, arrived=explained.summary.index < 3) for explained in now]
    approach = "closest approach of the others to `s1`: 2.5 m (`near(s1)` holds below 1.0 m)"
    assert f"; 3 of them were at `s1` when it broke; {approach}" in sentences(level, fspa, few)[1]


def test_an_atom_that_must_not_hold_is_described_as_such(level: StealthLevel, fspa: Fspa) -> None:
    near = NearestMiss("visible", -1.0, MIDDLE, wanted=False)
    now = [an_episode(index, False, states=states_after(fspa, 0), nearest=near) for index in range(25)]
    assert sentences(level, fspa, now)[1].endswith("; `visible` still held")
    with_open = [replace(explained, nearest=NearestMiss("open", -1.0, MIDDLE)) for explained in now]
    assert sentences(level, fspa, with_open)[1].endswith("; `open` was not reached")
    at_times = [replace(explained, nearest=NearestMiss("open", -1.0, MIDDLE, reached=True)) for explained in now]
    text = sentences(level, fspa, at_times)[1]
    assert text.endswith("; `open` held at times, but not together with the rest")


def test_the_order_of_killers_does_not_count(level: StealthLevel, fspa: Fspa) -> None:
    now = deaths(fspa, 14)
    now[:14] = [
        replace(explained, by=("b", "a") if explained.summary.index % 2 else ("a", "b")) for explained in now[:14]
    ]
    assert sentences(level, fspa, now)[1].startswith("dies in the north hall by `a` and `b` in 14 of 25")


def test_a_region_that_kills_is_named_once(level: StealthLevel, fspa: Fspa) -> None:
    now = deaths(fspa, 14, by=("north_hall",))
    assert sentences(level, fspa, now)[1].startswith("dies in the north hall in 14 of 25 episodes")


def test_places_with_the_same_text_are_one_group(level: StealthLevel, fspa: Fspa) -> None:
    """A place outside the region `middle` is in the middle of the level, too."""
    region = Region("middle", Box((3.8, 3.8, 0.0), (4.2, 4.2, 3.0)))
    places = ((4.0, 4.0, 0.0), MIDDLE)
    now = [an_episode(index, False, states=states_after(fspa, 0), place=places[index % 2]) for index in range(25)]
    end = findings(replace(level, regions=(region,)), fspa, now, successes(fspa))[1]
    assert end.text.startswith("runs out of time in the middle in 25 of 25 episodes")
    assert end.mentions.regions == ("middle",)


def test_an_obstacle_is_named(level: StealthLevel, fspa: Fspa) -> None:
    now = [an_episode(index, False, states=states_after(fspa, 0), place=(9.5, 5.0, 0.0)) for index in range(25)]
    end = findings(level, fspa, now, successes(fspa))[1]
    assert "runs out of time in the east, at `outer_east`, in 25 of 25" in end.text
    assert end.mentions == Mentions(("outer_east",))


@pytest.mark.parametrize(
    ("steps", "text"),
    [
        (130, "takes 30 more steps (4.50 s) to meet the spec: 130 on average; before: 100"),
        (80, "takes 20 fewer steps (3.00 s) to meet the spec: 80 on average; before: 100"),
        (110, None),
    ],
)
def test_longer_and_shorter_successes_are_described(
    level: StealthLevel, fspa: Fspa, steps: int, text: str | None
) -> None:
    now = [changed(explained, steps=steps) for explained in successes(fspa)]
    assert sentences(level, fspa, now)[1:] == ([text] if text else [])


def test_successes_without_positions_pass_through_no_region(level: StealthLevel, fspa: Fspa) -> None:
    now = [replace(explained, way=(), place=None) for explained in successes(fspa)]
    assert sentences(level, fspa, now, now)[1:] == []
    assert sentences(level, fspa, now, successes(fspa))[1:] == []


def test_a_new_route_of_successes_is_described(level: StealthLevel, fspa: Fspa) -> None:
    through = ((2.0, 2.0, 0, 0.0), (5.0, 9.0, 1, 2.0), (8.0, 8.0, 2, 4.0))
    now = [
        replace(explained, way=through) if explained.summary.index < 20 else explained for explained in successes(fspa)
    ]
    text = "80% of the successful episodes pass through the north hall; before: 0%"
    (_, route) = findings(level, fspa, now, successes(fspa))
    assert (route.text, route.mentions) == (text, Mentions(regions=("north_hall",)))
    assert sentences(level, fspa, successes(fspa), now)[1:] == [
        text.replace("80%", "0%").replace("before: 0%", "before: 80%")
    ]


def test_findings_refer_to_existing_episodes(level: StealthLevel, fspa: Fspa) -> None:
    now = [an_episode(index, index % 3 > 0, states=states_after(fspa, index % 4)) for index in range(30)]
    indices = {explained.summary.index for explained in now}
    for finding in findings(level, fspa, now, successes(fspa)):
        assert set(finding.episodes) <= indices
        assert list(finding.episodes) == sorted(set(finding.episodes))


MEASURED = """
signal x: length in [0 m, 10 m]
signal spin: number in [-50, 50]
signal fell: bool
spec go { limit 100 steps  reach x >= 7 m  keep spin < 12  avoid fell }
"""


def test_a_comparison_is_missed_by_a_length(level: StealthLevel) -> None:
    (fspa,) = compile_text(MEASURED)
    misses = [
        NearestMiss("x < 7", -0.1, MIDDLE, wanted=False, missed=Measure("x", 7 - gap, gap, "m")) for gap in (3, 1)
    ]
    now = [an_episode(index, False, nearest=misses[index % 2]) for index in range(25)]
    (stage, end, *_) = sentences(level, fspa, now, [an_episode(index, states=(0, 1)) for index in range(25)])
    assert stage == "no longer makes `x >= 7` true: in 0 of 25 episodes; before: in 25 of 25 episodes"
    assert end.endswith("; `x >= 7` was missed by 1.00 m at best")


def test_a_breach_without_a_time_needs_no_comma(level: StealthLevel) -> None:
    (fspa,) = compile_text(MEASURED)
    spins = [Measure("spin", 12 + gap, gap, "") for gap in (0.5, 2.1)]
    now = [
        replace(an_episode(index, False, cause="violated", by=("spin < 12",)), measured=spins[index % 2])
        for index in range(25)
    ]
    before = [an_episode(index, states=(0, 1)) for index in range(25)]
    texts = sentences(level, fspa, now, before)
    assert any(text.endswith("; `spin` reached 14.1 at worst") for text in texts), texts


def test_a_comparison_that_only_equality_misses_is_just_missed(level: StealthLevel) -> None:
    (fspa,) = compile_text(MEASURED)
    miss = NearestMiss("x < 7", -0.0, MIDDLE, wanted=True, missed=Measure("x", 7.0, 0.0, "m"))
    now = [an_episode(index, False, nearest=miss) for index in range(25)]
    met = [an_episode(index, states=(0, 1)) for index in range(25)]
    (end,) = [text for text in sentences(level, fspa, now, met) if "missed" in text]
    assert end.endswith("; `x < 7` was just missed")


def test_a_broken_clause_is_quoted_with_how_far_and_when_it_broke(level: StealthLevel) -> None:
    (fspa,) = compile_text(MEASURED)
    spins = [Measure("spin", 12 + gap, gap, "rad/s") for gap in (0.5, 2.1)]
    broken: dict[str, Any] = {"cause": "violated", "by": ("spin < 12",), "place": NORTH}
    now = [
        replace(
            an_episode(index, False, **broken),
            clauses=("keep spin < 12 rad/s",),
            measured=spins[index % 2],
            seconds=2.0 + 0.1 * index,
        )
        for index in range(25)
    ]
    met = [an_episode(index, states=(0, 1)) for index in range(30)]
    (end,) = [text for text in sentences(level, fspa, now, met) if "breaks" in text]
    assert end == (
        "breaks `keep spin < 12 rad/s` in the north hall in 25 of 25 episodes; before: in 0 of 30 episodes; "
        "`spin` reached 14.1 rad/s at worst, at 2.0 s to 4.4 s"
    )
    (only, *_) = [text for text in sentences(level, fspa, [*now[:1], *met], met) if "breaks" in text]
    assert "in 1 of 31 episodes (3%)" in only


def test_the_most_frequent_of_the_broken_quantities_is_told_of_traces_without_times() -> None:
    (fspa,) = compile_text(MEASURED)
    measures = [Measure("x", 9.0, 2.0, "m"), Measure("x", 8.0, 1.0, "m"), Measure("spin", 40.0, 28.0, "")]
    now = [replace(an_episode(index, False), measured=measures[index % 3]) for index in range(30)]
    breach = approach_phrase(None, fspa, Subgoal(), now)
    assert breach.text == "; `x` reached 9.00 m at worst"


def test_a_clause_that_two_atoms_break_is_quoted_with_the_atom(level: StealthLevel) -> None:
    (fspa,) = compile_text(MEASURED)
    now = [
        replace(
            an_episode(index, False, cause="violated", by=("fell",) if index % 2 else ("spin < 12",)),
            clauses=("keep spin < 12 and not fell",),
        )
        for index in range(24)
    ]
    texts = [text for text in sentences(level, fspa, now, now) if "breaks" in text]
    clause = "breaks `keep spin < 12 and not fell` in the middle"
    assert [text.partition(" in 12")[0] for text in texts] == [f"{clause} (`spin < 12`)", f"{clause} (`fell`)"]
