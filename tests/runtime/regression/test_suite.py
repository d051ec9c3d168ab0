"""Reading suites; the golden tests cover the error messages."""

from __future__ import annotations

import json
import shutil
from pathlib import Path

import pytest

from tests import pipes
from tests.runtime.regression.handmade import ROOM
from tltl_runtime.game.level_name import Variant
from tltl_runtime.policies.shipped import shipped_policies, shipped_policy
from tltl_runtime.regression.suite.suite import MOST_EPISODES, SHIPPED, Case, Thresholds, read_suite
from tltl_runtime.stealth.levels.default_spec import LEVELS
from tltl_runtime.stealth.levels.file import variants
from tltlc.diagnostics.diagnostic import TltlError

POLICY = 'policy = "navigation"\n'


def read(folder: Path, text: str) -> tuple[Case, ...]:
    (folder / "game.toml").write_text(text, encoding="utf-8")
    return read_suite(folder / "game.toml").cases


def test_the_shipped_suite_plays_the_shipped_policies_in_every_variant() -> None:
    suite = read_suite(SHIPPED)
    assert [(case.level, case.variant) for case in suite.cases] == [
        (level, Variant(variant))
        for level in ("navigation", "cover_and_hide", "branching")
        for variant in variants(level)
    ]
    assert {case.level for case in suite.cases} == set(shipped_policies())
    assert all(case.policy == shipped_policy(case.level) and case.reference == "v0" for case in suite.cases)
    assert [case.name for case in suite.cases[:2]] == ["navigation:v0", "navigation:v1"]


def test_a_case_without_settings_gets_the_defaults(tmp_path: Path) -> None:
    (case,) = read(tmp_path, '[[case]]\nlevel = "branching"\n')
    assert case == Case(
        name="branching:v0",
        level="branching",
        variant=Variant("v0"),
        reference="v0",
        spec=None,
        policy=shipped_policy("branching"),  # type: ignore[arg-type]
        episodes=MOST_EPISODES,
        thresholds=Thresholds(),
    )
    suite = read_suite(tmp_path / "game.toml")
    assert (suite.seed, suite.error) == (0, 0.05)


def test_a_case_inherits_the_settings_of_its_suite(tmp_path: Path) -> None:
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
    assert (second.name, second.variant, second.reference) == ("shut", Variant("v2"), "v1")


