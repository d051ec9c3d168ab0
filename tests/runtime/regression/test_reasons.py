"""The sentences that give the reasons of verdicts."""

from __future__ import annotations

from collections.abc import Sequence

import pytest

from tests.runtime.regression.handmade import PLAYED, summaries
from tltl_runtime.game.level import default_spec
from tltl_runtime.game.mentions import Mentions
from tltl_runtime.regression.report.reasons import edits, obstacles, reasons, version_changes
from tltl_runtime.regression.suite.changed_lines import changed_lines
from tltl_runtime.regression.suite.suite import Thresholds
from tltl_runtime.regression.verdict.baseline import Identity, text_sha256
from tltl_runtime.regression.verdict.level_texts import Texts
from tltl_runtime.regression.verdict.verdict import Judgement, judge
from tltl_runtime.spec.task import load_task
from tltl_runtime.stealth.levels.file import load_level
from tltlc.core.record import replace

DEFAULT = Thresholds()


def reasons_of(passed: int, failed: int, reward: float = 0.0) -> list[str]:
    """The reasons of a verdict; the rewards differ by ``reward`` from the rewards of the baseline."""
    before = summaries(passed + failed)
    now = [replace(episode, reward=episode.reward + reward) for episode in summaries(passed, failed)]
    judgement = judge(now, before, passed + failed, DEFAULT, 0.05)
    assert judgement is not None
    return list(reasons(judgement, DEFAULT, now, before))


def edit_texts(
    now: Identity, before: Identity, descriptions: Sequence[str], texts: Texts = (), texts_before: Texts = ()
) -> list[str]:
    return [edit.text for edit in edits(now, before, descriptions, texts, texts_before)]


@pytest.mark.parametrize(
    ("passed", "failed", "text"),
    [
        (40, 0, "met in 40 of 40 episodes, before in 40 of 40: certainly in 85% or more"),
        (2, 30, "met in 2 of 32 episodes (6%), before in 32 of 32: certainly in less than 50%"),
        (140, 60, "met in 140 of 200 episodes (70%), before in 200 of 200: certainly in 50% to 85%"),
    ],
)
def test_a_certain_pass_rate_is_stated(passed: int, failed: int, text: str) -> None:
    assert reasons_of(passed, failed)[0] == text


def test_thresholds_are_shown_as_they_were_chosen() -> None:
    chosen = replace(DEFAULT, pass_rate=0.995, fail_rate=0.125)
    judgement = Judgement("pass", True, (0.9985, 1.0), ())
    (passed,) = reasons(judgement, chosen, summaries(3000), summaries(3000))
    assert passed.endswith(": certainly in 99.5% or more")
    (failed,) = reasons(
        replace(judgement, verdict="fail", rate_interval=(0.0, 0.125)), chosen, summaries(1), summaries(1)
    )
    assert failed.endswith(": certainly in less than 12.5%")


def test_an_uncertain_pass_rate_is_stated() -> None:
    (first, *_) = reasons_of(86, 14)
    assert first == (
        "met in 86 of 100 episodes (86%), before in 100 of 100: "
        "with so few episodes, the true rate may be as low as 72%, and 85% or more is required"
    )


def test_certain_changes_are_stated() -> None:
    assert reasons_of(60, 0, -0.3)[1:] == ["reward is lower, 0.400 on average; before: 0.700"]
    assert reasons_of(120, 0, 0.2)[1:] == ["reward is higher, 0.900 on average; before: 0.700"]


def test_uncertain_changes_are_stated() -> None:
    (rate, figure) = reasons_of(40, 0, -0.06)
    assert rate == "met in 40 of 40 episodes, before in 40 of 40: certainly in 85% or more"
    assert figure == "reward is lower, 0.640 on average; before: 0.700; the difference is 0.05 or more, but not certain"
    assert len(reasons_of(40, 0, -0.04)) == 1


def test_uncertain_changes_refer_to_the_compared_episodes() -> None:
    """The report shows the means of all episodes of the baseline beside the sentence."""
    now = [replace(episode, reward=0.64) for episode in summaries(40)]
    before = [*summaries(40), *(replace(episode, reward=0.78) for episode in summaries(60))]
    judgement = Judgement("review", False, (0.86, 1.0), ())
    (_, figure) = reasons(judgement, DEFAULT, now, before)
    assert figure == (
        "reward is lower, 0.640 on average; before, in the same 40 episodes: 0.700 (in all 100: 0.748); "
        "the difference is 0.05 or more, but not certain"
    )


def test_a_certain_change_is_not_called_uncertain_too() -> None:
    """The rate stays near `fail_rate` to the end, and progress and reward have fallen with it."""
    sentences = reasons_of(150, 150)
    assert sentences[0].endswith(": the true rate may be 39% to 61%, and 85% or more is required")
    assert [sentence.partition(" ")[0] for sentence in sentences[1:]] == ["progress", "reward"]
    assert not any("not certain" in sentence for sentence in sentences)


def test_an_unreachable_entity_is_reported() -> None:
    level = load_level("navigation", "v2")
    task = load_task(default_spec(level))
    # The exit cannot be reached either, since the path to it ends at the same obstacle.
    (sentence,) = obstacles(level, task.fspa)
    assert sentence.text == (
        "nobody can reach `s2` in `navigation:v2`, so nobody can do what `navigation` asks: "
        "the way ends at `corridor_block_2`, which is 2.2 m high"
    )
    assert sentence.mentions == Mentions(("s2", "corridor_block_2"))
    open_level = load_level("navigation", "v1")
    assert list(obstacles(open_level, task.fspa)) == []


