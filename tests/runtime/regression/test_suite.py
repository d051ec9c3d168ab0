"""Suites as they are read; what is refused, goldens have."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.runtime.regression.made import ROOM
from tltl_runtime.policies.shipped import shipped_policy
from tltl_runtime.regression.suite import MOST_EPISODES, SHIPPED, Case, Thresholds, read_suite
from tltl_runtime.stealth.levels.file import level_names, variants
from tltlc.diagnostics.diagnostic import TltlError

POLICY = 'policy = "navigation"\n'


def read(folder: Path, text: str) -> tuple[Case, ...]:
    (folder / "game.toml").write_text(text, encoding="utf-8")
    return read_suite(folder / "game.toml").cases


def test_the_shipped_suite_has_every_level_in_every_variant() -> None:
    found = read_suite(SHIPPED)
    assert [(case.level, case.variant) for case in found.cases] == [
        (level, variant) for level in ("navigation", "cover_and_hide", "branching") for variant in variants(level)
    ]
    assert {case.level for case in found.cases} == set(level_names())
    assert all(case.policy == shipped_policy(case.level) and case.reference == "v0" for case in found.cases)
    assert [case.name for case in found.cases[:2]] == ["navigation:v0", "navigation:v1"]


def test_what_a_case_does_not_say(tmp_path: Path) -> None:
    (case,) = read(tmp_path, '[[case]]\nlevel = "branching"\n')
    assert case == Case(
        name="branching:v0",
        level="branching",
        variant="v0",
        reference="v0",
        spec=None,
        policy=shipped_policy("branching"),  # type: ignore[arg-type]
        episodes=MOST_EPISODES,
        thresholds=Thresholds(),
    )
    read_ = read_suite(tmp_path / "game.toml")
    assert (read_.seed, read_.error) == (0, 0.05)


def test_a_case_has_what_its_suite_says_unless_it_says_otherwise(tmp_path: Path) -> None:
    text = """seed = 5
error = 0.1
episodes = 50
thresholds = { pass_rate = 0.9, reward = 0.2 }
[[case]]
level = "navigation"
[[case]]
level = "navigation"
variant = "v2"
reference = "v1"
name = "shut"
episodes = 25
[case.thresholds]
pass_rate = 0.6
"""
    first, second = read(tmp_path, text)
    assert (first.episodes, first.thresholds) == (50, Thresholds(0.9, 0.5, 0.05, 0.2))
    assert (second.episodes, second.thresholds) == (25, Thresholds(0.6, 0.5, 0.05, 0.2))
    assert (second.name, second.variant, second.reference) == ("shut", "v2", "v1")


def test_paths_are_relative_to_the_suite(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    game = tmp_path / "game"
    for name in ("levels/vault.toml", "levels/plans.tltl", "edits/wide.toml", "trained/policy.safetensors"):
        (game / name).parent.mkdir(parents=True, exist_ok=True)
        (game / name).write_text(ROOM, encoding="utf-8")
    (game / "game.toml").write_text(
        """[[case]]
level = "levels/vault.toml"
overlay = ["guard_alert", "edits/wide.toml"]
spec = "levels/plans.tltl:careful"
policy = "trained"
""",
        encoding="utf-8",
    )
    monkeypatch.chdir(tmp_path)
    (case,) = read_suite(Path("game/game.toml")).cases
    assert case.level == "game/levels/vault.toml"
    assert case.variant == "v0+guard_alert+game/edits/wide.toml"
    assert case.name == "vault:v0+guard_alert+wide"
    assert (case.spec, case.policy) == ("game/levels/plans.tltl:careful", Path("game/trained"))


def test_one_overlay_needs_no_list(tmp_path: Path) -> None:
    (case,) = read(tmp_path, '[[case]]\nlevel = "branching"\noverlay = "guard_alert"\n')
    assert (case.variant, case.name) == ("v0+guard_alert", "branching:v0+guard_alert")


def test_a_policy_of_another_level_is_named_by_that(tmp_path: Path) -> None:
    (case,) = read(tmp_path, '[[case]]\nlevel = "branching"\npolicy = "cover_and_hide"\n')
    assert case.policy == shipped_policy("cover_and_hide")


@pytest.mark.parametrize("text", ["doc = ", 'doc = "x"\nvariants = 3\n', "\0"])
def test_a_level_that_does_not_load_is_its_cases_finding_and_not_the_suites(tmp_path: Path, text: str) -> None:
    (tmp_path / "vault.toml").write_text(text, encoding="utf-8")
    asked = '[[case]]\nlevel = "vault.toml"\n' + POLICY
    first, second = read(tmp_path, asked + asked + 'variant = "v3"\n')
    assert (first.variant, second.variant) == ("v0", "v3")


@pytest.mark.parametrize("name", ["nowhere.toml", "."])
def test_a_suite_that_cannot_be_read(tmp_path: Path, name: str) -> None:
    with pytest.raises(TltlError) as error:
        read_suite(tmp_path / name)
    assert [found.code for found in error.value.diagnostics] == ["TLT0001"]


@pytest.mark.parametrize(
    ("key", "name"),
    [("level", ".toml"), ("level", ""), ("policy", ""), ("spec", ".tltl:careful"), ("overlay", ".toml")],
)
def test_a_name_that_no_file_can_have_is_a_missing_one(tmp_path: Path, key: str, name: str) -> None:
    keys = {"level": "navigation", key: "a" * 300 + name}
    with pytest.raises(TltlError) as error:
        read(tmp_path, "[[case]]\n" + "".join(f'{each} = "{value}"\n' for each, value in keys.items()))
    (found,) = error.value.diagnostics
    assert found.title.startswith(f"there is no {key} `aaa")


def test_an_own_level_needs_a_policy_of_ones_own(tmp_path: Path) -> None:
    (tmp_path / "navigation.toml").write_text(ROOM, encoding="utf-8")
    with pytest.raises(TltlError, match=r"no policy comes with the level `.*navigation\.toml`"):
        read(tmp_path, '[[case]]\nlevel = "navigation.toml"\n')