def test_paths_are_relative_to_the_suite(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    game = tmp_path / "game"
    for name in ("levels/vault.toml", "levels/plans.tltl", "edits/wide.toml", "trained/policy.safetensors"):
        (game / name).parent.mkdir(parents=True, exist_ok=True)
        (game / name).write_text("spec careful = F alive" if name.endswith(".tltl") else ROOM, encoding="utf-8")
    shutil.copy(shipped_policy("navigation") or "", game / "trained" / "policy.safetensors")
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
    assert case.variant == Variant("v0", ("guard_alert", "game/edits/wide.toml"))
    assert case.name == "vault:v0+guard_alert+wide"
    assert (case.spec, case.policy) == ("game/levels/plans.tltl:careful", Path("game/trained"))


def test_a_single_overlay_needs_no_list(tmp_path: Path) -> None:
    (case,) = read(tmp_path, '[[case]]\nlevel = "branching"\noverlay = "guard_alert"\n')
    assert (case.variant, case.name) == (Variant("v0", ("guard_alert",)), "branching:v0+guard_alert")


def test_a_shipped_policy_is_named_by_its_level(tmp_path: Path) -> None:
    (case,) = read(tmp_path, '[[case]]\nlevel = "branching"\npolicy = "cover_and_hide"\n')
    assert case.policy == shipped_policy("cover_and_hide")


@pytest.mark.parametrize("text", ["doc = ", 'doc = "x"\nvariants = 3\n', "\0"])
def test_a_level_that_does_not_load_is_no_error_in_the_suite(tmp_path: Path, text: str) -> None:
    (tmp_path / "vault.toml").write_text(text, encoding="utf-8")
    case = '[[case]]\nlevel = "vault.toml"\n' + POLICY
    first, second = read(tmp_path, case + case + 'variant = "v3"\n')
    assert (first.variant, second.variant) == (Variant("v0"), Variant("v3"))


@pytest.mark.parametrize("name", ["nowhere.toml", "."])
def test_an_unreadable_suite_is_reported(tmp_path: Path, name: str) -> None:
    with pytest.raises(TltlError) as error:
        read_suite(tmp_path / name)
    assert [diagnostic.code for diagnostic in error.value.diagnostics] == ["TLT0001"]


@pytest.mark.parametrize(
    ("key", "name"),
    [("level", ".toml"), ("level", ""), ("policy", ""), ("spec", ".tltl:careful"), ("overlay", ".toml")],
)
def test_a_name_that_is_too_long_is_reported_as_missing(tmp_path: Path, key: str, name: str) -> None:
    keys = {"level": "navigation", key: "a" * 300 + name}
    with pytest.raises(TltlError) as error:
        read(tmp_path, "[[case]]\n" + "".join(f'{name} = "{value}"\n' for name, value in keys.items()))
    (diagnostic,) = error.value.diagnostics
    assert diagnostic.title.startswith(f"there is no {key} `aaa")


def test_a_user_level_needs_a_policy(tmp_path: Path) -> None:
    (tmp_path / "navigation.toml").write_text(ROOM, encoding="utf-8")
    with pytest.raises(TltlError, match=r"no policy comes with the level `.*navigation\.toml`"):
        read(tmp_path, '[[case]]\nlevel = "navigation.toml"\n')


def refused(folder: Path, case: str) -> list[tuple[str, str, str | None]]:
    """The code, title and help of each error in a case; all errors have a label in the suite file."""
    with pytest.raises(TltlError) as error:
        read(folder, f"[[case]]\n{case}")
    for diagnostic in error.value.diagnostics:
        assert Path(diagnostic.labels[0].source.name).name == "game.toml"
    return [(diagnostic.code, diagnostic.title, diagnostic.help) for diagnostic in error.value.diagnostics]


def test_a_missing_spec_is_an_error_in_the_suite(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    Path("plans.tltl").write_text("import stealth\nspec calm = F alive\nspec bold = G alive\n", encoding="utf-8")
    case = 'level = "navigation"\nspec = "plans.tltl'
    assert refused(Path(), f'{case}:clam"') == [("TLT0720", "`plans.tltl` has no spec `clam`", "did you mean `calm`?")]
    ((code, title, _),) = refused(Path(), f'{case}"')
    assert (code, title.partition(",")[0]) == ("TLT0721", "`plans.tltl` contains 2 specs")
    # A broken spec is a result of the run, not an error in the suite.
    Path("plans.tltl").write_text("spec calm = ((\n", encoding="utf-8")
    assert len(read(Path(), f'[[case]]\n{case}:calm"')) == 1


def test_an_unreadable_policy_is_an_error_in_the_suite(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    data = (shipped_policy("navigation") or Path()).read_bytes()
    for name, content in {"empty": b"", "cut": data[:-100], "text": b"no policy"}.items():
        Path(name).write_bytes(content)
        ((code, title, _),) = refused(Path(), f'level = "navigation"\npolicy = "{name}"')
        assert (code, f"`{name}`" in title) == ("TLT0840", True)
    Path("training/vault").mkdir(parents=True)
    folder = 'level = "navigation"\npolicy = "training'
    ((code, title, help_),) = refused(Path(), f'{folder}"')
    assert (code, title) == ("TLT0872", "there is neither a training nor a policy in `training`")
    Path("training/vault/run.json").write_text("{}", encoding="utf-8")
    ((_, title, help_),) = refused(Path(), f'{folder}"')
    assert title == "`training` contains trainings, but is not a training itself"
    assert help_ == "add the name of one of them to the path: `vault`"
    ((code, title, _),) = refused(Path(), f'{folder}/vault"')
    assert (code, title) == ("TLT0872", "the training in `training/vault` has no policy yet")
    Path("training/vault/policy.safetensors").write_bytes(data)
    assert len(read(Path(), f'[[case]]\n{folder}/vault"')) == 1


def test_the_help_for_a_missing_policy_lists_files_beside_the_suite(tmp_path: Path) -> None:
    (tmp_path / "mine.safetensors").touch()
    ((code, title, help_),) = refused(tmp_path, 'level = "navigation"\npolicy = "mine"')
    assert (code, title) == ("TLT0805", "there is no policy `mine`")
    assert help_ == "there are: `mine.safetensors`, `branching`, `cover_and_hide`, `navigation`"


@pytest.mark.parametrize(
    ("name", "meant"),
    [
        ("trianing/lake", "training/lake"),
        ("training/laek/policy.safetensors", "training/lake/policy.safetensors"),
        ("old/mien.safetensors", "old/mine.safetensors"),
        ("old/deep/er/still/x.safetensor", "old/deep/er/still/x.safetensors"),
        ("navigatoin", "navigation"),
    ],
)
def test_the_nearest_policy_is_suggested(tmp_path: Path, name: str, meant: str) -> None:
    for file in ("training/lake/policy.safetensors", "old/mine.safetensors", "old/deep/er/still/x.safetensors"):
        (tmp_path / file).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / file).touch()
    ((code, _, help_),) = refused(tmp_path, f'level = "navigation"\npolicy = "{name}"')
    assert (code, help_) == ("TLT0805", f"did you mean `{meant}`?")


def test_a_misspelt_key_of_another_table_is_found(tmp_path: Path) -> None:
    (tmp_path / "suite.toml").write_text(
        'pass_rat = 0.9\npolicy = "x"\n[[case]]\nlevel = "navigation"\nfail_rate = 0.1\n'
    )
    with pytest.raises(TltlError) as caught:
        read_suite(tmp_path / "suite.toml")
    assert [diagnostic.help for diagnostic in caught.value.diagnostics] == [
        "it is a key of `[thresholds]`",
        "did you mean `pass_rate`, a key of `[thresholds]`?",
        "it is a key of `[[case]]`",
    ]


@pytest.mark.parametrize(
    ("level", "meant"),
    [
        ("cover_and_hid", "cover_and_hide"),
        ("cover_and_hid.toml", "cover_and_hide"),
        ("levels/vualt.toml", "levels/vault.toml"),
        ("hall", "hall.toml"),
        ("hal.toml", "hall.toml"),
    ],
)
def test_a_similar_level_is_suggested(tmp_path: Path, level: str, meant: str) -> None:
    for name in ("levels/vault.toml", "hall.toml"):
        (tmp_path / name).parent.mkdir(exist_ok=True)
        (tmp_path / name).write_text(ROOM, encoding="utf-8")
    errors = refused(tmp_path, f'level = "{level}"\npolicy = "navigation"')
    assert errors == [("TLT0800", f"there is no level `{level}`", f"did you mean `{meant}`?")]


def test_pipes_are_not_read_to_suggest_a_level(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    pipes.put_beside(tmp_path / "hall.toml")
    pipes.forbid(monkeypatch)
    errors = refused(tmp_path, 'level = "hal.toml"\npolicy = "navigation"')
    assert errors == [("TLT0800", "there is no level `hal.toml`", "paths are relative to the suite")]


def test_the_shipped_policy_is_suggested_for_a_copy_of_its_level(tmp_path: Path) -> None:
    shutil.copy(LEVELS / "cover_and_hide.toml", tmp_path / "my_cover.toml")
    ((code, _, help_),) = refused(tmp_path, 'level = "my_cover.toml"')
    assert (code, (help_ or "").partition(", or ")[2]) == (
        "TLT0853",
        'the one for the same spec that comes with tltlc: `policy = "cover_and_hide"`',
    )


@pytest.mark.parametrize(
    ("keys", "error"),
    [
        (
            'scene = "hall:icy"\npolicy = "navigation"',
            ("TLT0803", "`hall:icy` is not the name of a scene", 'write `scene = "hall"`, `variant = "icy"`'),
        ),
        (
            'scene = "hall"',
            (
                "TLT0853",
                "no policy comes with the scene `{folder}/lake.game.toml:hall`",
                'name a policy that you trained, e.g. `policy = "training/hall"`',
            ),
        ),
        (
            'scene = "hall"\npolicy = "agent"',
            (
                "TLT0805",
                "there is no policy `agent`",
                "train it: `tltlc train --game {folder}/lake.game.toml:hall --out {folder}/agent`; "
                "paths are relative to the suite",
            ),
        ),
        (
            'scene = "hall"\npolicy = "bots/agent.safetensors"',
            (
                "TLT0805",
                "there is no policy `bots/agent.safetensors`",
                "train it: `tltlc train --game {folder}/lake.game.toml:hall --out {folder}/bots/agent`, and write "
                '`policy = "bots/agent"`; paths are relative to the suite',
            ),
        ),
        (
            'scene = "hall"\npolicy = "agent/policy.safetensors"',
            (
                "TLT0805",
                "there is no policy `agent/policy.safetensors`",
                "train it: `tltlc train --game {folder}/lake.game.toml:hall --out {folder}/agent`; "
                "paths are relative to the suite",
            ),
        ),
        (
            'scene = "hall"\npolicy = "agent"\nspec = "lake.tltl:cross"',
            (
                "TLT0805",
                "there is no policy `agent`",
                "train it: `tltlc train {folder}/lake.tltl:cross --game {folder}/lake.game.toml:hall "
                "--out {folder}/agent`; paths are relative to the suite",
            ),
        ),
    ],
)
def test_a_scene_needs_keys_of_its_own_for_its_variant_and_its_policy(
    tmp_path: Path, keys: str, error: tuple[str, str, str]
) -> None:
    (tmp_path / "lake.game.toml").write_text('[game]\ngymnasium = "FrozenLake-v1"\n\n[[scene]]\nname = "hall"\n')
    (tmp_path / "lake.tltl").write_text("signal done: bool\nspec cross = F done\n")
    code, title, help_ = error
    errors = refused(tmp_path, f'game = "lake.game.toml"\n{keys}')
    assert errors == [(code, title.format(folder=tmp_path), help_.format(folder=tmp_path))]


@pytest.mark.parametrize("key", ["name", "variant", "reference", "spec", "policy", "overlay", "level"])
def test_an_empty_text_is_rejected(tmp_path: Path, key: str) -> None:
    keys = {"level": "navigation", key: ""}
    errors = refused(tmp_path, "".join(f"{name} = {json.dumps(value)}\n" for name, value in keys.items()))
    assert errors == [("TLT0803", f'wrong value for `{key}`: ""', "expected a text that is not empty")]


def test_a_low_pass_rate_needs_a_lower_fail_rate(tmp_path: Path) -> None:
    errors = refused(tmp_path, 'level = "navigation"\nthresholds = { pass_rate = 0.4 }')
    title = "`pass_rate` is 0.4, below the `fail_rate`, which is 0.5 by default"
    assert errors == [("TLT0803", title, "write a `fail_rate`, too, of at most 0.4")]


@pytest.mark.parametrize(
    ("name", "what"),
    [("assets/guard", "an asset"), ("assets/corridor", "an asset"), ("overlays/guard_alert", "an overlay")],
)
def test_assets_and_overlays_are_no_suites(name: str, what: str) -> None:
    with pytest.raises(TltlError, match=f"TLT0803: this is {what}, not a suite"):
        read_suite(LEVELS / f"{name}.toml")


def test_a_suite_with_too_many_cases_is_rejected(tmp_path: Path) -> None:
    with pytest.raises(TltlError, match="TLT0006: the suite has more than 2,000 cases"):
        read(tmp_path, 2001 * '[[case]]\nlevel = "navigation"\n')


def test_each_level_of_a_suite_is_read_once(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    read_levels = []
    monkeypatch.setattr(
        "tltl_runtime.stealth.levels.file.variants", lambda level: read_levels.append(level) or variants(level)
    )
    cases = "".join(f'[[case]]\nlevel = "navigation"\nname = "n{number}"\n' for number in range(50))
    assert len(read(tmp_path, cases)) == 50
    assert read_levels == ["navigation"]


def test_reading_stops_after_many_errors(tmp_path: Path) -> None:
    with pytest.raises(TltlError) as caught:
        read(tmp_path, "".join(f'[[case]]\nlevel = "x{number}"\n' for number in range(2000)))
    diagnostics = caught.value.diagnostics
    assert len(diagnostics) == 101
    assert diagnostics[-1].title == "the last 1,900 cases were not read, because there are too many errors before them"
    with pytest.raises(TltlError) as caught:
        read(tmp_path, "".join(f'[[case]]\nlevel = "x{number}"\n' for number in range(101)))
    last = caught.value.diagnostics[-1].title
    assert last == "the last case was not read, because there are too many errors before it"