def test_changed_files_are_listed() -> None:
    now = replace(PLAYED, files=(("room.toml", "d" * 64), ("assets/guard.toml", "0" * 64), ("overlays/x.toml", "1")))
    assert edit_texts(now, PLAYED, []) == ["changed since the baseline: assets/guard.toml, overlays/x.toml"]
    without_asset = replace(PLAYED, files=PLAYED.files[:1])
    assert edit_texts(without_asset, PLAYED, []) == ["changed since the baseline: assets/guard.toml"]
    assert edit_texts(PLAYED, PLAYED, []) == []


def test_changed_keys_are_listed() -> None:
    now = replace(PLAYED, files=(("room.toml", "1"), ("assets/guard.toml", "2"), ("overlays/x.toml", "3")))
    new = (("room.toml", "size = 3"), ("assets/guard.toml", "walk_speed = 2.6"), ("overlays/x.toml", "a = 1"))
    old = (("room.toml", "size = "), ("assets/guard.toml", "walk_speed = 1.6"))
    assert edit_texts(now, PLAYED, [], new, old) == [
        "changed since the baseline: room.toml, assets/guard.toml (`walk_speed` 1.6 → 2.6), overlays/x.toml"
    ]


YARD = """
[game]
process = ["./game"]
[[scene]]
name = "yard"
options = { size = 6 }
variants = { v1 = { options = { size = 8 } }, v2 = { options = { dog = 2 } } }
[[scene]]
name = "alley"
options = { size = 3 }
"""


def scene_edits(now: str, before: str = YARD, variant: str = "v1", **others: str) -> list[str]:
    """The edits of the scene `yard`, whose game file had the text ``before`` and has the text ``now``."""
    old, new = [("g.game.toml", before)], [("g.game.toml", now)]
    for name, text in others.items():
        old.append((f"{name}.tscn", "\n".join("abcdefgh")))
        new.append((f"{name}.tscn", text))
    played, recorded = (
        replace(PLAYED, level="yard", files=tuple((name, text_sha256(text)) for name, text in texts))
        for texts in (new, old)
    )
    return edit_texts(replace(played, variant=variant), recorded, [], tuple(new), tuple(old))


@pytest.mark.parametrize(
    ("before", "now", "text"),
    [
        ("size = 6", "size = 7", "`scene.yard.options.size` 6 → 7"),
        ("size = 8", "size = 9", "`scene.yard.variants.v1.options.size` 8 → 9"),
        ("./game", "./play", "`game.process`"),
        ("size = 3", "size = 4", None),
        ("dog = 2", "dog = 3", None),
        ("[game]", "# A yard.\n[game]", None),
    ],
)
def test_a_change_of_a_game_file_counts_only_for_the_scenes_that_it_affects(
    before: str, now: str, text: str | None
) -> None:
    edited = scene_edits(YARD.replace(before, now))
    expected = [] if text is None else [f"changed since the baseline: g.game.toml ({text}"]
    assert [edit.partition(" [")[0].rstrip(")") for edit in edited] == [part.rstrip(")") for part in expected]


@pytest.mark.parametrize(
    ("text", "lines"),
    [
        ("aBcdefgh", "line 2"),
        ("aBcdeFGh", "line 2, lines 6 to 7"),
        ("adefgh", "2 lines removed after line 1"),
        ("bcdefgh", "1 line removed at the start"),
        ("abcdefghij", "lines 9 to 10"),
        ("AbCdEfGh", "line 1, line 3, line 5 and 1 more"),
    ],
)
def test_the_changed_lines_of_a_text_file_are_named(text: str, lines: str) -> None:
    assert scene_edits(YARD, crates="\n".join(text)) == [f"changed since the baseline: crates.tscn ({lines})"]


def test_files_with_very_many_changed_lines_are_not_compared_line_by_line() -> None:
    assert changed_lines("a\n" * 2_000 + "b", "c\n" * 2_000 + "b") == "lines 1 to 2000"


def test_the_things_whose_keys_have_changed_are_mentioned() -> None:
    now = replace(PLAYED, files=(("room.toml", "1"), *PLAYED.files[1:]))
    old, new = ((("room.toml", f'[[wall]]\nname = "far_wall"\nheight = {height}'),) for height in (2, 3))
    (edit,) = edits(now, PLAYED, [], new, old)
    assert edit.text == "changed since the baseline: room.toml (`wall.far_wall.height` 2 → 3)"
    assert "far_wall" in edit.mentions.things


def test_another_variant_differs_by_its_overlays() -> None:
    now = replace(PLAYED, variant="v1", files=(*PLAYED.files, ("overlays/x.toml", "1")))
    assert edit_texts(now, PLAYED, ["The way is shut."]) == [
        "differs from `v0` by overlays/x.toml",
        "The way is shut.",
    ]
    assert edit_texts(PLAYED, now, []) == ["differs from `v1` by overlays/x.toml"]
    both_changed = replace(now, files=(("room.toml", "2"), *now.files[1:]))
    assert edit_texts(both_changed, PLAYED, []) == [
        "changed since the baseline: room.toml",
        "differs from `v0` by overlays/x.toml",
    ]
    # An overlay of both variants was read twice, and its contents differ.
    other = replace(now, variant="v2", files=(*PLAYED.files, ("overlays/x.toml", "2")))
    assert edit_texts(other, now, []) == ["changed since the baseline: overlays/x.toml"]


def test_other_versions_are_reported() -> None:
    before = replace(PLAYED, versions={"tltlc": "0.1", "numpy": "1.26.4", "pybullet": "3.2"})
    now = replace(PLAYED, versions={"tltlc": "0.1", "numpy": "2.0.1"})
    assert edit_texts(now, before, []) == []
    assert list(version_changes(now, before)) == [
        "the baseline was recorded with numpy 1.26.4, this run with 2.0.1",
        "the baseline was recorded with pybullet 3.2, this run without it",
    ]
