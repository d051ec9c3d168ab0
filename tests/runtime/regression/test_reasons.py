"""What verdicts are founded on, in sentences."""

from __future__ import annotations

import pytest

from tests.runtime.regression.made import PLAYED, several
from tltl_runtime.regression.explain.reasons import edits, obstacles, reasons
from tltl_runtime.regression.suite.suite import Thresholds
from tltl_runtime.regression.verdict.verdict import Judgement, judge
from tltl_runtime.spec.task import load_task
from tltl_runtime.stealth.levels.file import load_level
from tltlc.core.record import replace

DEFAULT = Thresholds()


def said(passed: int, failed: int, reward: float = 0.0) -> list[str]:
    """The reasons of the verdict on episodes whose rewards are otherwise by ``reward`` than the baseline's."""
    before = several(passed + failed)
    now = [replace(each, reward=each.reward + reward) for each in several(passed, failed)]
    judgement = judge(now, before, passed + failed, DEFAULT, 0.05)
    assert judgement is not None
    return list(reasons(judgement, DEFAULT, now, before))


@pytest.mark.parametrize(
    ("passed", "failed", "text"),
    [
        (40, 0, "met in 40 of 40 episodes, before in 40 of 40: certainly in 85% or more"),
        (2, 30, "met in 2 of 32 episodes (6%), before in 32 of 32: certainly in less than 50%"),
        (140, 60, "met in 140 of 200 episodes (70%), before in 200 of 200: certainly in 50% to 85%"),
    ],
)
def test_what_is_certain(passed: int, failed: int, text: str) -> None:
    assert said(passed, failed)[0] == text


def test_thresholds_are_told_as_they_were_chosen() -> None:
    chosen = replace(DEFAULT, pass_rate=0.995, fail_rate=0.125)
    judgement = Judgement("pass", True, (0.9985, 1.0), ())
    (passed,) = reasons(judgement, chosen, several(3000), several(3000))
    assert passed.endswith(": certainly in 99.5% or more")
    (failed,) = reasons(replace(judgement, verdict="fail", rate_interval=(0.0, 0.125)), chosen, several(1), several(1))
    assert failed.endswith(": certainly in less than 12.5%")


def test_what_is_not_certain() -> None:
    (first, *_) = said(86, 14)
    assert first.startswith("met in 86 of 100 episodes (86%), before in 100 of 100: ")
    assert first.endswith(" can be said for certain, and 85% are asked for")


def test_what_has_changed() -> None:
    assert said(60, 0, -0.3)[1:] == ["reward is lower, 0.40 on average; before: 0.70"]
    assert said(120, 0, 0.2)[1:] == ["reward is higher, 0.90 on average; before: 0.70"]


def test_what_may_have_changed() -> None:
    (rate, figure) = said(40, 0, -0.06)
    assert rate == "met in 40 of 40 episodes, before in 40 of 40: certainly in 85% or more"
    assert figure == "reward is lower, 0.64 on average; before: 0.70; that is 0.05 or more, but not certain"
    assert len(said(40, 0, -0.04)) == 1


def test_what_may_have_changed_is_told_of_the_episodes_that_are_compared() -> None:
    """The report shows the means of all of the baseline's episodes beside the sentence."""
    now = [replace(each, reward=0.64) for each in several(40)]
    before = [*several(40), *(replace(each, reward=0.78) for each in several(60))]
    judgement = Judgement("review", False, (0.86, 1.0), ())
    (_, figure) = reasons(judgement, DEFAULT, now, before)
    assert figure == (
        "reward is lower, 0.64 on average; before, in the same 40 episodes: 0.70 (in all 100: 0.75); "
        "that is 0.05 or more, but not certain"
    )


def test_what_has_certainly_changed_is_not_doubted_too() -> None:
    """Where the rate is near `fail_rate` to the end, and figures have fallen with it."""
    told = said(150, 150)
    assert told[0].endswith(" can be said for certain, and 85% are asked for")
    assert [each.partition(" ")[0] for each in told[1:]] == ["progress", "reward"]
    assert not any("not certain" in each for each in told)


def test_what_nobody_can_reach_is_told_for_certain() -> None:
    level = load_level("navigation", "v2")
    task = load_task(level.spec)
    # Nobody reaches the exit then either, since the way ends at the same.
    (told,) = obstacles(level, task.fspa)
    assert told == (
        "nobody reaches `s2` in `navigation:v2`, so nobody can do what `navigation` asks: "
        "the way ends at `corridor_block_2`, which is 2.2 m high"
    )
    open_ = load_level("navigation", "v1")
    assert list(obstacles(open_, task.fspa)) == []


def test_which_files_have_changed() -> None:
    now = replace(PLAYED, files=(("room.toml", "d" * 64), ("assets/guard.toml", "0" * 64), ("overlays/x.toml", "1")))
    assert list(edits(now, PLAYED, [])) == ["changed since the baseline: assets/guard.toml, overlays/x.toml"]
    gone = replace(PLAYED, files=PLAYED.files[:1])
    assert list(edits(gone, PLAYED, [])) == ["changed since the baseline: assets/guard.toml"]
    assert list(edits(PLAYED, PLAYED, [])) == []


def test_which_keys_have_changed() -> None:
    now = replace(PLAYED, files=(("room.toml", "1"), ("assets/guard.toml", "2"), ("overlays/x.toml", "3")))
    new = (("room.toml", "size = 3"), ("assets/guard.toml", "walk_speed = 2.6"), ("overlays/x.toml", "a = 1"))
    old = (("room.toml", "size = "), ("assets/guard.toml", "walk_speed = 1.6"))
    assert list(edits(now, PLAYED, [], new, old)) == [
        "changed since the baseline: room.toml, assets/guard.toml (`walk_speed` 1.6 → 2.6), overlays/x.toml"
    ]


def test_another_variant_differs_by_its_overlays_which_have_not_changed() -> None:
    now = replace(PLAYED, variant="v1", files=(*PLAYED.files, ("overlays/x.toml", "1")))
    assert list(edits(now, PLAYED, ["The way is shut."])) == [
        "differs from `v0` by overlays/x.toml",
        "The way is shut.",
    ]
    assert list(edits(PLAYED, now, [])) == ["differs from `v1` by overlays/x.toml"]
    both = replace(now, files=(("room.toml", "2"), *now.files[1:]))
    assert list(edits(both, PLAYED, [])) == [
        "changed since the baseline: room.toml",
        "differs from `v0` by overlays/x.toml",
    ]
    # An overlay that both have was read twice, and differs.
    other = replace(now, variant="v2", files=(*PLAYED.files, ("overlays/x.toml", "2")))
    assert list(edits(other, now, [])) == ["changed since the baseline: overlays/x.toml"]


def test_a_baseline_of_other_versions() -> None:
    before = replace(PLAYED, versions={"tltlc": "0.1", "numpy": "1.26.4", "pybullet": "3.2"})
    now = replace(PLAYED, versions={"tltlc": "0.1", "numpy": "2.0.1"})
    assert list(edits(now, before, [])) == [
        "the baseline was recorded with numpy 1.26.4, and this is 2.0.1",
        "the baseline was recorded with pybullet 3.2, and this is without it",
    ]
